//! What the person states about the table, the box and the time they have.

use serde::{Deserialize, Serialize};

/// How a turn ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum TurnStops {
    /// Against a stop, good to about 0.1°: the closure is evidence for the scale.
    Fenced,
    /// By eye, ±2°: trusted as exact it would ruin the scale by 1980 ppm, so its closure carries that sigma.
    #[default]
    ByHand,
}

/// What is known of the box around the sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum BoxFaces {
    /// Its faces are square to each other, so they define the axes of the compensated data.
    Square,
    /// Nothing; the accelerometer defines the axes.
    #[default]
    Unknown,
}

/// How many turns are asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scheme {
    /// Both directions on every face: 194 s reach 25 ppm of scale, and bias drift cancels (design §2). Recommended.
    #[default]
    Double,
    /// One turn on every face: 43.6 ppm. All in the same direction as seen from above, which gives the two faces of an
    /// axis opposite signs in the sensor's frame and so cancels what of the bias drift is linear.
    Single,
}

/// A session's setup; the defaults are the cautious ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setup {
    /// How a turn ends.
    pub stops: TurnStops,
    /// What is known of the box.
    pub box_faces: BoxFaces,
    /// How many turns are asked for.
    pub scheme: Scheme,
}

impl Setup {
    /// The default, for constants.
    pub const CAUTIOUS: Self = Self { stops: TurnStops::ByHand, box_faces: BoxFaces::Unknown, scheme: Scheme::Double };
}

impl TurnStops {
    /// `fenced` or `by-hand`, as on the console and in a recording's metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fenced => "fenced",
            Self::ByHand => "by-hand",
        }
    }
}

impl BoxFaces {
    /// `square` or `unknown`, as on the console and in a recording's metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Unknown => "unknown",
        }
    }
}

impl Scheme {
    /// `double` or `single`, as on the console.
    pub fn name(self) -> &'static str {
        match self {
            Self::Double => "double",
            Self::Single => "single",
        }
    }
}
