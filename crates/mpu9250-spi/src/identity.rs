//! Which part answers, and whether to believe it.

use core::fmt;

use crate::register::Register;

/// A part that answered with a name we know.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Identity {
    /// The byte in `WHO_AM_I`.
    pub who_am_i: u8,
}

/// How far a name is to be trusted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Standing {
    /// The MPU9250 or a part with the same registers, ranges and noise.
    Known,
    /// A relative whose registers agree as far as is known; its figures may differ. Use it, and say so.
    Relative,
}

/// A part that is not used, with what it answered.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Refused {
    /// The byte in `WHO_AM_I`.
    pub who_am_i: u8,
}

impl Identity {
    /// The policy: 0x70, 0x71 and 0x73 are known, 0x74, 0x75 and 0x78 are relatives seen on boards sold as MPU9250,
    /// all else is refused: with foreign registers, a plausible reading would be the worst outcome.
    pub fn judge(who_am_i: u8) -> Result<Self, Refused> {
        match who_am_i {
            0x70 | 0x71 | 0x73 | 0x74 | 0x75 | 0x78 => Ok(Self { who_am_i }),
            _ => Err(Refused { who_am_i }),
        }
    }

    /// Known or only related.
    pub fn standing(self) -> Standing {
        match self.who_am_i {
            0x70 | 0x71 | 0x73 => Standing::Known,
            _ => Standing::Relative,
        }
    }

    /// The part's name, without spaces. 0x74 and 0x78 are named as in Linux' `inv_mpu6050` driver; 0x75 has no
    /// published name.
    pub fn name(self) -> &'static str {
        match self.who_am_i {
            0x70 => "MPU6500",
            0x71 => "MPU9250",
            0x73 => "MPU9255",
            0x74 => "MPU6515",
            0x78 => "MPU6880",
            _ => "MPU6500-like",
        }
    }
}

impl Refused {
    /// Nothing drives the line: 0x00 and 0xFF are an idle MISO, not a name.
    pub fn is_absent(self) -> bool {
        matches!(self.who_am_i, 0x00 | 0xFF)
    }

    /// What to do about it.
    pub fn remedy(self) -> &'static str {
        match self.who_am_i {
            0x00 => "MISO stays low: check the sensor's 3.3 V, ground and MISO wire, and that NCS reaches it",
            0xFF => "MISO stays high: check the NCS and SCK wires, and that the sensor is plugged in",
            0x68 => "this is an MPU6050 or MPU9150, which has no SPI: use an MPU9250, MPU9255 or MPU6500",
            0xEA => "this is an ICM20948, whose registers differ: use an MPU9250, MPU9255 or MPU6500",
            _ => "this is another part: use an MPU9250, MPU9255 or MPU6500, or check for a noisy or long wire",
        }
    }
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.is_absent() { "no sensor answers" } else { "a foreign sensor answers" };
        write!(f, "{what}: {} reads 0x{:02X}; {}", Register::WHO_AM_I, self.who_am_i, self.remedy())
    }
}
