//! The self-test: sequence, arithmetic, limits, and that the configuration comes back.

use crate::script::{Script, burst, configuration, read, run, write_checked};
use mpu9250_spi::{AccelRange, Basis, Configuration, Error, GyroRange, Register, SelfTest};

fn quiet() -> Configuration {
    Configuration {
        gyro_range: GyroRange::Dps250,
        accel_range: AccelRange::G2,
        gyro_filter: 2,
        accel_filter: 2,
        rate_divider: 0,
    }
}

fn reading(status: u8, accel: [i16; 3], gyro: [i16; 3]) -> [u8; 15] {
    let mut bytes = [0; 15];
    bytes[0] = status;
    for (pair, value) in bytes[1..].chunks_mut(2).zip(accel.into_iter().chain([0]).chain(gyro)) {
        pair.copy_from_slice(&value.to_be_bytes());
    }
    bytes
}

fn readings(accel: [i16; 3], gyro: [i16; 3]) -> Script {
    (0..200).flat_map(|_| burst(reading(1, accel, gyro))).collect()
}

/// A part at rest with +z up whose masses move by `accel` and `gyro` counts when pushed.
fn script(accel: [i16; 3], gyro: [i16; 3], gyro_codes: [u8; 3], accel_codes: [u8; 3]) -> Script {
    let rest_accel = [100, -200, 16384];
    let rest_gyro = [13, -17, 5];
    let sum = |a: [i16; 3], b: [i16; 3]| std::array::from_fn(|i| a[i] + b[i]);
    let mut script = [
        configuration(&quiet()),
        readings(rest_accel, rest_gyro),
        write_checked(Register::ACCEL_CONFIG, 0xE0),
        write_checked(Register::GYRO_CONFIG, 0xE0),
        readings(sum(rest_accel, accel), sum(rest_gyro, gyro)),
        write_checked(Register::ACCEL_CONFIG, 0),
        write_checked(Register::GYRO_CONFIG, 0),
    ]
    .concat();
    for (first, codes) in [(Register::SELF_TEST_X_GYRO, gyro_codes), (Register::SELF_TEST_X_ACCEL, accel_codes)] {
        for (i, code) in (0..).zip(codes) {
            script.extend(read(Register(first.0 + i), code));
        }
    }
    script.extend(configuration(&Configuration::default()));
    script
}

fn run_self_test(script: Script) -> Result<SelfTest, Error<embedded_hal_async::spi::ErrorKind>> {
    let config = Configuration::default();
    run(script, async |device| device.self_test(&config).await)
}

#[test]
fn a_healthy_part_answers_with_the_factorys_response() {
    // Trim code 101 is 2620 · 1.01^100 = 7086.6; code 1 is 2620.
    let result = run_self_test(script([2620, 2620, -2620], [7087, 2620, 2620], [101, 1, 1], [1, 1, 1])).expect("runs");
    let Basis::FactoryTrim(trim) = result.gyro[0].basis else { panic!("there is a trim") };
    assert!((f64::from(trim) / (2620.0 * 1.01_f64.powi(100)) - 1.0).abs() < 1e-5, "{trim}");
    assert!((result.gyro[0].response - 1.0).abs() < 1e-3);
    assert!(result.gyro.iter().all(|axis| axis.ok));
    assert_eq!(result.accel.map(|axis| axis.ok), [true, true, false], "a response of the wrong sign fails");
    assert!(!result.is_ok());
}

#[test]
fn limits_are_the_application_notes() {
    let gyro = run_self_test(script([2620; 3], [1310, 1311, 26200], [1; 3], [1; 3])).expect("runs").gyro;
    assert_eq!(gyro.map(|axis| axis.ok), [false, true, true], "above a half, with no upper bound");
    let accel = run_self_test(script([1310, 3929, 3930], [2620; 3], [1; 3], [1; 3])).expect("runs").accel;
    assert_eq!(accel.map(|axis| axis.ok), [false, true, false], "between a half and one and a half");
}

#[test]
fn a_part_without_factory_trim_is_judged_by_absolute_limits() {
    // 60 °/s at ±250 °/s are 7864.3 counts; 225 and 675 mg at ±2 g are 3686.4 and 11059.2.
    let result = run_self_test(script([3686, 3687, -11060], [7864, -7865, 0], [0; 3], [0; 3])).expect("runs");
    assert_eq!(result.gyro.map(|axis| axis.ok), [false, true, false]);
    assert_eq!(result.accel.map(|axis| axis.ok), [false, true, false]);
    assert!(result.gyro.iter().chain(&result.accel).all(|axis| axis.basis == Basis::Absolute));
}

#[test]
fn stale_readings_are_waited_out_and_a_stopped_part_is_told() {
    let mut stopped = configuration(&quiet());
    for _ in 0..50 {
        stopped.extend(burst(reading(0, [0; 3], [0; 3])));
    }
    stopped.extend(configuration(&Configuration::default()));
    let error = run_self_test(stopped).expect_err("nothing new comes");
    assert_eq!(error, Error::NoData { polls: 50 });
}
