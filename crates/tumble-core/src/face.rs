//! The six faces of the box, named by the sensor axis that points up.

use nalgebra::Vector3;

/// Which sensor axis points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Face {
    /// +x up.
    PlusX,
    /// −x up.
    MinusX,
    /// +y up.
    PlusY,
    /// −y up.
    MinusY,
    /// +z up.
    PlusZ,
    /// −z up.
    MinusZ,
}

impl Face {
    /// All six, in the order of their indices.
    pub const ALL: [Self; 6] = [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY, Self::PlusZ, Self::MinusZ];

    /// Half-angle of the cone around an axis within which that axis counts as up: 20°. A table is tilted by a few
    /// degrees, cross-axis errors add 2 % (1.1°) and offsets of 80 mg 4.6° (sheet); an oblique pose on an edge is at 45°.
    pub const CONE_COS: f32 = 0.939_692_6;

    /// 0 to 5.
    pub fn index(self) -> usize {
        self as usize
    }

    /// 0, 1, 2 for x, y, z.
    pub fn axis(self) -> usize {
        self.index() / 2
    }

    /// +1 or −1.
    pub fn sign(self) -> f32 {
        if self.index().is_multiple_of(2) { 1.0 } else { -1.0 }
    }

    /// The upward unit vector in sensor (and box) axes, if the box is exact.
    pub fn normal(self) -> Vector3<f32> {
        let mut n = Vector3::zeros();
        n[self.axis()] = self.sign();
        n
    }

    /// Unit vectors of the two axes that lie in the face.
    pub fn plane(self) -> [Vector3<f32>; 2] {
        [1, 2].map(|step| {
            let mut axis = Vector3::zeros();
            axis[(self.axis() + step) % 3] = 1.0;
            axis
        })
    }

    /// The face whose axis lies within [`Self::CONE_COS`] of the specific force, or none for an oblique pose.
    pub fn from_specific_force(force: &Vector3<f32>) -> Option<Self> {
        let norm = force.norm();
        Self::ALL.into_iter().find(|face| norm > 0.0 && face.normal().dot(force) > Self::CONE_COS * norm)
    }

    /// `+x` and so on, as on the console and in the contract's JSON.
    pub fn name(self) -> &'static str {
        ["+x", "-x", "+y", "-y", "+z", "-z"][self.index()]
    }

    /// The inverse of [`Self::name`]; the plus sign may be left out.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|face| face.name() == name || (face.sign() > 0.0 && &face.name()[1..] == name))
    }
}

/// A set of faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaceSet(u8);

impl FaceSet {
    /// None.
    pub const EMPTY: Self = Self(0);
    /// All six.
    pub const FULL: Self = Self(0b11_1111);

    /// With `face` in it.
    pub fn with(self, face: Face) -> Self {
        Self(self.0 | 1 << face.index())
    }

    /// With `face` not in it.
    pub fn without(self, face: Face) -> Self {
        Self(self.0 & !(1 << face.index()))
    }

    /// Is it in?
    pub fn contains(self, face: Face) -> bool {
        self.0 >> face.index() & 1 == 1
    }

    /// Those not in it.
    pub fn complement(self) -> Self {
        Self(!self.0 & Self::FULL.0)
    }

    /// How many.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// None at all?
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// In the order of [`Face::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Face> {
        Face::ALL.into_iter().filter(move |face| self.contains(*face))
    }
}

/// The order of asking when the person has no preference: X, Y, −X, Z, −Y, −Z. No axis follows itself, so that what grows
/// with time (drift) is not mistaken for what changes with the face; it separates the most effects.
pub const ASKING_ORDER: [Face; 6] = [Face::PlusX, Face::PlusY, Face::MinusX, Face::PlusZ, Face::MinusY, Face::MinusZ];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_is_recognised_through_sheet_errors_and_an_edge_is_none() {
        for face in Face::ALL {
            let tilted = face.normal() * 9.8 + Vector3::new(0.78, -0.78, 0.78);
            assert_eq!(Face::from_specific_force(&tilted), Some(face));
            assert_eq!(Face::from_name(face.name()), Some(face));
        }
        assert_eq!(Face::from_specific_force(&Vector3::new(7.0, 7.0, 0.0)), None);
        assert_eq!(Face::from_specific_force(&Vector3::zeros()), None);
    }

    #[test]
    fn sets_add_remove_and_complement() {
        let set = FaceSet::EMPTY.with(Face::PlusX).with(Face::MinusZ);
        assert_eq!((set.len(), set.complement().len()), (2, 4));
        assert!(!set.without(Face::PlusX).contains(Face::PlusX));
    }
}
