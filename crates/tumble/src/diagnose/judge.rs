//! Which of the names that the search accepted may be said.
//!
//! Before the recording is seen, each of the C names is taken to be as likely as all that has no name together (something outside the
//! catalogue: one in C + 1). The odds of a name against the shapes are then its evidence over their mean, and it is said at 20 to
//! 1, or where the shapes are no more than chance themselves. Several names at once are a coincidence that one thing without a
//! name is not: each further one is one of C, and costs ln C.

use super::catalogue::earth_rotation;
use super::exhibits;
use super::findings::{Finding, TIE};
use super::search::bench::{Accepted, Bench};
use super::search::restless::{self, Restless};
use super::search::select::Selection;
use super::search::unknown::{self, Aliases, Leftover};
use super::search::wandering;

/// ln of the odds that a name needs beside a distortion of the samples: 5e8 to 1.
pub const BESIDE_GATES: f64 = 20.0;

/// Beside something unknown a name stands if shapes without a name explain less than half of what it explains.
const BEYOND_UNKNOWN: f64 = 0.5;

/// A step or a warm-up none of whose sizes is as large as so many of its sigmas is none: what is certain is that something changed.
const SIZED: f64 = 2.0;

/// What of the accepted keeps its name.
pub struct Judged {
    /// What stands.
    pub named: Vec<Finding>,
    /// What fell, for what is unknown resembles it.
    pub demoted: Vec<Finding>,
    /// Is something there that has no name?
    pub unknown: bool,
    /// What improves only on the data it was fitted to, or not beside the others.
    pub dropped: Vec<String>,
    /// Do distortions of the samples leave traces that names have to stand clear of?
    pub beside_gates: bool,
    /// Is something left that such a distortion accounts for?
    pub traces: bool,
    /// Names that do not stand clear of it.
    pub faint: Vec<String>,
    /// Shapes that explain better than a name did.
    pub better: Vec<(String, f64)>,
    /// Largest probability of as much by chance.
    pub p_value: f64,
    /// Do moves scatter by more than any noise?
    pub restless: Option<Restless>,
}

impl Judged {
    fn new(leftover: &Leftover) -> Self {
        Self {
            named: Vec::new(),
            demoted: Vec::new(),
            unknown: leftover.is_real(),
            dropped: Vec::new(),
            beside_gates: false,
            traces: false,
            faint: Vec::new(),
            better: Vec::new(),
            p_value: leftover.p_value(),
            restless: None,
        }
    }

    /// These lose their names.
    fn demote(&mut self, falls: impl Fn(&Finding) -> bool) {
        self.demoted.extend(self.named.extract_if(.., |finding| falls(finding)));
    }

    /// Shapes without a name explain what a name would, and chance would explain it with this probability at most.
    fn nameless(&mut self, p_value: f64, shapes: Vec<(String, f64)>) {
        self.unknown = true;
        self.p_value = self.p_value.min(p_value);
        self.better.extend(shapes);
    }

    /// Likewise where these shapes are what explains it.
    fn yield_to(&mut self, bench: &Bench, shapes: &Leftover) {
        self.nameless(shapes.p_value(), exhibits::correlates(bench, shapes));
    }

    /// What distorts the samples themselves leaves traces in every fit. Beside it nothing is called unknown, and a name needs
    /// odds that no trace would reach; a bias that wanders is none.
    pub fn stand_beside_gates(&mut self) {
        self.beside_gates = true;
        let is_faint = |finding: &mut Finding| finding.found.evidence <= BESIDE_GATES || finding.is_walk;
        let faint = self.named.extract_if(.., is_faint).chain(self.demoted.drain(..));
        self.faint.extend(faint.map(|finding| finding.found.id));
        self.traces = self.unknown || !self.faint.is_empty();
        self.unknown = false;
    }
}

