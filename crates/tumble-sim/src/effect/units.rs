//! Units of magnitudes, in SI.

/// rad/s in a degree per second.
pub(super) const DPS: f64 = core::f64::consts::PI / 180.0;
/// m/s² in a thousandth of g.
pub(super) const MG: f64 = 1e-3 * crate::STANDARD_GRAVITY_MPS2;
/// A millionth.
pub(super) const PPM: f64 = 1e-6;
