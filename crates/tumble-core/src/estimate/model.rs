//! The physics: nominal parameters, and the observation rows that follow from them. Derivations: `docs/method.md`.

use nalgebra::{Matrix3, Quaternion, SMatrix, UnitQuaternion, Vector3};

use super::filter::AttitudeDrive;
use super::state::{Block, Row, Rows};
use crate::calibration::Triad;
use crate::tape::Record;

/// What the error state is an error of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nominal {
    /// Gyroscope, rad/s.
    pub gyro: Triad,
    /// Accelerometer, m/s².
    pub accel: Triad,
    /// Earth's rotation, rad/s, frame n with the heading of the first still.
    pub earth_rad_s: Vector3<f32>,
}

/// A residual and the row that explains it: `residual = row · state + noise`.
pub struct Observation {
    /// Observed minus nominal.
    pub residual: f32,
    /// Coefficients.
    pub row: Row,
}

/// Three residuals and the rows that explain them.
pub struct VectorObservation {
    /// Observed minus nominal.
    pub residual: Vector3<f32>,
    /// Coefficients.
    pub rows: Rows<3>,
}

impl Nominal {
    /// Rotation vector of a record, calibrated, rad, frame b.
    pub fn rotation(&self, record: &Record) -> Vector3<f32> {
        self.gyro.correction * (record.rotation_rad - self.gyro.bias * record.dt_s)
    }

    /// What is wrong with the coning in a record's rotation vector, rad, frame b. It was summed in uncorrected rates, `½ ∫ θ × ω`; of a
    /// rate with the slope ω̇ that is `ω × ω̇ T³/12`, and the correction belongs inside the product. A move by hand has some
    /// 0.2 mrad of it in a record, of which 5 % are 10 µrad: sheet noise hides that, a sensor five times as quiet does not.
    pub fn coning(&self, record: &Record, slope: &Vector3<f32>) -> Vector3<f32> {
        let raw = record.rotation_rad / record.dt_s - self.gyro.bias;
        let ideal = (self.gyro.correction * raw).cross(&(self.gyro.correction * slope));
        (ideal - self.gyro.correction * raw.cross(slope)) * (record.dt_s * record.dt_s * record.dt_s / 12.0)
    }

    /// Specific force of a record, calibrated, m/s², frame b.
    pub fn force(&self, record: &Record) -> Vector3<f32> {
        self.accel.compensate(&record.specific_force_mps2)
    }

    /// How attitude errors grow over a record: `φ ← φ + R (δM (Θ − b dt) − M δb dt) − Ω dt`, R at the record's middle.
    pub fn drive(&self, record: &Record, middle: &Matrix3<f32>) -> AttitudeDrive {
        let raw = record.rotation_rad - self.gyro.bias * record.dt_s;
        let mut correction = SMatrix::<f32, 3, 9>::zeros();
        for row in 0..3 {
            for column in 0..3 {
                correction.set_column(3 * row + column, &(middle.column(row) * raw[column]));
            }
        }
        AttitudeDrive { correction, bias: -(middle * self.gyro.correction) * record.dt_s, earth: -record.dt_s }
    }

    /// Specific force against gravity, in parts that can be averaged over records: see [`GravityParts`].
    pub fn gravity(&self, record: &Record, to_n: &Matrix3<f32>, gravity: f32, lever: &Matrix3<f32>) -> GravityParts {
        let raw = record.specific_force_mps2 - self.accel.bias;
        let mut correction = SMatrix::<f32, 3, 9>::zeros();
        for inner in 0..3 {
            for column in 0..3 {
                correction.set_column(3 * inner + column, &(to_n.column(inner) * -raw[column]));
            }
        }
        let bias = to_n * self.accel.correction;
        GravityParts { residual: bias * raw - Vector3::new(0.0, 0.0, gravity), correction, bias, lever: to_n * lever }
    }

    /// The same of a record that turns by `rotation`, θ, frame b, with `to_n` its middle: gravity's mean in frame b is `(1 + [θ×]²/24) Rᵀ g ẑ`. Of
    /// a table that leans by 2° that is 3 µrad at 36 °/s, and 90 µrad where a record is full at 0.25 rad, in the same direction in
    /// every turn.
    pub fn gravity_in_turn(
        &self,
        record: &Record,
        rotation: &Vector3<f32>,
        to_n: &Matrix3<f32>,
        gravity: f32,
        lever: &Matrix3<f32>,
    ) -> GravityParts {
        let mut parts = self.gravity(record, to_n, gravity, lever);
        let turned = to_n * rotation;
        parts.residual -= turned.cross(&turned.cross(&Vector3::z())) * (gravity / 24.0);
        parts
    }

