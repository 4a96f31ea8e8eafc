//! The chip alone, driven by hand: what the data sheet promises a driver.

use std::sync::{Arc, Mutex};

use super::*;
use crate::world::{AtRest, PhysicalSample};

const READY_NS: u64 = 20_000_000;

fn chip(options: SensorOptions, fault: Option<SensorFault>) -> Mpu9250 {
    Mpu9250::new(options, fault, Box::new(AtRest))
}

fn write(chip: &mut Mpu9250, address: u8, value: u8, now: u64) {
    chip.select(now);
    chip.transfer(address, now);
    chip.transfer(value, now);
    chip.deselect();
}

fn read<const N: usize>(chip: &mut Mpu9250, address: u8, now: u64) -> [u8; N] {
    chip.select(now);
    chip.transfer(address | 0x80, now);
    let bytes = std::array::from_fn(|_| chip.transfer(0, now));
    chip.deselect();
    bytes
}

/// 200 Hz, ±2000 °/s, ±16 g, latched, cleared by any read: as the product sets it.
fn configure(chip: &mut Mpu9250) {
    for (address, value) in
        [(0x6B, 1), (0x1A, 3), (0x19, 4), (0x1B, 0x18), (0x1C, 0x18), (0x1D, 3), (0x37, 0x30), (0x38, 1)]
    {
        write(chip, address, value, READY_NS);
    }
    // The interrupt of a sample from before the configuration.
    read::<1>(chip, 0x3A, READY_NS);
}

#[test]
fn registers_answer_nothing_until_the_chip_has_started() {
    let mut chip = chip(SensorOptions::default(), None);
    assert_eq!(read::<1>(&mut chip, 0x75, 5_000_000), [0]);
    assert_eq!(read::<1>(&mut chip, 0x75, READY_NS), [0x71]);
    write(&mut chip, 0x19, 9, READY_NS);
    write(&mut chip, 0x6B, 0x80, READY_NS);
    assert_eq!(read::<2>(&mut chip, 0x19, 2 * READY_NS), [0, 0], "a reset clears the configuration");
    assert_eq!(read::<1>(&mut chip, 0x6B, 2 * READY_NS), [1], "and its own bit");
}

#[test]
fn samples_come_at_the_chips_own_rate() {
    let options = SensorOptions { clock_error: 0.01, ..SensorOptions::default() };
    let mut chip = chip(options, None);
    configure(&mut chip);
    let first = chip.next_event_ns(READY_NS).expect("sampling");
    chip.on_event(first);
    let mut at = first;
    for _ in 0..1000 {
        // The pulse's end is an event too; only samples are counted here.
        at = loop {
            let next = chip.next_event_ns(at).expect("sampling");
            let samples = chip.samples();
            chip.on_event(next);
            at = next;
            if chip.samples() > samples {
                break next;
            }
        };
    }
    let expected = 1000.0 * 5e6 / 1.01;
    assert!(((at - first) as f64 - expected).abs() < 2.0, "{} against {expected}", at - first);
}

#[test]
fn the_latch_holds_until_any_read_and_no_longer() {
    let mut chip = chip(SensorOptions::default(), None);
    configure(&mut chip);
    let at = chip.next_event_ns(READY_NS).expect("sampling");
    assert!(!chip.int_high(at - 1));
    chip.on_event(at);
    assert!(chip.int_high(at) && chip.int_high(at + 4_000_000), "latched, not a pulse");
    let burst = read::<15>(&mut chip, 0x3A, at + 10);
    assert_eq!(burst[0] & 1, 1, "the status is read before it is cleared");
    assert_eq!(burst[5..7], [0x08, 0x00], "1 g at 16 g full scale is 2048");
    assert!(!chip.int_high(at + 20));
    assert_eq!(read::<1>(&mut chip, 0x3A, at + 30), [0]);
}

#[test]
fn an_unlatched_interrupt_is_a_pulse_of_50_us_and_polarity_inverts_it() {
    let mut chip = chip(SensorOptions::default(), None);
    configure(&mut chip);
    write(&mut chip, 0x37, 0x80, READY_NS);
    let at = chip.next_event_ns(READY_NS).expect("sampling");
    assert!(chip.int_high(at - 1), "idle high when active low");
    chip.on_event(at);
    assert!(!chip.int_high(at));
    assert_eq!(chip.next_event_ns(at), Some(at + 50_000), "the pulse's end is announced");
    assert!(chip.int_high(at + 50_000));
}

