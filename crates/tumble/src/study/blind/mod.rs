//! `tumble study blind`: does the diagnosis find what it was not told?
//!
//! Effects and their sizes are drawn from a seed and sealed; recordings get names that tell nothing; a process of its own
//! diagnoses each from the CSV alone; then the seals are opened and the answers scored.

pub mod answer;
pub(super) mod ask;
mod binomial;
pub(super) mod case;
mod make;
pub mod mapping;
pub mod score;
pub(super) mod size;
pub(super) mod sizing;
mod store;
mod strength;
pub mod table;
pub mod tally;
mod units;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use self::answer::{Answer, Asked};
use self::ask::Oracle;
use self::case::{Case, Setting};
use self::score::{Hidden, Scored};
use self::store::Store;
use self::tally::Report;
use super::parallel;
use crate::conceal::SealError;
use crate::recording::RecordingError;

/// What to put to the test.
#[derive(Clone, Debug)]
pub struct Options {
    /// Everything is drawn from it.
    pub seed: u64,
    /// Recordings an effect.
    pub seeds: usize,
    /// Recordings without any.
    pub clean: usize,
    /// Ids; none means all of the catalogue.
    pub effects: Vec<String>,
    /// Effects outside the catalogue as well.
    pub foreign: bool,
    /// Each effect once more, unknown to the diagnosis.
    pub removed: bool,
    /// Recordings a pair.
    pub pairs: usize,
    /// `single`, `double`, `multipose`.
    pub schemes: Vec<&'static str>,
    /// Processes at a time.
    pub jobs: usize,
    /// Folder for recordings and answers.
    pub folder: Option<PathBuf>,
    /// Recordings stay there.
    pub keep: bool,
    /// Answers that are there are computed anew.
    pub again: bool,
    /// Nothing is asked: what is answered in the folder is scored.
    pub partial: bool,
    /// Sizes in detection limits.
    pub at: f64,
    /// Noise in motion over that at rest.
    pub noise: f64,
    /// A diagnosis that takes longer is broken, s.
    pub patience_s: f64,
}

impl Options {
    fn wants(&self, id: &str) -> bool {
        self.effects.is_empty() || self.effects.iter().any(|one| one == id)
    }
}

/// Why a study cannot go on. Diagnoses that fail are no such reason: they are counted.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A file that cannot be read or written.
    #[error("{file}: {error}")]
    File {
        /// Which.
        file: String,
        /// What the system says.
        error: std::io::Error,
    },
    /// A recording that cannot be written.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A seal.
    #[error(transparent)]
    Seal(#[from] SealError),
    /// What was drawn cannot be simulated.
    #[error("{0}")]
    Plan(String),
}

impl StudyError {
    pub(super) fn file(path: &Path, error: std::io::Error) -> Self {
        Self::File { file: path.display().to_string(), error }
    }
}

/// Hears what is being done, how much of it is done, and of how much.
pub type Progress<'a> = dyn FnMut(&str, usize, usize) + Send + 'a;

/// Draws, seals, asks, unseals, scores.
pub fn run(options: &Options, program: &Path, progress: &mut Progress) -> Result<Report, StudyError> {
    let store = Store::open(options.folder.as_deref(), options.keep)?;
    if options.again {
        store.forget_answers()?;
    }
    if options.partial {
        let names = store.answered()?;
        let scored = names.iter().map(|name| unseal(&store, name)).collect::<Result<Vec<_>, _>>()?;
        return Ok(Report::new(options, &scored));
    }
    let patience = Duration::from_secs_f64(options.patience_s);
    let oracle = Oracle { program: program.to_path_buf(), patience };
    let mut cases = case::draw(options);
    let twins = settle(options, &store, &oracle, &mut cases, progress)?;
    let total = cases.len();
    let ask = |k: usize| {
        let case = &cases[k];
        let twin = twins.get(&case.setting.name("twin")).and_then(|asked| asked.answer.as_ref());
        store.case(&oracle, case, || sizing::sizes(&case.ids, options.at, twin, &case.setting))
    };
    parallel::map(total, options.jobs, ask, &mut |done| progress("recordings", done, total))
        .into_iter()
        .collect::<Result<Vec<()>, _>>()?;
    let scored = cases.iter().map(|case| unseal(&store, &case.name)).collect::<Result<Vec<_>, _>>()?;
    let report = Report::new(options, &scored);
    store.write("cases.csv", &table::cases(&scored))?;
    store.write("report.json", &format!("{}\n", serde_json::to_string(&report).unwrap_or_default()))?;
    store.write("report.txt", &table::text(&report))?;
    Ok(report)
}

/// Opens a seal when all is answered.
fn unseal(store: &Store, name: &str) -> Result<Scored, StudyError> {
    let hidden = Hidden::of(&store.secret(name)?)
        .ok_or_else(|| StudyError::Plan(format!("{name}: its seal is of another study")))?;
    Ok(Scored::new(name.to_owned(), hidden, store.said(name)?))
}

/// Has the clean twins diagnosed, and moves a case on to the next scheme where its effects cannot show.
fn settle(
    options: &Options,
    store: &Store,
    oracle: &Oracle,
    cases: &mut [Case],
    progress: &mut Progress,
) -> Result<BTreeMap<String, Asked>, StudyError> {
    let mut twins: BTreeMap<String, Asked> = BTreeMap::new();
    for attempt in 0..options.schemes.len() {
        let waiting = |case: &&Case| case.needs_twin() && case.schemes.get(attempt) == Some(&case.setting.scheme);
        let mut wanted: BTreeMap<String, Setting> = BTreeMap::new();
        for case in cases.iter().filter(waiting) {
            wanted.insert(case.setting.name("twin"), case.setting);
        }
        wanted.retain(|name, _| !twins.contains_key(name));
        let settings: Vec<&Setting> = wanted.values().collect();
        let total = settings.len();
        let ask = |k: usize| store.twin(oracle, settings[k]);
        let asked = parallel::map(total, options.jobs, ask, &mut |done| progress("clean twins", done, total));
        for (name, asked) in wanted.keys().zip(asked) {
            twins.insert(name.clone(), asked?);
        }
        let answer = |setting: &Setting| twins.get(&setting.name("twin")).and_then(|asked| asked.answer.as_ref());
        for case in cases.iter_mut().filter(|case| waiting(&&**case)) {
            let shows = |twin: &Answer| case.ids.iter().all(|id| sizing::can_show(id, twin));
            if answer(&case.setting).is_some_and(shows) {
                continue;
            }
            // After the last, back to the first choice: the limit there is as good as any.
            let next = case.schemes.get(attempt + 1).or(case.schemes.first());
            case.setting.scheme = next.copied().unwrap_or(case.setting.scheme);
        }
    }
    Ok(twins)
}
