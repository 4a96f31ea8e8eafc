//! The burst: decoding, freshness, and bytes that are no reading.

use crate::script::{burst, run};
use mpu9250_spi::{Error, Reading, Status};

#[test]
fn fifteen_bytes_are_status_accelerometer_temperature_and_gyroscope() {
    let bytes = [0x01, 0x08, 0x00, 0xF7, 0xFF, 0x00, 0x01, 0xFF, 0x38, 0x80, 0x00, 0x7F, 0xFF, 0xFF, 0xFE];
    let reading = run(burst(bytes), async |device| device.read().await).expect("a reading");
    assert_eq!(reading.accel, [2048, -2049, 1]);
    assert_eq!(reading.temperature, -200, "20.4 degrees: below 21 the count is negative");
    assert_eq!(reading.gyro, [i16::MIN, i16::MAX, -2]);
    assert!(reading.status.is_fresh());
}

#[test]
fn every_count_survives() {
    for count in i16::MIN..=i16::MAX {
        let [high, low] = count.to_be_bytes();
        let mut bytes = [0; 15];
        for pair in bytes[1..].chunks_mut(2) {
            pair.copy_from_slice(&[high, low]);
        }
        let expected = Reading { status: Status(0), accel: [count; 3], temperature: count, gyro: [count; 3] };
        assert_eq!(Reading::decode(&bytes), expected);
    }
}

#[test]
fn an_old_reading_is_not_fresh() {
    let reading = run(burst([0; 15]), async |device| device.read().await).expect("a reading");
    assert!(!reading.status.is_fresh());
}

#[test]
fn a_line_that_hangs_high_is_no_reading() {
    let error = run(burst([0xFF; 15]), async |device| device.read().await).expect_err("no reading");
    assert_eq!(error, Error::NotAReading { status: 0xFF });
    assert!(error.to_string().contains("INT_STATUS (0x3A) reads 0xFF"), "{error}");
}

#[test]
fn only_the_parts_own_status_bits_pass() {
    let possible: Vec<u8> = (0..=255).filter(|&status| Status(status).is_possible()).collect();
    assert_eq!(possible.len(), 16, "four bits are the part's: {possible:?}");
    assert!(possible.iter().all(|status| status & !0x59 == 0));
}
