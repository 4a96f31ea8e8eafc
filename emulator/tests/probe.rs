//! The probe firmware, built with embassy like the product's, run on the board: every peripheral the product uses.

mod common;

use common::{ask, board, board_in, line, value};
use emulator::{AtRest, BoardOptions, FlashTiming, PhysicalSample, SensorFault, SensorOptions, SensorWorld, Stopped};

/// `RCC_CSR`'s flags: power-on, pin and brown-out; software; independent watchdog.
const POWER_ON: &str = "boot csr=0e000003";
const SCRATCH: usize = 0x4_0000;

#[test]
fn it_boots_on_the_pll_says_so_at_460800_baud_and_blinks() {
    let mut board = board();
    assert_eq!(line(&mut board, 0.1), POWER_ON);
    board.serial_write(b"AMMONIA");
    board.run_for(0.01).expect("it runs");
    let timed = board.serial_read_timed();
    assert_eq!(timed.iter().map(|(_, byte)| *byte).collect::<Vec<_>>(), b"AMMONIA");
    board.run_until(3.2).expect("it runs");
    let changes = board.led_changes();
    assert!(changes.len() >= 6, "{changes:?}");
    for pair in changes.windows(2) {
        assert_ne!(pair[0].1, pair[1].1);
        let gap = pair[1].0 - pair[0].0;
        assert!((gap - 0.5).abs() < 1e-4, "half a second by the crystal: {gap}");
    }
    assert_eq!(board.gaps(), Vec::<String>::new());
}

#[test]
fn a_line_takes_the_time_its_bits_take() {
    let mut board = board();
    line(&mut board, 0.1);
    board.serial_write(b"w");
    board.run_for(0.01).expect("it runs");
    let timed = board.serial_read_timed();
    assert!(timed.len() >= 8, "{timed:?}");
    let byte_s = (timed[7].0 - timed[0].0) / 7.0;
    // Ten bits; 96 MHz / 460 800 rounds to 208 cycles, 0.16 % off.
    assert!((byte_s - 10.0 / 460_800.0).abs() < 1e-7, "{byte_s}");
}

#[test]
fn the_sensor_is_found_by_dma_and_sampled_at_its_own_rate() {
    let sensor = SensorOptions { clock_error: -0.008, ..SensorOptions::default() };
    let mut board = board_in(BoardOptions { sensor, ..BoardOptions::default() }, AtRest);
    line(&mut board, 0.1);
    board.run_until(0.3).expect("it runs");
    assert_eq!(ask(&mut board, b'w', 0.1), "who=71");
    let first = ask(&mut board, b's', 0.1);
    board.run_until(2.3).expect("it runs");
    let last = ask(&mut board, b's', 0.1);
    let grown = |key| value(&last, key) - value(&first, key);
    let (samples, taken_us) = (grown("samples"), grown("last_us"));
    let period_us = taken_us as f64 / samples as f64;
    assert!(samples > 350, "{samples}");
    assert!((period_us - 5000.0 / 0.992).abs() < 0.02, "{period_us} µs");
}

#[test]
fn the_bytes_on_the_bus_are_the_world_s() {
    struct Turning;
    impl SensorWorld for Turning {
        fn sample(&mut self, _t_s: f64) -> PhysicalSample {
            PhysicalSample {
                angular_rate_rad_s: [0.1, -0.2, 3.0],
                specific_force_mps2: [-1.0, 2.0, 9.7],
                temperature_degc: 27.5,
            }
        }
    }
    let mut board = board_in(BoardOptions::default(), Turning);
    line(&mut board, 0.1);
    board.run_until(0.5).expect("it runs");
    let answer = ask(&mut board, b'l', 0.1);
    let hex = answer.strip_prefix("last=").expect("a burst");
    let bytes: Vec<u8> = (0..15).map(|i| u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).expect("hex")).collect();
    let words: Vec<i16> = bytes[1..].chunks(2).map(|pair| i16::from_be_bytes([pair[0], pair[1]])).collect();
    let expected = [-835, 1671, 8103, 2170, 188, -375, 5632];
    assert_eq!((bytes[0], words), (0x01, expected.to_vec()), "4 g and 1000 °/s");
}

