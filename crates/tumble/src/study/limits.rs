//! `tumble study limits`: the device's estimator over many simulated sessions against the Cramér–Rao bound.

use serde::Serialize;
use tumble_core::procedure::BoxFaces;
use tumble_sim::motion::Stops;
use tumble_sim::scheme::Imperfection;
use tumble_sim::{Scheme, SchemeConfig};

use super::navigation::{Compensation, LevelError, level_error, tumbling};
use super::parallel;
use super::summary::{self, Group, GroupSummary, Nees};
use super::trial::{Trial, TrialError};

/// Largest tilt, degrees: the runs go from none to this.
const MAX_TILT_DEG: f64 = 3.0;

/// Sessions of one kind.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// For a table.
    pub name: &'static str,
    /// What is done.
    pub scheme: Scheme,
    /// What is promised of the box.
    pub faces: BoxFaces,
    /// On top of exact stops and a table tilted by 0–3°.
    pub imperfections: Vec<Imperfection>,
    /// Is it moved by a turntable, without tremor?
    pub machine: bool,
}

/// What a scenario came to.
#[derive(Clone, Debug, Serialize)]
pub struct ScenarioSummary {
    /// Name.
    pub name: &'static str,
    /// `single` or `double`.
    pub scheme: &'static str,
    /// `box` or `gravity`.
    pub reference: &'static str,
    /// Sessions with numbers.
    pub runs: usize,
    /// Of these, accepted by the judge.
    pub accepted: usize,
    /// Sessions without numbers, with their reasons.
    pub failures: Vec<String>,
    /// Errors.
    pub groups: Vec<GroupSummary>,
    /// Mean and standard deviation of scale and non-orthogonality by estimator.
    pub estimators: Vec<summary::EstimatorSummary>,
    /// Are the covariances true? None if one is not positive definite.
    pub nees: Option<Nees>,
    /// Share of all parameters within two sigma.
    pub within_2_sigma: f64,
    /// Level error after 65 s of tumbling, by calibration; none where it was not asked for.
    pub navigation: Vec<NavigationSummary>,
}

/// Level error of one calibration over all runs, degrees.
#[derive(Clone, Debug, Serialize)]
pub struct NavigationSummary {
    /// Which calibration.
    pub calibration: &'static str,
    /// Mean after 65 s.
    pub end_mean_deg: f64,
    /// 95 % of runs stay below this after 65 s.
    pub end_95_deg: f64,
    /// Mean of the largest on the way.
    pub max_mean_deg: f64,
    /// 95 % of runs never exceed this.
    pub max_95_deg: f64,
}

/// How much is done.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Sessions of each scenario.
    pub runs: usize,
    /// Threads.
    pub threads: usize,
    /// First seed.
    pub seed: u64,
    /// Batch and gravity as well: a second more a session.
    pub references: bool,
}

impl Scenario {
    /// Both schemes, both references, as a person does it and as a turntable does.
    pub fn nominal() -> Vec<Self> {
        let mut scenarios = Vec::new();
        for (name, machine) in [("nominal", false), ("nominal, no tremor", true)] {
            for faces in [BoxFaces::Square, BoxFaces::Unknown] {
                for scheme in [Scheme::Single, Scheme::Double] {
                    scenarios.push(Self { name, scheme, faces, imperfections: Vec::new(), machine });
                }
            }
        }
        scenarios
    }

    /// Both schemes, both references, with these imperfections together.
    pub fn with(imperfections: &[Imperfection]) -> Vec<Self> {
        let nominal = Self::nominal().into_iter().filter(|scenario| !scenario.machine);
        nominal.map(|scenario| Self { name: "as asked", imperfections: imperfections.to_vec(), ..scenario }).collect()
    }

    /// One thing at a time, then all of them; both directions on every face.
    pub fn imperfect() -> Vec<Self> {
        let one = [
            ("tilt 3 deg", Imperfection::Tilt(3.0)),
            ("by hand, 2 deg", Imperfection::ByHand(2.0)),
            ("wobble 1 deg", Imperfection::Wobble(1.0)),
            ("lever 5 cm", Imperfection::Lever(0.05)),
            ("bias drift 30 mdps", Imperfection::BiasDrift(0.03)),
            ("clock 1 %", Imperfection::Clock(0.01)),
            ("box 0.5 deg crooked", Imperfection::CrookedBox(0.5)),
            ("temperature 1 degC", Imperfection::TemperatureRamp(1.0)),
        ];
        let square_all = Imperfection::ALL.into_iter().filter(|i| !matches!(i, Imperfection::CrookedBox(_))).collect();
        let mut named: Vec<_> = one.into_iter().map(|(name, imperfection)| (name, vec![imperfection])).collect();
        named.push(("all but the box", square_all));
        named.push(("all together", Imperfection::ALL.to_vec()));
        [BoxFaces::Square, BoxFaces::Unknown]
            .into_iter()
            .flat_map(|faces| named.iter().map(move |(name, imperfections)| (faces, *name, imperfections.clone())))
            .map(|(faces, name, imperfections)| Self {
                name,
                scheme: Scheme::Double,
                faces,
                imperfections,
                machine: false,
            })
            .collect()
    }

