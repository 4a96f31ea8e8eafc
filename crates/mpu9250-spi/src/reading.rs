//! One burst of fifteen bytes: status, accelerometer, temperature, gyroscope, taken together.

/// `INT_STATUS`.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Status(pub u8);

impl Status {
    /// The reading is new since the last one was read.
    pub fn is_fresh(self) -> bool {
        self.0 & 0x01 != 0
    }

    /// Only bits that the part has: 0 data ready, 3 FSYNC, 4 FIFO overflow, 6 wake on motion. A line that hangs high
    /// reads 0xFF and fails this; one that hangs low reads 0x00 and is not fresh.
    pub fn is_possible(self) -> bool {
        self.0 & 0b1010_0110 == 0
    }
}

/// One reading in counts, right-handed axes of the part, full scale at ±32768.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Reading {
    /// As read in the same burst.
    pub status: Status,
    /// Specific force.
    pub accel: [i16; 3],
    /// Die temperature; counts / 333.87 + 21 °C.
    pub temperature: i16,
    /// Angular rate.
    pub gyro: [i16; 3],
}

impl Reading {
    /// Bytes in a burst.
    pub const LENGTH: usize = 15;

    /// Big-endian words after the status byte, in the order of the registers from 0x3A.
    pub fn decode(bytes: &[u8; Self::LENGTH]) -> Self {
        let word = |at: usize| i16::from_be_bytes([bytes[at], bytes[at + 1]]);
        Self {
            status: Status(bytes[0]),
            accel: [word(1), word(3), word(5)],
            temperature: word(7),
            gyro: [word(9), word(11), word(13)],
        }
    }
}