    /// Rate at rest, frame b: `M (raw − b) − Rᵀ Ω₀ = M δb + Rᵀ δΩ` (δM times a rate near zero is left out).
    pub fn rest_rate(&self, record: &Record, to_b: &Matrix3<f32>) -> VectorObservation {
        let mut rows = Rows::new();
        rows.set_matrix(Block::GyroBias, &self.gyro.correction);
        rows.set_matrix(Block::Earth, to_b);
        VectorObservation { residual: self.rotation(record) / record.dt_s - to_b * self.earth_rad_s, rows }
    }
}

/// Specific force against gravity, frame n:
/// `R A (raw − a) − g ẑ = −R δA (raw − a) + R A δa − g φ × ẑ + R L l`, `L = [ω×]² + [ω̇×]`. Attitude errors show in the
/// horizontal components alone, so the vertical tells of the accelerometer and the others of the motion.
#[derive(Clone, Copy, Debug)]
pub struct GravityParts {
    /// Left side, m/s².
    pub residual: Vector3<f32>,
    /// Coefficients of δA.
    pub correction: SMatrix<f32, 3, 9>,
    /// Coefficients of δa.
    pub bias: Matrix3<f32>,
    /// Coefficients of l.
    pub lever: Matrix3<f32>,
}

impl Default for GravityParts {
    fn default() -> Self {
        Self {
            residual: Vector3::zeros(),
            correction: SMatrix::zeros(),
            bias: Matrix3::zeros(),
            lever: Matrix3::zeros(),
        }
    }
}

impl GravityParts {
    /// Adds `weight · other`.
    pub fn add(&mut self, other: &Self, weight: f32) {
        self.residual += other.residual * weight;
        self.correction += other.correction * weight;
        self.bias += other.bias * weight;
        self.lever += other.lever * weight;
    }

    /// As an observation. `since`: how attitude has moved on from the mean of the records to now,
    /// `φ_mean = φ − since · (δM, δb, Ω)`; none at rest.
    pub fn observation(&self, gravity: f32, since: Option<&AttitudeDrive>) -> VectorObservation {
        let mut rows = Rows::new();
        rows.set_matrix(Block::AccelBias, &self.bias);
        rows.set_matrix(Block::AccelCorrection, &self.correction);
        // g ẑ × a: what an attitude error a does to the reading.
        let tilted = |x: f32, y: f32| [-gravity * y, gravity * x, 0.0];
        rows.set(Block::Attitude, 0, tilted(1.0, 0.0));
        rows.set(Block::Attitude, 1, tilted(0.0, 1.0));
        if let Some(since) = since {
            rows.set(Block::Earth, 0, tilted(-since.earth, 0.0));
            rows.set(Block::Earth, 1, tilted(0.0, -since.earth));
            for (offset, column) in since.correction.column_iter().enumerate() {
                rows.set(Block::GyroCorrection, offset, tilted(-column[0], -column[1]));
            }
            for (offset, column) in since.bias.column_iter().enumerate() {
                rows.set(Block::GyroBias, offset, tilted(-column[0], -column[1]));
            }
            rows.set_matrix(Block::Lever, &self.lever);
            rows.set_matrix(Block::Pivot, &self.lever);
        }
        VectorObservation { residual: self.residual, rows }
    }
}

/// The face that lies on the table is parallel to it: horizontal components of `R (n + e) = p`, n the face's normal.
/// `p = (R n)ₓᵧ + (φ × R n)ₓᵧ + (R e)ₓᵧ` as (mean, row) per component; `plane_n` holds the two box axes that e is
/// measured along.
pub fn plate(normal_n: &Vector3<f32>, plane_n: &[Vector3<f32>; 2]) -> [Observation; 2] {
    let facet =
        |row: Row, axis: usize| row.with(Block::Facet, 0, plane_n[0][axis]).with(Block::Facet, 1, plane_n[1][axis]);
    let x = Row::new().with(Block::Attitude, 1, normal_n.z).with(Block::Attitude, 2, -normal_n.y);
    let y = Row::new().with(Block::Attitude, 2, normal_n.x).with(Block::Attitude, 0, -normal_n.z);
    [Observation { residual: normal_n.x, row: facet(x, 0) }, Observation { residual: normal_n.y, row: facet(y, 1) }]
}

/// The same in a turn, of a face's mean normal: `(R n)ₓᵧ = p − (φ × R n)ₓᵧ − (R (e + w))ₓᵧ`. `since` as in
/// [`GravityParts::observation`]; the heading's part, a table's tilt small, goes without.
pub fn plate_in_turn(normal_n: &Vector3<f32>, plane_n: &[Vector3<f32>; 2], since: &AttitudeDrive) -> [Observation; 2] {
    let tilt = [(1, normal_n.z, -normal_n.y), (0, -normal_n.z, normal_n.x)];
    core::array::from_fn(|axis| {
        let (attitude, coefficient, heading) = tilt[axis];
        let mut row = Row::new();
        row.set(Block::Attitude, attitude, [-coefficient]);
        row.set(Block::Attitude, 2, [-heading]);
        since.add_to(&mut row, attitude, coefficient);
        row.set(Block::Table, axis, [1.0]);
        for block in [Block::Facet, Block::Wobble] {
            row.set(block, 0, [-plane_n[0][axis]]);
            row.set(block, 1, [-plane_n[1][axis]]);
        }
        Observation { residual: normal_n[axis], row }
    })
}