/// A name falls where shapes without one explain nearly as much, or where something is left that it does not stand clear of.
pub fn judge(bench: &mut Bench, selection: &Selection, leftover: &Leftover, found: Vec<Finding>) -> Judged {
    let mut judged = Judged::new(leftover);
    let refuted = refute_walks(bench, &found, &mut judged);
    let mut dropped = Vec::new();
    for mut finding in found {
        let id = finding.found.id.as_str();
        if refuted.iter().any(|walk| walk.takes_down(&finding)) {
            judged.demoted.push(finding);
            continue;
        }
        let Some(k) = bench.accepted.iter().position(|a| bench.candidate(a).effect.card.id == id) else { continue };
        // What pays no longer beside what came later is dropped as well.
        let worse = finding.found.held_out.is_some_and(|held_out| held_out.after > held_out.before);
        if worse || finding.found.evidence < selection.threshold {
            dropped.push((k, finding));
            continue;
        }
        if is_sizeless(bench, k, &finding) {
            judged.nameless((-finding.found.evidence).exp(), Vec::new());
            judged.demoted.push(finding);
            continue;
        }
        let shapes = shapes_instead(bench, selection, &[k], Aliases::LeftOut);
        // A bias that wanders stands for anything that changes with time: beside something unknown it is no name.
        let weak = finding.is_walk || shapes.clear(selection.evidence) < BEYOND_UNKNOWN * finding.found.evidence;
        if let Some(shape) = shapes.rival(selection.evidence, TIE) {
            judged.yield_to(bench, shape);
            judged.demoted.push(finding);
        } else if leftover.is_real() && weak {
            judged.demoted.push(finding);
        } else {
            finding.found.tied_with_shapes = exhibits::circumstances(bench, &shapes.at, selection.evidence);
            finding.found.tied_with_shapes.extend(earth_rotation::tied_with(&finding.found));
            judged.named.push(finding);
        }
    }
    drop_names(bench, selection, &mut judged, dropped);
    one_for_all(bench, selection, &mut judged);
    judged.restless = restless::restless(&bench.twin, &selection.noise);
    let only_walks = judged.named.iter().all(|finding| finding.is_walk);
    if let Some(restless) = judged.restless.filter(|_| only_walks && !judged.unknown) {
        judged.nameless(restless.p_value, vec![(restless.shape(), -restless.p_value.ln())]);
    }
    // What fell for a shape leaves something unknown too, and a bias that wanders stands for it as well.
    if judged.unknown {
        judged.demote(|finding| finding.is_walk);
    }
    judged
}

/// Is it a form of its own time, all of whose sizes are lost in their sigmas? It then stands in the place of a sum of others (the end of a
/// first rest, what is accepted besides), which the evidence belongs to.
fn is_sizeless(bench: &Bench, k: usize, finding: &Finding) -> bool {
    let accepted = &bench.accepted[k];
    let variant = bench.candidate(accepted).variants.get(accepted.variant);
    let Some(variant) = variant.filter(|variant| variant.setting.is_some()) else { return false };
    let sizes = finding.found.parameters.iter().take(variant.parameters.len());
    sizes.into_iter().all(|size| size.value.abs() < SIZED * size.sigma)
}

/// What does not hold on data left out, or no longer pays, is chance or has the wrong form: the latter if shapes without a name are more
/// than chance in its place.
fn drop_names(bench: &mut Bench, selection: &Selection, judged: &mut Judged, dropped: Vec<(usize, Finding)>) {
    if dropped.is_empty() {
        return;
    }
    let (places, findings): (Vec<usize>, Vec<Finding>) = dropped.into_iter().unzip();
    let shapes = shapes_instead(bench, selection, &places, Aliases::LeftOut);
    if shapes.best().is_real() {
        judged.yield_to(bench, shapes.best());
        judged.demoted.extend(findings);
    } else {
        judged.dropped.extend(findings.into_iter().map(|finding| finding.found.id));
    }
}

