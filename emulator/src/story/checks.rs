//! What must have held for the story to be true.

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    pub what: String,
    pub held: bool,
    pub detail: String,
}

#[derive(Debug, Clone, Default)]
pub struct Checks(pub Vec<Check>);

impl Checks {
    pub fn note(&mut self, what: &str, held: bool, detail: impl Into<String>) {
        self.0.push(Check { what: what.to_owned(), held, detail: detail.into() });
    }

    #[must_use]
    pub fn all_held(&self) -> bool {
        self.0.iter().all(|check| check.held)
    }

    /// What did not hold, one sentence each.
    #[must_use]
    pub fn failed(&self) -> Vec<String> {
        self.0.iter().filter(|check| !check.held).map(|check| format!("{}: {}", check.what, check.detail)).collect()
    }

    pub fn print(&self) {
        println!("\nWhat must hold:");
        for Check { what, held, detail } in &self.0 {
            let mark = if *held { "ok    " } else { "FAILED" };
            println!("  {mark}  {what:<56} {detail}");
        }
    }
}
