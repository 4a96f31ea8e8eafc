//! Its figures, drawn from our runs: 4 (errors over the runs), 7 and 10 (level error over tumbling), 8 (K over time), 9 (the
//! filter's own sigmas over time).

use std::error::Error;
use std::path::{Path, PathBuf};

use plotters::prelude::*;

use super::published::{CROSS, MEAN, SCALE};
use super::{Method, Run, shown};

/// A line with its name.
type Line = (String, Vec<(f64, f64)>);

const SIZE: (u32, u32) = (960, 560);
const COLOURS: [RGBColor; 7] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(255, 127, 14),
    RGBColor(148, 103, 189),
    RGBColor(140, 86, 75),
    RGBColor(23, 23, 23),
];
const NAMES: [&str; 6] = ["k12", "k13", "k21", "k23", "k31", "k32"];

/// Draws all into a folder, which is made; returns the files.
///
/// # Errors
/// If the folder or a file cannot be written.
pub fn draw(runs: &[Run], folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut files = Vec::new();
    let mut add = |name: &str, title: &str, axes: [&str; 2], lines: Vec<Line>| -> Result<(), Box<dyn Error>> {
        let path = folder.join(name);
        chart(&path, title, axes, &lines)?;
        files.push(path);
        Ok(())
    };
    let run_axis = "table tilt, degrees (one run each)";
    let (scale, cross) = (errors(runs, &SCALE), errors(runs, &CROSS));
    add("figure_4_scale.svg", "Figure 4: scale error (rms of three)", [run_axis, "log10 of the error"], scale)?;
    add("figure_4_k.svg", "Figure 4: error of K (rms of six)", [run_axis, "log10 of the error, rad"], cross)?;
    if let Some(run) = runs.get(shown(runs.len())) {
        let two = |methods: &[Method]| level(run, methods);
        let axes = ["s of tumbling", "level error, degrees"];
        let seven = two(&[Method::Literal, Method::Traditional, Method::TiltLeak]);
        add("figure_7.svg", "Figure 7: pure inertial navigation, the paper's methods", axes, seven)?;
        let ten = two(&[Method::Corrected, Method::Ours]);
        add("figure_10.svg", "Figure 10: pure inertial navigation, corrected and ours", axes, ten)?;
        let (kappa, sigma) = history(run);
        add("figure_8.svg", "Figure 8: estimates of K, corrected filter", ["s", "mrad"], kappa)?;
        add("figure_9.svg", "Figure 9: the filter's sigmas of K", ["s", "log10 of rad"], sigma)?;
    }
    Ok(files)
}

/// Errors run by run and method by method, and the published mean as a level line.
fn errors(runs: &[Run], which: &[usize]) -> Vec<Line> {
    let rms = |errors: &[f64; 9]| {
        (which.iter().map(|&k| errors[k] * errors[k]).sum::<f64>() / which.len() as f64).sqrt().max(1e-9).log10()
    };
    let of = |index: usize| runs.iter().map(|run| (run.tilt_deg, rms(&run.outcomes[index].errors))).collect();
    let mut lines: Vec<Line> =
        Method::ALL.into_iter().enumerate().map(|(index, method)| (method.name().to_owned(), of(index))).collect();
    lines.push(("published mean".to_owned(), runs.iter().map(|run| (run.tilt_deg, rms(&MEAN))).collect()));
    lines
}

fn level(run: &Run, methods: &[Method]) -> Vec<Line> {
    let all = Method::ALL.into_iter().zip(&run.outcomes);
    let chosen = all.filter(|(method, _)| methods.contains(method));
    chosen.map(|(method, outcome)| (method.name().to_owned(), outcome.level.clone())).collect()
}

fn history(run: &Run) -> (Vec<Line>, Vec<Line>) {
    let corrected = Method::ALL.into_iter().position(|method| method == Method::Corrected).unwrap_or(0);
    let history = &run.outcomes[corrected].history;
    let line = |i: usize, value: &dyn Fn(&super::Instant) -> f64| -> Line {
        (NAMES[i].to_owned(), history.iter().map(|instant| (instant.t_s, value(instant))).collect())
    };
    let kappa = (0..6).map(|i| line(i, &|instant| 1e3 * instant.kappa[i])).collect();
    let sigma = (0..6).map(|i| line(i, &|instant| instant.sigma[i].max(1e-9).log10())).collect();
    (kappa, sigma)
}

fn chart(path: &Path, title: &str, axes: [&str; 2], lines: &[Line]) -> Result<(), Box<dyn Error>> {
    let points = || lines.iter().flat_map(|line| &line.1);
    // Room on the right is the legend's.
    let range = |value: fn(&(f64, f64)) -> f64, below: f64, above: f64| {
        let (least, most) = points().map(value).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
        let length = (most - least).max(1e-6);
        least - below * length..most + above * length
    };
    let root = SVGBackend::new(path, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 22))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(range(|p| p.0, 0.0, 0.28), range(|p| p.1, 0.06, 0.06))?;
    chart.configure_mesh().x_desc(axes[0]).y_desc(axes[1]).light_line_style(WHITE).draw()?;
    for (line, colour) in lines.iter().zip(COLOURS.iter().cycle()) {
        let drawn = chart.draw_series(LineSeries::new(line.1.iter().copied(), colour.stroke_width(2)))?;
        let key = move |(x, y)| PathElement::new(vec![(x, y), (x + 22, y)], colour.stroke_width(2));
        drawn.label(line.0.as_str()).legend(key);
    }
    let labels = chart.configure_series_labels();
    { labels }
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK)
        .draw()?;
    root.present()?;
    Ok(())
}
