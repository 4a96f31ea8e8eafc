//! The device's `f32` passes against the references in `f64` on the same sessions.

use nalgebra::Matrix3;
use tumble::calibrate::{Method, Session};
use tumble::reference::batch::{self, Batch, MeanNoise};
use tumble::reference::data::{self, Stretch};
use tumble::study::trial::readings;
use tumble_core::calibration::{Calibration, Verdict};
use tumble_core::estimate::Conditions;
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_sim::{Scheme, SchemeConfig};

fn conditions(faces: BoxFaces) -> Conditions {
    Conditions { stops: TurnStops::Fenced, faces, ..Conditions::CAUTIOUS }
}

/// Batch solutions of one session, as the device went and as the samples have it.
struct Solutions {
    device: Calibration,
    /// From the device's records, a group's noise halved as the device has it.
    halved: Batch,
    /// From the same, a group's mean seeing its exact share.
    records: Batch,
    /// From the samples.
    samples: Batch,
}

/// Largest differences of the gyroscope's correction.
#[derive(Clone, Copy, Debug)]
struct Apart {
    scale_ppm: f64,
    cross_urad: f64,
    /// Of any element, over its sigma.
    sigmas: f64,
    /// Largest ratio of two sigmas, less 1.
    sigma_ratio: f64,
}

fn solve(scheme: Scheme, seed: u64, faces: BoxFaces) -> Solutions {
    let recording = SchemeConfig::new(scheme, seed).record().expect("a valid configuration");
    let readings = readings(&recording.samples);
    let conditions = conditions(faces);
    let session = Session { readings: &readings, origin_s: 0.0, lost: 0, conditions };
    let settled = session.settle_at(1.0, &mut |_| {});
    let tape = settled.tape;
    let (device, noise) = settled.estimate.expect("an estimate");
    let bias = device.calibration.gyroscope.triad.bias.cast();
    let [records, samples] = [data::records(&tape, &bias), data::stretches(tape.segments(), &readings)];
    let solve = |stretches: &[Stretch], mean_noise| {
        batch::estimate(stretches, &conditions, &device, &noise, mean_noise).expect("a solution")
    };
    Solutions {
        device: device.calibration,
        halved: solve(&records, MeanNoise::Halved),
        records: solve(&records, MeanNoise::Exact),
        samples: solve(&samples, MeanNoise::Exact),
    }
}

fn apart(a: (&Matrix3<f64>, &Matrix3<f64>), b: (&Matrix3<f64>, &Matrix3<f64>)) -> Apart {
    let mut apart = Apart { scale_ppm: 0.0, cross_urad: 0.0, sigmas: 0.0, sigma_ratio: 0.0 };
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let difference = (a.0[(i, j)] - b.0[(i, j)]).abs();
        let largest = if i == j { &mut apart.scale_ppm } else { &mut apart.cross_urad };
        *largest = largest.max(1e6 * difference);
        apart.sigmas = apart.sigmas.max(difference / b.1[(i, j)]);
        apart.sigma_ratio = apart.sigma_ratio.max((a.1[(i, j)] / b.1[(i, j)] - 1.0).abs());
    }
    apart
}

impl Solutions {
    /// Device against halved, halved against exact, records against samples.
    fn chain(&self) -> [Apart; 3] {
        let gyro = &self.device.gyroscope;
        let device = (gyro.triad.correction.cast(), gyro.correction_sigma.cast());
        let of = |batch: &Batch| (batch.gyro.correction, batch.gyro.correction_sigma);
        let links = [device, of(&self.halved), of(&self.records), of(&self.samples)];
        [0, 1, 2].map(|k| apart((&links[k].0, &links[k].1), (&links[k + 1].0, &links[k + 1].1)))
    }
}

/// The plate in turns is in the square ones. Equal sigmas say that both saw the same with the same weights; limits are some three times what
/// was measured (docs/method.md, §5).
#[test]
fn the_device_is_the_batch_solution_link_by_link() {
    let sessions =
        [(Scheme::Single, BoxFaces::Square), (Scheme::Double, BoxFaces::Square), (Scheme::Double, BoxFaces::Unknown)];
    for (scheme, faces) in sessions {
        let solutions = solve(scheme, 1, faces);
        let [arithmetic, mean_noise, records] = solutions.chain();
        println!("{} {faces:?}: chi² {:.3}", scheme.name(), solutions.samples.chi_square_per_dof);
        println!("  f32 passes, records: {arithmetic:.3?}");
        println!("  halved noise:        {mean_noise:.3?}");
        println!("  records for samples: {records:.3?}");
        assert!(arithmetic.sigmas < 0.05 && arithmetic.sigma_ratio < 0.01, "{arithmetic:?}");
        assert!(mean_noise.sigmas < 0.2 && mean_noise.sigma_ratio < 0.03, "{mean_noise:?}");
        assert!(records.sigmas < 0.4 && records.sigma_ratio < 0.01, "{records:?}");
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
