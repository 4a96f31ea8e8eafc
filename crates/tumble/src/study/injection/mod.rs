//! `tumble study injection`: known effects added to recordings of real sensors, and looked for.
//!
//! Each recording is first diagnosed as it is. What is named there stays out of the score, and is not injected; its detection
//! limits set the sizes. One effect at a time, and a process of its own for every diagnosis, as in [`super::blind`].

pub mod table;

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Serialize;
use tumble_sim::Effect;

use super::blind::StudyError;
use super::blind::answer::{Answer, Asked};
use super::blind::ask::Oracle;
use super::blind::case::{self, Group};
use super::blind::mapping::{self, Pairing, True};
use super::blind::score::{self, Outcome};
use super::blind::size::Size;
use super::blind::sizing;
use super::parallel;
use crate::inject;
use crate::recording::Recording;

/// What is tried, the most telling first: effects whose size is a multiple of a limit and that can be added to samples.
const ORDER: [&str; 17] = [
    "gyro_g_sensitivity",
    "gyro_bias_step",
    "accel_bias_step",
    "accel_quadratic",
    "gyro_scale_asymmetry",
    "gyro_scale_quadratic",
    "gyro_warm_up",
    "gyro_accel_lag",
    "gyro_g_squared",
    "gyro_dead_zone",
    "gyro_scale_cubic",
    "accel_cubic",
    "gyro_bias_temperature",
    "accel_bias_temperature",
    "gyro_bias_random_walk",
    "accel_bias_random_walk",
    "gyro_scale_temperature",
];

/// What to try.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where the recordings are.
    pub recordings: PathBuf,
    /// Where answers are kept.
    pub folder: PathBuf,
    /// Effects a recording.
    pub count: usize,
    /// Sizes in detection limits.
    pub at: f64,
    /// Draws axes, directions, signs, times.
    pub seed: u64,
    /// Processes at a time.
    pub jobs: usize,
    /// A diagnosis that takes longer is broken, s.
    pub patience_s: f64,
}

/// One effect added to one recording.
#[derive(Clone, Debug, Serialize)]
pub struct Trial {
    /// What was added.
    pub id: String,
    /// How much, in the simulation's unit.
    pub magnitude: f64,
    /// That unit.
    pub unit: &'static str,
    /// What came of it; what the recording shows by itself does not count.
    pub outcome: Outcome,
    /// What was named beyond what the recording shows by itself.
    pub said: Vec<String>,
    /// Numbers that both sides have.
    pub numbers: Vec<Number>,
    /// Why there is no answer.
    pub trouble: String,
}

/// A number against the truth.
#[derive(Clone, Debug, Serialize)]
pub struct Number {
    /// As the diagnosis calls it.
    pub name: String,
    /// What was added, in the diagnosis' unit.
    pub truth: f64,
    /// What was found.
    pub value: f64,
    /// Its sigma.
    pub sigma: f64,
}

impl From<Pairing> for Number {
    fn from(Pairing { name, truth, value, sigma }: Pairing) -> Self {
        Self { name, truth, value, sigma }
    }
}

/// One recording.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its file.
    pub file: String,
    /// As it is.
    pub verdict: String,
    /// What is named as it is.
    pub named: Vec<String>,
    /// Why.
    pub reasons: Vec<String>,
    /// Of the diagnosis as it is, s.
    pub seconds: f64,
    /// What was added; fewer than wanted where the recording can bear no more.
    pub trials: Vec<Trial>,
    /// Effects that the recording could show and that can be added.
    pub bears: usize,
}

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// `tumble-study-injection`.
    pub format: &'static str,
    /// 1.
    pub version: u32,
    /// Sizes in detection limits.
    pub at: f64,
    /// One a recording.
    pub rows: Vec<Row>,
}

/// All recordings of a folder, in the order of their names.
pub fn run(options: &Options, program: &Path, progress: &mut super::blind::Progress) -> Result<Report, StudyError> {
    let list = std::fs::read_dir(&options.recordings).map_err(|error| StudyError::file(&options.recordings, error))?;
    let mut files: Vec<PathBuf> = list.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "csv"));
    files.sort();
    std::fs::create_dir_all(&options.folder).map_err(|error| StudyError::file(&options.folder, error))?;
    let patience = Duration::from_secs_f64(options.patience_s);
    let oracle = Oracle { program: program.to_path_buf(), patience };
    let count = files.len();
    let one = |k: usize| recording(options, &oracle, &files[k]);
    let rows = parallel::map(count, options.jobs, one, &mut |done| progress("recordings", done, count));
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(Report { format: "tumble-study-injection", version: 1, at: options.at, rows })
}

