//! Round trip, the golden bytes of version 1, and damage of every kind.

extern crate std;
use std::string::ToString;
use std::vec::Vec as StdVec;

use nalgebra::{Matrix3, Vector3};

use super::*;
use crate::calibration::{Fit, Frame, GSensitivity, Triad, TriadEstimate};
use crate::setup::{BoxFaces, TurnStops};

fn triad(offset: f32) -> TriadEstimate {
    let mut observable = [[true; 3]; 3];
    observable[0][2] = false;
    TriadEstimate {
        triad: Triad {
            bias: Vector3::new(offset, offset + 1.0, offset + 2.0),
            correction: Matrix3::from_fn(|i, j| offset + 6.0 + (3 * i + j) as f32),
        },
        bias_sigma: Vector3::new(offset + 3.0, offset + 4.0, offset + 5.0),
        correction_sigma: Matrix3::from_fn(|i, j| offset + 15.0 + (3 * i + j) as f32),
        observable,
    }
}

fn example() -> (Origin, Calibration) {
    let origin = Origin {
        generation: 300,
        firmware: FirmwareVersion::parse("0.1.2"),
        whoami: 0x71,
        ranges: Ranges::WIDEST,
        setup: Setup { stops: TurnStops::Fenced, box_faces: BoxFaces::Unknown, ..Setup::default() },
    };
    let fit = Fit { nis_per_dof: 1.5, gravity_rms_mps2: 0.25, gravity_max_mps2: 0.5, turn_closure_rms_rad: 0.125 };
    let (accelerometer, gyroscope) = (triad(1.0), triad(100.0));
    let calibration =
        Calibration { accelerometer, gyroscope, g_sensitivity: None, frame: Frame::Box, temperature_degc: 24.0, fit };
    (origin, calibration)
}

/// The same with what takes version 2.
fn felt() -> (Origin, Calibration) {
    let (origin, calibration) = example();
    let matrix = |offset: u8| Matrix3::from_fn(|i, j| f32::from(offset) + (3 * i + j) as f32);
    (origin, Calibration { g_sensitivity: Some(GSensitivity { matrix: matrix(1), sigma: matrix(10) }), ..calibration })
}

fn encoded() -> Bytes {
    let (origin, calibration) = example();
    encode(&origin, &AcceptedCalibration::new(calibration)).expect("finite")
}

#[test]
fn what_is_written_is_read() {
    let (origin, calibration) = example();
    let record = decode(&encoded()).expect("whole");
    assert_eq!(record, Record { origin, calibration: AcceptedCalibration::new(calibration) });
    let mut with_rest_of_page = encoded();
    with_rest_of_page.extend_from_slice(&[0xff; 40]).expect("room");
    assert_eq!(decode(&with_rest_of_page), Ok(record));
}

/// Version 1 byte by byte, written down by hand from the table in `record.rs` and `v1.rs`: it must never change.
fn golden() -> StdVec<u8> {
    fn floats(bytes: &mut StdVec<u8>, range: core::ops::Range<u8>, offset: f32) {
        for value in range {
            bytes.extend_from_slice(&(offset + f32::from(value)).to_le_bytes());
        }
    }
    let mut bytes = StdVec::from(*b"TMBL\x01\x00\xf8\x00");
    bytes.extend_from_slice(&[0xac, 0x02]); // generation 300 as a varint
    bytes.extend_from_slice(&[0, 1, 2, 0x71]); // firmware, WHO_AM_I
    bytes.extend_from_slice(&[0x00, 0x00, 0xfa, 0x44, 0x00, 0x00, 0x80, 0x41]); // 2000 dps, 16 g
    bytes.extend_from_slice(&[1, 0, 0, 1]); // fenced, not square, not single, box frame
    for value in [24.0_f32, 1.5, 0.25, 0.5, 0.125] {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    for offset in [1.0, 100.0] {
        floats(&mut bytes, 0..24, offset); // bias, its sigma, correction by rows, its sigma by rows
        bytes.extend_from_slice(&[1, 1, 0, 1, 1, 1, 1, 1, 1]);
    }
    bytes
}

#[test]
fn version_1_is_what_it_always_was() {
    let golden = golden();
    assert_eq!(golden.len(), HEADER + 248);
    let bytes = encoded();
    assert_eq!(bytes[..golden.len()], golden[..]);
    // By Python's zlib.crc32 of the same bytes.
    assert_eq!(bytes[golden.len()..], 0x78fa_5364_u32.to_le_bytes());
}

#[test]
fn version_2_is_version_1_and_the_sensitivity_to_force() {
    let (origin, calibration) = felt();
    let bytes = encode(&origin, &AcceptedCalibration::new(calibration)).expect("finite");
    let mut golden = golden();
    golden[4] = 2;
    golden[6..8].copy_from_slice(&(248u16 + 72).to_le_bytes());
    (1u8..19).for_each(|value| golden.extend_from_slice(&f32::from(value).to_le_bytes()));
    assert_eq!(bytes[..golden.len()], golden[..]);
    // By Python's zlib.crc32 of the same bytes.
    assert_eq!(bytes[golden.len()..], 0x6349_08ae_u32.to_le_bytes());
    assert_eq!(decode(&bytes), Ok(Record { origin, calibration: AcceptedCalibration::new(calibration) }));
}

#[test]
fn any_flipped_bit_and_any_cut_is_found() {
    let bytes = encoded();
    for at in 0..bytes.len() {
        assert!(matches!(decode(&bytes[..at]), Err(RecordError::NotARecord | RecordError::Truncated { .. })), "{at}");
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << bit;
            assert!(decode(&damaged).is_err(), "byte {at} bit {bit}");
        }
    }
    assert_eq!(decode(&[0xff; 64]), Err(RecordError::NotARecord));
    assert_eq!(decode(&[]), Err(RecordError::NotARecord));
}