    /// Run `index` of `runs`.
    pub fn config(&self, index: usize, effort: &Effort) -> SchemeConfig {
        let mut config = SchemeConfig::new(self.scheme, effort.seed + index as u64);
        let motion = &mut config.world.motion;
        if self.machine {
            motion.hands = tumble_sim::motion::Hands::machine();
        }
        motion.hands.stops = Stops::Exact;
        motion.table.tilt_deg = MAX_TILT_DEG * index as f64 / (effort.runs.max(2) - 1) as f64;
        self.imperfections.iter().fold(config, |config, imperfection| config.with(*imperfection))
    }

    /// Runs it; `navigate` adds the tumbling.
    pub fn run(&self, effort: &Effort, navigate: bool, done: &mut (impl FnMut(usize) + Send)) -> ScenarioSummary {
        let work = |index: usize| -> Result<(Trial, Levels), TrialError> {
            let config = self.config(index, effort);
            let trial = Trial::run_with(&config, self.faces, effort.references)?;
            let levels = if navigate { navigated(&config, &trial)? } else { Vec::new() };
            Ok((trial, levels))
        };
        let results = parallel::map(effort.runs, effort.threads, work, done);
        let (mut trials, mut levels, mut failures) = (Vec::new(), Vec::new(), Vec::new());
        for result in results {
            match result {
                Ok((trial, level)) => {
                    trials.push(trial);
                    levels.push(level);
                }
                Err(error) => failures.push(error.to_string()),
            }
        }
        self.summary(&trials, &levels, failures)
    }

    fn summary(&self, trials: &[Trial], levels: &[Levels], failures: Vec<String>) -> ScenarioSummary {
        ScenarioSummary {
            name: self.name,
            scheme: self.scheme.name(),
            reference: if self.faces == BoxFaces::Square { "box" } else { "gravity" },
            runs: trials.len(),
            accepted: trials.iter().filter(|trial| trial.accepted).count(),
            failures,
            estimators: summary::estimators(trials),
            groups: Group::ALL.into_iter().map(|group| summary::group(trials, group)).collect(),
            nees: summary::nees(trials),
            within_2_sigma: summary::within_2_sigma(trials),
            navigation: navigation(levels),
        }
    }
}

/// One run's level errors by calibration.
type Levels = Vec<(&'static str, LevelError)>;

fn navigated(config: &SchemeConfig, trial: &Trial) -> Result<Levels, TrialError> {
    let recording = tumbling(config)?;
    let mut ways = vec![
        ("perfect", Compensation::perfect(trial)),
        ("device", Compensation::estimated(trial)),
        ("bias alone", Compensation::bias_alone(trial)),
    ];
    let two_step = trial.two_step.as_ref();
    ways.extend(two_step.map(|found| ("two-step", Compensation::of(found, trial.rotation_f_from_b))));
    Ok(ways.into_iter().map(|(name, way)| (name, level_error(&recording, &way))).collect())
}

fn navigation(levels: &[Levels]) -> Vec<NavigationSummary> {
    let names = levels.iter().max_by_key(|run| run.len()).into_iter().flatten().map(|level| level.0);
    let summary = |calibration: &'static str| {
        let runs: Vec<LevelError> =
            levels.iter().flatten().filter(|level| level.0 == calibration).map(|level| level.1).collect();
        let (end_mean_deg, end_95_deg) = mean_and_95(runs.iter().map(|level| level.end_deg).collect());
        let (max_mean_deg, max_95_deg) = mean_and_95(runs.iter().map(|level| level.max_deg).collect());
        NavigationSummary { calibration, end_mean_deg, end_95_deg, max_mean_deg, max_95_deg }
    };
    names.map(summary).collect()
}

fn mean_and_95(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_unstable_by(f64::total_cmp);
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let index = ((values.len() as f64 * 0.95).ceil() as usize).saturating_sub(1);
    (mean, values.get(index).copied().unwrap_or(f64::NAN))
}
