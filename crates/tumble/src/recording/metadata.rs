//! The `# key: value` lines above the header.

pub use tumble_core::procedure::{BoxFaces, TurnStops};

use super::error::Problem;

/// What the recording says of itself. Nothing is required.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// Maker's name of the chip.
    pub sensor: Option<String>,
    /// Full scale, °/s.
    pub gyro_range_dps: Option<f64>,
    /// Full scale, g.
    pub accel_range_g: Option<f64>,
    /// Nominal sample rate; the stamps are believed before it.
    pub rate_hz: Option<f64>,
    /// Local gravity.
    pub gravity_mps2: Option<f64>,
    /// Geographic latitude.
    pub latitude_deg: Option<f64>,
    /// How turns end, where it is said.
    pub turns: Option<TurnStops>,
    /// What the box is, where it is said.
    pub box_faces: Option<BoxFaces>,
}

impl Metadata {
    /// Takes in one `#` line. A key that is not known, or a line without a colon, is a remark and left alone.
    pub(super) fn read_line(&mut self, line: &str) -> Result<(), Problem> {
        let Some((key, value)) = line.trim_start_matches('#').split_once(':') else { return Ok(()) };
        let value = value.trim();
        match key.trim() {
            "sensor" => self.sensor = Some(value.into()),
            "gyro_range_dps" => self.gyro_range_dps = Some(positive("gyro_range_dps", value)?),
            "accel_range_g" => self.accel_range_g = Some(positive("accel_range_g", value)?),
            "rate_hz" => self.rate_hz = Some(positive("rate_hz", value)?),
            "gravity_mps2" => self.gravity_mps2 = Some(gravity(value)?),
            "latitude_deg" => self.latitude_deg = Some(latitude(value)?),
            "turns" => self.turns = Some(turns(value)?),
            "box" => self.box_faces = Some(box_faces(value)?),
            _ => {}
        }
        Ok(())
    }

    /// The lines that say all this, without line ends.
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut push = |key: &str, value: Option<String>| {
            if let Some(value) = value {
                lines.push(format!("# {key}: {value}"));
            }
        };
        let number = |value: Option<f64>| value.map(|v| v.to_string());
        push("sensor", self.sensor.clone());
        push("gyro_range_dps", number(self.gyro_range_dps));
        push("accel_range_g", number(self.accel_range_g));
        push("rate_hz", number(self.rate_hz));
        push("gravity_mps2", number(self.gravity_mps2));
        push("latitude_deg", number(self.latitude_deg));
        push("turns", self.turns.map(|turns| turns.name().into()));
        push("box", self.box_faces.map(|faces| faces.name().into()));
        lines
    }
}

fn number(value: &str, allowed: impl Fn(f64) -> bool) -> Option<f64> {
    value.parse().ok().filter(|v: &f64| v.is_finite() && allowed(*v))
}

fn positive(key: &'static str, value: &str) -> Result<f64, Problem> {
    number(value, |v| v > 0.0).ok_or_else(|| Problem::Metadata {
        key,
        value: value.into(),
        allowed: "a positive number",
    })
}

/// 9.76 to 9.84 m/s² is all there is on the ground; a wider band lets altitude in but keeps `1` (in g) out.
fn gravity(value: &str) -> Result<f64, Problem> {
    number(value, |v| (9.7..=9.9).contains(&v)).ok_or_else(|| Problem::Metadata {
        key: "gravity_mps2",
        value: value.into(),
        allowed: "a number from 9.7 to 9.9 (m/s²)",
    })
}

fn latitude(value: &str) -> Result<f64, Problem> {
    number(value, |v| v.abs() <= 90.0).ok_or_else(|| Problem::Metadata {
        key: "latitude_deg",
        value: value.into(),
        allowed: "a number from -90 to 90",
    })
}

pub(crate) fn turns(value: &str) -> Result<TurnStops, Problem> {
    [TurnStops::Fenced, TurnStops::ByHand]
        .into_iter()
        .find(|turns| turns.name() == value)
        .ok_or_else(|| Problem::Metadata { key: "turns", value: value.into(), allowed: "fenced or by-hand" })
}

pub(crate) fn box_faces(value: &str) -> Result<BoxFaces, Problem> {
    [BoxFaces::Square, BoxFaces::Unknown]
        .into_iter()
        .find(|faces| faces.name() == value)
        .ok_or_else(|| Problem::Metadata { key: "box", value: value.into(), allowed: "square or unknown" })
}
