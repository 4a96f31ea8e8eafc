//! Feeds the watchdog while sampling and the session both go round their loops.

use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use embassy_time::Timer;

use crate::shared::{SAMPLING_ALIVE, SESSION_ALIVE};

/// The task. A task that shows no sign of life for the watchdog's 12 s takes the board down with it, and the next
/// `@hello` says `reset=watchdog`.
#[embassy_executor::task]
pub async fn run(mut watchdog: IndependentWatchdog<'static, IWDG>) -> ! {
    watchdog.unleash();
    let (mut sampling, mut session) = (false, false);
    loop {
        sampling |= SAMPLING_ALIVE.take();
        session |= SESSION_ALIVE.take();
        if sampling && session {
            watchdog.pet();
            (sampling, session) = (false, false);
        }
        Timer::after_millis(250).await;
    }
}
