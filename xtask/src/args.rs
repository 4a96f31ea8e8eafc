//! The command line. By hand: a parser crate would double what a bare machine builds first.

use crate::Failure;
use crate::toolchain::Choice;

/// For `help` and for wrong usage.
pub const USAGE: &str = "\
usage: cargo xtask [--toolchain auto|debian] TASK [ARGUMENTS]

  setup   make sure that firmware for the board can be built on this machine
  demo    set-up, then the whole story on the emulated board; arguments are passed on:
          --seed N  --by-hand  --verbose  --json  --replay REC.csv
  test    set-up, then every check and test
  size    set-up, then flash, RAM and stack of the firmware
  bench   set-up, then exact instruction counts on the emulated core, and the firmware's size

TUMBLE_TOOLCHAIN=debian in the environment does what --toolchain debian does: build the firmware with Debian's
rustc-web and its library sources instead of a rustup target.";

/// What to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    Help,
    Setup,
    Demo,
    Test,
    Size,
    Bench,
}

/// The whole command line.
#[derive(Debug, PartialEq, Eq)]
pub struct Arguments {
    /// What to do.
    pub task: Task,
    /// How firmware is built.
    pub toolchain: Choice,
    /// For the task, which checks them itself.
    pub rest: Vec<String>,
}

impl Arguments {
    /// Reads the words after `cargo xtask`.
    pub fn parse(words: impl Iterator<Item = String>) -> Result<Self, Failure> {
        let from_environment = std::env::var("TUMBLE_TOOLCHAIN").ok();
        Self::parse_with(words, from_environment.as_deref())
    }

    fn parse_with(mut words: impl Iterator<Item = String>, environment: Option<&str>) -> Result<Self, Failure> {
        let mut toolchain = environment.map_or(Ok(Choice::Auto), choice)?;
        let mut task = None;
        let mut rest = Vec::new();
        while let Some(word) = words.next() {
            if word == "--toolchain" {
                toolchain = choice(&words.next().ok_or_else(|| usage("--toolchain needs a value: auto or debian"))?)?;
            } else if task.is_none() {
                task = Some(task_named(&word)?);
            } else {
                rest.push(word);
            }
        }
        let task = task.ok_or_else(|| usage("which task?"))?;
        if !rest.is_empty() && !matches!(task, Task::Demo | Task::Bench) {
            return Err(usage(&format!("'{}' is one word too many", rest[0])));
        }
        Ok(Self { task, toolchain, rest })
    }
}

fn task_named(word: &str) -> Result<Task, Failure> {
    Ok(match word {
        "help" | "--help" | "-h" => Task::Help,
        "setup" => Task::Setup,
        "demo" => Task::Demo,
        "test" => Task::Test,
        "size" => Task::Size,
        "bench" => Task::Bench,
        _ => return Err(usage(&format!("there is no task '{word}'"))),
    })
}

fn choice(word: &str) -> Result<Choice, Failure> {
    match word {
        "auto" => Ok(Choice::Auto),
        "debian" => Ok(Choice::Debian),
        _ => Err(usage(&format!("'{word}' is no toolchain: auto or debian"))),
    }
}

fn usage(what: &str) -> Failure {
    Failure { message: format!("{what}\n\n{USAGE}"), status: 2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str, environment: Option<&str>) -> Result<Arguments, Failure> {
        Arguments::parse_with(line.split_whitespace().map(String::from), environment)
    }

    #[test]
    fn words_reach_their_task() {
        let demo = parse("demo --seed 3 --by-hand", None).unwrap_or_else(|f| panic!("{}", f.message));
        assert_eq!((demo.task, demo.toolchain, demo.rest.len()), (Task::Demo, Choice::Auto, 3));
        let test = parse("--toolchain debian test", None).unwrap_or_else(|f| panic!("{}", f.message));
        assert_eq!((test.task, test.toolchain), (Task::Test, Choice::Debian));
        let size = parse("size", Some("debian")).unwrap_or_else(|f| panic!("{}", f.message));
        assert_eq!((size.task, size.toolchain), (Task::Size, Choice::Debian));
    }

    #[test]
    fn wrong_words_are_usage_errors() {
        for line in ["", "dance", "test --seed 1", "test --toolchain", "--toolchain gcc test"] {
            assert_eq!(parse(line, None).err().map(|f| f.status), Some(2), "{line}");
        }
    }
}
