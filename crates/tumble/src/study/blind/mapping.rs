//! What the simulation and the diagnosis call the same number. The two share no code, so that this is written by hand, effect
//! by effect: the only place where their names meet.

use super::answer::{Named, Value};
use super::units;

/// A number with its name as both sides have it.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairing {
    /// As the diagnosis calls it.
    pub name: String,
    /// In the diagnosis' unit.
    pub truth: f64,
    /// What was found.
    pub value: f64,
    /// Its sigma.
    pub sigma: f64,
}

impl Pairing {
    /// By how many sigmas it is off.
    pub fn sigmas(&self) -> f64 {
        (self.value - self.truth) / self.sigma
    }
}

/// One number of the truth.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
pub struct True {
    /// As the simulation calls it.
    pub name: String,
    /// In its unit.
    pub value: f64,
    /// Of the value.
    pub unit: String,
}

/// From the truth's numbers to the diagnosis' names: `(name in the diagnosis, value, unit)`; none for what has no counterpart.
type Rule = fn(&[True]) -> Vec<(String, f64, String)>;

const AXES: [&str; 3] = ["x", "y", "z"];

fn of<'a>(truth: &'a [True], name: &str) -> Option<&'a True> {
    truth.iter().find(|one| one.name == name)
}

/// `PREFIX_x` … is called `x` …
fn axes(truth: &[True], prefix: &str) -> Vec<(String, f64, String)> {
    let one =
        |axis: &&str| of(truth, &format!("{prefix}_{axis}")).map(|one| (axis.to_string(), one.value, one.unit.clone()));
    AXES.iter().filter_map(one).collect()
}

/// A number that only changes its name.
fn renamed(truth: &[True], from: &str, to: &str) -> Vec<(String, f64, String)> {
    of(truth, from).map(|one| (to.to_owned(), one.value, one.unit.clone())).into_iter().collect()
}

fn both(mut first: Vec<(String, f64, String)>, second: Vec<(String, f64, String)>) -> Vec<(String, f64, String)> {
    first.extend(second);
    first
}

/// A matrix's entries `FROM_ij`, or vectors' `FROM_i_j`, under the name `made(i, j)`.
fn matrix(
    truth: &[True],
    from: impl Fn(&str, &str) -> String,
    to: impl Fn(&str, &str) -> String,
) -> Vec<(String, f64, String)> {
    let pairs = AXES.iter().flat_map(|i| AXES.iter().map(move |j| (i, j)));
    pairs.filter_map(|(i, j)| of(truth, &from(i, j)).map(|one| (to(i, j), one.value, one.unit.clone()))).collect()
}

/// East and north of the diagnosis hang on the first pose's heading, which nothing ties to the Earth: of the tilt only the
/// angle's size can be compared.
fn tilt(truth: &[True]) -> Vec<(String, f64, String)> {
    both(renamed(truth, "angle", "|east, north|"), renamed(truth, "time", "at"))
}

/// The diagnosis states places less their mean: what they have in common is a lever arm.
fn places(truth: &[True]) -> Vec<(String, f64, String)> {
    let all = matrix(truth, |i, j| format!("offset_of_{i}_{j}"), |i, j| format!("{i}_at_{j}"));
    let mean = |k: usize| all.iter().skip(k % 3).step_by(3).map(|one| one.1).sum::<f64>() / 3.0;
    all.iter().enumerate().map(|(k, (name, value, unit))| (name.clone(), value - mean(k), unit.clone())).collect()
}

/// Effects whose numbers can be compared.
const RULES: &[(&str, Rule)] = &[
    ("gyro_g_sensitivity", |t| matrix(t, |i, j| format!("g_{i}{j}"), |i, j| format!("{i}_per_{j}"))),
    // The simulation has no cross terms: those of the diagnosis, where it has any, are true at 0.
    ("gyro_g_squared", |t| {
        let cross = |i: &str, j: &str| {
            let own = of(t, &format!("c_{i}"));
            own.map(|own| (format!("{i}_per_{j}_squared"), if i == j { own.value } else { 0.0 }, own.unit.clone()))
        };
        let all = AXES.iter().flat_map(|i| AXES.iter().filter_map(move |j| cross(i, j))).collect();
        both(all, axes(t, "c"))
    }),
    ("gyro_scale_quadratic", |t| axes(t, "k")),
    // A change of scale in ppm at 100 dps is 1e-4 of it in ppm/dps².
    ("gyro_scale_cubic", |t| {
        axes(t, "k_at_100_dps").into_iter().map(|(name, ppm, _)| (name, 1e-4 * ppm, "ppm/dps^2".into())).collect()
    }),
    ("gyro_scale_asymmetry", |t| axes(t, "scale_positive_less_negative")),
    ("gyro_dead_zone", |t| AXES.iter().flat_map(|axis| renamed(t, "half_width", axis)).collect()),
    ("gyro_bias_temperature", |t| axes(t, "slope")),
    ("gyro_scale_temperature", |t| axes(t, "slope")),
    ("gyro_warm_up", |t| both(axes(t, "decaying_bias"), renamed(t, "time_constant", "tau"))),
    ("accel_warm_up", |t| both(axes(t, "decaying_bias"), renamed(t, "time_constant", "tau"))),
    ("gyro_bias_step", |t| both(axes(t, "step"), renamed(t, "step_time", "at"))),
    ("gyro_bias_random_walk", |t| renamed(t, "random_walk", "q")),
    ("accel_bias_temperature", |t| axes(t, "slope")),
    ("accel_scale_temperature", |t| axes(t, "slope")),
    ("accel_bias_step", |t| both(axes(t, "step"), renamed(t, "step_time", "at"))),
    ("accel_bias_random_walk", |t| renamed(t, "random_walk", "q")),
    ("accel_quadratic", |t| axes(t, "k")),
    ("accel_cubic", |t| axes(t, "k")),
    ("accel_lever_arm", |t| axes(t, "lever")),
    ("accel_internal_lever_arms", places),
    ("gyro_accel_lag", |t| renamed(t, "lag", "accelerometer_after_gyroscope")),
    ("incomplete_turn", |t| renamed(t, "shortfall", "missing")),
    ("platform_tilt_change", tilt),
    // The truth is a rate about the Earth's axis; its components in the diagnosis' frame hang on latitude and heading.
    ("earth_rotation", |t| renamed(t, "rate", "|n_x, n_y, n_z|")),
];

