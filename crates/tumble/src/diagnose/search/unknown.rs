//! Is anything left, or explained better by a shape that has no name?
//!
//! Every block of generic shapes (a family, a shape on all channels of a triad, a channel, a single column) is weighed with
//! a prior of κ sigmas for κ over two decades, so that no size is presumed. The mean over all blocks and sizes is a Bayes
//! factor against the null; by Markov's inequality it exceeds B by chance in at most 1/B of recordings, whatever the
//! blocks have in common.

use super::bench::Bench;
use super::ledger::{Fit, Ledger, Term, log_mean};
use super::null::FALSE_ALARMS;

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
    pub rows: crate::diagnose::twin::rows::Rows,
}

impl Leftover {
    /// Is it more than chance?
    pub fn is_real(&self) -> bool {
        self.evidence > -FALSE_ALARMS.ln()
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
        let count = family.members.len();
        let mut add = |members: Vec<usize>| blocks.push(Block { family: index, members });
        (0..count).for_each(|member| add(vec![member]));
        let mut channels: Vec<usize> = family.members.iter().map(|member| member.0).collect();
        channels.dedup();
        if count <= WIDEST && count > 3 {
            add((0..count).collect());
        }
        let on = |channel: usize| (0..count).filter(|&m| family.members[m].0 == channel).collect::<Vec<_>>();
        for &channel in &channels {
            if on(channel).len() > 1 && on(channel).len() <= WIDEST {
                add(on(channel));
            }
        }
        // The same shape on all channels, and sine with cosine on one and on all.
        let per_channel = count / channels.len().max(1);
        for shape in 0..per_channel {
            add((0..channels.len()).map(|k| k * per_channel + shape).collect());
        }
        // Shapes come in threes, one an axis: each axis on its own channel, on the next, and on the one after, as in a product of
        // vectors.
        if channels.len() == 3 {
            for (three, on) in (0..per_channel / 3).flat_map(|three| (0..3).map(move |on| (3 * three, on))) {
                add((0..3).map(|k| k * per_channel + three + (k + on) % 3).collect());
            }
            // All of them at once, each axis on its own channel.
            if per_channel > 3 && 3 * (per_channel / 3) <= WIDEST {
                let own = |k: usize| (0..per_channel / 3).map(move |three| k * per_channel + 3 * three + k);
                add((0..3).flat_map(own).collect());
            }
        }
        if family.name == "slow oscillation" {
            for pair in 0..per_channel / 2 {
                let both = |k: usize| [k * per_channel + 2 * pair, k * per_channel + 2 * pair + 1];
                (0..channels.len()).for_each(|k| add(both(k).to_vec()));
                add((0..channels.len()).flat_map(both).collect());
            }
        }
    }
    blocks
}

/// Weighs all blocks beside what is accepted; in the place of those in `instead_of`, aliases of them left out.
pub fn weigh(bench: &mut Bench, instead_of: &[usize]) -> Leftover {
    let accepted = bench.accepted_terms(instead_of);
    let replaced: Vec<Term> = instead_of.iter().flat_map(|&k| bench.put_back(&bench.accepted[k])).collect();
    let own = replaced.clone();
    let first = bench.candidate_columns();
    let mut columns: Vec<usize> = accepted.iter().chain(&replaced).map(|term| term.column).collect();
    let given = columns.len();
    columns.extend(first..bench.columns.len());
    let rows = bench.rows_of(&columns);
    let ledger = Ledger::new(&rows, |_| true);
    let mut terms: Vec<Term> = accepted.iter().chain(&replaced).copied().collect();
    terms.iter_mut().enumerate().for_each(|(k, term)| term.column = k);
    let whole = ledger.fit(&terms);
    // Columns of the effect itself among the given: its put-back terms stand last.
    let own: Vec<usize> = (given - own.len().min(given)..given).collect();
    let (mut all, mut ranking, mut aliases) = (Vec::new(), Vec::new(), Vec::new());
    let mut best: Option<(f64, Vec<Term>, Fit)> = None;
    for block in blocks(bench) {
        let start = bench.families[block.family].1.start;
        let local: Vec<usize> = block.members.iter().map(|member| given + start - first + member).collect();
        let gram = ledger.gram(&whole.scales, &local, &local);
        let mut gains = Vec::with_capacity(SIZES.len());
        let mut strongest: Option<(f64, Vec<Term>, Fit)> = None;
        for size in SIZES {
            let mut model = terms.clone();
            model.extend(local.iter().enumerate().filter(|(i, _)| gram[(*i, *i)] > 1e-12).map(|(i, &column)| Term {
                column,
                width: size / gram[(i, i)].sqrt(),
                mean: 0.0,
            }));
            let fit = ledger.fit(&model);
            let gain = fit.evidence - whole.evidence;
            gains.push(gain);
            if strongest.as_ref().is_none_or(|strongest| gain > strongest.0) {
                strongest = Some((gain, model, fit));
            }
        }
        let Some((gain, model, fit)) = strongest else { continue };
        if !own.is_empty() && is_alias(&ledger, &fit, &model[given..], given, &own) {
            aliases.push((block, gain));
            continue;
        }
        all.push(log_mean(&gains));
        ranking.push((block, gain));
        if best.as_ref().is_none_or(|best| gain > best.0) {
            best = Some((gain, model, fit));
        }
    }
    let share = |i: usize| {
        let (_, model, fit) = best.as_ref()?;
        let block = model.iter().zip(fit.theta.iter()).skip(given);
        Some(block.map(|(term, theta)| rows.responses[(i, term.column)] * theta).sum())
    };
    let signal = (0..rows.at.len()).map(|i| share(i).unwrap_or(0.0)).collect();
    ranking.sort_by(|a: &(Block, f64), b| b.1.total_cmp(&a.1));
    Leftover { evidence: log_mean(&all), base: whole.evidence, ranking, aliases, signal, rows }
}

/// Does the effect itself explain the block's signal?
fn is_alias(ledger: &Ledger, fit: &Fit, block: &[Term], given: usize, own: &[usize]) -> bool {
    let columns: Vec<usize> = block.iter().map(|term| term.column).collect();
    let theta = fit.theta.rows(given, block.len()).into_owned();
    shared(ledger, &fit.scales, &columns, &theta, own) > ALIAS
}

/// Share of the signal of some columns at θ that other columns can imitate: `|P s|² / |s|²`.
pub fn shared(
    ledger: &Ledger,
    scales: &[f64; 6],
    columns: &[usize],
    theta: &nalgebra::DVector<f64>,
    others: &[usize],
) -> f64 {
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
