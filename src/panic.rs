//! What happens when something that cannot happen does: say so over RTT and start again. The next `@hello` then says
//! `reset=software`; the calibration in flash is untouched.

use core::panic::PanicInfo;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    defmt::error!("panic: {}", defmt::Display2Format(info));
    cortex_m::peripheral::SCB::sys_reset()
}
