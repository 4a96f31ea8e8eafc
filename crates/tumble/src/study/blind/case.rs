//! What is put to the test: drawn from the study's seed, and known to nobody before it is unsealed.

use tumble_sim::rng::{Purpose, Rng};
use tumble_sim::{Effect, Scheme};

use super::Options;

/// Poses of the oblique scheme: at 17 a nine-parameter fit has few to spare.
const POSES: usize = 24;
/// Effects that a person could well meet together.
pub const PAIRS: [[&str; 2]; 8] = [
    ["gyro_g_sensitivity", "gyro_warm_up"],
    ["accel_lever_arm", "gyro_accel_lag"],
    ["gyro_bias_temperature", "gyro_scale_temperature"],
    ["gyro_bias_random_walk", "gyro_g_sensitivity"],
    ["gyro_scale_cubic", "gyro_saturation"],
    ["accel_bias_temperature", "accel_scale_temperature"],
    ["accel_quadratic", "accel_bias_step"],
    ["gyro_scale_asymmetry", "gyro_bias_temperature"],
];
/// Effects of whole turns about a fixed axis, which oblique poses do not have.
const TURNS_ONLY: [&str; 3] = ["incomplete_turn", "spin_axis_wobble", "accel_lever_arm"];

/// Which question a case belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// One effect of the catalogue.
    Effect,
    /// None.
    Clean,
    /// One that is outside the catalogue.
    Foreign,
    /// One that this diagnosis was not to know.
    Removed,
    /// Two.
    Pair,
}

impl Group {
    /// As in the JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Effect => "effect",
            Self::Clean => "clean",
            Self::Foreign => "foreign",
            Self::Removed => "removed",
            Self::Pair => "pair",
        }
    }
}

/// The world in which a case happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// What the person does.
    pub scheme: Scheme,
    /// Of the world.
    pub seed: u64,
    /// Turns end by eye, and the box is put down by eye.
    pub by_hand: bool,
    /// The temperature moves by 3 to 8 °C; else by 0.2 to 0.8.
    pub swing: bool,
    /// Noise in motion over that at rest.
    pub noise: f64,
}

impl Setting {
    /// A name that tells nothing, the same for the same setting.
    pub fn name(&self, salt: &str) -> String {
        let Self { scheme, seed, by_hand, swing, noise } = self;
        neutral(&format!("{salt}|{}|{seed}|{by_hand}|{swing}|{noise}", scheme.name()))
    }
}

/// A recording to be made, but for its effects' sizes.
#[derive(Clone, Debug)]
pub struct Case {
    /// The question.
    pub group: Group,
    /// What is in it.
    pub ids: Vec<&'static str>,
    /// The schemes that may be used, the first choice first.
    pub schemes: Vec<Scheme>,
    /// The world; its scheme is the first choice.
    pub setting: Setting,
    /// Neutral: in the order of names, the cases are shuffled.
    pub name: String,
}

impl Case {
    fn new(options: &Options, group: Group, ids: Vec<&'static str>, number: u64) -> Option<Self> {
        let shows = |scheme: &Scheme| {
            let oblique = matches!(scheme, Scheme::MultiPose { .. });
            !(oblique && ids.iter().any(|id| TURNS_ONLY.contains(id)))
        };
        let mut schemes: Vec<Scheme> = options.schemes.iter().map(|name| scheme(name)).filter(shows).collect();
        let first = *schemes.get(number as usize % schemes.len().max(1))?;
        let count = schemes.len();
        schemes.rotate_left(number as usize % count);
        // Clean worlds are others than those with an effect.
        let clean = group == Group::Clean;
        let world = format!("{}|{clean}|{number}", options.seed);
        let (by_hand, swing) = if clean { (number / 2 % 2 == 1, number.is_multiple_of(2)) } else { (false, true) };
        let setting = Setting { scheme: first, seed: hash(&world) >> 1, by_hand, swing, noise: options.noise };
        let what = format!("{}|{}|{}|{:?}", group.word(), ids.join("+"), options.at, options.schemes);
        Some(Self { group, ids, schemes, setting, name: setting.name(&what) })
    }

    /// Whether sizes hang on what a clean twin could have shown.
    pub fn needs_twin(&self) -> bool {
        matches!(self.group, Group::Effect | Group::Removed | Group::Pair)
    }

    /// What the diagnosis is not to know.
    pub fn without(&self) -> &[&'static str] {
        if self.group == Group::Removed { &self.ids } else { &[] }
    }
}

fn scheme(name: &str) -> Scheme {
    match name {
        "single" => Scheme::Single,
        "multipose" => Scheme::MultiPose { poses: POSES },
        _ => Scheme::Double,
    }
}

/// All cases, in the order of their names: shuffled.
pub fn draw(options: &Options) -> Vec<Case> {
    let mut groups: Vec<(Group, Vec<&'static str>, usize)> = Vec::new();
    for kind in Effect::ALL.iter().filter(|kind| options.wants(kind.id)) {
        groups.push((Group::Effect, vec![kind.id], options.seeds));
        if options.removed {
            groups.push((Group::Removed, vec![kind.id], options.seeds));
        }
    }
    if options.foreign {
        let foreign = Effect::FOREIGN.iter().map(|kind| (Group::Foreign, vec![kind.id], options.seeds));
        groups.extend(foreign);
    }
    groups.extend(PAIRS.iter().map(|pair| (Group::Pair, pair.to_vec(), options.pairs)));
    groups.push((Group::Clean, Vec::new(), options.clean));
    let mut cases: Vec<Case> = groups
        .into_iter()
        .flat_map(|(group, ids, count)| (0..count as u64).map(move |number| (group, ids.clone(), number)))
        .filter_map(|(group, ids, number)| Case::new(options, group, ids, number))
        .collect();
    cases.sort_by(|a, b| a.name.cmp(&b.name));
    cases
}

/// A size from the effect's own range, for a case.
pub fn drawn(id: &str, seed: u64) -> Option<Effect> {
    let kind = Effect::kinds().find(|kind| kind.id == id)?;
    Some(Effect::drawn(kind, &mut Rng::new(seed ^ hash(id), Purpose::Effect)))
}

/// A name that tells nothing.
pub fn neutral(what: &str) -> String {
    format!("{:016x}", hash(what))
}

/// FNV-1a, stirred at the end so that neighbours do not sort together.
fn hash(text: &str) -> u64 {
    let fnv = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
    let mixed = text.bytes().fold(0xCBF2_9CE4_8422_2325, fnv);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}