/// A record with another version or payload and a checksum that fits.
fn resealed(version: u16, payload: &[u8]) -> StdVec<u8> {
    let mut bytes = StdVec::from(MAGIC);
    bytes.extend_from_slice(&version.to_le_bytes());
    bytes.extend_from_slice(&u16::try_from(payload.len()).expect("short").to_le_bytes());
    bytes.extend_from_slice(payload);
    bytes.extend_from_slice(&CRC.checksum(&bytes).to_le_bytes());
    bytes
}

#[test]
fn a_newer_version_is_reported_as_such_and_a_false_payload_too() {
    let newer = decode(&resealed(3, &[1, 2, 3])).expect_err("newer");
    assert_eq!(newer, RecordError::Newer { version: 3 });
    assert!(newer.to_string().contains("Install the newer firmware"), "{newer}");
    for version in [1, 2] {
        assert_eq!(decode(&resealed(version, &[1, 2, 3])), Err(RecordError::Malformed { version }));
    }
    assert_eq!(decode(&resealed(0, &[])), Err(RecordError::Malformed { version: 0 }));
}

#[test]
fn what_is_no_finite_number_is_refused_on_both_sides() {
    let (origin, calibration) = example();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut broken = calibration;
        broken.gyroscope.triad.correction[(1, 2)] = bad;
        let refused = encode(&origin, &AcceptedCalibration::new(broken));
        assert_eq!(refused, Err(RecordError::NotFinite { name: "gyro_correction_yz" }));
        let payload = payload(&v1::Payload::new(&origin, &broken));
        assert_eq!(decode(&resealed(1, &payload)), Err(RecordError::NotFinite { name: "gyro_correction_yz" }));
        let mut broken = calibration;
        broken.accelerometer.bias_sigma.x = bad;
        let refused = encode(&origin, &AcceptedCalibration::new(broken));
        assert_eq!(refused, Err(RecordError::NotFinite { name: "accel_bias_x" }));
        let fit = Fit { nis_per_dof: bad, ..calibration.fit };
        let refused = encode(&origin, &AcceptedCalibration::new(Calibration { fit, ..calibration }));
        assert_eq!(refused, Err(RecordError::NotFinite { name: "nis_per_dof" }));
    }
}

#[test]
fn the_largest_record_fits_and_versions_are_read() {
    let (mut origin, calibration) = felt();
    origin.generation = u32::MAX;
    origin.firmware = FirmwareVersion { major: u16::MAX, minor: u16::MAX, patch: u16::MAX };
    let bytes = encode(&origin, &AcceptedCalibration::new(calibration)).expect("fits");
    assert!(bytes.len() <= 362, "{}", bytes.len());
    assert_eq!(decode(&bytes).expect("whole").origin, origin);
    assert_eq!(FirmwareVersion::parse("1.22.333-rc1").to_string(), "1.22.333");
    assert_eq!(FirmwareVersion::parse("one"), FirmwareVersion::default());
}

fn payload(payload: &v1::Payload) -> StdVec<u8> {
    let mut buffer = [0; MAX_BYTES];
    postcard::to_slice(payload, &mut buffer).expect("fits").to_vec()
}
