//! Tables of `tumble study`.

use std::fmt::{self, Write};

use crate::study::limits::ScenarioSummary;
use crate::study::recordings::{Report, Row};

/// What `design.md` §2 gives as Cramér–Rao sigmas, of an earlier simulation of another protocol: scheme, reference, group,
/// sigma in the group's unit.
const PUBLISHED: [(&str, &str, &str, f64); 8] = [
    ("single", "box", "gyro scale", 43.6),
    ("single", "box", "gyro non-orthogonality", 48.4),
    ("single", "box", "gyro bias", 1.6),
    ("single", "box", "accel bias", 17.5),
    ("single", "box", "accel scale", 27.0),
    ("single", "box", "accel non-orthogonality", 29.0),
    ("double", "box", "gyro scale", 25.0),
    ("double", "box", "gyro non-orthogonality", 26.0),
];

fn published(scenario: &ScenarioSummary, group: &str) -> Option<f64> {
    let single_gravity = ("single", "gravity", "gyro non-orthogonality", 96.0);
    let mut known = PUBLISHED.into_iter().chain([single_gravity]);
    known.find(|k| (k.0, k.1, k.2) == (scenario.scheme, scenario.reference, group)).map(|k| k.3)
}

/// `tumble study limits`.
pub fn limits(nominal: &[ScenarioSummary], imperfect: &[ScenarioSummary]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = nominal.iter().try_for_each(|scenario| full(&mut text, scenario));
    if !imperfect.is_empty() {
        let _ = short(&mut text, imperfect);
    }
    text.push_str(
        "bound+: for one who knows the lever arm; bound-: for one who does not know that a box turns about its face's \
         normal; * Cramér–Rao sigma published in design.md, of another protocol\n",
    );
    text
}

fn full(text: &mut String, scenario: &ScenarioSummary) -> fmt::Result {
    let ScenarioSummary { name, scheme, reference, runs, accepted, .. } = scenario;
    writeln!(text, "{name}: {scheme} turns, exact stops, reference {reference}; {runs} runs, {accepted} accepted")?;
    scenario.failures.iter().try_for_each(|failure| writeln!(text, "  failed: {failure}"))?;
    writeln!(
        text,
        "  {:<24} {:>5} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>9} {:>10}",
        "", "unit", "mean", "std", "rms", "sigma", "bound", "bound+", "bound-", "ratio", "2 sigma", "design.md*"
    )?;
    for group in &scenario.groups {
        let published = published(scenario, group.group).map_or_else(String::new, |value| format!("{value:.1}"));
        writeln!(
            text,
            "  {:<24} {:>5} {:>8.2} {:>8.2} {:>8.2} {:>8.2} {:>8.2} {:>8.2} {:>8.2} {:>6.2} {:>7.1} % {published:>10}",
            group.group,
            group.unit,
            group.mean,
            group.std,
            group.rms,
            group.sigma,
            group.bound,
            group.bound_lever_known,
            group.bound_axis_free,
            group.ratio,
            100.0 * group.within_2_sigma
        )?;
    }
    estimators(text, scenario)?;
    consistency(text, scenario)?;
    navigation(text, scenario)?;
    writeln!(text)
}

fn estimators(text: &mut String, scenario: &ScenarioSummary) -> fmt::Result {
    for one in &scenario.estimators {
        let ((scale, scale_std), (cross, cross_std)) = (one.scale_ppm, one.cross_urad);
        writeln!(
            text,
            "  {:<10} scale mean {scale:.1}, std {scale_std:.1} ppm; K mean {cross:.1}, std {cross_std:.1} urad; {} runs",
            one.estimator, one.runs
        )?;
    }
    Ok(())
}

fn consistency(text: &mut String, scenario: &ScenarioSummary) -> fmt::Result {
    match &scenario.nees {
        Some(nees) => writeln!(
            text,
            "  NEES over {} parameters {:.3}, 95 % band {:.3} to {:.3}: {}; {:.1} % of parameters within 2 sigma",
            nees.parameters,
            nees.mean,
            nees.band.0,
            nees.band.1,
            if nees.inside { "inside" } else { "OUTSIDE" },
            100.0 * scenario.within_2_sigma
        ),
        None => writeln!(text, "  NEES: a covariance is not positive definite"),
    }
}

fn navigation(text: &mut String, scenario: &ScenarioSummary) -> fmt::Result {
    for level in &scenario.navigation {
        writeln!(
            text,
            "  level error after 65 s of tumbling, {:<10} mean {:.3}, 95 % {:.3} deg; largest on the way {:.3}, {:.3}",
            level.calibration, level.end_mean_deg, level.end_95_deg, level.max_mean_deg, level.max_95_deg
        )?;
    }
    Ok(())
}

fn short(text: &mut String, scenarios: &[ScenarioSummary]) -> fmt::Result {
    writeln!(text, "imperfections, rms errors (share within 2 sigma)")?;
    write!(text, "  {:<6} {:<9} {:<21}", "turns", "reference", "")?;
    for group in scenarios.iter().take(1).flat_map(|scenario| &scenario.groups) {
        write!(text, " {:>24}", format!("{}, {}", group.group, group.unit))?;
    }
    writeln!(text, " {:>7} {:>9}", "NEES", "accepted")?;
    for scenario in scenarios {
        write!(text, "  {:<6} {:<9} {:<21}", scenario.scheme, scenario.reference, scenario.name)?;
        for group in &scenario.groups {
            write!(text, " {:>24}", format!("{:.1} ({:.0} %)", group.rms, 100.0 * group.within_2_sigma))?;
        }
        let nees = scenario.nees.as_ref().map_or(f64::NAN, |nees| nees.mean);
        writeln!(text, " {nees:>7.2} {:>5}/{}", scenario.accepted, scenario.runs + scenario.failures.len())?;
    }
    Ok(())
}

/// `tumble study recordings`.
pub fn recordings(report: &Report) -> String {
    let mut text = String::new();
    let _ = side_by_side(&mut text, report);
    text
}

fn side_by_side(text: &mut String, report: &Report) -> fmt::Result {
    writeln!(text, "gyroscope scale error, % (one sigma), and accelerometer bias, m/s²")?;
    for Row { file, method, scale_percent, scale_sigma_percent, accel_bias_mps2, remark } in &report.rows {
        let scale = three(scale_percent.as_ref(), 3);
        let sigma = three(scale_sigma_percent.as_ref(), 3);
        let bias = three(accel_bias_mps2.as_ref(), 3);
        writeln!(text, "  {file:<28} {method:<10} {scale:<24} ({sigma:<20}) {bias:<22} {remark}")?;
    }
    writeln!(text, "stillness limits: change of the device's scales in their sigmas")?;
    for tolerance in &report.tolerances {
        let moved = three(tolerance.moved_sigma.as_ref(), 2);
        writeln!(text, "  {:<28} x {:<4} {moved}", tolerance.file, tolerance.tolerance)?;
    }
    if let Some(agreement) = &report.agreement {
        writeln!(
            text,
            "two chips on one board, {} samples of {:.1} deg/s rms: they differ by {:.3} deg/s raw, {:.3} compensated, \
             {:.3} whatever the calibration",
            agreement.samples, agreement.rate_dps, agreement.raw_dps, agreement.compensated_dps, agreement.linear_dps
        )?;
    }
    report.missing.iter().try_for_each(|missing| writeln!(text, "not read: {missing}"))
}

fn three(values: Option<&[f64; 3]>, digits: usize) -> String {
    values.map_or_else(|| "-".into(), |v| format!("{:+.digits$} {:+.digits$} {:+.digits$}", v[0], v[1], v[2]))
}
