//! The accelerometer's three axes feel at three points.
//!
//! `f_i = … + [ω̇ × d_i + ω × (ω × d_i)]_i` with `d_i` from the sensor's nominal place to where its axis `i` feels.
//! Within one die 0.1 to 2 mm; boards that carry single-axis parts have 5 to 20 mm (the "size effect" of inertial
//! units). What a full turn in 10 s shows of them is small: 0.4 mg for 10 mm, so that a session by hand sees 50 mm at
//! best. That is the size of a unit built of separate boards, and the default is twice that.
//!
//! Magnitude: the length of the longest `d_i`, mm; the others have 30 to 100 % of it, every one with its own direction.

use super::prelude::*;

pub(super) static KIND: Kind = Kind {
    id: "accel_internal_lever_arms",
    name: "accelerometer axes feel at different points",
    meaning: "the longest of the three axes' offsets",
    unit: "mm",
    default: 100.0,
    values: Values::Range(0.0, 500.0),
    draws: (100.0, 300.0),
    source: "size effect: 0.1 to 2 mm within a die, 5 to 20 mm between single-axis parts",
    injects: false,
    make: |draw| {
        let sizes = draw.spread();
        Box::new(Offsets { mm: [0, 1, 2].map(|i| draw.rng.direction() * sizes[i].abs()) })
    },
};

#[derive(Debug, Clone)]
struct Offsets {
    mm: [Vector3<f64>; 3],
}

impl Model for Offsets {
    fn ideal(&self, at: &Instant, ideal: &mut Ideal) {
        let (rate, accel) = (at.ideal.angular_rate_rad_s, at.angular_acceleration_rad_s2);
        for (axis, mm) in self.mm.iter().enumerate() {
            let offset = mm * 1e-3;
            let there = accel.cross(&offset) + rate.cross(&rate.cross(&offset));
            ideal.specific_force_mps2[axis] += there[axis];
        }
    }

    fn parameters(&self) -> Vec<Parameter> {
        let names = ["offset_of_x", "offset_of_y", "offset_of_z"];
        names.iter().zip(&self.mm).flat_map(|(name, mm)| Parameter::xyz(name, mm, "mm")).collect()
    }
}
