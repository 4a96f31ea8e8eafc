//! What is calibrated on the host is calibrated by the board's own session: it must not ask a recorded person for more rest than
//! the recording's scheme has.

use nalgebra::Vector3;
use tumble_core::DEGREE_RAD;
use tumble_core::command::Command;
use tumble_core::message::{Message, Refused};
use tumble_core::procedure::{BoxFaces, Scheme, Setup, TurnStops};
use tumble_core::sample::Sample;
use tumble_core::session::{Effect, Session};
use tumble_core::tape::Tape;
use tumble_sim::SchemeConfig;

/// Refusals of the session, and whether all was collected.
fn replay(scheme: tumble_sim::Scheme, wanted: Scheme, seed: u64) -> (Vec<Refused>, bool) {
    let (refused, complete, _) = play(&recorded(scheme, seed), wanted);
    (refused, complete)
}

fn recorded(scheme: tumble_sim::Scheme, seed: u64) -> Vec<Sample> {
    let samples = SchemeConfig::new(scheme, seed).record().expect("a valid configuration").samples;
    tumble::study::trial::readings(&samples).into_iter().map(|reading| reading.sample).collect()
}

/// Refusals, whether all was collected, and by how much the tape holds the gyroscope's bias to have jumped, rad/s.
fn play(samples: &[Sample], wanted: Scheme) -> (Vec<Refused>, bool, Vector3<f32>) {
    let mut tape = Box::new(Tape::<3072, 160>::new());
    let mut session = Session::new(&mut tape);
    let setup = Setup { stops: TurnStops::Fenced, box_faces: BoxFaces::Square, scheme: wanted };
    session.command(0, Command::Calibrate(setup));
    let mut refused = Vec::new();
    for sample in samples {
        session.sample(sample, 0);
        while let Some(effect) = session.next_effect() {
            if let Effect::Say(Message::Refused(why)) = effect {
                refused.push(why);
            }
        }
    }
    (refused, session.is_computing(), session.tape().bias_jumps.total_rad_s)
}

#[test]
fn a_session_with_rests_of_three_seconds_is_complete() {
    for seed in 1..=12 {
        let (refused, complete) = replay(tumble_sim::Scheme::Double, Scheme::Double, seed);
        assert!(complete && refused.is_empty(), "seed {seed}: {refused:?}");
    }
}

#[test]
fn so_is_one_with_single_turns() {
    for seed in 1..=4 {
        let (refused, complete) = replay(tumble_sim::Scheme::Single, Scheme::Single, seed);
        assert!(complete && refused.is_empty(), "seed {seed}: {refused:?}");
    }
}

/// Half-way through the first rest of two seconds or more after this sample, over which no rate moves by 0.6 °/s.
fn resting_from(samples: &[Sample], first: usize) -> usize {
    let steady = |start: usize| {
        let rates = samples[start..start + 400].iter().map(|sample| sample.angular_rate_rad_s);
        let (low, high) = rates.fold((Vector3::repeat(f32::MAX), Vector3::repeat(f32::MIN)), |(low, high), rate| {
            (low.inf(&rate), high.sup(&rate))
        });
        (high - low).amax() < 0.6 * DEGREE_RAD
    };
    350 + (first..samples.len() - 400).find(|&start| steady(start)).expect("a rest")
}

/// To the test of mean rates all that follows is one steady turn: the board waited for ever.
#[test]
fn a_bias_that_jumps_does_not_keep_the_board_waiting() {
    for (seed, jump_dps) in [(1, [0.9, -0.4, 0.2]), (2, [-2.0, 3.0, 1.0]), (3, [0.1, 0.8, -0.8]), (4, [-6.0, 2.0, 4.0])]
    {
        let recorded = recorded(tumble_sim::Scheme::Double, seed);
        let at = resting_from(&recorded, recorded.len() / 2);
        // The person sees that it is not content and lets it lie for six seconds more.
        let longer = (0..1200).map(|k| recorded[at - 250 + k % 250]);
        let jump = Vector3::from(jump_dps) * DEGREE_RAD;
        let after = longer.chain(recorded[at..].iter().copied());
        let after = after.map(|sample| Sample { angular_rate_rad_s: sample.angular_rate_rad_s + jump, ..sample });
        let stamped = recorded[..at].iter().copied().chain(after).zip(0u64..);
        let samples: Vec<Sample> = stamped.map(|(sample, k)| Sample { t_us: 1000 + 5000 * k, ..sample }).collect();
        let (refused, complete, found) = play(&samples, Scheme::Double);
        // The rest that the jump ends was too short: it asks for a longer one, and gets it.
        let held = refused.iter().all(|why| matches!(why, Refused::Hold { .. }));
        assert!(complete && held && refused.len() < 2, "seed {seed}: {refused:?}");
        // Means of 2.5 s and 1.5 s at 0.01 °/s/√Hz: 10 mdps.
        assert!((found - jump).amax() < 0.05 * DEGREE_RAD, "seed {seed}: {found} for {jump}");
    }
}
