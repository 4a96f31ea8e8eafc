//! Recordings that hide something, or nothing: a test that the person can put to the diagnosis, and to themselves.
//!
//! Every concealed recording is drawn alike: nuisances, a temperature that moves, counts, now and then a low rate. What
//! is hidden therefore shows by its physics alone. What it was stands in a sealed file beside the recording ([`Seal`]).

mod seal;

pub use seal::{Opened, Seal, SealError, path_of};

use std::hash::{BuildHasher as _, Hasher as _, RandomState};

use serde::Serialize;
use tumble_sim::effect::Kind;
use tumble_sim::rng::{Purpose, Rng};
use tumble_sim::{Effect, SchemeConfig, Truth};

use crate::recording::Recording;
use crate::simulate::{Plan, PlanError, SchemeName, make};

/// One recording in so many hides nothing, and one in so many something that is outside the catalogue.
const ONE_IN: usize = 6;

/// What is sealed.
#[derive(Debug, Serialize)]
pub struct Secret {
    /// `tumble-secret`.
    pub format: &'static str,
    /// 1.
    pub version: u32,
    /// `effect` or `nothing`.
    pub hidden: &'static str,
    /// Everything that was drawn, the effect with its parameters among it.
    pub truth: Truth,
}

/// A recording and what it hides.
pub struct Concealed {
    /// What anyone may see.
    pub recording: Recording,
    /// What only [`Seal`] is told.
    pub secret: Secret,
}

/// Draws what is to be hidden by the plan's seed, and makes the recording. The plan's own effects are not used.
pub fn conceal(plan: &Plan) -> Result<Concealed, PlanError> {
    let mut rng = Rng::new(plan.seed ^ 0x5EA1_ED00, Purpose::Effect);
    let effect = hidden(plan, &mut rng);
    let mut config = Plan { nuisance: true, effects: effect.into_iter().collect(), ..plan.clone() }.config()?;
    config.add_temperature_swing();
    config.averaged = averaging(&config, effect, &mut rng);
    let made = make(&config)?;
    let hidden = if effect.is_some() { "effect" } else { "nothing" };
    let secret = Secret { format: "tumble-secret", version: 1, hidden, truth: made.truth };
    Ok(Concealed { recording: made.recording, secret })
}

/// A seed that nobody knows: the standard library keys its hash maps from the system's entropy.
pub fn any_seed() -> u64 {
    RandomState::new().build_hasher().finish()
}

/// The effect, if there is one. Some would do nothing in some recordings: they are not drawn there.
fn hidden(plan: &Plan, rng: &mut Rng) -> Option<Effect> {
    let draw = rng.index(ONE_IN);
    if draw == 0 {
        return None;
    }
    let turns = !matches!(plan.scheme, SchemeName::Multipose | SchemeName::Tumble);
    let fenced = plan.by_hand != Some(true);
    let shows = |kind: &Kind| match kind.id {
        "incomplete_turn" => turns && fenced,
        "spin_axis_wobble" => turns,
        _ => true,
    };
    let among: Vec<&'static Kind> =
        if draw == 1 { Effect::FOREIGN } else { Effect::ALL }.iter().copied().filter(|kind| shows(kind)).collect();
    among.get(rng.index(among.len())).map(|kind| Effect::drawn(kind, rng))
}

/// How many samples the recorder averages. Were every other recording at the full rate, the low rate alone would give
/// undersampling away. Coarse steps would be averaged away, and stay at the full rate.
fn averaging(config: &SchemeConfig, effect: Option<Effect>, rng: &mut Rng) -> usize {
    let id = effect.map_or("", |effect| effect.id());
    let Some(kind) = Effect::ALL.iter().find(|kind| kind.id == "undersampling") else { return 1 };
    let slow = rng.index(ONE_IN) == 0 && id != "undersampling" && id != "gyro_coarse_quantization";
    if !slow {
        return 1;
    }
    let wanted_hz = Effect::drawn(kind, rng).magnitude();
    ((config.world.sensor.rate_hz / wanted_hz).round() as usize).clamp(1, 1000)
}