/// Several names may stand for one thing that has none, each clear of a shape in its place that leaves the others where they
/// are: the shapes once more in the place of them all.
fn one_for_all(bench: &mut Bench, selection: &Selection, judged: &mut Judged) {
    let named = |accepted: &Accepted| {
        let candidate = bench.candidate(accepted);
        candidate.walk.is_none() && judged.named.iter().any(|finding| finding.found.id == candidate.effect.card.id)
    };
    let shifts: Vec<usize> = (0..bench.accepted.len()).filter(|k| named(&bench.accepted[*k])).collect();
    if shifts.len() < 2 {
        return;
    }
    let shapes = shapes_instead(bench, selection, &shifts, Aliases::Counted);
    let coincidence = (shifts.len() - 1) as f64 * (bench.candidates.len() as f64).ln();
    if let Some(shape) = shapes.rival(selection.evidence, TIE + coincidence) {
        judged.yield_to(bench, shape);
        judged.demote(|finding| !finding.is_walk);
    }
}

/// What shapes without a name do in the place of accepted effects.
struct Instead {
    /// At the null's noise, at the noise in force and at the least: which one a shape needs is its own affair. At least one.
    at: Vec<Leftover>,
}

impl Instead {
    /// Where all shapes together explain most.
    fn best(&self) -> &Leftover {
        let most =
            |best: usize, next: usize| if self.at[next].reached() > self.at[best].reached() { next } else { best };
        &self.at[(1..self.at.len()).fold(0, most)]
    }

    /// ln of the names' odds against all shapes.
    fn clear(&self, evidence: f64) -> f64 {
        evidence - self.best().reached()
    }

    /// Where shapes are more than chance, and the names are not clear of them by a margin.
    fn rival(&self, evidence: f64, margin: f64) -> Option<&Leftover> {
        Some(self.best()).filter(|best| best.is_real() && self.clear(evidence) < margin)
    }
}

/// A walk is a part of the noise in force: in its place that is the null's. What a shape explains may have raised that too, a healthy
/// bias's wander or what stops and moves are taken for: with the shape the least noise may do.
fn shapes_instead(bench: &mut Bench, selection: &Selection, of: &[usize], aliases: Aliases) -> Instead {
    let in_force = bench.twin.noise;
    let walks = of.iter().any(|&k| bench.candidate(&bench.accepted[k]).walk.is_some());
    let least = bench.least_noise(of);
    let mut noises = vec![selection.null_noise];
    if !walks && in_force != selection.null_noise {
        noises.push(in_force);
    }
    if !noises.contains(&least) {
        noises.push(least);
    }
    let weigh = |noise| {
        bench.twin.noise = noise;
        unknown::weigh(bench, of, aliases)
    };
    let at: Vec<Leftover> = noises.into_iter().map(weigh).collect();
    bench.twin.noise = in_force;
    // Against the model that explains most without any shape, whichever noise that needs.
    let base = at.iter().map(|leftover| leftover.base).fold(f64::NEG_INFINITY, f64::max);
    Instead { at: at.into_iter().map(|leftover| leftover.against(base)).collect() }
}

/// A walk that is none.
struct Refuted {
    id: String,
    triad: &'static str,
    evidence: f64,
}

impl Refuted {
    /// Itself, and what was found on the same triad beside it and is less than it: its size rests on a walk that was wrong.
    fn takes_down(&self, finding: &Finding) -> bool {
        let found = &finding.found;
        found.id == self.id || (found.id.starts_with(self.triad) && found.evidence < self.evidence)
    }
}

/// Walks that do not behave as one.
fn refute_walks(bench: &mut Bench, found: &[Finding], judged: &mut Judged) -> Vec<Refuted> {
    let mut refuted = Vec::new();
    for finding in found {
        let mut candidates = bench.candidates.iter();
        let walk = candidates.find(|candidate| candidate.effect.card.id == finding.found.id);
        let Some((gyro, ..)) = walk.and_then(|candidate| candidate.walk) else { continue };
        let Some((why, gain)) = wandering::refute(bench, gyro) else { continue };
        let (triad, name) = if gyro { ("gyro_", "gyroscope") } else { ("accel_", "accelerometer") };
        judged.nameless((-gain).exp(), vec![(format!("{why} ({name})"), gain)]);
        refuted.push(Refuted { id: finding.found.id.clone(), triad, evidence: finding.found.evidence });
    }
    refuted
}
