//! A channel that repeats one reading while the sensor goes on (`frozen_reading`).
//!
//! Statistic: the longest run of equal readings of one channel. Noise of σ on steps of Δ makes neighbours equal with `p ≈ Δ/(2√π σ)`; p is
//! counted in windows of a second and the ninth decile of these taken, which is that of rests, where nothing else parts neighbours. A run
//! of L then happens by chance in N samples with at most `N p^(L−1)`. What stands at a level again and again clips, and a value to which a driver
//! sets small rates is stood at again and again: neither is frozen. Where p is near one (steps far above the noise) no run is too long.

use std::ops::Range;

use super::chance::LN_ALARM;
use super::tell::{Outcome, found, limit, value};
use super::view::View;
use crate::diagnose::catalogue::Card;

const WINDOW_S: f64 = 1.0;
/// Windows with more equal neighbours than rests have: frozen ones themselves.
const DECILE: f64 = 0.9;
/// A run shorter than this harms nothing, s: what a session's noise leaves of a turn (0.03°) is lost by it at 100 °/s² in 25 ms.
const LEAST_S: f64 = 0.025;
/// As often stood at as this, a value is a driver's.
const AGAIN: usize = 3;

pub(super) const CARD: Card = Card {
    id: "frozen_reading",
    name: "one channel stands still",
    equation: "reading_c(t) = reading_c(t_0) for t_0 < t < t_0 + T",
    typical: "an old word in the reader's buffer after a transfer cut short; 10 ms to seconds, until the next good one",
    shows: "one channel",
    confounded: &["incomplete_turn", "accel_bias_step", "platform_tilt_change"],
    separate_by: "read all data registers in one burst and check the transfer's status",
};

struct Run {
    channel: usize,
    samples: Range<usize>,
    ln_p: f64,
}

/// The gate; `stale` samples repeat in all channels for another reason, and `clipped` ones stand at a level.
pub fn examine(view: &View, stale: &[usize], clipped: &[(usize, u8)]) -> Outcome {
    let of = |channel: usize| {
        let clips = |index: usize| clipped.iter().any(|(at, channels)| *at == index && channels >> channel & 1 == 1);
        frozen(view, stale, channel, clips)
    };
    let (runs, least): (Vec<Vec<Run>>, Vec<f64>) = (0..6).map(of).unzip();
    let least_s = least.into_iter().fold(0.0, f64::max);
    let why = "of the channel whose steps are the coarsest beside its noise";
    let mut outcome = Outcome { limit: limit(&CARD, least_s, "s", why), ..Outcome::default() };
    let runs: Vec<Run> = runs.into_iter().flatten().collect();
    let Some(longest) = runs.iter().max_by_key(|run| run.samples.len()) else { return outcome };
    let mask = runs.iter().fold(0, |mask, run| mask | 1 << run.channel);
    let time_s = |run: &Run| run.samples.len() as f64 * view.dt_s;
    let parameters = vec![
        value("duration", time_s(longest), view.dt_s, "s"),
        value("time", view.scene.recording.origin_s() + view.t_s[longest.samples.start], view.dt_s, "s"),
        value("runs", runs.len() as f64, 0.0, ""),
    ];
    let from = runs.iter().map(|run| run.samples.start).min().unwrap_or_default();
    let to = runs.iter().map(|run| run.samples.end).max().unwrap_or_default();
    let mut place = view.place(mask, from..to);
    place.segments.retain(|number| {
        let range = view.samples_of(&view.scene.segments[*number]);
        runs.iter().any(|run| run.samples.start < range.end && range.start < run.samples.end)
    });
    let evidence = -runs.iter().map(|run| run.ln_p).sum::<f64>();
    outcome.found = Some(found(&CARD, evidence, parameters, place));
    outcome.clipped = runs.iter().flat_map(|run| run.samples.clone().map(|index| (index, 1 << run.channel))).collect();
    outcome
}

/// Runs of one channel that chance does not make, and the least length that would be told, s.
fn frozen(view: &View, stale: &[usize], channel: usize, clips: impl Fn(usize) -> bool) -> (Vec<Run>, f64) {
    let values = &view.channels[channel];
    let same = |index: usize| values[index] == values[index - 1] && stale.binary_search(&index).is_err();
    let window = view.count(WINDOW_S).max(20);
    let mut shares: Vec<f64> = (1..values.len())
        .step_by(window)
        .map(|start| (start..(start + window).min(values.len())).filter(|index| same(*index)).count())
        .map(|equal| (equal as f64 + 0.5) / (window as f64 + 1.0))
        .collect();
    let ln_equal = super::chance::quantile(&mut shares, DECILE).ln();
    let ln_count = (6.0 * values.len() as f64).ln();
    let least = (1.0 + (LN_ALARM - ln_count) / ln_equal).max(LEAST_S / view.dt_s);
    let mut runs = Vec::new();
    let mut start = 0;
    for index in 1..=values.len() {
        if index < values.len() && same(index) {
            continue;
        }
        let length = (index - start) as f64;
        if length >= least && !clips(start) {
            runs.push(Run { channel, samples: start..index, ln_p: ln_count + (length - 1.0) * ln_equal });
        }
        start = index;
    }
    let often = |run: &Run| {
        runs.iter().filter(|other| values[other.samples.start] == values[run.samples.start]).count() >= AGAIN
    };
    let drivers: Vec<bool> = runs.iter().map(often).collect();
    let mut driver = drivers.into_iter();
    runs.retain(|_| driver.next() != Some(true));
    (runs, least * view.dt_s)
}
