//! The device's `f32` passes against the references in `f64` on the same sessions.

use tumble::calibrate::{Method, Session, estimate};
use tumble::reference::{batch, data};
use tumble::study::trial::readings;
use tumble_core::calibration::Verdict;
use tumble_core::estimate::Conditions;
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_sim::scheme::Imperfection;
use tumble_sim::{Scheme, SchemeConfig};

fn conditions(faces: BoxFaces) -> Conditions {
    Conditions { stops: TurnStops::Fenced, faces, ..Conditions::CAUTIOUS }
}

/// Largest differences of the gyroscope's correction, device less batch: scale, K, and over sigma.
fn differences(scheme: Scheme, seed: u64, faces: BoxFaces, from_records: bool) -> (f64, f64, f64) {
    // The batch does not know that a box turns about its face's normal; where the hand wobbles, the device does not either.
    let config = SchemeConfig::new(scheme, seed).with(Imperfection::Wobble(1.0));
    let recording = config.record().expect("a valid configuration");
    let readings = readings(&recording.samples);
    let conditions = conditions(faces);
    let session = Session { readings: &readings, origin_s: 0.0, lost: 0, conditions };
    let (tape, _) = session.tape(1.0);
    let (device, noise) = estimate(&tape, conditions, &mut |_| {}).expect("an estimate");
    let stretches = if from_records { data::records(&tape) } else { data::stretches(tape.segments(), &readings) };
    let batch = batch::estimate(&stretches, &conditions, &device, &noise).expect("a solution");
    let gyro = &device.calibration.gyroscope;
    let (mut scale, mut cross, mut sigmas) = (0.0f64, 0.0f64, 0.0f64);
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let difference = (f64::from(gyro.triad.correction[(i, j)]) - batch.gyro.correction[(i, j)]).abs();
        let ratio = f64::from(gyro.correction_sigma[(i, j)]) / batch.gyro.correction_sigma[(i, j)];
        assert!((ratio - 1.0).abs() < 0.02, "sigmas of {i}{j} differ by {ratio}");
        sigmas = sigmas.max(difference / batch.gyro.correction_sigma[(i, j)]);
        *(if i == j { &mut scale } else { &mut cross }) = difference.max(if i == j { scale } else { cross });
    }
    println!(
        "{} {seed} {faces:?} from {}: scale {:.2} ppm, K {:.2} urad, {sigmas:.3} sigma, chi² {:.3}",
        scheme.name(),
        if from_records { "records" } else { "samples" },
        scale * 1e6,
        cross * 1e6,
        batch.chi_square_per_dof
    );
    (scale * 1e6, cross * 1e6, sigmas)
}

#[test]
fn on_its_own_records_the_device_is_the_batch_solution() {
    for (scheme, faces) in [(Scheme::Single, BoxFaces::Square), (Scheme::Double, BoxFaces::Unknown)] {
        let (.., sigmas) = differences(scheme, 1, faces, true);
        assert!(sigmas < 0.15, "{sigmas} sigma");
    }
}

#[test]
fn records_cost_less_than_a_sigma_against_samples() {
    for (scheme, faces) in [(Scheme::Single, BoxFaces::Square), (Scheme::Double, BoxFaces::Unknown)] {
        let (.., sigmas) = differences(scheme, 1, faces, false);
        assert!(sigmas < 0.8, "{sigmas} sigma");
    }
}

/// Seventeen poses give the nine numbers that six faces cannot (`design.md` §2).
#[test]
fn gravity_alone_needs_more_than_six_faces() {
    for (scheme, enough) in [(Scheme::MultiPose { poses: 17 }, true), (Scheme::Double, false)] {
        let recording = SchemeConfig::new(scheme, 2).record().expect("a valid configuration");
        let readings = readings(&recording.samples);
        let session =
            Session { readings: &readings, origin_s: 0.0, lost: 0, conditions: conditions(BoxFaces::Unknown) };
        let outcome = session.run(Method::Gravity, &mut |_| {});
        assert_eq!(outcome.verdict != Verdict::Rejected, enough, "{scheme:?}: {:?}", outcome.reasons);
        let calibration = outcome.calibration.expect("computed");
        if enough {
            let truth = recording.truth.in_accelerometer_frame.gyroscope.correction;
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let error = f64::from(calibration.gyroscope.triad.correction[(i, j)]) - truth[i][j];
                assert!(error.abs() < 2e-3, "{i}{j}: {error}");
            }
        }
    }
}
