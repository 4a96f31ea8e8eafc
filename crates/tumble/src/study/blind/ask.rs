//! One diagnosis by a process of its own, which is given a recording's path and nothing else.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::answer::Asked;

/// How often a running process is looked at.
const GLANCE: Duration = Duration::from_millis(20);
/// Of what it says on standard error, the last characters are kept.
const KEPT: usize = 600;

/// Who is asked.
#[derive(Clone, Debug)]
pub struct Oracle {
    /// The program: this one, as it is on the disk.
    pub program: PathBuf,
    /// A process that takes longer is ended.
    pub patience: Duration,
}

impl Oracle {
    /// Asks for a diagnosis and keeps the answer in `to`; an answer that is there already is read instead.
    pub fn ask(&self, recording: &Path, without: &[&str], to: &Path) -> std::io::Result<Asked> {
        if let Some(asked) = read(to) {
            return Ok(asked);
        }
        let (out, err) = (to.with_extension("out"), to.with_extension("err"));
        let started = Instant::now();
        let mut command = Command::new(&self.program);
        command.arg("diagnose").arg(recording).arg("--json");
        without.iter().for_each(|id| {
            command.args(["--without", id]);
        });
        let child = command.stdin(Stdio::null()).stdout(File::create(&out)?).stderr(File::create(&err)?).spawn()?;
        let ended = wait(child, self.patience)?;
        let seconds = started.elapsed().as_secs_f64();
        let diagnosis: Option<Value> = serde_json::from_slice(&std::fs::read(&out)?).ok();
        let said = String::from_utf8_lossy(&std::fs::read(&err)?).into_owned();
        let trouble = match ended {
            Some(status) if status.success() && diagnosis.is_some() => String::new(),
            Some(status) => format!("{status}: {}", tail(said.trim())),
            None => format!("ended after {:.0} s", self.patience.as_secs_f64()),
        };
        let object = json!({ "seconds": seconds, "trouble": trouble, "diagnosis": diagnosis });
        // First whole, then under its name: a study that is ended leaves no half an answer.
        std::fs::write(&out, object.to_string())?;
        std::fs::rename(&out, to)?;
        std::fs::remove_file(&err)?;
        Ok(asked(&object))
    }
}

/// None if it had to be ended.
fn wait(mut child: Child, patience: Duration) -> std::io::Result<Option<ExitStatus>> {
    let started = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if started.elapsed() > patience {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(GLANCE);
    }
}

fn tail(text: &str) -> String {
    let skip = text.chars().count().saturating_sub(KEPT);
    text.chars().skip(skip).collect()
}

/// An answer from an earlier run.
pub fn read(path: &Path) -> Option<Asked> {
    let object: Value = serde_json::from_slice(&std::fs::read(path).ok()?).ok()?;
    Some(asked(&object))
}

fn asked(object: &Value) -> Asked {
    let answer = serde_json::from_value(object["diagnosis"].clone()).ok();
    let mut trouble = object["trouble"].as_str().unwrap_or_default().to_owned();
    if answer.is_none() && trouble.is_empty() {
        trouble = "the answer is not the contract's object".into();
    }
    Asked { seconds: object["seconds"].as_f64().unwrap_or(0.0), answer, trouble }
}
