//! Shows the pattern in force, from the moment it was set.

use embassy_futures::select::{Either, select};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;
use embassy_time::{Instant, Timer};
use tumble_core::led::Pattern;

use crate::board::Light;

/// The pattern to show from now on.
pub static PATTERN: Signal<CriticalSectionRawMutex, Pattern> = Signal::new();

/// The task. The eye does not see the 10 ms by which it may be late.
#[embassy_executor::task]
pub async fn run(mut light: Light) -> ! {
    let (mut pattern, mut since) = (Pattern::Off, Instant::now());
    loop {
        light.set(pattern.lit(since.elapsed().as_millis()));
        match select(Timer::after_millis(10), PATTERN.wait()).await {
            Either::First(()) => {}
            // Said twice, a lasting pattern goes on as it was; an event is blinked anew.
            Either::Second(new) if new == pattern && !matches!(new, Pattern::Accepted | Pattern::Done) => {}
            Either::Second(new) => (pattern, since) = (new, Instant::now()),
        }
    }
}
