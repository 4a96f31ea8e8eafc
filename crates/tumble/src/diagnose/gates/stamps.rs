//! Stamps that scatter (`timestamp_jitter`) or come in coarse steps (`timestamp_quantization`).
//!
//! Statistic: the spacings dt less their median T, those longer than 1.5 T left out. Clean stamps are rounded to text of
//! four to six decimals: rms at most 0.04 ms, below 1 % of 5 ms; the gates begin at 2 %, which rounding to 1e-4 s cannot reach
//! at 500 Hz and below (0.041/2 ms), so that a clean recording has no false alarm by arithmetic rather than by
//! chance. A clock that truly wanders has spacings that are not anti-correlated; white errors of the stamps have
//! corr(dt_k, dt_k+1) = −1/2 exactly, with standard deviation 1/√N: the second condition, corr < −0.2, holds by chance with
//! exp(−0.02 N), below e⁻²⁰ from 1000 samples on. Late bursts (a host that reads several at once) pass by it too.
//!
//! Steps: spacings are whole multiples of q, at least two different ones, both taken often, and the stamps stay within a
//! few steps of an even grid (which lost samples, also multiples, do not).

use super::chance::{SURE, median, quantile};
use super::tell::{Outcome, found, limit, value};
use super::view::{self, View};
use crate::diagnose::catalogue::Card;

/// What bad stamps are taken for: rates' products with wrong intervals.
const IMITATED: &[&str] = &["gyro_scale_cubic", "gyro_scale_quadratic", "gyro_scale_asymmetry", "gyro_accel_lag"];
/// Rms of a stamp as a share of the interval, from which it is told.
const LEAST_SHARE: f64 = 0.02;
/// A step that nearly divides the interval shows by its beats: now and then a spacing is one step longer. From ten on they are
/// no accident: in 200 s a step of 1 ms shows where sensor and clock differ by more than 50 ppm. A step that divides the
/// interval to better than that leaves stamps as even as a clock without steps. (A step above half the interval keeps one in a
/// hundred, for spacings of two intervals are lost samples, unless they come as evenly as beats do.)
const LEAST_BEATS: f64 = 10.0;
/// Scatter of the times from beat to beat over their mean. Of samples lost at random it is 1, and of nine such times below a quarter in
/// fewer than one case of a million.
const EVEN: f64 = 0.25;
/// From one sample to the next rates change by more than this times their noise where they move, and so many beats must lie there.
const MOVING: f64 = 6.0;
const LEAST_MOVING: f64 = 3.0;
/// Least step as a share of the interval, and in s: text has 1e-4 s, and a tick of 1/4096 s is 2.4e-4.
const LEAST_STEP: f64 = 0.03;
const LEAST_STEP_S: f64 = 1.5e-4;

pub(super) const JITTER: Card = Card {
    id: "timestamp_jitter",
    name: "stamps scatter",
    equation: "t_stamp = t_true + n, n white: successive intervals are anti-correlated",
    typical: "0.2 to 10 ms where the host stamps what arrives; USB and Bluetooth deliver bursts up to 0.4 s late",
    shows: "intervals",
    confounded: IMITATED,
    separate_by: "stamp samples where they are taken, by the sensor's data-ready interrupt, or number them and divide by the rate",
};

pub(super) const STEPS: Card = Card {
    id: "timestamp_quantization",
    name: "stamps come in coarse steps",
    equation: "t_stamp = q·floor(t_true/q)",
    typical: "clocks of 1 ms, schedulers of 10 ms, old Windows 15.6 ms",
    shows: "intervals",
    confounded: IMITATED,
    separate_by: "record with a clock of microseconds, or number the samples and divide by the rate",
};

/// Both gates: at most one fires.
pub fn examine(view: &View) -> (Outcome, Outcome) {
    let own = &view.scene.recording.stamps_s;
    let stamps = if own.is_empty() { &view.t_s } else { own };
    let dt: Vec<f64> = stamps.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let limit_ms = 1e3 * view.dt_s;
    // The rms of N errors scatters by 1/√(2N) of itself, half as much again as neighbours share one.
    let surely = 1.0 + SURE * (0.75 / dt.len().max(1) as f64).sqrt();
    let mut jitter = Outcome { limit: limit(&JITTER, surely * LEAST_SHARE * limit_ms, "ms", ""), ..Outcome::default() };
    let why = "a step that divides the interval to within 50 ppm does not show and does no harm";
    let mut steps = Outcome {
        limit: limit(&STEPS, (LEAST_STEP * limit_ms).max(1e3 * LEAST_STEP_S), "ms", why),
        ..Outcome::default()
    };
    if dt.len() < 100 {
        return (jitter, steps);
    }
    if let Some((step_s, evidence)) = clock_step(view, &dt) {
        let parameters = vec![value("step", 1e3 * step_s, 1e3 * step_s / dt.len() as f64, "ms")];
        steps.found = Some(found(&STEPS, evidence, parameters, view.place(0, 0..view.len())));
        steps.imitated = IMITATED;
    } else if let Some((rms_s, evidence)) = scatter(view, &dt) {
        let parameters = vec![value("rms", 1e3 * rms_s, 1e3 * rms_s / (dt.len() as f64).sqrt(), "ms")];
        jitter.found = Some(found(&JITTER, evidence, parameters, view.place(0, 0..view.len())));
        jitter.imitated = IMITATED;
    }
    (jitter, steps)
}