/// Why an effect's numbers are not compared.
pub fn why_not(id: &str) -> Option<&'static str> {
    (!RULES.iter().any(|(ruled, _)| *ruled == id)).then_some("no hand-written pairing of its numbers (mapping.rs)")
}

/// The numbers of an effect that both sides have.
pub fn pair(id: &str, truth: &[True], found: &Named) -> Vec<Pairing> {
    let Some((_, rule)) = RULES.iter().find(|(ruled, _)| *ruled == id) else { return Vec::new() };
    rule(truth)
        .into_iter()
        .filter_map(|(name, value, unit)| {
            let found = if name.starts_with('|') { length(&name, &found.parameters)? } else { find(&name, found)? };
            let sigma = found.sigma.filter(|sigma| *sigma > 0.0 && sigma.is_finite())?;
            let truth = value * units::factor(&unit, &found.unit)?;
            Some(Pairing { name, truth, value: found.value?, sigma })
        })
        .collect()
}

fn find(name: &str, found: &Named) -> Option<Value> {
    found.parameters.iter().find(|one| one.name == name).cloned()
}

/// The length of the vector `|a, b|`, with its sigma along itself.
fn length(name: &str, parameters: &[Value]) -> Option<Value> {
    let names: Vec<&str> = name.trim_matches('|').split(", ").collect();
    let parts: Vec<&Value> = parameters.iter().filter(|one| names.contains(&one.name.as_str())).collect();
    let first = parts.first().filter(|_| parts.len() == names.len())?;
    let square = |f: &dyn Fn(&Value) -> Option<f64>| parts.iter().map(|one| f(one)).sum::<Option<f64>>();
    let value = square(&|one| Some(one.value?.powi(2)))?.sqrt();
    let along = square(&|one| Some((one.value? * one.sigma?).powi(2)))?.sqrt() / value;
    Some(Value { name: name.into(), value: Some(value), sigma: Some(along), unit: first.unit.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(name: &str, value: f64, unit: &str) -> True {
        True { name: name.into(), value, unit: unit.into() }
    }

    fn named(id: &str, parameters: &[(&str, f64, f64, &str)]) -> Named {
        let value = |(name, value, sigma, unit): &(&str, f64, f64, &str)| Value {
            name: name.to_string(),
            value: Some(*value),
            sigma: Some(*sigma),
            unit: unit.to_string(),
        };
        Named { id: id.into(), parameters: parameters.iter().map(value).collect(), ..Named::default() }
    }

    #[test]
    fn numbers_meet_in_the_diagnosis_unit() {
        let truth = [truth("slope_x", 500.0, "ppm/degC"), truth("slope_y", -100.0, "ppm/degC")];
        let found = named("gyro_scale_temperature", &[("x", 0.052, 0.001, "%/K"), ("y", -0.01, 0.001, "%/K")]);
        let pairs = pair("gyro_scale_temperature", &truth, &found);
        assert_eq!(pairs.len(), 2);
        assert!((pairs[0].truth - 0.05).abs() < 1e-12 && (pairs[0].sigmas() - 2.0).abs() < 1e-9);
        assert!((pairs[1].sigmas()).abs() < 1e-9);
    }

    #[test]
    fn a_vector_of_unknown_direction_is_compared_by_its_length() {
        let found = named("platform_tilt_change", &[("east", 0.3, 0.01, "deg"), ("north", 0.4, 0.01, "deg")]);
        let pairs =
            pair("platform_tilt_change", &[truth("angle", 0.5, "deg"), truth("axis_from_east", 10.0, "deg")], &found);
        assert_eq!(pairs.len(), 1);
        assert!((pairs[0].value - 0.5).abs() < 1e-12 && (pairs[0].sigma - 0.01).abs() < 1e-9);
    }

    #[test]
    fn what_has_no_pairing_says_so() {
        assert!(why_not("shock").is_some() && why_not("gyro_warm_up").is_none());
    }
}
