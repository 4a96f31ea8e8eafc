//! What came out: of the estimate, of `verify`, of the self-test.

use core::fmt::{self, Write};

use super::words::{Maybe, degrees, yes};
use crate::STANDARD_GRAVITY_MPS2;
use crate::calibration::{Parameter, Verdict};
use crate::verify::{PoseCheck, Verification};

pub(super) fn result_human(verdict: Verdict, reasons: u8, w: &mut impl Write) -> fmt::Result {
    match (verdict, reasons) {
        (Verdict::Accepted, 0) => w.write_str("The calibration is good."),
        (Verdict::Accepted, _) => w.write_str("The calibration is good. For your information:"),
        (Verdict::AcceptedWithWarnings, _) => w.write_str("The calibration can be used, but know this:"),
        (Verdict::Rejected, _) => {
            w.write_str("The calibration is rejected and not stored; the one in flash, if any, is untouched. Why:")
        }
    }
}

/// `{:e}` gives the shortest digits that read back as the same `f32`. What is not observable gets no number.
pub(super) fn parameter_machine(p: &Parameter, w: &mut impl Write) -> fmt::Result {
    write!(w, "@param name={} value=", p.name)?;
    if p.observable {
        write!(w, "{:e}", p.value)?
    } else {
        w.write_str("-")?
    }
    w.write_str(" sigma=")?;
    match p.sigma.filter(|_| p.observable) {
        Some(sigma) => write!(w, "{sigma:e}")?,
        None => w.write_str("-")?,
    }
    write!(w, " unit={} observable={}", p.unit, yes(p.observable))
}

pub(super) fn parameter_human(p: &Parameter, w: &mut impl Write) -> fmt::Result {
    let unit = if p.unit == "1" { "" } else { p.unit };
    match (p.observable, p.sigma) {
        (false, _) => write!(w, "  {}: not observable in this session.", p.name),
        (true, Some(sigma)) => write!(w, "  {} = {:.6} +- {sigma:.6} {unit}", p.name, p.value),
        (true, None) => write!(w, "  {} = {:.2} {unit}", p.name, p.value),
    }
}

pub(super) fn pose_machine(pose: &PoseCheck, w: &mut impl Write) -> fmt::Result {
    write!(
        w,
        "@verify pose={} gravity_error_mg={:.2} level_error_deg=",
        pose.number,
        milli_g(pose.gravity_error_mps2)
    )?;
    match pose.level_error_rad {
        Some(level) => write!(w, "{:.3}", degrees(level))?,
        None => write!(w, "{}", Maybe::<f32>(None))?,
    }
    write!(
        w,
        " gravity_limit_mg={:.2} level_limit_deg={:.3}",
        milli_g(pose.gravity_limit_mps2),
        degrees(pose.level_limit_rad)
    )?;
    write!(w, " ok={}", yes(pose.ok()))
}

pub(super) fn pose_human(pose: &PoseCheck, w: &mut impl Write) -> fmt::Result {
    let (error, limit) = (milli_g(pose.gravity_error_mps2), milli_g(pose.gravity_limit_mps2));
    write!(w, "Pose {}: gravity is off by {error:.2} mg ({limit:.2} allowed)", pose.number)?;
    if let Some(level) = pose.level_error_rad {
        write!(
            w,
            ", level by {:.3} degrees after the move ({:.3} allowed)",
            degrees(level),
            degrees(pose.level_limit_rad)
        )?;
    }
    w.write_str(if pose.ok() { ": good." } else { ": too much." })
}

pub(super) fn verified_machine(v: &Verification, w: &mut impl Write) -> fmt::Result {
    write!(
        w,
        "@verified verdict={} poses={} gravity_rms_mg={:.2} level_max_deg={:.3} temperature_change_degc={:.1}",
        if v.pass { "pass" } else { "fail" },
        v.poses,
        milli_g(v.gravity_rms_mps2),
        degrees(v.level_max_rad),
        Maybe(v.temperature_change_degc)
    )
}

pub(super) fn verified_human(v: &Verification, w: &mut impl Write) -> fmt::Result {
    let (gravity, level) = (milli_g(v.gravity_rms_mps2), degrees(v.level_max_rad));
    if v.pass {
        return write!(
            w,
            "Verified: over {} fresh poses gravity is right to {gravity:.2} mg and level to {level:.3} degrees, as the \
             calibration's own sigmas promise.",
            v.poses
        );
    }
    write!(
        w,
        "Not verified: over {} fresh poses gravity is off by {gravity:.2} mg (rms) and level by up to {level:.3} degrees, more \
         than the calibration's own sigmas explain. ",
        v.poses
    )?;
    if let Some(change) = v.temperature_change_degc.filter(|_| v.is_temperature_suspect()) {
        write!(
            w,
            "The sensor is {change:+.1} degrees C away from where it was calibrated: calibrate at the temperature of use."
        )
    } else {
        w.write_str("If nothing shook the table, run \"verify\" once more, then \"calibrate\".")
    }
}

pub(super) fn self_test_human(axis: &str, response: f32, ok: bool, w: &mut impl Write) -> fmt::Result {
    let percent = response * 100.0;
    if ok {
        write!(w, "Self-test {axis}: {percent:.0} % of the factory's response, good.")
    } else {
        write!(
            w,
            "Self-test {axis}: {percent:.0} % of the factory's response, outside what the manufacturer allows. Leave the board \
             still, run \"selftest\" again, and if it stays so replace the sensor."
        )
    }
}

fn milli_g(force_mps2: f32) -> f32 {
    force_mps2 / STANDARD_GRAVITY_MPS2 * 1000.0
}
