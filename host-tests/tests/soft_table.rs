//! A table that gives way: at each rest the box leans anew.

use host_tests::sim::{Deviation, session};
use tumble_core::calibration::Reason;
use tumble_core::estimate::judge::judge;
use tumble_core::procedure::{BoxFaces, TurnStops};
use tumble_sim::scheme::Imperfection;
use tumble_sim::{Scheme, SchemeConfig};

const SESSIONS: usize = 12;

/// Mean e²/σ² and the share within 2 sigma; how often the table was blamed, and how often nothing usable came out.
struct Told {
    squares: f64,
    within: f64,
    blamed: usize,
    rejected: usize,
}

fn told(soft_deg: f64, scheme: Scheme) -> Told {
    let mut all: Vec<f64> = Vec::new();
    let (mut blamed, mut rejected) = (0, 0);
    for seed in (7_001..).take(SESSIONS) {
        let config = SchemeConfig::new(scheme, seed).with(Imperfection::SoftTable(soft_deg));
        let session = session(&config, TurnStops::Fenced, BoxFaces::Square);
        let (judgement, accepted) = judge(&session.estimate, &session.tape, 0);
        blamed += usize::from(judgement.reasons.iter().any(|r| matches!(r, Reason::LooseContact { .. })));
        rejected += usize::from(accepted.is_none());
        all.extend(session.deviations().iter().map(|Deviation { error, sigma, .. }| error / sigma));
    }
    let count = all.len() as f64;
    let told = Told {
        squares: all.iter().map(|z| z * z).sum::<f64>() / count,
        within: all.iter().filter(|z| z.abs() < 2.0).count() as f64 / count,
        blamed,
        rejected,
    };
    println!(
        "{soft_deg:4}° {scheme:?}: e²/σ² {:.2}, within 2 sigma {:.1} %, table blamed in {blamed}, rejected {rejected} of {SESSIONS}",
        told.squares,
        100.0 * told.within
    );
    told
}

/// A lean of 0.1° used to be the box's crookedness, the accelerometer's scale or a walk, with errors of up to 38 sigma, and to get one
/// session in three rejected. One of the twelve sessions both ways has stops that pass for exact ones by chance (scale off by 8 sigma).
#[test]
fn what_a_soft_table_does_is_the_tables() {
    for scheme in [Scheme::Single, Scheme::Double] {
        for soft_deg in [0.03, 0.1, 0.3] {
            let told = told(soft_deg, scheme);
            assert!(told.squares < 1.6 && told.within > 0.93, "{soft_deg}° {scheme:?}");
            assert!(told.blamed == SESSIONS && told.rejected == 0, "{soft_deg}° {scheme:?}");
        }
        let firm = told(0.0, scheme);
        assert!(firm.blamed == 0 && firm.rejected == 0 && firm.squares < 1.6, "{scheme:?}");
    }
}
