//! The table's tilt changed once: `p += δ [t > t₀]`.

use super::{Card, DPS, Effect, Model, Variant, parameter};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
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
    // Between two rests on the table: where a motion begins.
    let times = twin.stretches.iter().filter(|stretch| matches!(stretch.deed, Deed::Move | Deed::Turn { .. }));
    let variant = |from_s: f64| Variant {
        setting: Some(("at", from_s, "s")),
        parameters: vec![parameter("east", "deg", 0.5), parameter("north", "deg", 0.5)],
        influences: (0..2).map(|axis| Influence::Table(from_s, axis, DPS)).collect(),
    };
    Model::Shift(times.map(|stretch| variant(twin.samples[stretch.samples.start].t_s)).collect())
}
