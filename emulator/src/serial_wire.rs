//! The host's end of USART1: bytes to the board in order, bytes from it with the instant each stop bit ended.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};

use rigless::chip::Timeline;
use rigless::chip::uart::Peer;
use rigless::snapshot::Store;
use rigless::time::VirtualNanos;

#[derive(Debug, Default)]
pub struct Buffers {
    pub to_board: VecDeque<u8>,
    /// Each byte with the run's nanosecond it had arrived at.
    pub from_board: Vec<(u64, u8)>,
}

#[derive(Debug, Clone, Default)]
pub struct SerialWire(Arc<Mutex<Buffers>>);

impl SerialWire {
    pub fn buffers(&self) -> MutexGuard<'_, Buffers> {
        self.0.lock().expect("no panic holds it")
    }
}

/// Snapshots are not used here.
impl Store for SerialWire {}

impl Peer for SerialWire {
    fn receive(&mut self, word: u16, context: &mut Timeline<'_, '_>) {
        self.buffers().from_board.push((context.now().0, word as u8));
    }

    fn transmit(&mut self, _now: VirtualNanos) -> Option<u16> {
        self.buffers().to_board.pop_front().map(u16::from)
    }
}
