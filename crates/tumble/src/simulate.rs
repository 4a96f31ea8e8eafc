//! Recordings of simulated sensors, with the metadata that the contract asks for.

use clap::ValueEnum;
use nalgebra::Vector3;
use thiserror::Error;
use tumble_sim::effect::EffectError;
use tumble_sim::motion::{Hands, Table};
use tumble_sim::scheme::Imperfection;
use tumble_sim::sensor::{Noise, Quantisation};
use tumble_sim::{Effect, Scheme, SchemeConfig, SimError, Truth};

use crate::recording::{BoxFaces, Metadata, Recording, Row, STANDARD_GRAVITY_MPS2, TurnStops};

/// What the person does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemeName {
    /// Six faces, one turn on each, as in the paper: 200 s
    Single,
    /// Six faces, a turn both ways on each: 194 s
    Double,
    /// 17 oblique poses with hand rotations between them
    Multipose,
    /// Six faces, then a turn about each axis in quarter steps
    Quarter,
    /// 65 s of violent tumbling between two rests
    Tumble,
}

/// What to simulate; what is none stays nominal.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What the person does.
    pub scheme: SchemeName,
    /// Of the sensor's errors and all chance.
    pub seed: u64,
    /// The paper's Table 1.
    pub paper: bool,
    /// Of the table.
    pub tilt_deg: Option<f64>,
    /// Of the sensor from the axis.
    pub lever_cm: Option<[f64; 3]>,
    /// By hand or against a fence.
    pub by_hand: Option<bool>,
    /// Of the axis of a turn.
    pub wobble_deg: Option<f64>,
    /// `NAME[=SIZE]`, or `all`.
    pub imperfections: Vec<String>,
    /// Gyroscope's (°/s) and accelerometer's (g), if readings are rounded to counts.
    pub ranges: Option<(f64, f64)>,
    /// Samples a second.
    pub rate_hz: f64,
    /// Leaves out all noise.
    pub noiseless: bool,
    /// What every real recording has besides.
    pub nuisance: bool,
    /// Physics that the nominal world leaves out.
    pub effects: Vec<Effect>,
}

/// A recording and, apart from it, the truth.
pub struct Made {
    /// What anyone may see.
    pub recording: Recording,
    /// What nobody else is told.
    pub truth: Truth,
}

