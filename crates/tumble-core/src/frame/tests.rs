//! Round trips over the whole ranges, and damage of every byte.

extern crate std;
use std::string::{String, ToString};

use nalgebra::Vector3;

use super::*;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// All magnitudes are equally likely, so that short numbers come as often as long ones.
    fn any(&mut self) -> u64 {
        let bits = self.next() % 65;
        self.next().checked_shr(bits as u32).unwrap_or(0)
    }

    fn raw(&mut self) -> RawFrame {
        let mut count = || self.any() as i16;
        let counts =
            Counts { gyro: [count(), count(), count()], accel: [count(), count(), count()], temperature: count() };
        RawFrame { seq: self.any() as u32, t_us: self.any(), counts }
    }

    fn compensated(&mut self) -> CompensatedFrame {
        let mut value = || self.any() as i32;
        CompensatedFrame {
            angular_rate_urad_s: [value(), value(), value()],
            specific_force_um_s2: [value(), value(), value()],
            temperature_cdegc: value(),
            seq: self.any() as u32,
            t_us: self.any(),
        }
    }
}

#[test]
fn a_frame_is_spelt_as_the_protocol_says() {
    let counts = Counts { gyro: [1, -2, 3], accel: [-4, 5, 2048], temperature: -32768 };
    let line = RawFrame { seq: 7, t_us: 35_000, counts }.line();
    assert_eq!(line, "R,7,35000,1,-2,3,-4,5,2048,-32768*55\r\n");
    assert_eq!(line.as_bytes().iter().take_while(|b| **b != b'*').fold(0, |sum, b| sum ^ b), 0x55);
}

#[test]
fn every_frame_comes_back() {
    let mut random = Random(1);
    for _ in 0..20_000 {
        let (raw, compensated) = (random.raw(), random.compensated());
        assert_eq!(Frame::parse(&raw.line()), Ok(Frame::Raw(raw)));
        assert_eq!(Frame::parse(compensated.line().trim_end()), Ok(Frame::Compensated(compensated)));
    }
}

#[test]
fn the_longest_frame_fits() {
    let frame = CompensatedFrame {
        seq: u32::MAX,
        t_us: u64::MAX,
        angular_rate_urad_s: [i32::MIN; 3],
        specific_force_um_s2: [i32::MIN; 3],
        temperature_cdegc: i32::MIN,
    };
    assert_eq!(frame.line().len(), MAX_LINE);
    assert_eq!(Frame::parse(&frame.line()), Ok(Frame::Compensated(frame)));
}

#[test]
fn one_changed_byte_is_always_found() {
    let mut random = Random(2);
    for _ in 0..20 {
        for line in [random.raw().line(), random.compensated().line()] {
            let text = line.trim_end();
            for at in 0..text.len() {
                for flip in 1..=255_u8 {
                    let mut bytes = text.as_bytes().to_vec();
                    bytes[at] ^= flip;
                    let found = String::from_utf8(bytes).ok().and_then(|text| Frame::parse(&text).ok());
                    assert_eq!(found, None, "{text}: byte {at} by {flip:#04x}");
                }
            }
        }
    }
}

#[test]
fn a_cut_line_is_found() {
    let line = Random(3).compensated().line();
    let text = line.trim_end();
    for end in 0..text.len() {
        assert!(Frame::parse(&text[..end]).is_err(), "{}", &text[..end]);
    }
}

fn summed(body: &str) -> String {
    std::format!("{body}*{:02X}", body.bytes().fold(0, |sum, byte| sum ^ byte))
}

#[test]
fn errors_say_what_is_wrong() {
    for (text, error) in [
        ("@ask want=still".to_string(), FrameError::NotAFrame),
        (String::new(), FrameError::NotAFrame),
        ("R,1,2".to_string(), FrameError::NoChecksum),
        ("R,1,2*4".to_string(), FrameError::NoChecksum),
        ("R,1,2*FF".to_string(), FrameError::Checksum { computed: 0x51, written: 0xff }),
        (summed("R,1,2"), FrameError::Fields { found: 2 }),
        (summed("R,1,2,3,4,5,6,7,8,9,10"), FrameError::Fields { found: 10 }),
        (summed("R,1,2,3,4,40000,6,7,8,9"), FrameError::Field { name: "gz" }),
        (summed("R,1,2,3,4,5,6,7,8,"), FrameError::Field { name: "temp" }),
        (summed("R,+1,2,3,4,5,6,7,8,9"), FrameError::Field { name: "seq" }),
        (summed("R,1,02,3,4,5,6,7,8,9"), FrameError::Field { name: "t_us" }),
        (summed("R,1,2,-0,4,5,6,7,8,9"), FrameError::Field { name: "gx" }),
        (summed("C,1,2,3,4,5,nan,7,8,9"), FrameError::Field { name: "ax" }),
    ] {
        assert_eq!(Frame::parse(&text), Err(error), "{text}");
        assert!(!error.to_string().is_empty());
    }
}

#[test]
fn samples_are_rounded_and_what_is_no_number_is_refused() {
    let sample = Sample {
        t_us: 5000,
        angular_rate_rad_s: Vector3::new(1.0, -0.000_000_6, 0.0),
        specific_force_mps2: Vector3::new(0.0, 0.0, 9.806_65),
        temperature_degc: 24.567,
    };
    let frame = CompensatedFrame::new(1, &sample).expect("fits");
    assert_eq!(frame.angular_rate_urad_s, [1_000_000, -1, 0]);
    assert!((frame.specific_force_um_s2[2] - 9_806_650).abs() <= 1);
    assert_eq!(frame.temperature_cdegc, 2457);
    for bad in [f32::NAN, f32::INFINITY, 3000.0] {
        let broken = Sample { angular_rate_rad_s: Vector3::new(bad, 0.0, 0.0), ..sample };
        assert_eq!(CompensatedFrame::new(1, &broken), None);
    }
    assert_eq!(CompensatedFrame::new(1, &Sample { temperature_degc: f32::NAN, ..sample }), None);
}
