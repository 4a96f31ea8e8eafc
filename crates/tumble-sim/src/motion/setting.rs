//! The table, the box and the hands.

use crate::error::SimError;
use crate::face::Face;
use crate::rng::Rng;
use nalgebra::{Unit, UnitQuaternion, Vector3};

/// The table top: a plate that is not quite level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table {
    /// Angle between the plate's normal and up, degrees.
    pub tilt_deg: f64,
    /// Where the normal leans to, degrees counter-clockwise from east.
    pub azimuth_deg: f64,
    /// Residual vibration, if any.
    pub vibration: Option<Vibration>,
    /// How much its surface gives way: at each rest the box leans anew, by this 1σ about either level axis, degrees.
    pub soft_deg: f64,
}

/// A steady shaking of the whole table, say by a fan or a pump.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibration {
    /// Peak acceleration, m/s².
    pub amplitude_mps2: f64,
    /// Hz.
    pub frequency_hz: f64,
    /// Direction in `n`; need not be a unit vector.
    pub direction_n: Vector3<f64>,
}

impl Table {
    /// A still table of this tilt.
    pub const fn tilted(tilt_deg: f64, azimuth_deg: f64) -> Self {
        Self { tilt_deg, azimuth_deg, vibration: None, soft_deg: 0.0 }
    }

    /// `R_n_from_p`: the plate is the level plane turned about the horizontal axis square to the azimuth.
    pub fn rotation_n_from_p(&self) -> UnitQuaternion<f64> {
        let azimuth = self.azimuth_deg.to_radians();
        let axis = Vector3::new(-azimuth.sin(), azimuth.cos(), 0.0);
        UnitQuaternion::from_scaled_axis(axis * self.tilt_deg.to_radians())
    }

    /// The plate's normal in `n`.
    pub fn normal_n(&self) -> Vector3<f64> {
        self.rotation_n_from_p() * Vector3::z()
    }
}

/// The box and where the sensor sits in it.
#[derive(Debug, Clone, PartialEq)]
pub struct BoxShape {
    /// From the spin axis (the box's centre) to the sensor, in `b`, m.
    pub lever_b_m: Vector3<f64>,
    /// For each face, the direction in `b` that is square to the plate when the box stands with it up.
    pub up_normals_b: [Vector3<f64>; 6],
}

impl BoxShape {
    /// A perfect box: every normal along its axis.
    pub fn square(lever_b_m: Vector3<f64>) -> Self {
        Self { lever_b_m, up_normals_b: Face::ALL.map(Face::up_b) }
    }

    /// A box whose six faces each lean by up to `error_deg` (uniform in each of the two directions).
    ///
    /// The box frame stays the nominal one; the faces depart from it.
    pub fn crooked(lever_b_m: Vector3<f64>, error_deg: f64, rng: &mut Rng) -> Self {
        let error = error_deg.to_radians();
        let up_normals_b = Face::ALL.map(|face| {
            let lean = Vector3::from_fn(|_, _| rng.symmetric(error));
            UnitQuaternion::from_scaled_axis(lean - face.up_b() * face.up_b().dot(&lean)) * face.up_b()
        });
        Self { lever_b_m, up_normals_b }
    }

    /// `R_p_from_b` when `up` points up and the box is turned by `heading_rad` about the plate's normal.
    pub fn standing(&self, up: Face, heading_rad: f64) -> UnitQuaternion<f64> {
        let normal = self.up_normals_b[up.index()];
        let upright = up.upright();
        // The small rest after the exact right angle; never near 180°, so it always exists.
        let level = UnitQuaternion::rotation_between(&(upright * normal), &Vector3::z()).unwrap_or_default();
        UnitQuaternion::from_axis_angle(&Unit::new_unchecked(Vector3::z()), heading_rad) * level * upright
    }
}

/// How well a turn ends where it began. Each stop has an offset from the mark; a turn's error is the difference of two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stops {
    /// To the last bit.
    Exact,
    /// Against a fence: each stop uniform within `±half_width_deg` of it. A full turn then has a triangular error of 1σ
    /// `half_width·√(2/3)`: 0.082° for the usual 0.1°.
    Fenced {
        /// Degrees.
        half_width_deg: f64,
    },
    /// By hand to a mark: each stop normal about it with `closure_sigma_deg/√2`, so that a full turn's error has
    /// 1σ `closure_sigma_deg`.
    ByHand {
        /// Degrees.
        closure_sigma_deg: f64,
    },
}

impl Stops {
    /// The usual fence: ±0.1°.
    pub const FENCE: Self = Self::Fenced { half_width_deg: 0.1 };
    /// The usual hand: a full turn closes to 2°, 1σ.
    pub const HAND: Self = Self::ByHand { closure_sigma_deg: 2.0 };

    /// One stop's offset from the mark, rad.
    pub fn draw(self, rng: &mut Rng) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Fenced { half_width_deg } => rng.symmetric(half_width_deg).to_radians(),
            Self::ByHand { closure_sigma_deg } => (closure_sigma_deg * rng.normal()).to_radians() / 2f64.sqrt(),
        }
    }
}

