//! The registers the driver touches, by name, so that an error can say which.

use core::fmt;

/// A register's address, which prints as its data-sheet name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Register(pub u8);

/// Bit 7 of the first byte: set to read, clear to write (product specification, 7.5 "SPI interface").
pub(crate) const READ: u8 = 0x80;

macro_rules! registers {
    ($($name:ident = $address:literal $what:literal)*) => {
        impl Register {
            $(#[doc = $what] pub const $name: Self = Self($address);)*

            /// The data sheet's name.
            pub fn name(self) -> &'static str {
                match self.0 { $($address => stringify!($name),)* _ => "UNNAMED" }
            }
        }
    };
}

registers! {
    SELF_TEST_X_GYRO = 0x00 "Factory trim code of the gyroscope's x axis; y and z follow."
    SELF_TEST_X_ACCEL = 0x0D "Factory trim code of the accelerometer's x axis; y and z follow."
    SMPLRT_DIV = 0x19 "Output rate = internal rate / (1 + this)."
    CONFIG = 0x1A "Gyroscope's low-pass filter."
    GYRO_CONFIG = 0x1B "Gyroscope's range and self-test."
    ACCEL_CONFIG = 0x1C "Accelerometer's range and self-test."
    ACCEL_CONFIG_2 = 0x1D "Accelerometer's low-pass filter."
    INT_PIN_CFG = 0x37 "How the INT pin behaves."
    INT_ENABLE = 0x38 "What raises INT."
    INT_STATUS = 0x3A "Data ready and its like; a burst of fifteen bytes begins here."
    SIGNAL_PATH_RESET = 0x68 "Clears the three signal paths; clears itself."
    USER_CTRL = 0x6A "Holds I2C_IF_DIS."
    PWR_MGMT_1 = 0x6B "Reset, sleep and the clock's source."
    PWR_MGMT_2 = 0x6C "Which axes are off."
    WHO_AM_I = 0x75 "The part's name."
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (0x{:02X})", self.name(), self.0)
    }
}