/// Diagnoses a recording as it is, then with each effect that it can bear.
fn recording(options: &Options, oracle: &Oracle, path: &Path) -> Result<Row, StudyError> {
    let file = path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let to = options.folder.join(format!("{}.json", case::neutral(&file)));
    let asked = oracle.ask(path, &[], &to).map_err(|error| StudyError::file(&to, error))?;
    let Some(answer) = &asked.answer else { return Ok(no_answer(file, asked)) };
    let sizes: Vec<Size> = ORDER.iter().filter_map(|id| bearable(options, id, answer)).collect();
    let bears = sizes.len();
    let mut trials = Vec::new();
    for size in sizes {
        if trials.len() == options.count {
            break;
        }
        // What an effect needs may be missing: a temperature.
        if let Some(trial) = trial(options, oracle, path, answer, &size)? {
            trials.push(trial);
        }
    }
    Ok(Row {
        file,
        verdict: answer.verdict.clone(),
        named: answer.effects.iter().map(|named| named.id.clone()).collect(),
        reasons: answer.reasons.clone(),
        seconds: asked.seconds,
        trials,
        bears,
    })
}

fn no_answer(file: String, asked: Asked) -> Row {
    let (verdict, reasons) = ("no answer".into(), vec![asked.trouble]);
    Row { file, verdict, named: Vec::new(), reasons, seconds: asked.seconds, trials: Vec::new(), bears: 0 }
}

/// The size of an effect that the recording could show, does not show by itself, and that can be made as large.
fn bearable(options: &Options, id: &str, answer: &Answer) -> Option<Size> {
    let says = answer.effects.iter().any(|named| named.says(id));
    let listed = answer.detection_limits.iter().any(|limit| limit.id == id && limit.testable);
    if says || !listed {
        return None;
    }
    sizing::as_stated(id, options.at, Some(answer), options.seed).filter(|size| size.limit.is_some())
}

fn trial(
    options: &Options,
    oracle: &Oracle,
    path: &Path,
    before: &Answer,
    size: &Size,
) -> Result<Option<Trial>, StudyError> {
    let plan = |error: &dyn std::fmt::Display| StudyError::Plan(format!("{}: {error}", path.display()));
    let effect = Effect::new(&size.id, Some(size.magnitude)).map_err(|error| plan(&error))?;
    let mut recording = Recording::read(path).map_err(|error| plan(&error))?;
    let Ok(truths) = inject::add(&mut recording, &[effect], options.seed) else { return Ok(None) };
    let name = case::neutral(&format!("{}|{}|{}|{}", path.display(), size.id, size.magnitude, options.seed));
    let (csv, to) = (options.folder.join(format!("{name}.csv")), options.folder.join(format!("{name}.json")));
    recording.write_file(&csv)?;
    let asked = oracle.ask(&csv, &[], &to).map_err(|error| StudyError::file(&to, error))?;
    std::fs::remove_file(&csv).map_err(|error| StudyError::file(&csv, error))?;
    let truth: Vec<True> = truths
        .iter()
        .flat_map(|truth| &truth.parameters)
        .map(|one| True { name: one.name.clone(), value: one.value, unit: one.unit.into() })
        .collect();
    Ok(Some(judge(&effect, &truth, before, asked)))
}

/// What the recording shows by itself is taken off the answer first.
fn judge(effect: &Effect, truth: &[True], before: &Answer, asked: Asked) -> Trial {
    let id = effect.id();
    let mut trial = Trial {
        id: id.into(),
        magnitude: effect.magnitude(),
        unit: effect.kind().unit,
        outcome: Outcome::Broken,
        said: Vec::new(),
        numbers: Vec::new(),
        trouble: asked.trouble,
    };
    let Some(mut answer) = asked.answer else { return trial };
    let own = |other: &str| before.effects.iter().any(|named| named.id == other);
    answer.effects.retain(|named| named.says(id) || !own(&named.id));
    if answer.verdict == before.verdict && answer.verdict == "unknown_effect" {
        answer.verdict = if answer.effects.is_empty() { "unknown_effect" } else { "effect_found" }.into();
    }
    trial.outcome = score::judge(Group::Effect, &[id], &answer);
    trial.said = answer.effects.iter().map(|named| named.id.clone()).collect();
    let found = answer.effects.iter().find(|named| named.id == id);
    trial.numbers =
        found.map(|named| mapping::pair(id, truth, named)).unwrap_or_default().into_iter().map(Number::from).collect();
    trial
}
