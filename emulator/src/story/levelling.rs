//! What the board streamed of a tumbling, against what its sensor's registers held and where the box truly was.

use nalgebra::{Matrix3, Vector3};
use tumble_core::frame::{CompensatedFrame, RawFrame};
use tumble_core::sample::{Counts, Ranges, Sample};
use tumble_sim::sensor::FrameTruth;

use super::Failure;
use super::acts::Tumbling;
use super::inertial::{LevelError, Rates};
use super::parameters::{Compensation, Parameters};
use super::stage::Stage;

/// Frames that must agree in a row to say which of the sensor's samples they are.
const ALIKE: usize = 8;
/// Where carrying begins: this long before the tumbling, at rest.
const BEFORE_S: f64 = 0.5;

/// Which of the sensor's samples a frame is, and what the board's clock showed then.
#[derive(Debug, Clone)]
pub struct Alignment {
    /// The chip's samples, with the board time of each.
    taken: Vec<(f64, Counts)>,
    /// `taken` of the frame with this number.
    first: (u32, usize),
    /// Board time less time-stamp.
    offset_s: f64,
    /// The largest departure of a stamp from that.
    pub stamp_error_us: f64,
    /// Raw frames that are not what the registers held.
    pub different: usize,
}

impl Alignment {
    /// From a stretch of raw frames.
    pub fn new(stage: &Stage, tumbling: &Tumbling) -> Result<Self, Failure> {
        let taken = taken(stage, tumbling.rest_s.0 - 2.0);
        let frames: Vec<&RawFrame> = tumbling.frames.raw.iter().map(|(_, frame)| frame).collect();
        let alike =
            |window: &[(f64, Counts)]| window.iter().zip(&frames).all(|((_, counts), frame)| *counts == frame.counts);
        let index = taken.windows(ALIKE).position(alike).filter(|_| frames.len() >= ALIKE);
        let index =
            index.ok_or_else(|| Failure("the raw frames are not what the sensor's registers held".to_owned()))?;
        let offset_s = taken[index].0 - frames[0].t_us as f64 * 1e-6;
        let first = (frames[0].seq, index);
        let mut alignment = Self { taken, first, offset_s, stamp_error_us: 0.0, different: 0 };
        for frame in frames {
            let Some((t_s, counts)) = alignment.sample(frame.seq) else { continue };
            let error_us = ((t_s - offset_s) * 1e6 - frame.t_us as f64).abs();
            alignment.stamp_error_us = alignment.stamp_error_us.max(error_us);
            alignment.different += usize::from(counts != frame.counts);
        }
        Ok(alignment)
    }

    fn sample(&self, seq: u32) -> Option<(f64, Counts)> {
        self.taken.get(self.first.1 + seq.wrapping_sub(self.first.0) as usize).copied()
    }

    /// The same for a later stretch of the same power-on, whose frames have no counts to compare.
    #[must_use]
    pub fn later(&self, stage: &Stage) -> Self {
        let from_s = self.taken.first().map_or(0.0, |(t_s, _)| *t_s);
        Self { taken: taken(stage, from_s), ..self.clone() }
    }

    fn time_s(&self, t_us: u64) -> f64 {
        t_us as f64 * 1e-6 + self.offset_s
    }

    /// The largest difference, in the frame's last digit, between compensated frames and the compensation of what the
    /// registers held; none where a frame is no sample of this time.
    #[must_use]
    pub fn worst_digit(&self, tumbling: &Tumbling, compensation: &Compensation) -> Option<i32> {
        let mut worst = 0;
        for (_, frame) in &tumbling.frames.compensated {
            let (t_s, counts) = self.sample(frame.seq)?;
            ((t_s - self.time_s(frame.t_us)).abs() < 1e-3).then_some(())?;
            let raw = Ranges::WIDEST.to_si(frame.t_us, &counts);
            let expected = CompensatedFrame::new(frame.seq, &compensation.apply(&raw))?;
            let pairs = frame.angular_rate_urad_s.iter().zip(&expected.angular_rate_urad_s);
            let pairs = pairs.chain(frame.specific_force_um_s2.iter().zip(&expected.specific_force_um_s2));
            worst = pairs.map(|(said, computed)| (said - computed).abs()).fold(worst, i32::max);
        }
        Some(worst)
    }

