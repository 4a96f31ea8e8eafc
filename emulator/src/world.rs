//! What the sensor asks of the physics behind it.

/// What the sensing elements put out at one instant, errors and noise included, in the sensor's own axes.
/// Specific force points up at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhysicalSample {
    pub angular_rate_rad_s: [f64; 3],
    pub specific_force_mps2: [f64; 3],
    pub temperature_degc: f64,
}

impl PhysicalSample {
    /// A level sensor that does not move, at 21 °C where the temperature register reads zero.
    #[must_use]
    pub fn at_rest() -> Self {
        Self {
            angular_rate_rad_s: [0.0; 3],
            specific_force_mps2: [0.0, 0.0, STANDARD_GRAVITY_MPS2],
            temperature_degc: 21.0,
        }
    }
}

pub const STANDARD_GRAVITY_MPS2: f64 = 9.806_65;

/// The world as the sensor feels it. Times are the board's virtual seconds since it was first powered, and
/// never go back.
pub trait SensorWorld: Send {
    /// What the elements put out at `t_s`.
    fn sample(&mut self, t_s: f64) -> PhysicalSample;

    /// When the next sample falls due after `after_s`: `None` leaves it to the chip's own sample clock. A replay
    /// answers the recording's own time-stamps, and infinity once it has no more.
    fn next_sample_time(&mut self, after_s: f64) -> Option<f64> {
        let _ = after_s;
        None
    }
}

/// A level sensor at rest for ever.
#[derive(Debug, Clone, Copy, Default)]
pub struct AtRest;

impl SensorWorld for AtRest {
    fn sample(&mut self, _t_s: f64) -> PhysicalSample {
        PhysicalSample::at_rest()
    }
}
