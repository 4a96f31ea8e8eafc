//! The work bench of a search: the twin, all columns, and what has been accepted so far.

use std::ops::Range;

use nalgebra::DMatrix;

use super::family::Family;
use super::generic::families;
use super::ledger::{Fit, Ledger, Term, by_place, log_mean};
use crate::diagnose::catalogue::{AtSize, Effect, Model, Parameter, STRUCTURAL};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::column::Column;
use crate::diagnose::twin::data::Raw;
use crate::diagnose::twin::influence::{Influence, Push};
use crate::diagnose::twin::noise::{BIAS_WALK_FLOOR, FORCE_WALK_FLOOR, Noise};
use crate::diagnose::twin::rows::Rows;

/// Levels of wander that a healthy sensor has, as factors on the floors' variance: 1, 3 and 10 mdps in 100 s, and 10, 30 and
/// 100 µg. What is more is an effect.
pub const HEALTHY: [f64; 3] = [1.0, 9.0, 100.0];
/// Levels that count as an effect.
pub const WANDERING: [f64; 6] = [400.0, 1600.0, 6400.0, 25_600.0, 102_400.0, 409_600.0];

/// An effect may be this much larger than typical: the prior is a mixture of widths, so that a large one is not shrunk, and
/// what shrinking would leave is not taken for a second effect. Widths below typical (a quarter, a 16th) were tried: a sensitivity to force
/// shows at two thirds of the size, and half of the rooms' magnetic fields are called one (`docs/diagnosis.md` 8).
pub const WIDENINGS: [f64; 3] = [1.0, 4.0, 16.0];

/// A variant with its place among the columns.
#[derive(Clone)]
pub struct Placed {
    /// What is held.
    pub setting: Option<(&'static str, f64, &'static str)>,
    /// Its numbers.
    pub parameters: Vec<Parameter>,
    /// Its columns.
    pub columns: Range<usize>,
    /// Combinations that are its own.
    pub own: Option<DMatrix<f64>>,
    /// Influences at a size.
    pub at_size: Option<AtSize>,
}

/// A candidate.
pub struct Candidate {
    /// Of the catalogue.
    pub effect: &'static Effect,
    /// None for walks and what cannot show.
    pub variants: Vec<Placed>,
    /// `(gyro, unit_si, unit)`.
    pub walk: Option<(bool, f64, &'static str)>,
    /// Why it cannot show.
    pub absent: Option<&'static str>,
}

/// What is accepted.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// Which candidate.
    pub candidate: usize,
    /// Which of its variants.
    pub variant: usize,
    /// Of [`WIDENINGS`].
    pub widening: f64,
    /// Taken out of the samples already.
    pub taken: Vec<f64>,
}

/// All of it.
pub struct Bench {
    /// Fitted, with what is accepted taken out.
    pub twin: Twin,
    /// Readings as they were.
    pub original: Vec<Raw>,
    /// All columns.
    pub columns: Vec<Column>,
    /// In the catalogue's order.
    pub candidates: Vec<Candidate>,
    /// Shapes that detect.
    pub families: Vec<(Family, Range<usize>)>,
    /// So far.
    pub accepted: Vec<Accepted>,
    /// Noise as the recording was given.
    pub given: Noise,
    /// Walks found: the gyroscope's and the accelerometer's densities.
    pub wander: (f64, f64),
    /// Rows about the present nominal, by the noise they were made under: they cost a quarter of a second.
    made: Vec<(Noise, std::sync::Arc<Rows>)>,
}

