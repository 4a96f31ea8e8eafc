//! Axes are not what their names say.
//!
//! Two columns of one triad are exchanged, or one has the wrong sign: `raw ↦ P·raw` of everything, bias and noise
//! included. Usual where accelerometer and gyro come from different drivers or a board's print is wrong. Either makes a
//! left-handed triad.
//!
//! Magnitude: the variant: 1 two gyro axes exchanged, 2 one gyro axis reversed, 3 two accelerometer axes exchanged, 4
//! one accelerometer axis reversed. Which axes is drawn.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "axis_mapping",
    name: "axes exchanged or reversed",
    meaning: "1 gyro axes exchanged, 2 gyro axis reversed, 3 accelerometer axes exchanged, 4 accelerometer axis reversed",
    unit: "variant",
    default: 1.0,
    values: Values::Whole(1, 4),
    draws: (1.0, 4.0),
    source: "drivers and board prints",
    injects: true,
    make: |draw| Box::new(Mapping { variant: draw.magnitude as u8, axis: draw.axis() }),
};

#[derive(Debug, Clone)]
struct Mapping {
    variant: u8,
    /// The reversed one, or the one that stays.
    axis: usize,
}

impl Model for Mapping {
    fn converter(&mut self, _: &Instant, signal: &mut Signal) {
        let triad = if self.variant <= 2 { &mut signal.angular_rate_rad_s } else { &mut signal.specific_force_mps2 };
        if self.variant % 2 == 1 {
            triad.swap_rows((self.axis + 1) % 3, (self.axis + 2) % 3);
        } else {
            triad[self.axis] = -triad[self.axis];
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let name = if self.variant % 2 == 1 { "axis_that_stays" } else { "axis_reversed" };
        let triad = if self.variant <= 2 { 0.0 } else { 1.0 };
        vec![
            Parameter::new(name, self.axis as f64, "0 x, 1 y, 2 z"),
            Parameter::new("triad", triad, "0 gyro, 1 accelerometer"),
        ]
    }
}
