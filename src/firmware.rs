//! Start: the board, then the tasks.

use defmt_rtt as _;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_stm32::interrupt;
use embassy_stm32::interrupt::{InterruptExt, Priority};

use crate::{board, console, led, sampling, session, supervisor};

/// Runs in an interrupt that no peripheral here uses, so that it preempts everything else.
static SAMPLING_EXECUTOR: InterruptExecutor = InterruptExecutor::new();

#[interrupt]
unsafe fn SPI5() {
    // SAFETY: this is the handler of the interrupt the executor was started with, and nobody else calls it.
    unsafe { SAMPLING_EXECUTOR.on_interrupt() }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) -> ! {
    // A failure here is one of this file's constants and not of the world: the panic says which and starts again.
    let board = board::init().unwrap_or_else(|what| panic!("{}", what));
    defmt::info!("tumble {} on {}, reset by {}", env!("CARGO_PKG_VERSION"), board::NAME, board.reset_cause);

    interrupt::SPI5.set_priority(Priority::P6);
    let sampling_spawner = SAMPLING_EXECUTOR.start(interrupt::SPI5);
    sampling_spawner.spawn(sampling::run(board.sensor, board.data_ready).expect("spawned once"));

    spawner.spawn(console::transmit(board.transmit).expect("spawned once"));
    spawner.spawn(console::receive(board.receive).expect("spawned once"));
    spawner.spawn(led::run(board.led).expect("spawned once"));
    spawner.spawn(supervisor::run(board.watchdog).expect("spawned once"));
    session::run(board.flash, board.reset_cause).await
}