impl Candidate {
    /// `place` puts influences among the columns.
    fn new(effect: &'static Effect, model: Model, mut place: impl FnMut(Vec<Influence>) -> Range<usize>) -> Self {
        let mut candidate = Self { effect, variants: Vec::new(), walk: None, absent: None };
        match model {
            Model::Shift(variants) => {
                let placed = variants.into_iter().map(|variant| Placed {
                    setting: variant.setting,
                    parameters: variant.parameters,
                    columns: place(variant.influences),
                    own: variant.own,
                    at_size: variant.at_size,
                });
                candidate.variants = placed.collect();
            }
            Model::Walk { gyro, unit_si, unit } => candidate.walk = Some((gyro, unit_si, unit)),
            Model::Absent(why) => candidate.absent = Some(why),
        }
        candidate
    }
}

impl Bench {
    /// All candidates for a twin, except those in `without`.
    pub fn new(twin: Twin, without: &[String]) -> Self {
        let mut all: Vec<Column> = Vec::new();
        let mut place = |more: Vec<Influence>| {
            let first = all.len();
            all.extend(more.into_iter().map(Column::from));
            first..all.len()
        };
        let known = STRUCTURAL.iter().filter(|effect| !without.iter().any(|id| id == effect.card.id));
        let candidates = known.map(|effect| Candidate::new(effect, (effect.model)(&twin), &mut place)).collect();
        let families = families(&twin)
            .into_iter()
            .map(|mut family| {
                let columns = place(std::mem::take(&mut family.influences));
                (family, columns)
            })
            .collect();
        let original = twin.samples.clone();
        let given = twin.noise;
        Self {
            twin,
            original,
            columns: all,
            candidates,
            families,
            accepted: Vec::new(),
            given,
            wander: (0.0, 0.0),
            made: Vec::new(),
        }
    }

    /// Number of columns that belong to candidates; generic shapes come after.
    pub fn candidate_columns(&self) -> usize {
        self.families.first().map_or(self.columns.len(), |(_, columns)| columns.start)
    }

    /// Terms of a variant, what is taken out of the samples counted.
    pub fn terms(&self, candidate: usize, variant: usize, widening: f64, taken: &[f64]) -> Vec<Term> {
        let placed = &self.candidates[candidate].variants[variant];
        let term = |(i, column): (usize, usize)| Term {
            column,
            width: widening * placed.parameters[i].width,
            mean: -taken.get(i).copied().unwrap_or(0.0),
        };
        placed.columns.clone().enumerate().map(term).collect()
    }

    /// The candidate that was accepted.
    pub fn candidate(&self, accepted: &Accepted) -> &Candidate {
        &self.candidates[accepted.candidate]
    }

    /// The variant that was accepted; none of a walk.
    pub fn placed(&self, accepted: &Accepted) -> Option<&Placed> {
        self.candidate(accepted).variants.get(accepted.variant)
    }

    /// Is this triad's bias accepted as one that wanders?
    pub fn wanders(&self, gyro: bool) -> bool {
        self.wanders_but(gyro, &[])
    }

    fn wanders_but(&self, gyro: bool, but: &[usize]) -> bool {
        let is_walk = |accepted: &Accepted| self.candidate(accepted).walk.is_some_and(|walk| walk.0 == gyro);
        self.accepted.iter().enumerate().any(|(k, accepted)| !but.contains(&k) && is_walk(accepted))
    }

    /// Where a bias is accepted as wandering, but for those in `but`, it does so as found.
    #[must_use]
    pub fn with_accepted_walks(&self, noise: &Noise, but: &[usize]) -> Noise {
        Noise {
            bias_walk: if self.wanders_but(true, but) { self.wander.0 } else { noise.bias_walk },
            force_walk: if self.wanders_but(false, but) { self.wander.1 } else { noise.force_walk },
            ..*noise
        }
    }

    /// Sensor, fence and box at their best: what the device's estimator found beyond that may be an effect that it took for noise.
    pub fn least_noise(&self, but: &[usize]) -> Noise {
        let least = with_walks(&self.given.trusting(self.twin.stops), HEALTHY[0], HEALTHY[0]);
        self.with_accepted_walks(&least, but)
    }