    /// The rates that somebody makes of the raw frames.
    #[must_use]
    pub fn rates(&self, stage: &Stage, tumbling: &Tumbling, of: impl Fn(&Sample) -> Vector3<f64>) -> Rates {
        let delay_s = delay_s(stage);
        let frames = tumbling.frames.raw.iter().map(|(_, frame)| frame);
        let rates = frames.map(|frame| {
            let raw = Ranges::WIDEST.to_si(frame.t_us, &frame.counts);
            (self.time_s(frame.t_us) - delay_s, of(&raw))
        });
        let (t_s, rad_s) = rates.unzip();
        Rates { t_s, rad_s }
    }

    /// The rates of the compensated frames.
    #[must_use]
    pub fn delivered_rates(&self, stage: &Stage, tumbling: &Tumbling) -> Rates {
        let delay_s = delay_s(stage);
        let frames = tumbling.frames.compensated.iter().map(|(_, frame)| frame);
        let rates = frames.map(|frame| {
            let rate = Vector3::from(frame.angular_rate_urad_s.map(|micro| f64::from(micro) * 1e-6));
            (self.time_s(frame.t_us) - delay_s, rate)
        });
        let (t_s, rad_s) = rates.unzip();
        Rates { t_s, rad_s }
    }
}

/// The chip's samples since `from_s`, as counts at its settings.
fn taken(stage: &Stage, from_s: f64) -> Vec<(f64, Counts)> {
    let sensor = stage.board.sensor_handle();
    let sensor = sensor.lock().expect("no panic holds it");
    let counts = |words: [i16; 7]| {
        let [ax, ay, az, temperature, gx, gy, gz] = words;
        Counts { gyro: [gx, gy, gz], accel: [ax, ay, az], temperature }
    };
    let samples = stage.theatre.taken_since(from_s);
    samples.iter().map(|taken| (taken.t_s, counts(sensor.counts_of(&taken.physical)))).collect()
}

fn delay_s(stage: &Stage) -> f64 {
    stage.theatre.with(|world| world.sensor().config().delay.gyro_s)
}

/// Level errors of one tumbling under several readings of the same raw frames.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Levels {
    pub raw: LevelError,
    pub raw_less_bias: LevelError,
    pub compensated: LevelError,
    /// With the true parameters: the noise's share, which no calibration can take away.
    pub perfect: LevelError,
}

/// Where the box goes astray if its raw frames are integrated as they are, less their resting bias, and compensated.
#[must_use]
pub fn of_raw(
    stage: &Stage,
    tumbling: &Tumbling,
    alignment: &Alignment,
    parameters: &Parameters,
    truth: &FrameTruth,
) -> Levels {
    let raw = alignment.rates(stage, tumbling, |raw| raw.angular_rate_rad_s.cast());
    let bias = raw.mean(tumbling.rest_s);
    let level = |rates: &Rates| level_error(stage, &rates.since(tumbling.rest_s.1 - BEFORE_S));
    let compensated = parameters.compensation().map(|compensation| {
        level(&alignment.rates(stage, tumbling, |raw| compensation.apply(raw).angular_rate_rad_s.cast()))
    });
    let (accel, gyro) = (&truth.accelerometer, &truth.gyroscope);
    let matrix = |rows: &[[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
    let felt = matrix(&gyro.g_sensitivity_rad_s_per_mps2.unwrap_or_default());
    let perfect = alignment.rates(stage, tumbling, |raw| {
        let force = matrix(&accel.correction) * (raw.specific_force_mps2.cast() - Vector3::from(accel.bias_mps2));
        matrix(&gyro.correction) * (raw.angular_rate_rad_s.cast() - Vector3::from(gyro.bias_rad_s) - felt * force)
    });
    Levels {
        raw: level(&raw),
        raw_less_bias: level(&raw.map(|rate| rate - bias)),
        compensated: compensated.unwrap_or_default(),
        perfect: level(&perfect),
    }
}

/// The same for the compensated frames as the board delivered them.
#[must_use]
pub fn of_delivered(stage: &Stage, tumbling: &Tumbling, rates: &Rates) -> LevelError {
    level_error(stage, &rates.since(tumbling.rest_s.1 - BEFORE_S))
}

fn level_error(stage: &Stage, rates: &Rates) -> LevelError {
    stage.theatre.with(|world| {
        let earth_rate_n = world.earth_rate_n();
        rates.level_error(&earth_rate_n, |t_s| world.true_attitude(t_s))
    })
}
