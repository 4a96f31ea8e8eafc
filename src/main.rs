//! Tumble's firmware: tasks that carry samples, words and bytes between the hardware and `tumble_core`, which thinks.
//!
//! [`sampling`] runs in an interrupt and fills a queue; [`session`] empties it into the core, carries out what the core
//! asks for and answers the person; [`console`] moves bytes; [`store`] keeps the calibration; [`supervisor`] feeds the
//! watchdog while both of the first live. The pins are in [`board`] alone.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod console;
#[cfg(target_os = "none")]
mod fault;
#[cfg(target_os = "none")]
mod firmware;
#[cfg(target_os = "none")]
mod flash;
#[cfg(target_os = "none")]
mod led;
#[cfg(target_os = "none")]
mod panic;
#[cfg(target_os = "none")]
mod sampling;
#[cfg(target_os = "none")]
mod session;
#[cfg(target_os = "none")]
mod shared;
#[cfg(target_os = "none")]
mod store;
#[cfg(target_os = "none")]
mod supervisor;

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "This is firmware for the STM32F411. With a board and a debug probe connected:\n\n    \
         rustup target add thumbv7em-none-eabihf\n    \
         cargo install probe-rs-tools --locked\n    \
         cargo run --release --target thumbv7em-none-eabihf\n\n\
         Without a board, on an emulated one:\n\n    \
         cargo xtask demo"
    );
}