    /// How this triad's bias wanders, if it is accepted as such.
    pub fn set_wander(&mut self, gyro: bool, density: f64) {
        *if gyro { &mut self.wander.0 } else { &mut self.wander.1 } = density;
    }

    /// Terms of all that is accepted, but for some.
    pub fn accepted_terms(&self, but: &[usize]) -> Vec<Term> {
        let chosen = self.accepted.iter().enumerate().filter(|(k, _)| !but.contains(k));
        chosen
            .filter(|(_, accepted)| self.candidate(accepted).walk.is_none())
            .flat_map(|(_, accepted)| {
                self.terms(accepted.candidate, accepted.variant, accepted.widening, &accepted.taken)
            })
            .collect()
    }

    /// A candidate beside other terms: evidence over its variants and widenings, and the best of them.
    pub fn weigh(&self, ledger: &Ledger, others: &[Term], candidate: usize) -> (f64, usize, f64) {
        let mut best = (f64::NEG_INFINITY, 0, 1.0);
        let mut all = Vec::new();
        for variant in 0..self.candidates[candidate].variants.len() {
            for widening in WIDENINGS {
                let mut terms = others.to_vec();
                terms.extend(self.terms(candidate, variant, widening, &[]));
                let evidence = ledger.fit(&terms).evidence;
                all.push(evidence);
                if evidence > best.0 {
                    best = (evidence, variant, widening);
                }
            }
        }
        (log_mean(&all), best.1, best.2)
    }

    /// Rows with all candidates' columns under a noise.
    pub fn rows(&mut self, noise: Noise) -> std::sync::Arc<Rows> {
        self.twin.noise = noise;
        if let Some((_, rows)) = self.made.iter().find(|(made, _)| *made == noise) {
            return rows.clone();
        }
        let all: Vec<usize> = (0..self.candidate_columns()).collect();
        let rows = std::sync::Arc::new(self.rows_of(&all));
        self.made.push((noise, rows.clone()));
        rows
    }

    /// Fits the nominal anew; what was made about the one before no longer holds.
    pub fn fit_nominal(&mut self) {
        self.made.clear();
        let terms: Vec<Term> = self
            .accepted_terms(&[])
            .into_iter()
            .filter(|term| self.columns[term.column].influence.reading().is_none())
            .collect();
        let chosen: Vec<usize> = terms.iter().map(|term| term.column).collect();
        let local = by_place(&terms);
        let sizes = |rows: &Rows| Ledger::new(rows, |_| true).fit(&local).theta.iter().copied().collect();
        self.twin.fit_beside(&mut self.columns, &chosen, sizes);
        self.columns.iter_mut().for_each(Column::forget);
    }

    /// Takes the accepted effects' best numbers out of the samples and fits the nominal anew: the non-linear refit.
    pub fn refit(&mut self) {
        for _ in 0..2 {
            let terms = self.accepted_terms(&[]);
            let fit = self.fit_alone(self.twin.noise, &terms);
            let mut next = 0;
            for accepted in &mut self.accepted {
                let Some(placed) = self.candidates[accepted.candidate].variants.get(accepted.variant) else { continue };
                for (i, column) in placed.columns.clone().enumerate() {
                    if self.columns[column].influence.reading().is_some() {
                        accepted.taken[i] += fit.theta[next];
                    }
                    next += 1;
                }
            }
            self.resize();
            self.take_out(&self.taken());
            self.fit_nominal();
        }
    }

    /// Influences that depend on the effect's size, at the sizes taken.
    fn resize(&mut self) {
        for accepted in &self.accepted {
            let Some(placed) = self.candidates[accepted.candidate].variants.get(accepted.variant) else { continue };
            let Some(at_size) = &placed.at_size else { continue };
            for (i, column) in placed.columns.clone().enumerate() {
                self.columns[column] = at_size(i, accepted.taken[i]).into();
            }
        }
    }

