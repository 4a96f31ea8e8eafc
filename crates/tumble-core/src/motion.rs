//! From samples to what the person did: still, turn or move.

pub mod block;
pub mod grain;
pub mod means;
pub mod path;
pub mod record;
pub mod segmenter;
pub(crate) mod standstill;
pub mod stillness;

pub use path::RevolutionCheck;

use crate::face::Face;

/// What the segmenter tells the procedure, in the order in which things happen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionEvent {
    /// It has come to rest. `face` is none for an oblique pose.
    StillBegan {
        /// Which axis is up.
        face: Option<Face>,
    },
    /// Right after [`Self::StillBegan`] where the move before stayed on one face and ended a whole number of turns from
    /// the first rest on it.
    TurnClosed {
        /// Which axis is up.
        face: Face,
        /// Heading change, rad, positive counter-clockwise as seen from above; by the gyroscope, not yet calibrated.
        angle_rad: f32,
    },
    /// Right after [`Self::StillBegan`] where the move before stayed on one face but is no whole turn.
    TurnOpen {
        /// Which axis is up.
        face: Face,
        /// As in [`Self::TurnClosed`].
        angle_rad: f32,
    },
    /// Every half second while it rests.
    StillHeld {
        /// Which axis is up.
        face: Option<Face>,
        /// How long so far, s.
        held_s: f32,
    },
    /// It moves again.
    StillEnded {
        /// Which axis was up.
        face: Option<Face>,
        /// How long it lasted, s.
        held_s: f32,
    },
    /// Every half second while it moves or trembles: how far from rest, 1 at the threshold.
    Moving {
        /// Largest test statistic over its threshold.
        excess: f32,
    },
    /// The session memory has no room left.
    TapeFull,
}
