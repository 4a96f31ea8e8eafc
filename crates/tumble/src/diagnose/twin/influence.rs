//! What a unit of a candidate's parameter does to a recording: the one interface between an effect and the twin.

use nalgebra::Vector3;

use super::trajectory::Moment;

/// What is added to a raw reading at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Push {
    /// rad/s, sensor axes.
    pub rate: Vector3<f64>,
    /// m/s², sensor axes.
    pub force: Vector3<f64>,
}

impl Push {
    /// Does it add nothing?
    pub fn is_nothing(&self) -> bool {
        self.rate == Vector3::zeros() && self.force == Vector3::zeros()
    }

    /// On the gyroscope alone.
    pub fn rate(rate: Vector3<f64>) -> Self {
        Self { rate, force: Vector3::zeros() }
    }

    /// On the accelerometer alone.
    pub fn force(force: Vector3<f64>) -> Self {
        Self { rate: Vector3::zeros(), force }
    }

    /// On one channel: 0–2 gyroscope, 3–5 accelerometer.
    pub fn channel(channel: usize, value: f64) -> Self {
        let mut push = Self { rate: Vector3::zeros(), force: Vector3::zeros() };
        if channel < 3 {
            push.rate[channel] = value;
        } else {
            push.force[channel - 3] = value;
        }
        push
    }
}

/// What an effect adds to a reading, per unit of its parameter.
pub type Reading = Box<dyn Fn(&Moment) -> Push + Send + Sync>;

/// How a candidate's unit shows. The last number of each is SI per unit.
pub enum Influence {
    /// In the readings, as smoothly as hands move.
    Reading(Reading),
    /// In the readings, so abruptly that every sample counts: with the sign of a trembling rate, say.
    EverySample(Reading),
    /// Whole turns (by their stretch) end this much short, rad.
    Stop(Vec<(usize, f64)>),
    /// The table's normal leans along axis 0 or 1 of frame n from a time on (s), rad.
    Table(f64, usize, f64),
    /// The Earth's rate along an axis of frame n, rad/s.
    Earth(usize, f64),
    /// A lever arm common to all turns along an axis of frame b, m.
    Lever(usize, f64),
}

impl Influence {
    /// What it adds to a reading, if that is how it shows.
    pub fn reading(&self) -> Option<&Reading> {
        match self {
            Self::Reading(reading) | Self::EverySample(reading) => Some(reading),
            _ => None,
        }
    }

    /// The same at every sample.
    #[must_use]
    pub fn at_every_sample(self) -> Self {
        match self {
            Self::Reading(reading) => Self::EverySample(reading),
            other => other,
        }
    }
}
