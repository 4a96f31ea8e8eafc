//! `tumble study limits` over few seeds: the bound is one, the device is near it, and the figures are what they say.

use tumble::study::bound::bound;
use tumble::study::limits::{Effort, Scenario, ScenarioSummary};
use tumble_core::procedure::BoxFaces;
use tumble_sim::motion::Stops;
use tumble_sim::{Scheme, SchemeConfig};

fn run(scheme: Scheme, faces: BoxFaces, navigate: bool) -> ScenarioSummary {
    let scenario = Scenario { name: "test", scheme, faces, imperfections: Vec::new(), machine: false };
    scenario.run(&Effort { runs: 8, threads: 2, seed: 1, references: false }, navigate, &mut |_| {})
}

/// rms over bound of a group of eight runs: 1.4 leaves room for what eight seeds scatter (24 values: ±14 %).
fn assert_near_bound(summary: &ScenarioSummary, group: &str, least: f64, most: f64) {
    let found = summary.groups.iter().find(|g| g.group == group).expect("a group of the table");
    println!("{group}: rms {:.1} {}, bound {:.1}, ratio {:.2}", found.rms, found.unit, found.bound, found.ratio);
    assert!((least..most).contains(&found.ratio), "{group}: ratio {:.2}", found.ratio);
}

#[test]
fn the_device_is_near_the_bound_and_not_below_it() {
    let summary = run(Scheme::Single, BoxFaces::Square, true);
    assert_eq!((summary.runs, summary.accepted), (8, 8), "{:?}", summary.failures);
    for group in ["gyro scale", "gyro non-orthogonality", "accel bias", "accel scale", "accel non-orthogonality"] {
        assert_near_bound(&summary, group, 0.7, 1.5);
    }
    let nees = summary.nees.as_ref().expect("positive definite");
    assert!(nees.parameters == 24 && (0.6..1.4).contains(&nees.mean), "{nees:?}");
    let [perfect, device, bias_alone] = [0, 1, 2].map(|i| summary.navigation[i].end_mean_deg);
    assert!(perfect < device && device < 0.2 && bias_alone > 1.0, "{perfect} {device} {bias_alone}");
}

#[test]
fn without_the_box_the_frame_fixes_three_numbers() {
    let summary = run(Scheme::Double, BoxFaces::Unknown, false);
    assert_near_bound(&summary, "gyro non-orthogonality", 0.7, 1.6);
    assert_eq!(summary.nees.as_ref().expect("positive definite").parameters, 21);
    assert!(summary.navigation.is_empty());
}

/// What must make a bound smaller does, and by as much as it must.
#[test]
fn the_bound_obeys_what_bounds_obey() {
    let sigma = |change: &dyn Fn(&mut SchemeConfig), faces, index: usize| {
        let mut config = SchemeConfig::new(Scheme::Single, 3);
        config.world.motion.hands.stops = Stops::Exact;
        change(&mut config);
        let recording = config.record().expect("a valid configuration");
        bound(&config, &recording, faces)[(index, index)].sqrt()
    };
    const SCALE_X: usize = 15;
    let exact = sigma(&|_| {}, BoxFaces::Square, SCALE_X);
    let loud = sigma(&|c| c.world.sensor.noise.gyro_dps_rthz *= 2.0, BoxFaces::Square, SCALE_X);
    assert!(
        (loud / exact - 2.0).abs() < 0.1,
        "twice the gyroscope's noise is twice the scale's sigma: {}",
        loud / exact
    );
    let fenced = sigma(&|c| c.world.motion.hands.stops = Stops::FENCE, BoxFaces::Square, SCALE_X);
    // Two turns an axis of 0.082° each alone give 160 ppm, gravity through the moves alone 84 to 100: together 71 to 85.
    assert!((55e-6..90e-6).contains(&fenced) && exact < 0.8 * fenced, "{fenced} {exact}");
    // Of a single element either frame may know more; of K as a whole the box does.
    let cross = |faces| [16, 17, 18, 20, 21, 22].map(|k| sigma(&|_| {}, faces, k).powi(2)).iter().sum::<f64>().sqrt();
    let (square, unknown) = (cross(BoxFaces::Square), cross(BoxFaces::Unknown));
    assert!(square < 0.8 * unknown, "{square} {unknown}");
}
