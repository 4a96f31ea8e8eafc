//! Is anything left, or explained better by a shape that has no name?
//!
//! Every block of generic shapes (a family, a shape on all channels of a triad, a channel, a single column) is weighed with
//! a prior of κ sigmas for κ over two decades, so that no size is presumed. The mean over all blocks and sizes is a Bayes
//! factor against the null; by Markov's inequality it exceeds B by chance in at most 1/B of recordings, whatever the
//! blocks have in common.

use nalgebra::DVector;

use super::bench::Bench;
use super::family::Family;
use super::ledger::{Fit, Ledger, Term, by_place, log_mean};
use super::null::FALSE_ALARMS;
use crate::diagnose::twin::rows::Rows;

/// Sizes presumed, in sigmas of a column.
const SIZES: [f64; 4] = [3.0, 12.0, 50.0, 200.0];
/// A family with more columns is weighed by its parts alone.
const WIDEST: usize = 27;
/// Share of a shape's signal that an effect explains as well, above which the two are the same thing on this recording.
pub const ALIAS: f64 = 0.95;

/// Shapes that go together.
#[derive(Clone, Debug)]
pub struct Block {
    /// Of [`Bench::families`].
    pub family: usize,
    /// Among the family's members.
    pub members: Vec<usize>,
}

/// Shapes that the effects in whose place they are weighed imitate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Aliases {
    /// The shape and the one effect are the same thing on this recording: it is named.
    LeftOut,
    /// One shape that takes several effects to imitate it is no coincidence.
    Counted,
}

/// What a block gained.
#[derive(Clone, Debug)]
pub struct Leftover {
    /// ln of the mean Bayes factor over all blocks.
    pub evidence: f64,
    /// ln p of the model without any block.
    pub base: f64,
    /// All blocks by their gain, best first.
    pub ranking: Vec<(Block, f64)>,
    /// Blocks left out as aliases of the effect in whose place they were weighed, with their gain.
    pub aliases: Vec<(Block, f64)>,
    /// The best block's share of each row.
    pub signal: Vec<f64>,
    /// The rows that it was found in.
    pub rows: Rows,
}

impl Leftover {
    /// Is it more than chance?
    pub fn is_real(&self) -> bool {
        self.evidence > -FALSE_ALARMS.ln()
    }

    /// Against another model without any block.
    pub fn against(mut self, base: f64) -> Self {
        let more = self.base - base;
        self.evidence += more;
        self.ranking.iter_mut().chain(&mut self.aliases).for_each(|(_, gain)| *gain += more);
        Self { base, ..self }
    }

    /// ln p with the blocks, each as likely as every other.
    pub fn reached(&self) -> f64 {
        self.base + self.evidence
    }

    /// Largest probability of as much by chance.
    pub fn p_value(&self) -> f64 {
        (-self.evidence).exp().min(1.0)
    }
}

fn blocks(bench: &Bench) -> Vec<Block> {
    let mut blocks = Vec::new();
    for (index, (family, _)) in bench.families.iter().enumerate() {
        let mut channels: Vec<usize> = family.members.iter().map(|member| member.0).collect();
        channels.dedup();
        let mut members = apart(family, &channels);
        members.extend(across(family, channels.len()));
        blocks.extend(members.into_iter().map(|members| Block { family: index, members }));
    }
    blocks
}

/// Every member alone, all of them, and those of each channel.
fn apart(family: &Family, channels: &[usize]) -> Vec<Vec<usize>> {
    let count = family.members.len();
    let mut blocks: Vec<Vec<usize>> = (0..count).map(|member| vec![member]).collect();
    if count <= WIDEST && count > 3 {
        blocks.push((0..count).collect());
    }
    let on = |channel: &usize| (0..count).filter(|&m| family.members[m].0 == *channel).collect::<Vec<_>>();
    blocks.extend(channels.iter().map(on).filter(|on| on.len() > 1 && on.len() <= WIDEST));
    blocks
}

/// The same shape on all channels, and what goes together of several shapes.
fn across(family: &Family, channels: usize) -> Vec<Vec<usize>> {
    let per_channel = family.members.len() / channels.max(1);
    let mut blocks: Vec<Vec<usize>> =
        (0..per_channel).map(|shape| (0..channels).map(|k| k * per_channel + shape).collect()).collect();
    // Shapes come in threes, one an axis: each axis on its own channel, on the next, and on the one after, as in a product of
    // vectors.
    if channels == 3 {
        for (three, on) in (0..per_channel / 3).flat_map(|three| (0..3).map(move |on| (3 * three, on))) {
            blocks.push((0..3).map(|k| k * per_channel + three + (k + on) % 3).collect());
        }
        // All of them at once, each axis on its own channel.
        if per_channel > 3 && 3 * (per_channel / 3) <= WIDEST {
            let own = |k: usize| (0..per_channel / 3).map(move |three| k * per_channel + 3 * three + k);
            blocks.push((0..3).flat_map(own).collect());
        }
    }
    // Sine with cosine, on one channel and on all.
    if family.name == "slow oscillation" {
        for pair in 0..per_channel / 2 {
            let both = |k: usize| [k * per_channel + 2 * pair, k * per_channel + 2 * pair + 1];
            blocks.extend((0..channels).map(|k| both(k).to_vec()));
            blocks.push((0..channels).flat_map(both).collect());
        }
    }
    blocks
}

/// All blocks beside what is accepted, under the noise in force and under the least: what has no name may have passed for noise. The second
/// look counts against the same null, and two looks cost ln 2.
pub fn left_over(bench: &mut Bench) -> Leftover {
    let in_force = bench.twin.noise;
    let mut left = weigh(bench, &[], Aliases::LeftOut);
    let least = bench.least_noise(&[]);
    if least != in_force {
        bench.twin.noise = least;
        let quiet = weigh(bench, &[], Aliases::LeftOut);
        bench.twin.noise = in_force;
        if quiet.reached() > left.reached() {
            left = quiet.against(left.base);
        }
        left.evidence -= std::f64::consts::LN_2;
    }
    left
}