/// Why a plan cannot be simulated.
#[derive(Debug, Error)]
pub enum PlanError {
    /// No such imperfection.
    #[error(
        "'{0}' is no imperfection: {words} or all, with =SIZE if the usual size is not meant",
        words = tumble_sim::scheme::Imperfection::WORDS
    )]
    Imperfection(String),
    /// A setting out of its range.
    #[error(transparent)]
    Setting(#[from] SimError),
    /// An effect that there is not, or not so large.
    #[error(transparent)]
    Effect(#[from] EffectError),
}

impl Plan {
    /// Runs the simulation.
    pub fn make(&self) -> Result<Made, PlanError> {
        Ok(make(&self.config()?)?)
    }

    /// What the plan comes to.
    pub(crate) fn config(&self) -> Result<SchemeConfig, PlanError> {
        let scheme = self.scheme.scheme();
        let mut config = SchemeConfig::new(scheme, self.seed);
        if self.paper {
            config =
                SchemeConfig { scheme, timing: config.timing, turns: config.turns, ..SchemeConfig::paper(self.seed) };
        }
        if self.nuisance {
            config.add_nuisances();
        }
        self.set_motion(&mut config);
        config.world.sensor.rate_hz = self.rate_hz;
        if let Some((gyro_range_dps, accel_range_g)) = self.ranges {
            config.world.sensor.quantisation = Some(Quantisation { gyro_range_dps, accel_range_g });
        }
        config.effects.clone_from(&self.effects);
        for word in &self.imperfections {
            config = imperfections(word)?.into_iter().fold(config, SchemeConfig::with);
        }
        if self.noiseless {
            config.world.sensor.noise = Noise::NONE;
        }
        Ok(config)
    }

    fn set_motion(&self, config: &mut SchemeConfig) {
        let motion = &mut config.world.motion;
        let wobble_deg = motion.hands.wobble_deg;
        match self.by_hand {
            Some(true) => motion.hands = Hands { wobble_deg, ..Hands::by_hand() },
            Some(false) => motion.hands = Hands { wobble_deg, ..Hands::fenced() },
            None => {}
        }
        if let Some(wobble_deg) = self.wobble_deg {
            motion.hands.wobble_deg = wobble_deg;
        }
        if let Some(tilt_deg) = self.tilt_deg {
            motion.table = Table { tilt_deg, ..motion.table };
        }
        if let Some(lever_cm) = self.lever_cm {
            motion.shape.lever_b_m = Vector3::from(lever_cm) / 100.0;
        }
    }
}

/// Runs a simulation and writes it down as a recorder would.
pub(crate) fn make(config: &SchemeConfig) -> Result<Made, SimError> {
    Ok(written(config, config.record()?))
}

/// Writes a simulation down as a recorder would.
pub(crate) fn written(config: &SchemeConfig, made: tumble_sim::Recording) -> Made {
    let rows = made.samples.iter().map(row).collect();
    let recording =
        Recording { metadata: metadata(config, made.rate_hz), rows, notices: Vec::new(), stamps_s: Vec::new() };
    Made { recording, truth: made.truth }
}

/// Says only what an honest recorder would know. A crooked box is not said to be square.
fn metadata(config: &SchemeConfig, rate_hz: f64) -> Metadata {
    let world = &config.world;
    let square = world.motion.shape.up_normals_b == tumble_sim::motion::BoxShape::square(Vector3::zeros()).up_normals_b;
    Metadata {
        sensor: Some("simulated MPU-9250".into()),
        gyro_range_dps: world.sensor.quantisation.map(|ranges| ranges.gyro_range_dps),
        accel_range_g: world.sensor.quantisation.map(|ranges| ranges.accel_range_g),
        rate_hz: Some(rate_hz),
        gravity_mps2: Some(world.gravity_mps2),
        latitude_deg: Some(world.latitude_deg),
        turns: Some(if config.turns_word() == "by-hand" { TurnStops::ByHand } else { TurnStops::Fenced }),
        box_faces: Some(if square { BoxFaces::Square } else { BoxFaces::Unknown }),
    }
}

impl SchemeName {
    pub(crate) fn scheme(self) -> Scheme {
        match self {
            Self::Single => Scheme::Single,
            Self::Double => Scheme::Double,
            Self::Multipose => Scheme::MultiPose { poses: 17 },
            Self::Quarter => Scheme::Quarter,
            Self::Tumble => Scheme::Tumble { duration_s: 65.0, violence: 1.0 },
        }
    }
}

fn imperfections(word: &str) -> Result<Vec<Imperfection>, PlanError> {
    let unknown = || PlanError::Imperfection(word.into());
    if word == "all" {
        return Ok(Imperfection::ALL.to_vec());
    }
    let (name, size) = match word.split_once('=') {
        None => (word, None),
        Some((name, size)) => (name, Some(size.parse().map_err(|_| unknown())?)),
    };
    Imperfection::parse(name, size).map(|one| vec![one]).ok_or_else(unknown)
}

/// Decimals that are below a ten-thousandth of a count (0.061 °/s, 0.49 mg), and a third of all seventeen digits.
fn row(sample: &tumble_sim::Sample) -> Row {
    let decimals = |value: f64, digits: i32| (value * 10f64.powi(digits)).round() / 10f64.powi(digits);
    Row {
        t_s: decimals(sample.t_s, 6),
        gyro_dps: sample.angular_rate_rad_s.map(|v| decimals(v.to_degrees(), 6)).into(),
        accel_g: sample.specific_force_mps2.map(|v| decimals(v / STANDARD_GRAVITY_MPS2, 8)).into(),
        temp_c: Some(decimals(sample.temperature_degc, 3)),
    }
}
