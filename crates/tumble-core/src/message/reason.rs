//! Why a calibration is rejected or accepted with warnings: what, by how much, and what to do.

use core::fmt::{self, Display};

use super::words::{all_faces, axis, degrees};
use crate::calibration::Reason;
use crate::face::{Face, FaceSet};

impl Reason {
    /// A word for the machine line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::FacesMissing { .. } => "faces_missing",
            Self::TurnsMissing { .. } => "turns_missing",
            Self::Clipped { .. } => "clipped",
            Self::OutOfRange { .. } => "out_of_range",
            Self::PoorFit { .. } => "poor_fit",
            Self::Unsettled { .. } => "unsettled",
            Self::NotObservable { .. } => "not_observable",
            Self::Uncertain { .. } => "uncertain",
            Self::BiasDrift { .. } => "bias_drift",
            Self::BiasJump { .. } => "bias_jump",
            Self::CrookedBox { .. } => "crooked_box",
            Self::LooseContact { .. } => "loose_contact",
            Self::SegmentExcluded { .. } => "segment_excluded",
            Self::SamplesLost { .. } => "samples_lost",
            Self::Arithmetic { .. } => "arithmetic",
        }
    }

    /// The face to do again, where the reason itself tells. A name like `gyro_correction_xy` leads to its last axis: that
    /// column is what a turn about that axis, or a rest on it, determines.
    pub fn face_to_redo(&self) -> Option<Face> {
        let up = |axis: u32| [Face::PlusX, Face::PlusY, Face::PlusZ].get(axis as usize).copied();
        match self {
            Self::FacesMissing { missing } => super::words::ordered(*missing).next(),
            Self::TurnsMissing { axes } => up(axes.trailing_zeros()),
            Self::Clipped { channel, .. } => up(u32::from(*channel) % 3),
            Self::OutOfRange { name, .. } | Self::NotObservable { name } | Self::Uncertain { name, .. } => {
                match name.as_bytes() {
                    [.., b'x'] => up(0),
                    [.., b'y'] => up(1),
                    [.., b'z'] => up(2),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

/// The sentence.
impl Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FacesMissing { missing } => faces_missing(*missing, f),
            Self::TurnsMissing { axes } => turns_missing(*axes, f),
            Self::Clipped { channel, samples } => clipped(*channel, *samples, f),
            Self::OutOfRange { .. } | Self::NotObservable { .. } | Self::Uncertain { .. } => parameter(self, f),
            Self::PoorFit { nis_per_dof } => write!(
                f,
                "The data do not fit together: residuals are {nis_per_dof:.1} times (squared) what the noise explains. Use a firm \
                 table, let go fully at each rest, keep the box flat in turns, and calibrate again."
            ),
            Self::Unsettled { sigmas } => write!(
                f,
                "The estimate did not settle: a number still moved by {sigmas:.0} times its uncertainty. The data contradict each other \
                 or hardly tell the axes apart. Use a firm table, turn the box fully on each face, and calibrate again."
            ),
            Self::BiasDrift { axis: i, drift_rad_s } => write!(
                f,
                "The gyroscope's {} axis drifted by {:.3} degrees per second during the session. Let the board warm up for ten \
                 minutes, out of draughts, and calibrate again.",
                axis(usize::from(*i)),
                degrees(*drift_rad_s)
            ),
            Self::BiasJump { axis: i, jump_rad_s } => write!(
                f,
                "The gyroscope's {} axis jumped by {:.2} degrees per second during the session. The biases are those after it. Keep the board \
                 from knocks and draughts and check its supply; if it jumps again, its biases do not last.",
                axis(usize::from(*i)),
                degrees(*jump_rad_s)
            ),
            Self::CrookedBox { facet_rad } => write!(
                f,
                "The box was called square, but its faces are {:.2} degrees off: the axes are only as true as that. Calibrate \
                 again without \"square\", or with a better box.",
                degrees(*facet_rad)
            ),
            Self::LooseContact { lean_rad } => write!(
                f,
                "The box leaned {:.2} degrees differently from rest to rest on the same face, which makes axes less certain. \
                 Use a firm, even table.",
                degrees(*lean_rad)
            ),
            Self::SegmentExcluded { segment, nis_per_dof } => write!(
                f,
                "Step {segment} of the recording does not fit the rest ({nis_per_dof:.1} times the noise, squared) and was left out; \
                 probably a knock. Redo that face if you want its data."
            ),
            Self::SamplesLost { samples } => write!(
                f,
                "{samples} samples were lost. Check the wires to the sensor (short and firm), then calibrate again."
            ),
            Self::Arithmetic { place } => write!(
                f,
                "The computation broke down at {place}. Nothing was stored. Calibrate again; if it happens again, record the session \
                 with \"record\" and report it."
            ),
        }
    }
}

/// What is wrong with one number.
fn parameter(reason: &Reason, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    match reason {
        Reason::OutOfRange { name, value, limit } => write!(
            f,
            "{name} is {value:.4}, beyond the {limit:.4} of a healthy sensor. Check that the box lay flat on every face and \
             turned a full 360 degrees; if it stays so, the sensor is damaged."
        ),
        Reason::NotObservable { name } => write!(
            f,
            "{name} cannot be determined from this session. Turns on the faces of that axis would tell; where only a \
             square box can tell, say \"calibrate square\" if yours is; if that was said, rests did not lie flat on their faces."
        ),
        Reason::Uncertain { name, sigma, limit } => write!(
            f,
            "{name} is only known to {sigma:.2e}, and {limit:.2e} is needed. Redo the faces of that axis with turns both ways \
             and longer rests."
        ),
        _ => Ok(()),
    }
}

fn clipped(channel: u8, samples: u32, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let (sensor, remedy) = if channel < 3 {
        ("gyroscope", "Turn more slowly.")
    } else {
        ("accelerometer", "Lay the box down more gently.")
    };
    let axis = axis(usize::from(channel) % 3);
    write!(f, "The {sensor}'s {axis} axis stood at the end of its range for {samples} samples. {remedy}")
}

fn faces_missing(missing: FaceSet, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let faces = all_faces(missing);
    write!(f, "No usable rest on {faces}. Lay the box on each of them and let go for three seconds.")
}

fn turns_missing(axes: u8, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    f.write_str("No usable full turn about ")?;
    let mut gap = "";
    for i in (0..3).filter(|i| axes >> i & 1 == 1) {
        write!(f, "{gap}{}", axis(i))?;
        gap = ", ";
    }
    f.write_str(". Lay the box with that arrow up or down and turn it once around, then let go.")
}
