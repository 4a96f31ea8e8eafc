//! The study's folder: recordings without labels, answers, and the seals, apart.
//!
//! ```text
//! recordings/NAME.csv      what the diagnosis sees
//! answers/NAME.json        what it said
//! seals/NAME.csv.seal      what was hidden; opened when all is answered
//! twins/NAME.json          answers for clean twins, whose detection limits set the effects' sizes
//! ```

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::StudyError;
use super::answer::Asked;
use super::ask::{self, Oracle};
use super::case::{Case, Setting};
use super::make;
use super::size::Size;
use crate::conceal::Seal;

/// The folder.
pub struct Store {
    root: PathBuf,
    /// Recordings stay when they are diagnosed.
    keep: bool,
    /// It goes when the study is over.
    passing: bool,
}

impl Store {
    /// In this folder, or in one that goes again.
    pub fn open(folder: Option<&Path>, keep: bool) -> Result<Self, StudyError> {
        let passing = folder.is_none();
        let aside = || std::env::temp_dir().join(format!("tumble-blind-{}", std::process::id()));
        let root = folder.map_or_else(aside, Path::to_path_buf);
        for part in ["recordings", "answers", "seals", "twins"] {
            let path = root.join(part);
            std::fs::create_dir_all(&path).map_err(|error| StudyError::file(&path, error))?;
        }
        Ok(Self { root, keep: keep && !passing, passing })
    }

    fn recording(&self, name: &str) -> PathBuf {
        self.root.join("recordings").join(format!("{name}.csv"))
    }

    fn answer(&self, name: &str) -> PathBuf {
        self.root.join("answers").join(format!("{name}.json"))
    }

    fn seal(&self, name: &str) -> PathBuf {
        self.root.join("seals").join(format!("{name}.csv"))
    }

    fn twin_answer(&self, setting: &Setting) -> PathBuf {
        self.root.join("twins").join(format!("{}.json", setting.name("twin")))
    }

    /// The answer for a clean twin.
    pub fn twin(&self, oracle: &Oracle, setting: &Setting) -> Result<Asked, StudyError> {
        let to = self.twin_answer(setting);
        if let Some(asked) = ask::read(&to) {
            return Ok(asked);
        }
        let path = self.recording(&setting.name("twin"));
        let made = make::make(setting, &[]).map_err(|error| StudyError::Plan(error.to_string()))?;
        made.recording.write_file(&path)?;
        let asked = oracle.ask(&path, &[], &to).map_err(|error| StudyError::file(&to, error))?;
        remove(&path)?;
        Ok(asked)
    }

    /// Makes, seals, asks.
    pub fn case(&self, oracle: &Oracle, case: &Case, sizes: impl FnOnce() -> Vec<Size>) -> Result<(), StudyError> {
        let (path, to) = (self.recording(&case.name), self.answer(&case.name));
        if ask::read(&to).is_some() && self.secret(&case.name).is_ok() {
            return Ok(());
        }
        // What was sealed once stays: sizes take a minute to find.
        let sealed =
            self.secret(&case.name).ok().and_then(|secret| serde_json::from_value(secret["sizes"].clone()).ok());
        let sizes: Vec<Size> = sealed.unwrap_or_else(sizes);
        let (recording, secret) = make::make_case(case, &sizes).map_err(StudyError::Plan)?;
        let mut bytes = Vec::new();
        recording.write(&mut bytes).map_err(|error| StudyError::file(&path, error))?;
        std::fs::write(&path, &bytes).map_err(|error| StudyError::file(&path, error))?;
        Seal::new(&bytes, &secret)?.write(&self.seal(&case.name))?;
        drop((recording, secret, bytes));
        oracle.ask(&path, case.without(), &to).map_err(|error| StudyError::file(&to, error))?;
        if self.keep { Ok(()) } else { remove(&path) }
    }

    /// Opens a seal.
    pub fn secret(&self, name: &str) -> Result<Value, StudyError> {
        Ok(Seal::secret(&crate::conceal::path_of(&self.seal(name)))?.1)
    }

    /// What was said of a recording.
    pub fn said(&self, name: &str) -> Result<Asked, StudyError> {
        let path = self.answer(name);
        ask::read(&path).ok_or_else(|| StudyError::Plan(format!("{}: no answer", path.display())))
    }

    /// Names of the recordings that have an answer.
    pub fn answered(&self) -> Result<Vec<String>, StudyError> {
        let folder = self.root.join("answers");
        let entries = std::fs::read_dir(&folder).map_err(|error| StudyError::file(&folder, error))?;
        let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
        let json = paths.filter(|path| path.extension().is_some_and(|extension| extension == "json"));
        let mut names: Vec<String> =
            json.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
        names.sort();
        Ok(names)
    }

    /// Answers of another build are of no use to somebody who changed the search.
    pub fn forget_answers(&self) -> Result<(), StudyError> {
        let folder = self.root.join("answers");
        std::fs::remove_dir_all(&folder)
            .and_then(|()| std::fs::create_dir_all(&folder))
            .map_err(|error| StudyError::file(&folder, error))
    }

    /// Writes a result beside all that, where the folder stays.
    pub fn write(&self, name: &str, text: &str) -> Result<(), StudyError> {
        if self.passing {
            return Ok(());
        }
        let path = self.root.join(name);
        std::fs::write(&path, text).map_err(|error| StudyError::file(&path, error))
    }
}

impl Drop for Store {
    fn drop(&mut self) {
        if self.passing {
            // In the system's folder for what may go: nobody is left to be told if it cannot.
            let _ = std::fs::remove_dir_all(&self.root);
        }
    }
}

fn remove(path: &Path) -> Result<(), StudyError> {
    std::fs::remove_file(path).map_err(|error| StudyError::file(path, error))
}
