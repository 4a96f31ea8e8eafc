//! The accelerometer remembers the face before.
//!
//! `f_raw,i = … + h_i·m_i`, where `m_i` is the sign that `f_i` had when it last went beyond 0.7 g: with the axis level,
//! the reading depends on which side was up before. Friction and charge of the electrodes.
//!
//! Magnitude: the largest `|h_i|`, mg.

use crate::effect::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "x_accel_hysteresis",
    name: "accelerometer remembers the face before",
    meaning: "the largest of the axes' shifts",
    unit: "mg",
    default: 3.0,
    values: Values::Range(0.0, 200.0),
    draws: (1.0, 6.0),
    source: "0.02 to 0.2 % of the load: 0.2 to 2 mg",
    injects: true,
    make: |draw| {
        let memory = Vector3::from_fn(|_, _| draw.sign());
        Box::new(Hysteresis { mg: draw.spread(), memory })
    },
};

/// A load beyond which the axis takes on its sign, g.
const BEYOND_G: f64 = 0.7;

#[derive(Debug, Clone)]
struct Hysteresis {
    mg: Vector3<f64>,
    /// +1 or −1 for each axis.
    memory: Vector3<f64>,
}

impl Model for Hysteresis {
    fn analog(&mut self, at: &Instant, signal: &mut Signal) {
        for (memory, force) in self.memory.iter_mut().zip(at.ideal.specific_force_mps2.iter()) {
            if force.abs() > BEYOND_G * G {
                *memory = force.signum();
            }
        }
        signal.specific_force_mps2 += self.mg.component_mul(&self.memory) * MG;
    }

    fn parameters(&self) -> Vec<Parameter> {
        Parameter::xyz("shift", &self.mg, "mg")
    }
}
