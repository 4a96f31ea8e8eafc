//! The six faces, named by the sensor axis that points up.

use core::f64::consts::FRAC_PI_2;
use core::fmt;
use nalgebra::{UnitQuaternion, Vector3};

/// Which axis of the box points up: the protocol's `+x -x +y -y +z -z`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Face {
    /// `+x` up.
    PlusX,
    /// `-x` up.
    MinusX,
    /// `+y` up.
    PlusY,
    /// `-y` up.
    MinusY,
    /// `+z` up.
    PlusZ,
    /// `-z` up.
    MinusZ,
}

impl Face {
    /// All six, in the protocol's order.
    pub const ALL: [Self; 6] = [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY, Self::PlusZ, Self::MinusZ];

    /// The protocol's name.
    pub const fn name(self) -> &'static str {
        ["+x", "-x", "+y", "-y", "+z", "-z"][self as usize]
    }

    /// The face of a protocol name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|face| face.name() == name)
    }

    /// Its index in [`Face::ALL`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The nominal up direction in the box frame `b`.
    pub fn up_b(self) -> Vector3<f64> {
        let sign = if self.index().is_multiple_of(2) { 1.0 } else { -1.0 };
        Vector3::ith(self.index() / 2, sign)
    }

    /// An exact rotation that takes the nominal up direction to `z`.
    pub fn upright(self) -> UnitQuaternion<f64> {
        let quarter = |axis: Vector3<f64>, turns: f64| UnitQuaternion::from_scaled_axis(axis * (turns * FRAC_PI_2));
        match self {
            Self::PlusX => quarter(Vector3::y(), -1.0),
            Self::MinusX => quarter(Vector3::y(), 1.0),
            Self::PlusY => quarter(Vector3::x(), 1.0),
            Self::MinusY => quarter(Vector3::x(), -1.0),
            Self::PlusZ => UnitQuaternion::identity(),
            Self::MinusZ => quarter(Vector3::x(), 2.0),
        }
    }
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upright_puts_the_named_axis_up() {
        for face in Face::ALL {
            assert!((face.upright() * face.up_b() - Vector3::z()).norm() < 1e-15, "{face}");
            assert_eq!(Face::parse(face.name()), Some(face));
        }
        assert_eq!(Face::parse("x"), None);
    }
}
