//! What the report's pictures are drawn from.

use super::findings::{Finding, TIE};
use super::search::bench::Bench;
use super::search::ledger::Ledger;
use super::search::select::Selection;
use super::search::shares;
use super::search::unknown::{ALIAS, Block, Leftover, shared};
use super::twin::data::Deed;
use super::twin::rows::Address;

/// A segment for a picture's axis.
#[derive(Clone, Debug)]
pub struct Segment {
    /// As `tumble calibrate --json` counts.
    pub number: usize,
    /// `rest +x`, `turn -z`, `move`.
    pub name: String,
    /// By the recording's own stamps.
    pub start_s: f64,
    /// Likewise.
    pub end_s: f64,
}

/// A found effect's regressor against what it explains.
#[derive(Clone, Debug)]
pub struct Regression {
    /// As in the contract.
    pub id: String,
    /// The effect's share of each row, sigmas.
    pub signal: Vec<f64>,
    /// The row with this effect left in, sigmas.
    pub before: Vec<f64>,
}

/// All of it.
#[derive(Clone, Debug, Default)]
pub struct Exhibits {
    /// Where the rows come from.
    pub at: Vec<Address>,
    /// The nominal model's whitened residuals.
    pub before: Vec<f64>,
    /// What found effects leave.
    pub after: Vec<f64>,
    /// Where the rows of `after` and of the regressions come from: a refit may keep others than before.
    pub after_at: Vec<Address>,
    /// Of the recording.
    pub segments: Vec<Segment>,
    /// One a found effect.
    pub regressions: Vec<Regression>,
    /// Gain in evidence of every candidate alone, best first.
    pub scores: Vec<(String, f64)>,
    /// What a gain must exceed.
    pub threshold: f64,
    /// Names of the isolability matrix' rows and columns.
    pub isolable: Vec<String>,
    /// Share of a typical row effect's signal that the column's effect can imitate.
    pub isolability: Vec<Vec<f64>>,
    /// What is left follows these: (shape, gain in evidence).
    pub correlates: Vec<(String, f64)>,
}

/// Gathers them.
pub fn exhibits(
    bench: &Bench,
    selection: &Selection,
    findings: &[Finding],
    leftover: &Leftover,
    origin_s: f64,
) -> Exhibits {
    let (isolable, isolability) = isolability(bench, selection);
    let after = shares::left(bench, &selection.after);
    let regressions = findings
        .iter()
        .map(|finding| Regression {
            id: finding.found.id.clone(),
            before: after.iter().zip(&finding.signal).map(|(left, own)| left + own).collect(),
            signal: finding.signal.clone(),
        })
        .collect();
    Exhibits {
        at: selection.before.at.clone(),
        before: selection.before.values.iter().copied().collect(),
        after,
        after_at: selection.after.at.clone(),
        segments: segments(bench, origin_s),
        regressions,
        scores: selection
            .first
            .iter()
            .map(|score| (bench.candidates[score.candidate].effect.card.id.to_string(), score.gain))
            .collect(),
        threshold: selection.threshold,
        isolable,
        isolability,
        correlates: correlates(bench, leftover),
    }
}

/// What the leftover follows, in words.
pub fn correlates(bench: &Bench, leftover: &Leftover) -> Vec<(String, f64)> {
    leftover.ranking.iter().take(8).map(|(block, gain)| (shape(bench, block), *gain)).collect()
}

/// Shapes of circumstance, not of the instant's force or rate, that explain as much as a name which has this evidence: on this
/// recording the two are one. (A bias in proportion to a temperature that rose all the time is one that drifts with time.)
pub fn circumstances(bench: &Bench, instead: &[Leftover], evidence: f64) -> Vec<String> {
    const FAMILIES: [&str; 8] = [
        "time",
        "slow oscillation",
        "temperature",
        "heading",
        "the face before",
        "the side before",
        "memory of motion",
        "memory of force",
    ];
    // As between names: what is the same signal may lack twice as much, for then the priors' widths alone make the difference; and
    // the twentieth of the whole by which an alias may fall short of being the same.
    let base = instead.first().map_or(evidence, |leftover| leftover.base);
    let of_alias = 2.0 * TIE + (1.0 - ALIAS) * (evidence - base).max(0.0);
    let family = |block: &Block| bench.families[block.family].0.name.as_str();
    let mut tied: Vec<(f64, String)> = Vec::new();
    for leftover in instead {
        let own = leftover.ranking.iter().map(|ranked| (ranked, TIE));
        // What follows temperature is one of four names, and an alias of them no other circumstance.
        let aliases = leftover.aliases.iter().filter(|(block, _)| family(block) != "temperature");
        for ((block, gain), gap) in own.chain(aliases.map(|ranked| (ranked, of_alias))) {
            let reached = leftover.base + gain;
            if reached > evidence - gap && FAMILIES.contains(&family(block)) {
                tied.push((reached, shape(bench, block)));
            }
        }
    }
    tied.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut said = once(tied.into_iter().map(|(_, shape)| shape));
    said.truncate(3);
    said
}

/// Each once, where it stands first.
pub fn once<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut once = Vec::new();
    for one in all {
        if !once.contains(&one) {
            once.push(one);
        }
    }
    once
}

/// A block in words.
fn shape(bench: &Bench, block: &Block) -> String {
    let family = &bench.families[block.family].0;
    let mut shapes = once(block.members.iter().map(|member| family.members[*member].1.as_str()));
    shapes.truncate(3);
    let triad = if family.gyro { "gyroscope" } else { "accelerometer" };
    format!("{}: {} ({})", family.name, shapes.join(", "), triad)
}

fn segments(bench: &Bench, origin_s: f64) -> Vec<Segment> {
    let samples = &bench.twin.samples;
    bench
        .twin
        .stretches
        .iter()
        .map(|stretch| {
            let face = stretch.face().map_or("", |face| face.name());
            let deed = match stretch.deed {
                Deed::Rest { .. } => "rest",
                Deed::Held => "held",
                Deed::Turn { .. } => "turn",
                Deed::Move => "move",
            };
            Segment {
                number: stretch.number,
                name: format!("{deed} {face}").trim().to_string(),
                start_s: origin_s + samples[stretch.samples.start].t_s,
                end_s: origin_s + samples[stretch.samples.end - 1].t_s,
            }
        })
        .collect()
}

/// For every pair of candidates: of the first's signal at its typical size, the share that the second can imitate.
fn isolability(bench: &Bench, selection: &Selection) -> (Vec<String>, Vec<Vec<f64>>) {
    let ledger = Ledger::new(&selection.before, |_| true);
    let scales = &selection.null_scales;
    let columns: Vec<(String, Vec<usize>)> = bench
        .candidates
        .iter()
        .filter_map(|candidate| {
            // Of a jump's many instants the middle one stands for all.
            let placed = candidate.variants.get(candidate.variants.len() / 2)?;
            Some((candidate.effect.card.id.to_string(), placed.columns.clone().collect()))
        })
        .collect();
    let one = |from: &[usize], by: &[usize]| {
        let shares: Vec<f64> = from
            .iter()
            .map(|&column| shared(&ledger, scales, &[column], &nalgebra::DVector::from_element(1, 1.0), by))
            .collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    };
    let matrix = columns.iter().map(|(_, from)| columns.iter().map(|(_, by)| one(from, by)).collect()).collect();
    (columns.into_iter().map(|(id, _)| id).collect(), matrix)
}
