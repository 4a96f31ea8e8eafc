//! `tumble study recordings`: real recordings by device, gravity and batch, beside what their authors published; how
//! much hangs on the stillness limits; and whether two chips on one board agree.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;
use tumble_core::calibration::{Calibration, Triad, Verdict};
use tumble_core::estimate::Conditions;

use crate::calibrate::{self, Method, Outcome, Session};
use crate::recording::{Inference, Reading, Recording};

/// What an author published: gyroscope scale error, %, and accelerometer bias, m/s².
struct Published {
    file: &'static str,
    scale_percent: Option<[f64; 3]>,
    accel_bias_mps2: Option<[f64; 3]>,
}

const PUBLISHED: [Published; 4] = [
    Published {
        file: "mikoff_mpu9150_imu0.csv",
        scale_percent: Some([0.04, 0.46, 0.83]),
        accel_bias_mps2: Some([0.103, 0.097, 0.344]),
    },
    Published { file: "mikoff_mpu9150_imu1.csv", scale_percent: None, accel_bias_mps2: None },
    Published { file: "mikoff_mpu9150_imu3.csv", scale_percent: None, accel_bias_mps2: None },
    Published {
        file: "imucal_ferraris_session.csv",
        // Raw integrals of 369.97, 353.69 and 359.33° over 360°.
        scale_percent: Some([2.769, -1.753, -0.186]),
        accel_bias_mps2: None,
    },
];
/// Two chips on one board.
const PAIR: [&str; 2] = ["mimu4444_exp1_imu1.csv", "mimu4444_exp1_imu5.csv"];
/// Stillness limits against the usual.
const TOLERANCES: [f32; 2] = [0.5, 2.0];
/// Slower than this the noise tells more than the motion, rad/s.
const SPINNING: f64 = 1.0;

/// One method's numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Of the recording.
    pub file: &'static str,
    /// `published`, `device`, `gravity` or `batch`.
    pub method: &'static str,
    /// Raw over ideal less 1, %, to first order.
    pub scale_percent: Option<[f64; 3]>,
    /// One sigma of it.
    pub scale_sigma_percent: Option<[f64; 3]>,
    /// m/s².
    pub accel_bias_mps2: Option<[f64; 3]>,
    /// The verdict and the beginning of its first reason.
    pub remark: String,
}

/// The device's gyroscope scale under another stillness limit.
#[derive(Clone, Debug, Serialize)]
pub struct Tolerance {
    /// Of the recording.
    pub file: &'static str,
    /// Times the usual limit.
    pub tolerance: f32,
    /// Change of each scale over its sigma under the usual limit; none where there was no estimate.
    pub moved_sigma: Option<[f64; 3]>,
}

/// How two chips see one board's rate.
#[derive(Clone, Debug, Serialize)]
pub struct Agreement {
    /// Samples faster than 1 rad/s.
    pub samples: usize,
    /// Rms of their rate, °/s.
    pub rate_dps: f64,
    /// Rms difference less biases, the best common rotation taken off, °/s.
    pub raw_dps: f64,
    /// The same of compensated rates.
    pub compensated_dps: f64,
    /// The same with the best 3×3 matrix instead of any calibration: what no calibration of this form can undercut, which is what
    /// the chips' own sampling instants leave.
    pub linear_dps: f64,
}

/// All of it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Side by side.
    pub rows: Vec<Row>,
    /// Stillness.
    pub tolerances: Vec<Tolerance>,
    /// None where the pair is missing.
    pub agreement: Option<Agreement>,
    /// Files that are not in the folder, or cannot be read.
    pub missing: Vec<String>,
}

struct Loaded {
    readings: Vec<Reading>,
    origin_s: f64,
    lost: u32,
    conditions: Conditions,
}

impl Loaded {
    fn read(folder: &Path, file: &str) -> Result<Self, String> {
        let recording = Recording::read(&folder.join(file)).map_err(|error| error.to_string())?;
        let inference = Inference::of(&recording);
        Ok(Self {
            readings: recording.samples(&inference),
            origin_s: recording.origin_s(),
            lost: inference.missing(),
            conditions: calibrate::conditions(&recording.metadata),
        })
    }

    fn session(&self) -> Session<'_> {
        let Self { readings, origin_s, lost, conditions } = self;
        Session { readings, origin_s: *origin_s, lost: *lost, conditions: *conditions }
    }
}

/// Runs it over a folder.
pub fn run(folder: &Path, done: &mut impl FnMut(f32)) -> Report {
    let mut report = Report::default();
    for (k, published) in PUBLISHED.iter().enumerate() {
        done(k as f32 / (PUBLISHED.len() + 1) as f32);
        match Loaded::read(folder, published.file) {
            Ok(loaded) => one(published, &loaded, &mut report),
            Err(reason) => report.missing.push(reason),
        }
    }
    match (Loaded::read(folder, PAIR[0]), Loaded::read(folder, PAIR[1])) {
        (Ok(a), Ok(b)) => report.agreement = agreement(&a, &b),
        (a, b) => report.missing.extend([a.err(), b.err()].into_iter().flatten()),
    }
    report
}