#[test]
fn a_missing_or_foreign_sensor_and_a_stuck_line_show() {
    for (fault, who) in [
        (SensorFault::Missing { miso_high: true }, "who=ff"),
        (SensorFault::Missing { miso_high: false }, "who=00"),
        (SensorFault::Foreign { who_am_i: 0x74 }, "who=74"),
        (SensorFault::DataReadyStuck, "who=71"),
    ] {
        let options = BoardOptions { sensor_fault: Some(fault), ..BoardOptions::default() };
        let mut board = board_in(options, AtRest);
        line(&mut board, 0.1);
        board.run_until(0.5).expect("it runs");
        assert_eq!(ask(&mut board, b'w', 0.1), who);
        let samples = value(&ask(&mut board, b's', 0.1), "samples");
        assert_eq!(samples > 0, matches!(fault, SensorFault::Foreign { .. }), "{fault:?}: {samples}");
    }
}

#[test]
fn flash_erases_programs_refuses_and_survives_power() {
    let mut board = board();
    line(&mut board, 0.1);
    let asked = board.now_s();
    let erased = ask(&mut board, b'e', 5.0);
    assert!(erased.starts_with("erase=true"), "{erased}");
    // PSIZE is x8 out of reset, so 2 s pass; embassy's clock, 16 bits at 1 MHz and extended by an interrupt that
    // could not be taken meanwhile, sees them modulo 65.536 ms and at most one period more.
    assert!((2.0..2.01).contains(&(board.now_s() - asked)), "{} s", board.now_s() - asked);
    assert!(value(&erased, "ms") < 132, "{erased}");
    assert_eq!(ask(&mut board, b'v', 0.1), "word=ffffffff");
    assert_eq!(ask(&mut board, b'f', 0.1), "program=true");
    assert_eq!(ask(&mut board, b'v', 0.1), format!("word={:08x}", u32::from_le_bytes(*b"tumb")));
    assert_eq!(ask(&mut board, b'x', 0.1), "refused sr=00000080 cleared=00000000 word=ffffffff");
    assert_eq!(&board.flash()[SCRATCH..SCRATCH + 8], b"tumble!!");
    board.power_cycle(1.0).expect("it powers up");
    assert_eq!(line(&mut board, 0.1), POWER_ON);
    assert_eq!(ask(&mut board, b'v', 0.1), format!("word={:08x}", u32::from_le_bytes(*b"tumb")));
}

#[test]
fn the_core_stands_still_while_the_flash_is_busy() {
    let mut board = board();
    line(&mut board, 0.1);
    board.run_until(0.5).expect("it runs");
    let before = board.instructions();
    board.serial_write(b"e");
    board.run_for(1.9).expect("it runs");
    // Two seconds of erase: the sampling interrupt alone would have run 380 times.
    let ran = board.instructions() - before;
    assert!(ran < 20_000, "{ran} instructions");
    assert_eq!(board.serial_read(), b"");
}

#[test]
fn power_cuts_leave_what_they_leave() {
    let flash_timing = FlashTiming { erase_scale: 0.01, ..FlashTiming::default() };
    let mut board = board_in(BoardOptions { flash_timing, ..BoardOptions::default() }, AtRest);
    line(&mut board, 0.1);
    ask(&mut board, b'e', 1.0);
    // "tumble!!" is two words; the second is cut.
    board.power_cut_at_flash_op(1);
    board.serial_write(b"f");
    assert_eq!(board.run_for(0.1), Ok(Stopped::PowerCut));
    let cells = board.flash();
    assert_eq!(&cells[SCRATCH..SCRATCH + 4], b"tumb");
    let second: [u8; 4] = cells[SCRATCH + 4..SCRATCH + 8].try_into().expect("four");
    assert!(&second != b"le!!" && second != [0xFF; 4], "partly written: {second:02x?}");
    board.power_cycle(0.5).expect("it powers up");
    assert_eq!(line(&mut board, 0.1), POWER_ON);
    board.power_cut_at_flash_op(0);
    board.serial_write(b"e");
    assert_eq!(board.run_for(0.5), Ok(Stopped::PowerCut));
    board.power_cycle(0.5).expect("it powers up");
    assert_eq!(line(&mut board, 0.1), POWER_ON, "the firmware's own sectors are whole");
}

