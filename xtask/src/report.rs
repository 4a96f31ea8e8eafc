//! Steps with their names and seconds; the first that fails ends the run.

use std::time::{Duration, Instant};

use crate::Failure;

/// Keeps count of what was done.
pub struct Steps {
    done: Vec<(String, Duration, Outcome)>,
}

/// How a step ended, if it did not fail.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It passed.
    Passed,
    /// It could not be done here, and why.
    Skipped(String),
}

impl Steps {
    /// None yet.
    pub fn new() -> Self {
        Self { done: Vec::new() }
    }

    /// Does one step.
    pub fn step<T>(&mut self, name: &str, work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
        println!("\n==> {}. {name}", self.done.len() + 1);
        let started = Instant::now();
        match work() {
            Ok(value) => {
                self.done.push((name.into(), started.elapsed(), Outcome::Passed));
                Ok(value)
            }
            Err(failure) => {
                self.print(Some((name, started.elapsed())));
                Err(Failure { message: format!("step '{name}' failed: {}", failure.message), ..failure })
            }
        }
    }

    /// Says that a step cannot be done here.
    pub fn skip(&mut self, name: &str, why: &str) {
        println!("\n==> {}. {name}: skipped, {why}", self.done.len() + 1);
        self.done.push((name.into(), Duration::ZERO, Outcome::Skipped(why.into())));
    }

    /// The list, and the closing line that continuous integration reads.
    pub fn print(&self, failed: Option<(&str, Duration)>) {
        println!();
        for (name, took, outcome) in &self.done {
            match outcome {
                Outcome::Passed => println!("  passed  {:>7.1} s  {name}", took.as_secs_f64()),
                Outcome::Skipped(why) => println!("  skipped            {name}: {why}"),
            }
        }
        if let Some((name, took)) = failed {
            println!("  FAILED  {:>7.1} s  {name}", took.as_secs_f64());
        }
        let skipped = self.done.iter().filter(|(_, _, outcome)| *outcome != Outcome::Passed).count();
        let tail = if skipped > 0 { format!(", {skipped} skipped") } else { String::new() };
        println!("{} passed, {} failed{tail}", self.done.len() - skipped, usize::from(failed.is_some()));
    }
}