/// Weighs all blocks beside what is accepted; in the place of those in `instead_of`.
pub fn weigh(bench: &mut Bench, instead_of: &[usize], treated: Aliases) -> Leftover {
    let (given, rows) = Given::new(bench, instead_of);
    let first = bench.candidate_columns();
    let (mut all, mut ranking, mut aliases) = (Vec::new(), Vec::new(), Vec::new());
    let mut best: Option<Beside> = None;
    for block in blocks(bench) {
        let start = given.terms.len() + bench.families[block.family].1.start - first;
        let columns: Vec<usize> = block.members.iter().map(|member| start + member).collect();
        let Some((mean, strongest)) = given.with(&columns) else { continue };
        if treated == Aliases::LeftOut && given.is_alias(&strongest) {
            aliases.push((block, strongest.gain));
            continue;
        }
        all.push(mean);
        ranking.push((block, strongest.gain));
        if best.as_ref().is_none_or(|best| strongest.gain > best.gain) {
            best = Some(strongest);
        }
    }
    let signal = (0..rows.at.len()).map(|i| best.as_ref().map_or(0.0, |best| best.share(&rows, i))).collect();
    ranking.sort_by(|a: &(Block, f64), b| b.1.total_cmp(&a.1));
    Leftover { evidence: log_mean(&all), base: given.whole.evidence, ranking, aliases, signal, rows }
}

/// What blocks are weighed beside.
struct Given {
    /// Over rows that carry the columns of `terms`, in their order, and after them those of all shapes.
    ledger: Ledger,
    /// Of what is accepted, and last those that put back what blocks are to take the place of.
    terms: Vec<Term>,
    /// How many those are.
    replaced: usize,
    /// Without any block.
    whole: Fit,
}

/// A block beside what is given, at the size at which it gains most.
struct Beside {
    gain: f64,
    /// The block's own.
    terms: Vec<Term>,
    /// θ of the block's terms.
    theta: DVector<f64>,
    /// Of the fit's rows.
    scales: [f64; 6],
}

impl Given {
    fn new(bench: &mut Bench, instead_of: &[usize]) -> (Self, Rows) {
        let mut terms = bench.accepted_terms(instead_of);
        let accepted = terms.len();
        terms.extend(instead_of.iter().flat_map(|&k| bench.put_back(&bench.accepted[k])));
        let mut columns: Vec<usize> = terms.iter().map(|term| term.column).collect();
        columns.extend(bench.candidate_columns()..bench.columns.len());
        let rows = bench.rows_of(&columns);
        let ledger = Ledger::new(&rows, |_| true);
        let terms = by_place(&terms);
        let whole = ledger.fit(&terms);
        (Self { ledger, replaced: terms.len() - accepted, terms, whole }, rows)
    }

    /// ln of the block's mean Bayes factor over all sizes, and its best.
    fn with(&self, columns: &[usize]) -> Option<(f64, Beside)> {
        let gram = self.ledger.gram(&self.whole.scales, columns, columns);
        let mut gains = Vec::with_capacity(SIZES.len());
        let mut strongest: Option<Beside> = None;
        for size in SIZES {
            let shown = columns.iter().enumerate().filter(|(i, _)| gram[(*i, *i)] > 1e-12);
            let term = |(i, &column): (usize, &usize)| Term { column, width: size / gram[(i, i)].sqrt(), mean: 0.0 };
            let terms: Vec<Term> = shown.map(term).collect();
            let fit = self.ledger.fit(&[self.terms.as_slice(), &terms].concat());
            let gain = fit.evidence - self.whole.evidence;
            gains.push(gain);
            if strongest.as_ref().is_none_or(|strongest| gain > strongest.gain) {
                let theta = fit.theta.rows(self.terms.len(), terms.len()).into_owned();
                strongest = Some(Beside { gain, terms, theta, scales: fit.scales });
            }
        }
        Some((log_mean(&gains), strongest?))
    }

    /// Does the effect that it would replace itself explain the block's signal?
    fn is_alias(&self, block: &Beside) -> bool {
        let columns: Vec<usize> = block.terms.iter().map(|term| term.column).collect();
        let own: Vec<usize> = (self.terms.len() - self.replaced..self.terms.len()).collect();
        self.replaced > 0 && shared(&self.ledger, &block.scales, &columns, &block.theta, &own) > ALIAS
    }
}

impl Beside {
    /// The block's share of a row.
    fn share(&self, rows: &Rows, i: usize) -> f64 {
        self.terms.iter().zip(&self.theta).map(|(term, theta)| rows.responses[(i, term.column)] * theta).sum()
    }
}

/// Share of the signal of some columns at θ that other columns can imitate: `|P s|² / |s|²`.
pub fn shared(ledger: &Ledger, scales: &[f64; 6], columns: &[usize], theta: &DVector<f64>, others: &[usize]) -> f64 {
    let own = ledger.gram(scales, columns, columns);
    let size = theta.dot(&(&own * theta));
    if size <= 0.0 || others.is_empty() {
        return 0.0;
    }
    let cross = ledger.gram(scales, others, columns) * theta;
    let mut gram = ledger.gram(scales, others, others);
    for i in 0..gram.nrows() {
        gram[(i, i)] = gram[(i, i)] * (1.0 + 1e-9) + 1e-300;
    }
    gram.cholesky().map_or(0.0, |factor| cross.dot(&factor.solve(&cross)) / size)
}
