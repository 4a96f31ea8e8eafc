//! Start-up: the sequence, the read-back of every register, the refusals.

use crate::script::{configuration, read, run, wake_up, write, write_checked};
use embedded_hal_mock::eh1::spi::Transaction;
use mpu9250_spi::{Configuration, Error, Register, Standing};

#[test]
fn the_default_is_what_the_design_fixes() {
    let default = Configuration::default();
    let writes = default.writes().map(|(register, value)| (register.0, value));
    let design = [
        (0x6B, 0x01),
        (0x6C, 0x00),
        (0x6A, 0x10),
        (0x1A, 3),
        (0x19, 4),
        (0x1B, 0x18),
        (0x1C, 0x18),
        (0x1D, 3),
        (0x37, 0x30),
        (0x38, 0x01),
    ];
    assert_eq!(writes, design);
    assert_eq!((default.rate_hz(), default.period_us()), (200.0, 5000));
    assert_eq!((default.gyro_range.full_scale_dps(), default.accel_range.full_scale_g()), (2000, 16));
}

#[test]
fn start_resets_identifies_configures_and_reads_everything_back() {
    let config = Configuration::default();
    let script = [wake_up(0x71), write(Register::SIGNAL_PATH_RESET, 0x07), configuration(&config)].concat();
    let identity = run(script, async |device| device.start(&config).await).expect("as scripted");
    assert_eq!((identity.who_am_i, identity.name(), identity.standing()), (0x71, "MPU9250", Standing::Known));
}

#[test]
fn relatives_are_named_and_told_apart() {
    for (who_am_i, name, standing) in [
        (0x70, "MPU6500", Standing::Known),
        (0x73, "MPU9255", Standing::Known),
        (0x74, "MPU6515", Standing::Relative),
        (0x75, "MPU6500-like", Standing::Relative),
        (0x78, "MPU6880", Standing::Relative),
    ] {
        let identity =
            run(read(Register::WHO_AM_I, who_am_i), async |device| device.identity().await).expect("a relative");
        assert_eq!((identity.name(), identity.standing()), (name, standing));
    }
}

#[test]
fn every_other_name_is_refused_before_anything_is_configured() {
    let known = [0x70, 0x71, 0x73, 0x74, 0x75, 0x78];
    for who_am_i in (0..=255).filter(|name| !known.contains(name)) {
        let config = Configuration::default();
        let error = run(wake_up(who_am_i), async |device| device.start(&config).await).expect_err("a stranger");
        let Error::Identity(refused) = error else { panic!("{error}") };
        assert_eq!((refused.who_am_i, refused.is_absent()), (who_am_i, who_am_i == 0 || who_am_i == 255));
        assert!(error.to_string().contains(&format!("WHO_AM_I (0x75) reads 0x{who_am_i:02X}; ")), "{error}");
    }
}

#[test]
fn an_absent_sensor_is_a_matter_of_wires_and_a_foreign_one_of_parts() {
    let say = |who_am_i| {
        run(read(Register::WHO_AM_I, who_am_i), async |device| device.identity().await)
            .expect_err("refused")
            .to_string()
    };
    assert!(say(0x00).contains("no sensor answers") && say(0x00).contains("3.3 V"));
    assert!(say(0xFF).contains("no sensor answers") && say(0xFF).contains("NCS"));
    assert!(say(0x68).contains("a foreign sensor answers") && say(0x68).contains("MPU6050"));
}

#[test]
fn any_register_that_does_not_hold_its_value_is_named_with_both_values() {
    let config = Configuration::default();
    for (at, (register, written)) in config.writes().into_iter().enumerate() {
        let wrong = written ^ 0x04;
        let mut script = [wake_up(0x71), write(Register::SIGNAL_PATH_RESET, 0x07)].concat();
        for (register, value) in config.writes().into_iter().take(at) {
            script.extend(write_checked(register, value));
        }
        script.extend([write(register, written), read(register, wrong)].concat());
        let error = run(script, async |device| device.start(&config).await).expect_err("the mismatch");
        assert_eq!(error, Error::ReadBack { register, written, read: wrong });
        let text = error.to_string();
        let values = format!("was written 0x{written:02X} and reads 0x{wrong:02X}");
        assert!(text.starts_with(register.name()) && text.contains(&values), "{text}");
    }
}

#[test]
fn check_finds_a_part_that_forgot_its_settings() {
    let config = Configuration::default();
    let settings: Vec<_> = config.writes().into_iter().flat_map(|(register, value)| read(register, value)).collect();
    assert_eq!(run(settings, async |device| device.check(&config).await), Ok(()));
    // After a power dip: clock auto-selected (1), then USER_CTRL is 0 instead of 0x10.
    let forgotten =
        [read(Register::PWR_MGMT_1, 1), read(Register::PWR_MGMT_2, 0), read(Register::USER_CTRL, 0)].concat();
    let error = run(forgotten, async |device| device.check(&config).await).expect_err("forgotten");
    assert_eq!(error, Error::ReadBack { register: Register::USER_CTRL, written: 0x10, read: 0 });
}

/// The mock's bus cannot fail, so this one stands in for a bus that does nothing else.
struct BrokenBus;

#[derive(Debug, Clone, Copy, PartialEq)]
struct Broken;

impl embedded_hal_async::spi::Error for Broken {
    fn kind(&self) -> embedded_hal_async::spi::ErrorKind {
        embedded_hal_async::spi::ErrorKind::Other
    }
}

impl embedded_hal_async::spi::ErrorType for BrokenBus {
    type Error = Broken;
}

impl embedded_hal_async::spi::SpiDevice for BrokenBus {
    async fn transaction(&mut self, _: &mut [embedded_hal_async::spi::Operation<'_, u8>]) -> Result<(), Broken> {
        Err(Broken)
    }
}

#[test]
fn a_failing_bus_is_reported_with_the_register_it_failed_at() {
    let mut device = mpu9250_spi::Mpu9250::new(BrokenBus, embedded_hal_mock::eh1::delay::NoopDelay::new());
    let error = embassy_futures::block_on(device.start(&Configuration::default())).expect_err("broken");
    assert_eq!(error, Error::Bus { register: Register::PWR_MGMT_1, cause: Broken });
    assert!(error.to_string().contains("PWR_MGMT_1 (0x6B)"), "{error}");
    let error = embassy_futures::block_on(device.read()).expect_err("broken");
    assert_eq!(error, Error::Bus { register: Register::INT_STATUS, cause: Broken });
}

#[test]
fn the_script_is_strict() {
    // A guard on the guard: a transfer that is not in the script fails the test.
    let stray =
        vec![Transaction::transaction_start(), Transaction::write_vec(vec![1, 2]), Transaction::transaction_end()];
    let caught = std::panic::catch_unwind(|| run(stray, async |device| device.identity().await));
    assert!(caught.is_err());
}
