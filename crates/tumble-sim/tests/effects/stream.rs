//! Stamps, gaps, repeats, torn bytes and low rates.

use crate::common::{Pair, short};

#[test]
fn the_accelerometer_lags() {
    let pair = Pair::quiet("gyro_accel_lag=10");
    for k in 2..pair.with.samples.len() {
        let (with, before) = (&pair.with.samples[k], &pair.without.samples[k - 2]);
        assert!((with.specific_force_mps2 - before.specific_force_mps2).norm() < 1e-9, "10 ms are two samples");
        assert_eq!(with.angular_rate_rad_s, pair.without.samples[k].angular_rate_rad_s);
    }
}

#[test]
fn stamps_scatter_or_come_in_steps() {
    let pair = Pair::of(short(1), "timestamp_jitter=0.8");
    let errors: Vec<f64> = pair.samples().map(|(with, without)| with.t_s - without.t_s).collect();
    let sigma = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    assert!((sigma / 0.8e-3 - 1.0).abs() < 0.03, "{sigma}");
    assert!(pair.samples().all(|(with, without)| with.angular_rate_rad_s == without.angular_rate_rad_s));

    let mut config = short(1);
    config.clock.rate_error = 0.003;
    let pair = Pair::of(config, "timestamp_quantization=2");
    for (with, without) in pair.samples() {
        let ticks = with.t_s / 2e-3;
        assert!(
            (ticks - ticks.round()).abs() < 1e-6 && with.t_s <= without.t_s + 1e-5 && with.t_s > without.t_s - 2e-3
        );
    }
    // Steps of three samples: stamps still increase.
    for word in ["timestamp_quantization=15.6", "timestamp_jitter=10"] {
        let pair = Pair::of(short(1), word);
        assert!(pair.with.samples.windows(2).all(|two| two[1].t_s - two[0].t_s > 0.99e-5), "{word}");
    }
}

#[test]
fn samples_are_lost_or_repeated() {
    let pair = Pair::of(short(2), "dropped_samples=3");
    let (with, without) = (&pair.with.samples, &pair.without.samples);
    let lost = without.len() - with.len();
    assert_eq!(lost, (0.03 * without.len() as f64).round() as usize);
    assert_eq!(lost as f64, pair.parameter("samples_lost"));
    let longest = with.windows(2).map(|two| ((two[1].t_s - two[0].t_s) * 200.0).round() as i32 - 1).max();
    assert!((2..12).contains(&longest.unwrap()), "{longest:?}");
    let mut rest = without.iter();
    assert!(
        with.iter().all(|sample| rest.any(|other| other == sample)),
        "the others are what they were, in their order"
    );

    let pair = Pair::of(short(2), "duplicated_samples=3");
    let samples = &pair.with.samples;
    let repeated = samples.windows(2).filter(|two| two[0].angular_rate_rad_s == two[1].angular_rate_rad_s).count();
    assert_eq!(repeated as f64, pair.parameter("samples_repeated"));
    assert!((repeated as f64 / samples.len() as f64 / 0.03 - 1.0).abs() < 0.2, "{repeated}");
    assert!(pair.samples().all(|(with, without)| with.t_s == without.t_s), "new stamps");
}

#[test]
fn torn_bytes_are_off_by_whole_high_bytes() {
    let pair = Pair::of(short(4), "byte_tearing=20");
    // 16.4 counts for each °/s and 2048 for each g at the widest ranges.
    let counts = |s: &tumble_sim::Sample| -> Vec<i32> {
        let rate = s.angular_rate_rad_s.iter().map(|w| w.to_degrees() * 16.4);
        rate.chain(s.specific_force_mps2.iter().map(|f| f / 9.80665 * 2048.0)).map(|c| c.round() as i32).collect()
    };
    let mut torn = 0;
    for k in 1..pair.with.samples.len() {
        let (before, now) = (counts(&pair.without.samples[k - 1]), counts(&pair.without.samples[k]));
        for (c, (b, n)) in counts(&pair.with.samples[k]).into_iter().zip(before.into_iter().zip(now)) {
            let of = |high: i32, low: i32| 256 * high.div_euclid(256) + low.rem_euclid(256);
            assert!(c == n || c == of(b, n) || c == of(n, b), "{c} of {b} and {n}");
            torn += i32::from(c != n);
        }
    }
    // A torn reading is right by chance: neighbours may share their low byte.
    let (said, crossings) = (pair.parameter("readings_torn"), pair.parameter("high_byte_changes"));
    assert!((f64::from(torn) / said - 1.0).abs() < 0.1, "{torn} of {said}");
    assert!((said / crossings / 0.2 - 1.0).abs() < 0.2, "{said} of {crossings}");
    assert!(torn > 50);
}

#[test]
fn a_low_rate_keeps_every_so_many() {
    let pair = Pair::of(short(4), "undersampling=20");
    let every_tenth: Vec<_> = pair.without.samples.iter().step_by(10).copied().collect();
    assert_eq!(pair.with.samples, every_tenth);
    assert_eq!((pair.with.rate_hz, pair.without.rate_hz), (20.0, 200.0));

    let mut config = short(4);
    config.averaged = 10;
    let averaged = config.record().unwrap();
    assert_eq!((averaged.samples.len(), averaged.rate_hz), (every_tenth.len(), 20.0));
    assert!(averaged.samples.iter().zip(&every_tenth).all(|(a, b)| a.t_s == b.t_s));
}