#[test]
fn a_burst_never_mixes_two_samples() {
    struct Steps(f64);
    impl SensorWorld for Steps {
        fn sample(&mut self, _t_s: f64) -> PhysicalSample {
            self.0 += 10.0_f64.to_radians();
            PhysicalSample { angular_rate_rad_s: [self.0; 3], ..PhysicalSample::at_rest() }
        }
    }
    let mut chip = Mpu9250::new(SensorOptions::default(), None, Box::new(Steps((-10.0_f64).to_radians())));
    configure(&mut chip);
    let first = chip.next_event_ns(READY_NS).expect("sampling");
    chip.on_event(first);
    chip.select(first);
    chip.transfer(0x43 | 0x80, first);
    let x = [chip.transfer(0, first), chip.transfer(0, first)];
    let second = first + 5_000_000;
    assert_eq!(chip.next_event_ns(first + 50_000), Some(second));
    chip.on_event(second);
    let y = [chip.transfer(0, second), chip.transfer(0, second)];
    assert_eq!(x, y, "the burst began before the second sample");
    chip.deselect();
    assert_ne!(read::<2>(&mut chip, 0x43, second), x);
    assert_eq!(i16::from_be_bytes(x), 164, "10 °/s at 2000 °/s full scale is 163.84");
}

#[test]
fn counts_saturate() {
    struct Fast;
    impl SensorWorld for Fast {
        fn sample(&mut self, _t_s: f64) -> PhysicalSample {
            PhysicalSample {
                angular_rate_rad_s: [100.0, -100.0, 0.0],
                specific_force_mps2: [200.0, -200.0, 0.0],
                temperature_degc: 31.0,
            }
        }
    }
    let mut chip = Mpu9250::new(SensorOptions::default(), None, Box::new(Fast));
    configure(&mut chip);
    let counts = chip.counts_of(&Fast.sample(0.0));
    assert_eq!(counts, [32767, -32768, 0, 3339, 32767, -32768, 0]);
}

#[test]
fn the_self_test_answers_the_factory_trim_times_the_response() {
    let options = SensorOptions { self_test_response: [1.0, 0.4, 1.0, 1.0, 1.0, 1.0], ..SensorOptions::default() };
    let mut chip = chip(options, None);
    configure(&mut chip);
    write(&mut chip, 0x1B, 0xE0, READY_NS);
    let counts = chip.counts_of(&PhysicalSample::at_rest());
    let trim = |code: u8| 2620.0 * 1.01_f64.powi(i32::from(code) - 1);
    assert_eq!(f64::from(counts[4]), trim(0x40).round());
    assert_eq!(f64::from(counts[5]), (0.4 * trim(0x3E)).round());
    assert_eq!(read::<3>(&mut chip, 0x00, READY_NS), [0x40, 0x3E, 0x44]);
    assert_eq!(read::<3>(&mut chip, 0x0D, READY_NS), [0x5A, 0x58, 0x60]);
}

#[test]
fn a_replay_is_sampled_at_its_own_time_stamps() {
    const STAMPS: [f64; 4] = [0.1000000004, 0.1049999996, 0.1123, 0.1150000001];
    struct Replay(Arc<Mutex<Vec<f64>>>);
    impl SensorWorld for Replay {
        fn sample(&mut self, t_s: f64) -> PhysicalSample {
            self.0.lock().expect("one thread").push(t_s);
            PhysicalSample::at_rest()
        }
        fn next_sample_time(&mut self, after_s: f64) -> Option<f64> {
            Some(STAMPS.into_iter().find(|stamp| *stamp > after_s).unwrap_or(f64::INFINITY))
        }
    }
    let seen = Arc::new(Mutex::new(Vec::new()));
    let mut chip = Mpu9250::new(SensorOptions::default(), None, Box::new(Replay(Arc::clone(&seen))));
    configure(&mut chip);
    let mut now = READY_NS;
    while let Some(next) = chip.next_event_ns(now) {
        chip.on_event(next);
        now = next;
    }
    let seen = seen.lock().expect("one thread");
    assert_eq!(seen.len(), STAMPS.len(), "{seen:?}");
    assert!(seen.iter().zip(STAMPS).all(|(at, stamp)| (at - stamp).abs() < 1e-9), "{seen:?}");
}

#[test]
fn each_fault_shows_as_itself() {
    let mut missing = chip(SensorOptions::default(), Some(SensorFault::Missing { miso_high: true }));
    assert_eq!(read::<2>(&mut missing, 0x75, READY_NS), [0xFF, 0xFF]);
    let mut foreign = chip(SensorOptions::default(), Some(SensorFault::Foreign { who_am_i: 0xEA }));
    assert_eq!(read::<1>(&mut foreign, 0x75, READY_NS), [0xEA]);
    let mut stuck = chip(SensorOptions::default(), Some(SensorFault::DataReadyStuck));
    configure(&mut stuck);
    let at = stuck.next_event_ns(READY_NS).expect("it still samples");
    stuck.on_event(at);
    assert!(!stuck.int_high(at));
    let mut noisy = chip(SensorOptions::default(), Some(SensorFault::Garbage { from_s: 0.05 }));
    assert_eq!(read::<1>(&mut noisy, 0x75, READY_NS), [0x71]);
    assert_ne!(read::<4>(&mut noisy, 0x75, 60_000_000), [0x71, 0, 0, 0]);
    let mut lost = chip(SensorOptions::default(), Some(SensorFault::Lost { from_s: 0.05, miso_high: false }));
    assert_eq!(read::<1>(&mut lost, 0x75, READY_NS), [0x71]);
    assert_eq!(read::<1>(&mut lost, 0x75, 60_000_000), [0]);
}
