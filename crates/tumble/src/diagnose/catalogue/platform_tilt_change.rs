//! The table's tilt changed once: `p += δ [t > t₀]`.

use super::{Card, DPS, Effect, Model, Variant, parameter};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::{Deed, Stretch};
use crate::diagnose::twin::influence::Influence;

const CARD: Card = Card {
    id: "platform_tilt_change",
    name: "the table was moved or gave way",
    equation: "table_normal += d * (t > t0)",
    typical: "0.05 to 1 deg when somebody leans on it",
    shows: "all faces after an instant stand at another angle than those before",
    confounded: &["accel_bias_step", "accel_bias_random_walk"],
    separate_by: "return to faces that were rested on before, and turn by half a turn: tilt turns with the table, a bias with the box",
};

/// In the catalogue.
pub const EFFECT: Effect = Effect { card: &CARD, model };

fn model(twin: &Twin) -> Model {
    if twin.noise.facet_sigma_rad.is_none() {
        return Model::Absent(
            "the box is not known to be square, so faces say nothing of the table: state `box: square` if it is",
        );
    }
    let begins = |stretch: &Stretch| twin.samples[stretch.samples.start].t_s;
    let variants = twin.stretches.iter().enumerate().filter(|(_, s)| matches!(s.deed, Deed::Move | Deed::Turn { .. }));
    let variants = variants.map(|(k, stretch)| {
        // The table is seen at the end of each rest: when it gave way between two of them, nothing tells.
        let seen = twin.stretches[k..].iter().find(|stretch| stretch.is_rest());
        let until_s = seen.map_or(begins(stretch), |rest| twin.samples[rest.samples.end - 1].t_s);
        variant(begins(stretch), 0.5 * (begins(stretch) + until_s))
    });
    Model::Shift(variants.collect())
}

fn variant(from_s: f64, at_s: f64) -> Variant {
    Variant {
        setting: Some(("at", at_s, "s")),
        parameters: vec![parameter("east", "deg", 0.5), parameter("north", "deg", 0.5)],
        influences: (0..2).map(|axis| Influence::Table(from_s, axis, DPS)).collect(),
        own: None,
        at_size: None,
    }
}
