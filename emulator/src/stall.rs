//! A core that can be made to stand still: what a fetch from busy flash does on the part.
//!
//! While stalled, the wrapped core reports that it waits, so the run moves its clock to the next event without
//! an instruction, an interrupt or any host time being spent. Everything else is the inner core's.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rigless::emulator::{
    BitAlias, CoreBus, DataModel, Error, Exit, HaltReason, HostCall, Processor, ProcessorConstructor, Queued,
};
use rigless::soc::{Endian, Width};
use rigless::time::VirtualNanos;

/// What the board and its models share with the core.
#[derive(Debug, Default)]
pub struct CoreState {
    stalled: AtomicBool,
    pc: AtomicU64,
    locked_up: AtomicBool,
}

pub type SharedCore = Arc<CoreState>;

impl CoreState {
    /// Has the core stand still, or run on.
    pub fn stall(&self, stalled: bool) {
        self.stalled.store(stalled, Ordering::Relaxed);
    }

    /// The next instruction's address, as of the last stretch of instructions.
    #[must_use]
    pub fn pc(&self) -> u64 {
        self.pc.load(Ordering::Relaxed)
    }

    /// Whether a fault inside a fault handler stopped the core for good.
    #[must_use]
    pub fn locked_up(&self) -> bool {
        self.locked_up.load(Ordering::Relaxed)
    }
}

/// Wraps what `make` makes in a core that stands still while `state` says so.
#[must_use]
pub fn stalling(make: ProcessorConstructor, state: SharedCore) -> ProcessorConstructor {
    Arc::new(move |endian| {
        let inner = make(endian)?;
        Ok(Box::new(StallingCore { inner, state: Arc::clone(&state) }))
    })
}

#[derive(Debug)]
struct StallingCore {
    inner: Box<dyn Processor>,
    state: SharedCore,
}

type ReadMemory<'a> = &'a mut dyn FnMut(u64, Width) -> Option<u64>;

#[expect(unsafe_code, reason = "`Processor::map` is unsafe to declare; the call is passed on unchanged")]
impl Processor for StallingCore {
    fn run(&mut self, budget: u32, bus: &mut dyn CoreBus) -> (Exit, u64) {
        if self.state.stalled.load(Ordering::Relaxed) {
            return (Exit::Waiting, 0);
        }
        let (exit, ran) = self.inner.run(budget, bus);
        self.state.pc.store(self.inner.pc(), Ordering::Relaxed);
        self.state.locked_up.store(exit == Exit::Lockup, Ordering::Relaxed);
        (exit, ran)
    }
    unsafe fn map(&mut self, start: u64, length: u64, host: *mut u8, writable: bool) {
        // SAFETY: the caller's promise to this core is the one the inner core asks for.
        unsafe { self.inner.map(start, length, host, writable) }
    }
    fn retired(&self) -> u64 {
        self.inner.retired()
    }
    fn ask(&mut self, queued: Queued) {
        self.inner.ask(queued);
    }
    fn maps(&self, start: u64, length: u64) -> bool {
        self.inner.maps(start, length)
    }
    fn page_size(&self) -> u64 {
        self.inner.page_size()
    }
    fn boot(&mut self, table: u64, read: &dyn Fn(u64, Width) -> Option<u64>) {
        self.inner.boot(table, read);
    }
    fn reset(&mut self) {
        self.inner.reset();
    }
    fn take_reset_request(&mut self) -> bool {
        self.inner.take_reset_request()
    }
    fn next_event(&self) -> Option<VirtualNanos> {
        self.inner.next_event()
    }
    fn on_event(&mut self, now: VirtualNanos) {
        self.inner.on_event(now);
    }
    fn waiting(&self) -> bool {
        self.inner.waiting()
    }
    fn pc(&self) -> u64 {
        self.inner.pc()
    }
    fn add_breakpoint(&mut self, address: u64) -> bool {
        self.inner.add_breakpoint(address)
    }
    fn remove_breakpoint(&mut self, address: u64) {
        self.inner.remove_breakpoint(address);
    }
    fn pass_breakpoint(&mut self, address: u64) {
        self.inner.pass_breakpoint(address);
    }
    fn attach_debugger(&mut self, attached: bool) {
        self.inner.attach_debugger(attached);
    }
    fn hold_interrupts(&mut self, held: bool) {
        self.inner.hold_interrupts(held);
    }
    fn gdb_register(&self, number: usize) -> Option<Vec<u8>> {
        self.inner.gdb_register(number)
    }
    fn set_gdb_register(&mut self, number: usize, bytes: &[u8]) -> bool {
        self.inner.set_gdb_register(number, bytes)
    }
    fn debugger_access(&mut self, write: Option<u64>, address: u64, width: Width, now: VirtualNanos) -> Option<u64> {
        self.inner.debugger_access(write, address, width, now)
    }
    fn take_debugger_trace(&mut self) -> Vec<u8> {
        self.inner.take_debugger_trace()
    }
    fn target_xml(&self) -> &'static str {
        self.inner.target_xml()
    }
    fn data_model(&self) -> DataModel {
        self.inner.data_model()
    }
    fn byte_order(&self, address: u64) -> Endian {
        self.inner.byte_order(address)
    }
    fn save(&self) -> Vec<u8> {
        self.inner.save()
    }
    fn load(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.inner.load(bytes)
    }
    fn monitor_command(&mut self, command: &str) -> Option<String> {
        self.inner.monitor_command(command)
    }
    fn debugger_halted(&mut self, why: HaltReason) -> bool {
        self.inner.debugger_halted(why)
    }
    fn bit_alias(&self, address: u64, width: Width) -> Option<BitAlias> {
        self.inner.bit_alias(address, width)
    }
    fn own_ranges(&self) -> Vec<Range<u64>> {
        self.inner.own_ranges()
    }
    fn check_reads(&mut self, every: bool) {
        self.inner.check_reads(every);
    }
    fn host_call(&self, read: ReadMemory<'_>) -> Option<HostCall> {
        self.inner.host_call(read)
    }
    fn answer_host_call(&mut self, answer: Option<u64>) {
        self.inner.answer_host_call(answer);
    }
}
