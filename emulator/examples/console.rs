//! Runs a firmware with its sensor at rest and shows what it says:
//! `cargo run --ignore-rust-version --example console -- ELF SECONDS [WORDS...]`. Each word is sent as a line, the
//! first after a second and the others two seconds apart.

use std::time::Instant;

use emulator::{AtRest, Board, BoardOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let elf = std::fs::read(arguments.next().ok_or("which ELF file?")?)?;
    let seconds: f64 = arguments.next().ok_or("how many seconds?")?.parse()?;
    let mut words: Vec<String> = arguments.collect();
    words.reverse();
    let started = Instant::now();
    let mut board = Board::new(&elf, BoardOptions::default(), Box::new(AtRest))?;
    let mut next_word_s = 1.0;
    let mut line = Vec::new();
    while board.now_s() < seconds {
        board.run_for(0.01)?;
        for (t_s, byte) in board.serial_read_timed() {
            match byte {
                b'\n' => println!("{t_s:10.4} {}", String::from_utf8_lossy(&std::mem::take(&mut line))),
                b'\r' => {}
                byte => line.push(byte),
            }
        }
        if board.now_s() >= next_word_s
            && let Some(word) = words.pop()
        {
            board.serial_write(format!("{word}\r\n").as_bytes());
            next_word_s += 2.0;
        }
    }
    println!(
        "{:.1} virtual seconds, {} instructions, {} samples, {:.2} s of host time",
        board.now_s(),
        board.instructions(),
        board.sensor_samples(),
        started.elapsed().as_secs_f64()
    );
    println!("stack {:?}, flash operations {:?}", board.stack_high_water(), board.flash_operations());
    println!("resets {:?}", board.resets());
    println!("LED changes {}", board.led_changes().len());
    board.gaps().iter().for_each(|gap| println!("gap {gap}"));
    Ok(())
}