    /// Columns of what is accepted, with what of each is to be taken out of the samples.
    fn taken(&self) -> Vec<(usize, f64)> {
        let columns = self.accepted.iter().filter_map(|accepted| {
            let placed = self.placed(accepted)?;
            Some(placed.columns.clone().zip(accepted.taken.iter().copied()))
        });
        columns.flatten().filter(|(_, taken)| *taken != 0.0).collect()
    }

    /// The original readings less these columns at these sizes; what does not show in readings has no part in it. The
    /// nominal is to be fitted anew after it.
    pub fn take_out(&mut self, columns: &[(usize, f64)]) {
        for (index, raw) in self.twin.samples.iter_mut().enumerate() {
            *raw = self.original[index];
            let Some(moment) = self.twin.trajectory.moments.get(index) else { continue };
            for &(column, taken) in columns {
                if let Some(reading) = self.columns[column].influence.reading() {
                    let push = reading(moment);
                    raw.rate -= push.rate * taken;
                    raw.force -= push.force * taken;
                }
            }
        }
    }

    /// What the accepted effects' columns at these sizes are of every reading.
    pub fn pushes<'a>(&'a self, sizes: &'a [f64]) -> impl Iterator<Item = Push> + 'a {
        let columns =
            self.accepted.iter().filter_map(|accepted| self.placed(accepted)).flat_map(|placed| placed.columns.clone());
        let sized: Vec<(usize, f64)> = columns.zip(sizes.iter().copied()).collect();
        self.twin.trajectory.moments.iter().map(move |moment| {
            let readings =
                sized.iter().filter_map(|(column, size)| Some((self.columns[*column].influence.reading()?, size)));
            readings.fold(Push::default(), |sum, (reading, size)| {
                let push = reading(moment);
                Push { rate: sum.rate + push.rate * *size, force: sum.force + push.force * *size }
            })
        })
    }

    /// The model of some terms under a noise. Only their columns are carried: a hundred times faster than all.
    pub fn fit_alone(&mut self, noise: Noise, terms: &[Term]) -> Fit {
        let (ledger, terms) = self.ledger_under(noise, terms);
        ledger.fit(&terms)
    }

    /// As [`Self::ledger_of`], under this noise.
    pub fn ledger_under(&mut self, noise: Noise, terms: &[Term]) -> (Ledger, Vec<Term>) {
        self.twin.noise = noise;
        self.ledger_of(terms)
    }

    /// Sums over rows that carry these terms' columns alone, under the noise in force, and the terms by their place in them.
    pub fn ledger_of(&mut self, terms: &[Term]) -> (Ledger, Vec<Term>) {
        let columns: Vec<usize> = terms.iter().map(|term| term.column).collect();
        let rows = self.rows_of(&columns);
        (Ledger::new(&rows, |_| true), by_place(terms))
    }

    /// Rows that carry these columns alone, in this order, under the noise in force.
    pub fn rows_of(&mut self, columns: &[usize]) -> Rows {
        for &column in columns {
            if !self.columns[column].is_made() {
                self.columns[column].make(&self.twin);
            }
        }
        let columns: Vec<&Column> = columns.iter().map(|&column| &self.columns[column]).collect();
        self.twin.rows(&columns)
    }

    /// Terms that put an accepted effect back at exactly the size at which it was taken out of the samples.
    pub fn put_back(&self, accepted: &Accepted) -> Vec<Term> {
        if self.candidate(accepted).walk.is_some() {
            return Vec::new();
        }
        let back = self.terms(accepted.candidate, accepted.variant, accepted.widening, &accepted.taken);
        back.into_iter().map(|term| Term { width: 1e-9 * term.width, ..term }).collect()
    }
}

/// The floors at a level, for gyroscope and accelerometer.
pub fn with_walks(noise: &Noise, gyro: f64, accel: f64) -> Noise {
    Noise { bias_walk: gyro * BIAS_WALK_FLOOR, force_walk: accel * FORCE_WALK_FLOOR, ..*noise }
}
