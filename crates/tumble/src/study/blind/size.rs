//! How large an effect is made: a multiple of what the clean twin of its recording could have shown.

use serde::{Deserialize, Serialize};
use tumble_sim::Effect;
use tumble_sim::effect::{Kind, Values};

use super::answer::{Answer, Limit};
use super::case;
use super::units;

/// Effects that grow as their number falls, and variants: a multiple of a limit means nothing there.
const DRAWN: [&str; 5] = ["gyro_saturation", "accel_saturation", "undersampling", "axis_mapping", "wrong_full_scale"];
/// What the nominal world has already, in the simulation's unit: a lever of (3, 2, 1) cm, and the Earth's rate.
const PRESENT: [(&str, f64); 2] = [("accel_lever_arm", 3.742), ("earth_rotation", 1.0)];
/// Where the units differ by more than a name: ppm at 100 dps in a ppm/dps², Earth rates in a degree per hour.
const SPECIAL: [(&str, &str, f64); 2] =
    [("gyro_scale_cubic", "ppm/dps^2", 1e4), ("earth_rotation", "deg/h", 1.0 / 15.041)];

/// A size, and what it rests on.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Size {
    /// Of this effect.
    pub id: String,
    /// In the simulation's unit.
    pub magnitude: f64,
    /// The detection limit in that unit, where it made the size.
    pub limit: Option<f64>,
    /// The same as the diagnosis states it, in its own unit.
    #[serde(default)]
    pub stated: Option<f64>,
    /// `limit`, or why it was drawn from the effect's own range.
    pub by: String,
}

/// Whether the twin says that the effect could show here; a diagnosis that does not mention it is no reason to go
/// elsewhere.
pub fn can_show(id: &str, twin: &Answer) -> bool {
    twin.detection_limits.iter().find(|limit| limit.id == id).is_none_or(|limit| limit.testable)
}

/// The size of one effect of a case at `at` times the limit.
pub fn size(id: &str, at: f64, twin: Option<&Answer>, seed: u64) -> Option<Size> {
    let kind = Effect::kinds().find(|kind| kind.id == id)?;
    let by_range = |why: &str| {
        let magnitude = case::drawn(id, seed)?.magnitude();
        Some(Size { id: id.into(), magnitude, limit: None, stated: None, by: format!("its own range: {why}") })
    };
    if DRAWN.contains(&id) || matches!(kind.values, Values::Whole(..)) {
        return by_range("no multiple of a limit");
    }
    let Some(twin) = twin else { return by_range("the twin has no diagnosis") };
    let Some(limit) = twin.detection_limits.iter().find(|limit| limit.id == id) else {
        return by_range("the diagnosis states no limit");
    };
    let Some(unit) = in_unit(kind, limit) else {
        return by_range(&format!("its limit is in '{}', its size in {}", limit.unit, kind.unit));
    };
    let present = PRESENT.iter().find(|(one, _)| *one == id).map_or(0.0, |(_, present)| *present);
    let (low, high) = kind.values.bounds();
    let magnitude = (present + at * unit).clamp(low, high);
    let by = if limit.testable { "limit" } else { "limit, beyond usual sizes" };
    Some(Size { id: id.into(), magnitude, limit: Some(unit), stated: limit.limit, by: by.into() })
}

/// A limit in the simulation's unit.
fn in_unit(kind: &Kind, limit: &Limit) -> Option<f64> {
    let value = limit.limit.filter(|value| value.is_finite() && *value > 0.0 && *value < f64::MAX)?;
    let special = SPECIAL.iter().find(|(id, unit, _)| *id == kind.id && *unit == limit.unit);
    let factor = special.map(|(_, _, factor)| *factor).or_else(|| units::factor(&limit.unit, kind.unit))?;
    Some(value * factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn twin(id: &str, limit: f64, unit: &str) -> Answer {
        let limit = Limit { id: id.into(), limit: Some(limit), unit: unit.into(), testable: true, why: String::new() };
        Answer { detection_limits: vec![limit], ..Answer::default() }
    }

    #[test]
    fn limits_come_in_the_simulation_unit() {
        let of = |id: &str, limit, unit| size(id, 2.0, Some(&twin(id, limit, unit)), 1).expect("it exists");
        assert!((of("gyro_scale_cubic", 0.1, "ppm/dps^2").magnitude - 2000.0).abs() < 1e-9);
        assert!((of("gyro_bias_random_walk", 1.0, "mdps/sqrt(s)").magnitude - 0.002).abs() < 1e-12);
        assert!((of("accel_lever_arm", 1.0, "cm").magnitude - 5.742).abs() < 1e-9);
        assert!((of("earth_rotation", 15.041, "deg/h").magnitude - 3.0).abs() < 1e-9);
    }

    #[test]
    fn without_a_limit_the_effects_own_range_is_used_and_said() {
        let size = size("gyro_saturation", 2.0, None, 1).expect("it exists");
        assert!(
            (30.0..=80.0).contains(&size.magnitude) && size.limit.is_none() && size.by.starts_with("its own range")
        );
    }
}