#[test]
fn resets_say_why() {
    let mut board = board();
    line(&mut board, 0.1);
    assert_eq!(ask(&mut board, b'r', 0.1), "boot csr=14000003", "software, and the pin it pulls");
    board.run_for(0.2).expect("it runs");
    assert_eq!(ask(&mut board, b'w', 0.1), "who=71", "the sensor was reset by the firmware and runs again");
    let started = board.now_s();
    assert_eq!(ask(&mut board, b'd', 1.0), "boot csr=24000003", "the watchdog");
    let resets = board.resets();
    assert_eq!(resets.len(), 2, "{resets:?}");
    assert!(resets[0].1.contains("Core") && resets[1].1.contains("IWDG"));
    // Started but never reloaded, it counts from 0xFFF whatever the reload register holds: 4096 · 4 / 32 kHz.
    let took = resets[1].0 - started;
    assert!((0.512..0.514).contains(&took), "{took} s");
}

#[test]
fn the_cycle_counter_counts_and_instructions_are_exact_and_repeatable() {
    let run = || {
        let mut board = board();
        line(&mut board, 0.1);
        board.watch_function("bench_begin").expect("a function");
        board.watch_function("bench_end").expect("a function");
        let answer = ask(&mut board, b'c', 0.1);
        let arrivals = board.take_arrivals();
        assert_eq!(arrivals.len(), 2, "{arrivals:?}");
        (value(&answer, "cycles"), arrivals[1].instructions - arrivals[0].instructions, board.instructions())
    };
    let (cycles, instructions, total) = run();
    assert!((20_000..200_000).contains(&instructions), "{instructions}");
    assert!(cycles.abs_diff(instructions) < 100, "{cycles} cycles for {instructions} instructions");
    assert_eq!(run(), (cycles, instructions, total), "a second run is the same run");
}

#[test]
fn the_stack_is_measured() {
    let mut board = board();
    line(&mut board, 0.1);
    let (used, size) = board.stack_high_water().expect("cortex-m-rt's symbols");
    assert!((200..8192).contains(&used) && size > 65_536, "{used} of {size}");
}

#[test]
fn it_stops_at_a_watched_function_and_memory_can_be_read_there() {
    let mut board = board();
    line(&mut board, 0.1);
    let address = board.watch_function("bench_begin").expect("a function");
    board.serial_write(b"c");
    assert_eq!(board.run_to_arrival(board.now_s() + 1.0), Ok(Stopped::Hit));
    assert_eq!(board.pc(), Some(address));
    let vectors = board.read_memory(0x0800_0000, 8).expect("flash");
    assert_eq!(vectors[..4], 0x2002_0000_u32.to_le_bytes(), "the initial stack pointer, at the end of RAM");
    assert_eq!(board.read_memory(0x2002_0000, 4), None, "there is no RAM past 128 KB");
    assert_eq!(board.run_for(0.1), Ok(Stopped::OnTime));
}

#[test]
fn a_fault_can_come_and_go_and_a_new_world_can_begin() {
    struct Hot;
    impl SensorWorld for Hot {
        fn sample(&mut self, _t_s: f64) -> PhysicalSample {
            PhysicalSample { temperature_degc: 60.0, ..PhysicalSample::at_rest() }
        }
    }
    let mut board = board();
    line(&mut board, 0.1);
    board.run_until(1.0).expect("it runs");
    let samples = |board: &mut emulator::Board| value(&ask(board, b's', 0.1), "samples");
    board.inject_fault(Some(SensorFault::DataReadyStuck));
    board.run_for(0.1).expect("it runs");
    let stuck = samples(&mut board);
    board.run_for(0.5).expect("it runs");
    assert_eq!(samples(&mut board), stuck);
    board.inject_fault(None);
    board.set_world(Box::new(Hot));
    board.run_for(0.5).expect("it runs");
    assert!(samples(&mut board) > stuck + 90);
    // (60 - 21) · 333.87 = 13021.
    assert!(ask(&mut board, b'l', 0.1).contains("32dd"));
}
