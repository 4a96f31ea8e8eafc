//! The paper's two-step method on simulated recordings: truth is recovered, sigmas are honest, `f32` is enough.
//!
//! `cargo test -p host-tests --test two_step -- --nocapture` prints the figures.

mod session;
mod statistics;

use session::{FENCED, SessionTape, session};
use statistics::{print, run, study};
use tumble_core::estimate::two_step::{Outcome, Variant, estimate};
use tumble_sim::scheme::TurnOrder;
use tumble_sim::{Scheme, SchemeConfig};

/// Rms of Table 1's non-orthogonalities, −0.45° and 0.65°: 9.8 mrad.
const PAPER_K: f64 = 9.757e-3;

fn opposite(seed: u64) -> SchemeConfig {
    SchemeConfig { turns: TurnOrder::SameFromAbove, ..SchemeConfig::new(Scheme::Single, seed) }
}

fn double(seed: u64) -> SchemeConfig {
    SchemeConfig::new(Scheme::Double, seed)
}

#[test]
fn corrected_recovers_the_papers_truth_to_one_percent_of_k() {
    let groups = study(SchemeConfig::paper, 24, Variant::Corrected);
    print("paper, corrected, 24 seeds", &groups);
    assert!(groups["K"].rms() < 0.01 * PAPER_K, "{:e}", groups["K"].rms());
    assert!(groups["gyro scale"].rms() < 1e-4);
    // Exact stops, where a fence was assumed: its sigma is then too large, and nothing else is far from the truth.
    for name in ["K", "K by closed form", "accel bias", "accel scale", "accel cross", "gyro bias"] {
        let z2 = groups[name].z2();
        assert!((0.5..1.5).contains(&z2), "{name}: {z2}");
    }
}

#[test]
fn sigmas_are_honest_with_a_lever_arm_and_a_fence() {
    for (title, config) in [("single, lever arm", opposite as fn(u64) -> _), ("double, lever arm", double)] {
        let groups = study(config, 24, Variant::Corrected);
        print(&format!("{title}, corrected, 24 seeds"), &groups);
        assert!(groups["K"].rms() < 1e-4, "{:e}", groups["K"].rms());
        for (name, group) in groups.iter().filter(|group| *group.0 != "nis") {
            assert!((0.4..1.6).contains(&group.z2()), "{title} {name}: {}", group.z2());
        }
    }
}

/// Published: K errors of 8 to 21 mrad (12.6 rms), larger than the truth left uncalibrated; scale −0.136 %.
#[test]
fn literal_reproduces_the_published_pattern() {
    let groups = study(SchemeConfig::paper, 5, Variant::Literal);
    print("paper, literal, 5 seeds", &groups);
    assert!((5e-3..25e-3).contains(&groups["K"].rms()), "{:e}", groups["K"].rms());
    let slip = 1.0 / 1.5f64.to_radians().cos() - 1.0;
    assert!((groups["gyro scale"].rms() - slip).abs() < 0.3 * slip, "{:e}", groups["gyro scale"].rms());
}

/// K follows the accelerometer: what step 1 leaves of the tilt goes into it one to one.
#[test]
fn an_accelerometer_error_leaks_into_k_one_to_one() {
    let (tape, truth) = session(&SchemeConfig::paper(3));
    let outcome = run(&tape, Variant::Literal);
    let accel = outcome.first.accelerometer().triad.correction;
    for (k, (i, j)) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)].into_iter().enumerate() {
        let left = f64::from(accel[(i, j)]) - truth.accel[(i, j)];
        let found = outcome.correction[(i, j)] - truth.gyro[(i, j)];
        let leak = found / left;
        // E of the corrected data is the correction's own error.
        let predicted = outcome.leak[(k, 4 * i + 1 + j)];
        println!("k{}{}: left {left:.2e} found {found:.2e} factor {leak:.3} predicted {:.3}", i + 1, j + 1, predicted);
        assert!((0.9..1.05).contains(&predicted), "{predicted}");
        assert!((found - predicted * left).abs() < 6e-4, "{found} {left}");
    }
}

#[test]
fn traditional_is_far_worse_than_corrected() {
    let groups = study(SchemeConfig::paper, 5, Variant::Traditional);
    print("paper, traditional, 5 seeds", &groups);
    assert!(groups["K"].rms() > 1e-3 && groups["gyro scale"].rms() > 1e-3);
    assert!(groups["nis"].rms().is_finite());
}

fn difference(tape: &SessionTape, variant: Variant) -> [f64; 3] {
    let single: Outcome<f32> = estimate(tape, &FENCED, variant).expect("a whole session");
    let double = run(tape, variant);
    let k = (single.gyro.cast::<f64>() - double.gyro).amax();
    let scale = (single.correction.cast::<f64>() - double.correction).diagonal().amax();
    let sigma = (0..6).fold(0.0f64, |largest, k| {
        let ratio = f64::from(single.gyro_covariance[(k, k)]) / double.gyro_covariance[(k, k)];
        largest.max((ratio.sqrt() - 1.0).abs())
    });
    [k, scale, sigma]
}

#[test]
fn f32_is_enough() {
    let mut largest = [0.0f64; 3];
    for seed in 1..=8 {
        for config in [SchemeConfig::paper(seed), opposite(seed), double(seed)] {
            let (tape, _) = session(&config);
            let found = difference(&tape, Variant::Corrected);
            largest = std::array::from_fn(|i| largest[i].max(found[i]));
        }
    }
    println!("f32 against f64: K {:.2e}, scale {:.2e}, sigma of K {:.2e}", largest[0], largest[1], largest[2]);
    assert!(largest[0] < 3e-6, "K differs by {:e}", largest[0]);
    assert!(largest[1] < 2e-6, "scale differs by {:e}", largest[1]);
    assert!(largest[2] < 0.02, "sigma differs by {:e}", largest[2]);
}
