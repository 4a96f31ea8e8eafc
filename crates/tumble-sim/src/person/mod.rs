//! The simulated person.