/// The shortest rotation that takes `up` to z. The half-angle form keeps small angles to `f32`'s last digit, where an
/// arc cosine of the dot product would round them to 0.3 mrad. Straight down has no shortest way: half a turn about x.
pub fn levelling(up: &Vector3<f32>) -> UnitQuaternion<f32> {
    let half = Quaternion::new(up.norm() + up.z, up.y, -up.x, 0.0);
    let half_turn = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 1.0, 0.0, 0.0));
    UnitQuaternion::try_new(half, 1e-6 * up.norm()).unwrap_or(half_turn)
}

/// Heading error about the table's normal, `φ · n`, as a row.
pub fn heading(normal_n: &Vector3<f32>) -> Row {
    Row::new().with_vector(Block::Attitude, 0, normal_n)
}

/// A stop against the fence: what is left of the rotation since the first stop after whole turns,
/// `log(R R₀ᵀ) · n = −φ · n + h + stop error`.
pub fn fence(now: &UnitQuaternion<f32>, first: &UnitQuaternion<f32>, normal_n: &Vector3<f32>) -> Observation {
    let left = (now * first.inverse()).scaled_axis().dot(normal_n);
    Observation { residual: left, row: heading(&-normal_n).with(Block::Fence, 0, 1.0) }
}

/// Lever matrix `[ω×]² + [ω̇×]`, mean over `dt_s` of a rate that changes evenly: its square's mean has `[ω̇×]² dt²/12` besides.
pub fn lever(rate: &Vector3<f32>, acceleration: &Vector3<f32>, dt_s: f32) -> Matrix3<f32> {
    let (w, more) = (rate.cross_matrix(), acceleration.cross_matrix());
    w * w + more * more * (dt_s * dt_s / 12.0) + more
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A record of a rate that changes its direction, by a crooked and offset gyroscope, against the true rotation in small steps.
    #[test]
    fn coning_is_that_of_corrected_rates() {
        let correction = Matrix3::new(1.03, 0.02, -0.01, -0.02, 0.98, 0.015, 0.01, -0.02, 1.02);
        let bias = Vector3::new(0.08, -0.06, 0.05);
        let accel = Triad::identity();
        let nominal = Nominal { gyro: Triad { bias, correction }, accel, earth_rad_s: Vector3::zeros() };
        let (rate, slope, dt_s) = (Vector3::new(2.0f32, -1.0, 0.5), Vector3::new(-6.0f32, 5.0, 8.0), 1.0 / 12.0);
        let steps = 400;
        let mut truth = UnitQuaternion::<f64>::identity();
        for step in 0..steps {
            let t_s = (step as f32 + 0.5) * dt_s / steps as f32;
            let turn = correction * (rate + slope * (t_s - 0.5 * dt_s)) * (dt_s / steps as f32);
            truth *= UnitQuaternion::from_scaled_axis(turn.cast());
        }
        let summed = rate * dt_s + rate.cross(&slope) * (dt_s * dt_s * dt_s / 12.0);
        let record = Record { dt_s, rotation_rad: summed + bias * dt_s, specific_force_mps2: Vector3::zeros() };
        let error = |rotation: Vector3<f32>| (rotation.cast::<f64>() - truth.scaled_axis()).norm();
        let (with, without) =
            (error(nominal.rotation(&record) + nominal.coning(&record, &slope)), error(nominal.rotation(&record)));
        // What is left is the third order, θ² times the coning's 1.4 mrad over ten.
        assert!(with < 6e-6 && without > 10.0 * with, "{with:e} {without:e}");
    }

    #[test]
    fn levelling_is_exact_for_tiny_tilts_and_whole_for_upside_down() {
        let tilt = 1e-5;
        let turn = levelling(&(Vector3::new(tilt, -2.0 * tilt, 1.0) * 9.8));
        let expected = Vector3::new(-2.0 * tilt, -tilt, 0.0);
        assert!((turn.scaled_axis() - expected).norm() < 1e-11, "{}", turn.scaled_axis());
        assert!((levelling(&-Vector3::z()) * -Vector3::z() - Vector3::z()).norm() < 1e-6);
        let oblique = Vector3::new(3.0, -4.0, 1.0);
        assert!((levelling(&oblique) * oblique - Vector3::z() * oblique.norm()).norm() < 1e-5);
    }
}
