//! From the diagnosis' units to the simulation's.

/// What both mean, however it is written: `dps/g²` and `dps/g^2`, `mdps/√s` and `mdps/sqrt(s)`, `mg/degC` and `mg/K`.
fn plain(unit: &str) -> String {
    let unit = unit.replace('²', "^2").replace('³', "^3").replace('µ', "u").replace("√s", "sqrt(s)");
    unit.replace("degC", "K").replace("°C", "K").replace("°/s", "dps").replace(' ', "")
}

/// Sizes of numerators in a common unit of their kind.
const HEADS: [&[(&str, f64)]; 6] = [
    &[("ppm", 1e-6), ("%", 1e-2)],
    &[("mdps", 1e-3), ("dps", 1.0), ("deg/h", 1.0 / 3600.0)],
    &[("ug", 1e-6), ("mg", 1e-3), ("g", 1.0)],
    &[("um", 1e-6), ("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)],
    &[("us", 1e-6), ("ms", 1e-3), ("s", 1.0)],
    &[("mrad", 1e-3 * 180.0 / std::f64::consts::PI), ("deg", 1.0)],
];

/// How many `to` a `from` is; none where they measure different things.
pub fn factor(from: &str, to: &str) -> Option<f64> {
    let (from, to) = (plain(from), plain(to));
    if from == to {
        return Some(1.0);
    }
    let split = |unit: &str| match unit.split_once('/') {
        Some((head, tail)) if unit != "deg/h" => (head.to_owned(), tail.to_owned()),
        _ => (unit.to_owned(), String::new()),
    };
    let ((from, from_tail), (to, to_tail)) = (split(&from), split(&to));
    if from_tail != to_tail {
        return None;
    }
    HEADS.iter().find_map(|kind| {
        let size = |head: &str| kind.iter().find(|(name, _)| *name == head).map(|(_, size)| *size);
        Some(size(&from)? / size(&to)?)
    })
}

#[cfg(test)]
mod tests {
    use super::factor;

    #[test]
    fn units_agree_however_they_are_written() {
        assert_eq!(factor("dps/g^2", "dps/g²"), Some(1.0));
        assert_eq!(factor("mg/K", "mg/degC"), Some(1.0));
        for (from, to, expected) in [
            ("mdps/sqrt(s)", "dps/√s", 1e-3),
            ("ug/sqrt(s)", "mg/√s", 1e-3),
            ("%/K", "ppm/degC", 1e4),
            ("deg/h", "dps", 1.0 / 3600.0),
        ] {
            let found = factor(from, to).expect("the same kind of thing");
            assert!((found / expected - 1.0).abs() < 1e-12, "{from} in {to}: {found}");
        }
        assert_eq!(factor("mg", "dps"), None);
        assert_eq!(factor("ppm/dps^2", "ppm"), None);
    }
}
