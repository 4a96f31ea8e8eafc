//! How large an effect is made: a multiple of what the clean twin of its recording could have shown.

use tumble_sim::Effect;
use tumble_sim::effect::{Kind, Values};

use super::answer::{Answer, Limit};
use super::case::{self, Setting};
use super::size::{HIDDEN, Size};
use super::strength::{self, Sought};
use super::units;

/// Variants: a multiple of a limit means nothing there. Nor does it for a clock's step: its limit is a tenth of the interval, and
/// twice that divides the interval exactly, which leaves the stamps even.
const DRAWN: [&str; 3] = ["axis_mapping", "wrong_full_scale", "timestamp_quantization"];
/// Effects that grow as their number falls: twice the limit is half of it.
const FALLING: [&str; 3] = ["gyro_saturation", "accel_saturation", "undersampling"];
/// What the nominal world has already, in the simulation's unit: a lever of (3, 2, 1) cm, and the Earth's rate.
const PRESENT: [(&str, f64); 2] = [("accel_lever_arm", 3.742), ("earth_rotation", 1.0)];
/// Where the units differ by more than a name: ppm at 100 dps in a ppm/dps², Earth rates in a degree per hour.
const SPECIAL: [(&str, &str, f64); 2] =
    [("gyro_scale_cubic", "ppm/dps^2", 1e4), ("earth_rotation", "deg/h", 1.0 / 15.041)];

/// Whether the twin says that the effect could show here; a diagnosis that does not mention it is no reason to go
/// elsewhere.
pub fn can_show(id: &str, twin: &Answer) -> bool {
    twin.detection_limits.iter().find(|limit| limit.id == id).is_none_or(|limit| limit.testable)
}

/// The sizes of a case's effects, in their order. What gates find first, because it takes from what the search can see; then each beside those
/// before it, because a bias that wanders is noise to all else.
pub fn sizes(ids: &[&str], at: f64, twin: Option<&Answer>, setting: &Setting) -> Vec<Size> {
    let searched = |id: &str| Effect::kinds().any(|kind| kind.id == id && strength::Seen::of(kind).is_some());
    let gates = ids.iter().filter(|id| !searched(id)).filter_map(|id| as_stated(id, at, twin, setting.seed));
    let mut sizes: Vec<Size> = gates.collect();
    let mut known: Vec<&str> = Vec::new();
    for id in ids.iter().filter(|id| searched(id)) {
        let beside: Vec<Effect> =
            sizes.iter().filter_map(|size| Effect::new(&size.id, Some(size.magnitude)).ok()).collect();
        sizes.extend(size(id, at, twin, setting, &beside, &known));
        known.push(id);
    }
    sizes.sort_by_key(|size| ids.iter().position(|id| *id == size.id));
    sizes
}

/// The size of one effect of a case at `at` times the limit of its own direction; where that cannot be had, of the limit that
/// the twin states.
fn size(
    id: &str,
    at: f64,
    twin: Option<&Answer>,
    setting: &Setting,
    beside: &[Effect],
    known: &[&str],
) -> Option<Size> {
    let kind = Effect::kinds().find(|kind| kind.id == id)?;
    let stated = stated(kind, twin).ok();
    let first = stated.map_or(kind.default - present(id), |stated| stated.0);
    let Some(Sought { size: limit, shows }) = strength::limit(setting, beside, known, kind, present(id), first) else {
        return as_stated(id, at, twin, setting.seed);
    };
    let by = match strength::Seen::of(kind) {
        _ if !shows && !beside.is_empty() => HIDDEN,
        Some(strength::Seen::ByShapes) => "limit of the shapes",
        _ => "limit",
    };
    let magnitude = large(kind, at, limit);
    Some(Size { id: id.into(), magnitude, limit: Some(limit), stated: stated.map(|stated| stated.1), by: by.into() })
}

/// The same by what the twin states alone, or from the effect's own range.
pub fn as_stated(id: &str, at: f64, twin: Option<&Answer>, seed: u64) -> Option<Size> {
    let kind = Effect::kinds().find(|kind| kind.id == id)?;
    match stated(kind, twin) {
        Ok((limit, value, testable)) => {
            let by = if testable { "limit" } else { "limit, beyond usual sizes" }.into();
            let magnitude = large(kind, at, limit);
            Some(Size { id: id.into(), magnitude, limit: Some(limit), stated: Some(value), by })
        }
        Err(why) => {
            let (magnitude, by) = (case::drawn(id, seed)?.magnitude(), format!("its own range: {why}"));
            Some(Size { id: id.into(), magnitude, limit: None, stated: None, by })
        }
    }
}

fn present(id: &str) -> f64 {
    PRESENT.iter().find(|(one, _)| *one == id).map_or(0.0, |(_, present)| *present)
}

fn large(kind: &Kind, at: f64, limit: f64) -> f64 {
    let (low, high) = kind.values.bounds();
    let size = if FALLING.contains(&kind.id) { limit / at } else { present(kind.id) + at * limit };
    size.clamp(low, high)
}

/// The limit that the clean twin states: in the simulation's unit, in its own, and whether it is testable; or why there is none.
fn stated(kind: &Kind, twin: Option<&Answer>) -> Result<(f64, f64, bool), String> {
    if DRAWN.contains(&kind.id) || matches!(kind.values, Values::Whole(..)) {
        return Err("no multiple of a limit".into());
    }
    let twin = twin.ok_or("the twin has no diagnosis")?;
    let limit = twin.detection_limits.iter().find(|limit| limit.id == kind.id);
    let limit = limit.ok_or("the diagnosis states no limit")?;
    let unit =
        in_unit(kind, limit).ok_or_else(|| format!("its limit is in '{}', its size in {}", limit.unit, kind.unit))?;
    Ok((unit, limit.limit.unwrap_or(f64::NAN), limit.testable))
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
        let limit = Limit { id: id.into(), limit: Some(limit), unit: unit.into(), testable: true, ..Limit::default() };
        Answer { detection_limits: vec![limit], ..Answer::default() }
    }

    #[test]
    fn limits_come_in_the_simulation_unit() {
        let of = |id: &str, limit, unit| {
            let kind = Effect::kinds().find(|kind| kind.id == id).expect("it exists");
            stated(kind, Some(&twin(id, limit, unit))).expect("it is stated").0
        };
        assert!((of("gyro_scale_cubic", 0.1, "ppm/dps^2") - 1000.0).abs() < 1e-9);
        assert!((of("gyro_bias_random_walk", 1.0, "mdps/sqrt(s)") - 0.001).abs() < 1e-12);
        assert!((of("accel_lever_arm", 1.0, "cm") - 1.0).abs() < 1e-9);
        assert!((of("earth_rotation", 15.041, "deg/h") - 1.0).abs() < 1e-9);
    }

    #[test]
    fn without_a_limit_the_effects_own_range_is_used_and_said() {
        let scheme = tumble_sim::Scheme::Double;
        let setting = Setting { scheme, seed: 1, by_hand: false, swing: true, noise: 1.0 };
        let size = size("gyro_saturation", 2.0, None, &setting, &[], &[]).expect("it exists");
        assert!(
            (30.0..=80.0).contains(&size.magnitude) && size.limit.is_none() && size.by.starts_with("its own range")
        );
    }
}