/// Rms of a stamp's error and the evidence for it.
fn scatter(view: &View, dt: &[f64]) -> Option<(f64, f64)> {
    let mut sizes: Vec<f64> = dt.iter().map(|dt| (dt - view.dt_s).abs()).collect();
    let core = quantile(&mut sizes, 0.75) / 1.15;
    // Lost samples make whole multiples, which are not scatter, unless intervals scatter that much themselves.
    let usual = |dt: f64| core > 0.25 * view.dt_s || (dt / view.dt_s - 1.0).abs() < 0.5;
    let error = |dt: f64| if usual(dt) { dt - view.dt_s } else { 0.0 };
    let power = dt.iter().map(|dt| error(*dt).powi(2)).sum::<f64>();
    let mean = dt.iter().map(|dt| error(*dt)).sum::<f64>() / dt.len() as f64;
    let product: f64 = dt.windows(2).map(|pair| (error(pair[0]) - mean) * (error(pair[1]) - mean)).sum();
    let correlation = product / power;
    let rms_s = (0.5 * power / dt.len() as f64).sqrt();
    let count = dt.len() as f64;
    let white = correlation < -0.2 && 0.5 * count * correlation * correlation > 11.5;
    // Arrivals that come late in bursts: a long interval, then several short ones; white only in part.
    let bursts = rms_s > 0.15 * view.dt_s && core > 0.05 * view.dt_s;
    (rms_s > LEAST_SHARE * view.dt_s && (white || bursts)).then(|| (rms_s, 0.5 * count * correlation.powi(2).max(0.05)))
}

/// The clock's step and the evidence for it.
fn clock_step(view: &View, dt: &[f64]) -> Option<(f64, f64)> {
    let mean_s = dt.iter().sum::<f64>() / dt.len() as f64;
    let common = common_spacings(dt);
    let mut candidates: Vec<f64> = common.clone();
    candidates.extend(common.iter().enumerate().flat_map(|(i, a)| common[..i].iter().map(move |b| (a - b).abs())));
    candidates.retain(|step| *step > (LEAST_STEP * mean_s).max(LEAST_STEP_S));
    candidates.sort_by(|a, b| b.total_cmp(a));
    candidates.into_iter().find_map(|step| {
        let multiple = |dt: &f64| (dt / step).round();
        // Text of microseconds, and stamps that a writer would repeat and set a few µs on, stay well within this.
        let near = |dt: &&f64| (*dt - multiple(dt) * step).abs() < (0.02 * step).max(3e-5);
        let on = dt.iter().filter(near).count() as f64 / dt.len() as f64;
        let low = (mean_s / step).floor();
        let share = |wanted: f64| dt.iter().filter(|dt| multiple(dt) == wanted).count() as f64 / dt.len() as f64;
        let (below, above) = (share(low), share(low + 1.0));
        let long: Vec<usize> = (0..dt.len()).filter(|i| multiple(&dt[*i]) == low + 1.0).collect();
        let alternates = below + above > 0.9 && below.min(above) * dt.len() as f64 > LEAST_BEATS;
        let alternates = alternates && (low >= 2.0 || beats(view, &long, dt.len()));
        let bounded = excursion(&view.t_s) < 3.0 * step;
        (on > 0.98 && alternates && bounded).then(|| (step, dt.len() as f64 * below.min(above)))
    })
}

/// Of spacings of one step and of two: are the long ones a clock's beats? A clock beats evenly, and motion goes on through a beat as through any
/// other sample; over one that is missing it goes on twice as far, however evenly a reader loses them. Where few beats lie in motion these must be
/// even, and without motion one in a hundred is asked for.
fn beats(view: &View, at: &[usize], count: usize) -> bool {
    let apart: Vec<f64> = at.windows(2).map(|pair| (pair[1] - pair[0]) as f64).collect();
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    let even = at.len() as f64 >= LEAST_BEATS && view::scatter(&apart) < EVEN * mean;
    let many = at.len() as f64 > 0.01 * count as f64;
    let noise = view.sigma[..3].iter().fold(0.0, |most, sigma| sigma.max(most));
    let change = |index: usize| (view.rate(index + 1) - view.rate(index)).norm();
    let inside = at.iter().copied().filter(|i| *i > 0 && i + 2 < view.len());
    let (moving, across, beside) = inside
        .map(|i| (change(i), 0.5 * (change(i - 1) + change(i + 1))))
        .filter(|(_, beside)| *beside > MOVING * noise)
        .fold((0.0, 0.0, 0.0), |(count, a, b), (across, beside)| (count + 1.0, a + across, b + beside));
    let goes_on = across < 1.5 * beside;
    if moving >= LEAST_MOVING { (even || many) && goes_on } else { many || (even && moving > 0.0 && goes_on) }
}

/// Spacings (to 10 µs) that at least [`LEAST_BEATS`] have, the commonest eight.
fn common_spacings(dt: &[f64]) -> Vec<f64> {
    let mut sorted = dt.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut groups: Vec<(usize, f64)> = Vec::new();
    for group in sorted.chunk_by(|a, b| b - a < 1e-5) {
        if group.len() as f64 >= LEAST_BEATS {
            groups.push((group.len(), group.iter().sum::<f64>() / group.len() as f64));
        }
    }
    groups.sort_by_key(|group| std::cmp::Reverse(group.0));
    groups.into_iter().take(8).map(|group| group.1).collect()
}

/// How far stamps stray from an even grid over 2000 samples, the median of all such stretches, s.
fn excursion(t_s: &[f64]) -> f64 {
    let stray = |stamps: &[f64]| {
        let (first, last, count) = (stamps[0], stamps[stamps.len() - 1], (stamps.len() - 1) as f64);
        let off = |(i, t): (usize, &f64)| t - first - (last - first) * i as f64 / count;
        let (low, high) =
            stamps.iter().enumerate().map(off).fold((0.0, 0.0), |(l, h): (f64, f64), e| (l.min(e), h.max(e)));
        high - low
    };
    median(t_s.chunks(2000).filter(|stamps| stamps.len() > 50).map(stray).collect())
}
