use super::*;
use crate::face::Face;
use crate::tape::{Exclusion, Record};

/// Rests of these lengths in half-second records, with these sample variances.
fn rests(rests: &[(usize, f32)]) -> Tape<64, 8> {
    let mut tape = Tape::new();
    let mut start_us = 0;
    for &(records, rate_variance) in rests {
        let first = tape.len();
        for index in 0..records {
            let swing = if index % 2 == 0 { 1.0 } else { -1.0 } * libm::sqrtf(rate_variance);
            let record = Record {
                dt_s: REST_RECORD_S,
                rotation_rad: Vector3::repeat(0.1 * swing * REST_RECORD_S),
                specific_force_mps2: Vector3::new(0.0, 0.0, crate::STANDARD_GRAVITY_MPS2),
            };
            tape.push(&record).expect("there is room");
        }
        let end_us = start_us + (records as u64) * 500_000;
        let segment = Segment {
            kind: Kind::Still { face: Some(Face::PlusZ), rate_variance },
            exclusion: Exclusion::None,
            first: first as u16,
            end: tape.len() as u16,
            start_us,
            end_us,
            clipped: 0,
            clipped_samples: 0,
        };
        tape.close(segment).expect("there is room");
        start_us = end_us;
    }
    tape
}

#[test]
fn a_quiet_moment_is_no_quiet_rest() {
    let noise = |tape: &Tape<64, 8>| Noise::from_rests(tape, TurnStops::ByHand, BoxFaces::Unknown);
    // Half a second within a tremor, a twentieth as loud as what lasts.
    let trembling = rests(&[(8, 1e-4), (1, 5e-6), (8, 1.2e-4)]);
    let found = noise(&trembling);
    assert_eq!(found.quiet_variance, 1e-4);
    assert!(trembling.segments().iter().all(|segment| is_solid(segment, found.quiet_variance)));
    // A rest that lasts is one, beside which the others are in the hand.
    let held = rests(&[(8, 1e-4), (4, 5e-6), (8, 1.2e-4)]);
    assert_eq!(noise(&held).quiet_variance, 5e-6);
    // Where none lasts, the quietest there is.
    assert_eq!(noise(&rests(&[(2, 3e-5), (2, 5e-6)])).quiet_variance, 5e-6);
}
