//! Which rests stand on the table with their face, and which are poses that happen to lie near one.

use crate::face::Face;
use crate::motion::path::NUDGE;
use crate::tape::{Kind, Segment};

/// The face that the rest in segment `index` stands on the table with, for all that is known. Where a session turns the box on a face,
/// that face's plate is what it was turned on: up without a turn at another time, it may be a pose that leans by some degrees (one of 45
/// random poses lies within 7° of a face), and as a plate it would bend all numbers.
pub fn standing(segments: &[Segment], index: usize) -> Option<Face> {
    let face = segments.get(index)?.face()?;
    let turned = |segment: &Segment| match segment.kind {
        Kind::OnTable { face: on, angle_rad } => on == face && libm::fabsf(angle_rad) > NUDGE,
        _ => false,
    };
    let on_it = |segment: &&Segment| segment.face() == Some(face);
    let before = segments[..index].iter().rev().take_while(on_it);
    let mut visit = before.chain(segments[index..].iter().take_while(on_it));
    (visit.any(turned) || !segments.iter().any(turned)).then_some(face)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tape::Exclusion;

    fn segment(kind: Kind) -> Segment {
        let (start_us, end_us, exclusion) = (0, 1, Exclusion::None);
        Segment { kind, first: 0, end: 1, start_us, end_us, exclusion, clipped: 0, clipped_samples: 0 }
    }

    #[test]
    fn a_face_that_was_turned_on_is_no_pose_near_it() {
        let still = |face| segment(Kind::Still { face: Some(face), rate_variance: 0.0 });
        let turn = |face, angle_rad| segment(Kind::OnTable { face, angle_rad });
        let (x, y) = (Face::PlusX, Face::PlusY);
        let nudge = turn(x, 0.2);
        let visit = [still(x), turn(x, 6.3), still(x), nudge, still(x), segment(Kind::Hand)];
        let later = [still(x), nudge, still(x), segment(Kind::Hand), still(y)];
        let session: heapless::Vec<Segment, 11> = visit.into_iter().chain(later).collect();
        let standing: heapless::Vec<usize, 11> = (0..11).filter(|i| standing(&session, *i).is_some()).collect();
        // Nobody turned on y: it may be a face that was only shown. A turn has a face, and is asked for none.
        assert_eq!(standing, [0, 1, 2, 3, 4, 10]);
    }
}
