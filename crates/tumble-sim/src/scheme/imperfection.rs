//! What a real table, box and hand do that the nominal world leaves out.

use super::realistic::{ACCEL_INSTABILITY_G, GYRO_INSTABILITY_EARTH_RATES};
use super::{Clock, Scheme, SchemeConfig, Stamps};
use crate::motion::{BoxShape, Hands};
use crate::rng::{Purpose, Rng};
use crate::sensor::Thermal;
use crate::{EARTH_RATE_RAD_S, STANDARD_GRAVITY_MPS2};
use nalgebra::Vector3;

/// One imperfection with its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Imperfection {
    /// Every gyro bias ramps by this much over the recording, °/s, in a random direction.
    BiasDrift(f64),
    /// The sensor's oscillator is off by this fraction; the stamps are true.
    Clock(f64),
    /// The spin axis wobbles by this amplitude, degrees.
    Wobble(f64),
    /// The sensor sits this far from the spin axis, m.
    Lever(f64),
    /// Each face leans by up to this much, degrees.
    CrookedBox(f64),
    /// The die warms up evenly by this much over the recording, °C.
    TemperatureRamp(f64),
    /// The table's tilt, degrees.
    Tilt(f64),
    /// Turns close by hand with this 1σ, degrees, with overshoot.
    ByHand(f64),
    /// The box slides about in its turns by this rms, m.
    Slide(f64),
    /// The table gives way: at each rest the box leans anew, by this 1σ about either level axis, degrees.
    SoftTable(f64),
    /// Turns end against a fence, each stop uniform within this of it, degrees.
    Fence(f64),
    /// So many samples a second, Hz; put-downs ring as before.
    Rate(f64),
    /// 1/f noise of both biases, in units of what Allan plots of such sensors show (10 °/h and 40 µg).
    Flicker(f64),
}

impl Imperfection {
    /// All at once in the sizes of the accuracy study: drift 30 mdps, clock 1 %, wobble 1°, lever 5 cm, box 0.5°, 1 °C, hand 2°.
    pub const ALL: [Self; 7] = [
        Self::BiasDrift(0.03),
        Self::Clock(0.01),
        Self::Wobble(1.0),
        Self::Lever(0.05),
        Self::CrookedBox(0.5),
        Self::TemperatureRamp(1.0),
        Self::ByHand(2.0),
    ];

    /// All words, for a person.
    pub const WORDS: &str = "bias_drift (°/s), clock (fraction), wobble (°), lever (m), crooked_box (°), temperature_ramp (°C), tilt (°), \
                             by_hand (°), slide (m), soft_table (°), fence (°), rate (Hz), flicker (times the usual)";

    /// Of its word, with its usual size if none is given.
    pub fn parse(word: &str, size: Option<f64>) -> Option<Self> {
        let or = |usual: f64| size.unwrap_or(usual);
        Some(match word {
            "bias_drift" => Self::BiasDrift(or(0.03)),
            "clock" => Self::Clock(or(0.01)),
            "wobble" => Self::Wobble(or(1.0)),
            "lever" => Self::Lever(or(0.05)),
            "crooked_box" => Self::CrookedBox(or(0.5)),
            "temperature_ramp" => Self::TemperatureRamp(or(1.0)),
            "tilt" => Self::Tilt(or(3.0)),
            "by_hand" => Self::ByHand(or(2.0)),
            "slide" => Self::Slide(or(0.01)),
            "soft_table" => Self::SoftTable(or(0.1)),
            "fence" => Self::Fence(or(0.1)),
            "rate" => Self::Rate(or(100.0)),
            "flicker" => Self::Flicker(or(1.0)),
            _ => return None,
        })
    }
}

impl SchemeConfig {
    /// Adds an imperfection.
    #[must_use]
    pub fn with(mut self, imperfection: Imperfection) -> Self {
        let duration_s = self.duration_s();
        let seed = self.world.seed;
        let mut rng = Rng::new(seed, Purpose::Box);
        let motion = &mut self.world.motion;
        match imperfection {
            Imperfection::BiasDrift(dps) => {
                let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
                let ramp = Vector3::from_fn(|_, _| sign(rng.symmetric(1.0)) * dps.to_radians() / duration_s);
                self.world.sensor.drift.gyro.ramp_per_s += ramp;
            }
            Imperfection::Clock(rate_error) => self.clock = Clock { rate_error, stamps: Stamps::True },
            Imperfection::Wobble(deg) => motion.hands.wobble_deg = deg,
            // Along (2, 2, 1): off the axis of every turn.
            Imperfection::Lever(metres) => motion.shape.lever_b_m = Vector3::new(2.0, 2.0, 1.0) * (metres / 3.0),
            Imperfection::CrookedBox(deg) => {
                motion.shape = BoxShape::crooked(motion.shape.lever_b_m, deg, &mut rng);
            }
            Imperfection::TemperatureRamp(degc) => {
                let coefficients = Thermal::warming_up(seed);
                self.world.sensor.thermal =
                    Thermal { warm_up_degc: 0.0, ramp_degc_per_s: degc / duration_s, ..coefficients };
            }
            Imperfection::Tilt(deg) => motion.table.tilt_deg = deg,
            Imperfection::Slide(metres) => motion.hands.slide_m = metres,
            Imperfection::SoftTable(deg) => motion.table.soft_deg = deg,
            Imperfection::Fence(half_width_deg) => {
                motion.hands.stops = crate::motion::Stops::Fenced { half_width_deg };
            }
            Imperfection::Rate(hz) => self.world.sensor.rate_hz = hz,
            Imperfection::Flicker(times) => {
                let drift = &mut self.world.sensor.drift;
                drift.gyro.instability = times * GYRO_INSTABILITY_EARTH_RATES * EARTH_RATE_RAD_S;
                drift.accel.instability = times * ACCEL_INSTABILITY_G * STANDARD_GRAVITY_MPS2;
            }
            Imperfection::ByHand(closure_sigma_deg) => {
                motion.hands.overshoot_deg = Hands::by_hand().overshoot_deg;
                motion.hands.stops = crate::motion::Stops::ByHand { closure_sigma_deg };
            }
        }
        self
    }

    /// How long the recording will be, s.
    pub fn duration_s(&self) -> f64 {
        let t = &self.timing;
        let body = match self.scheme {
            Scheme::Single => 6.0 * (2.0 * t.still_s + t.turn_s) + 5.0 * t.move_s,
            Scheme::Double => 6.0 * (3.0 * t.still_s + 2.0 * t.turn_s) + 5.0 * t.move_s,
            Scheme::MultiPose { poses } => (poses as f64 + 1.0) * t.still_s + poses as f64 * t.move_s,
            Scheme::Quarter => 6.0 * t.still_s + 8.0 * t.move_s + 3.0 * (2.0 * t.still_s + t.turn_s + 8.0),
            Scheme::Tumble { duration_s, .. } => 2.0 * t.still_s + duration_s,
        };
        t.start_rest_s + body
    }
}