/// The hands: how smoothly and how exactly they move the box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hands {
    /// Tremor of a held box in angle, rms per axis, degrees; physiological tremor lies at 8–12 Hz.
    pub tremor_angle_deg: f64,
    /// Tremor of a held box in position, rms per axis, m.
    pub tremor_position_m: f64,
    /// How much of it remains while the box is turned on the table, which carries it and damps it by friction.
    pub tremor_on_table: f64,
    /// Rms of a turn's rate about its profile, as a fraction of the mean rate.
    pub speed_wander: f64,
    /// Fraction of a turn spent getting up to speed, and again slowing down.
    pub turn_ramp: f64,
    /// A turn goes up to this far too far, and settles back, degrees. Zero against a fence.
    pub overshoot_deg: f64,
    /// Amplitude of the spin axis's wobble during a turn, degrees.
    pub wobble_deg: f64,
    /// How far the box slides about on the table in a turn, rms along each of two directions, m.
    pub slide_m: f64,
    /// Where turns end.
    pub stops: Stops,
    /// How far from its home the box is put down, m.
    pub scatter_m: f64,
    /// Peak acceleration of the knock when it is put down, m/s².
    pub knock_mps2: f64,
}

impl Hands {
    /// A careful person who turns the box against a fence.
    pub const fn fenced() -> Self {
        Self {
            tremor_angle_deg: 0.05,
            tremor_position_m: 1e-4,
            tremor_on_table: 0.1,
            speed_wander: 0.15,
            turn_ramp: 0.15,
            overshoot_deg: 0.0,
            wobble_deg: 0.0,
            slide_m: 0.0,
            stops: Stops::FENCE,
            scatter_m: 0.02,
            knock_mps2: 1.0,
        }
    }

    /// The same person without a fence.
    pub const fn by_hand() -> Self {
        Self { overshoot_deg: 3.0, stops: Stops::HAND, ..Self::fenced() }
    }

    /// A turntable: no tremor, no wander, no knock, exact stops.
    pub const fn machine() -> Self {
        Self {
            tremor_angle_deg: 0.0,
            tremor_position_m: 0.0,
            speed_wander: 0.0,
            stops: Stops::Exact,
            scatter_m: 0.0,
            knock_mps2: 0.0,
            ..Self::fenced()
        }
    }
}

/// Everything the motion depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionConfig {
    /// The table.
    pub table: Table,
    /// The box.
    pub shape: BoxShape,
    /// The hands.
    pub hands: Hands,
}

impl MotionConfig {
    /// A table tilted by 1.5°, a square box, the sensor (3, 2, 1) cm off the axis, a fence.
    pub fn nominal() -> Self {
        Self {
            table: Table::tilted(1.5, 30.0),
            shape: BoxShape::square(Vector3::new(0.03, 0.02, 0.01)),
            hands: Hands::fenced(),
        }
    }

    /// Refuses what cannot be moved.
    ///
    /// # Errors
    /// Names the first setting out of its range.
    pub fn check(&self) -> Result<(), SimError> {
        let hands = &self.hands;
        SimError::check("tilt_deg", self.table.tilt_deg, |v| v.abs() < 45.0, "below 45 degrees")?;
        SimError::check("azimuth_deg", self.table.azimuth_deg, |_| true, "finite")?;
        SimError::check("soft_deg", self.table.soft_deg, |v| (0.0..5.0).contains(&v), "0 to 5 degrees")?;
        SimError::check("lever_b_m", self.shape.lever_b_m.norm(), |v| v < 1.0, "below 1 m")?;
        SimError::check("wobble_deg", hands.wobble_deg, |v| v.abs() < 20.0, "below 20 degrees")?;
        SimError::check("slide_m", hands.slide_m, |v| (0.0..0.5).contains(&v), "0 to 50 cm")?;
        SimError::check("speed_wander", hands.speed_wander, |v| (0.0..=0.5).contains(&v), "between 0 and 0.5")?;
        SimError::check("tremor_angle_deg", hands.tremor_angle_deg, |v| (0.0..5.0).contains(&v), "0 to 5 degrees")?;
        SimError::check("tremor_position_m", hands.tremor_position_m, |v| (0.0..0.01).contains(&v), "0 to 1 cm")?;
        SimError::check("overshoot_deg", hands.overshoot_deg, |v| (0.0..45.0).contains(&v), "0 to 45 degrees")?;
        for normal in self.shape.up_normals_b {
            SimError::check("up_normals_b", normal.norm(), |v| (v - 1.0).abs() < 1e-6, "unit vectors")?;
        }
        if let Some(vibration) = self.table.vibration {
            SimError::check("vibration.frequency_hz", vibration.frequency_hz, |v| v > 0.0, "above 0")?;
            SimError::check("vibration.direction_n", vibration.direction_n.norm(), |v| v > 0.0, "a direction")?;
        }
        Ok(())
    }
}