fn one(published: &Published, loaded: &Loaded, report: &mut Report) {
    let file = published.file;
    if published.scale_percent.is_some() || published.accel_bias_mps2.is_some() {
        report.rows.push(Row {
            file,
            method: "published",
            scale_percent: published.scale_percent,
            scale_sigma_percent: None,
            accel_bias_mps2: published.accel_bias_mps2,
            remark: String::new(),
        });
    }
    for (name, method) in [("device", Method::Device), ("gravity", Method::Gravity), ("batch", Method::Batch)] {
        let outcome = loaded.session().run(method, &mut |_| {});
        report.rows.push(row(file, name, &outcome));
    }
    let usual = device(loaded, 1.0);
    for tolerance in TOLERANCES {
        let moved = usual.as_ref().zip(device(loaded, tolerance)).map(|(usual, other)| moved(usual, &other));
        report.tolerances.push(Tolerance { file, tolerance, moved_sigma: moved });
    }
}

fn row(file: &'static str, method: &'static str, outcome: &Outcome) -> Row {
    let calibration = outcome.calibration.as_ref().filter(|_| outcome.verdict != Verdict::Rejected);
    let reason = outcome.reasons.first().map(|reason| reason.split(". ").next().unwrap_or(reason));
    Row {
        file,
        method,
        scale_percent: calibration.map(|c| scale(c).map(|scale| 100.0 * (scale - 1.0))),
        scale_sigma_percent: calibration.map(|c| scale_sigma(c).map(|sigma| 100.0 * sigma)),
        accel_bias_mps2: calibration.map(|c| c.accelerometer.triad.bias.cast::<f64>().into()),
        remark: format!("{:?}. {}", outcome.verdict, reason.unwrap_or_default()),
    }
}

fn scale(calibration: &Calibration) -> [f64; 3] {
    [0, 1, 2].map(|i| 1.0 / f64::from(calibration.gyroscope.triad.correction[(i, i)]))
}

fn scale_sigma(calibration: &Calibration) -> [f64; 3] {
    [0, 1, 2].map(|i| f64::from(calibration.gyroscope.correction_sigma[(i, i)]))
}

fn moved(usual: &Calibration, other: &Calibration) -> [f64; 3] {
    let (a, b, sigma) = (scale(usual), scale(other), scale_sigma(usual));
    [0, 1, 2].map(|i| (b[i] - a[i]) / sigma[i])
}

/// The device's estimate under stillness limits at `tolerance` times the usual.
fn device(loaded: &Loaded, tolerance: f32) -> Option<Calibration> {
    let settled = loaded.session().settle_at(tolerance, &mut |_| {});
    settled.estimate.ok().map(|(estimate, _)| estimate.calibration)
}

fn agreement(a: &Loaded, b: &Loaded) -> Option<Agreement> {
    let [first, second] = [device(a, 1.0)?.gyroscope.triad, device(b, 1.0)?.gyroscope.triad];
    let raw = |triad: &Triad| Triad { correction: Matrix3::identity(), ..*triad };
    let pairs = |first: &Triad, second: &Triad| -> Vec<(Vector3<f64>, Vector3<f64>)> {
        // At an end of its range a reading is a bound, not a rate.
        let both = a.readings.iter().zip(&b.readings).filter(|(a, b)| a.clipped == 0 && b.clipped == 0);
        let rates = both.map(|(a, b)| {
            let compensated =
                |triad: &Triad, reading: &Reading| triad.compensate(&reading.sample.angular_rate_rad_s).cast::<f64>();
            (compensated(first, a), compensated(second, b))
        });
        rates.filter(|(a, _)| a.norm() > SPINNING).collect()
    };
    let compensated = pairs(&first, &second);
    let square: f64 = compensated.iter().map(|(a, _)| a.norm_squared()).sum();
    Some(Agreement {
        samples: compensated.len(),
        rate_dps: (square / compensated.len().max(1) as f64).sqrt().to_degrees(),
        raw_dps: difference(&pairs(&raw(&first), &raw(&second)))?.to_degrees(),
        compensated_dps: difference(&compensated)?.to_degrees(),
        linear_dps: linear_difference(&compensated)?.to_degrees(),
    })
}

/// Rms of `a − T b` with the best matrix.
fn linear_difference(pairs: &[(Vector3<f64>, Vector3<f64>)]) -> Option<f64> {
    let across: Matrix3<f64> = pairs.iter().map(|(a, b)| a * b.transpose()).sum();
    let own: Matrix3<f64> = pairs.iter().map(|(_, b)| b * b.transpose()).sum();
    let best = across * own.try_inverse()?;
    let sum: f64 = pairs.iter().map(|(a, b)| (a - best * b).norm_squared()).sum();
    Some((sum / pairs.len().max(1) as f64).sqrt())
}

/// Rms of `a − R b` with the best rotation (Kabsch 1976): the chips' own frames need not be parallel.
fn difference(pairs: &[(Vector3<f64>, Vector3<f64>)]) -> Option<f64> {
    let moment: Matrix3<f64> = pairs.iter().map(|(a, b)| a * b.transpose()).sum();
    let svd = moment.svd(true, true);
    let (u, v) = (svd.u?, svd.v_t?);
    let sign = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v).determinant().signum()));
    let rotation = u * sign * v;
    let sum: f64 = pairs.iter().map(|(a, b)| (a - rotation * b).norm_squared()).sum();
    Some((sum / pairs.len().max(1) as f64).sqrt())
}
