//! What can be wrong with a configuration.

use core::fmt;

/// A configuration that cannot be simulated: which setting, and its value.
#[derive(Debug, Clone, PartialEq)]
pub struct SimError {
    /// The setting's name.
    pub setting: &'static str,
    /// The value it had.
    pub value: f64,
    /// What it must be.
    pub must_be: &'static str,
}

impl SimError {
    /// `Ok` if `value` is finite and satisfies `good`.
    ///
    /// # Errors
    /// Otherwise the error that names the setting.
    pub fn check(
        setting: &'static str,
        value: f64,
        good: impl Fn(f64) -> bool,
        must_be: &'static str,
    ) -> Result<(), Self> {
        if value.is_finite() && good(value) { Ok(()) } else { Err(Self { setting, value, must_be }) }
    }
}

impl fmt::Display for SimError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "simulation setting `{}` is {}: it must be {}", self.setting, self.value, self.must_be)
    }
}

impl std::error::Error for SimError {}
