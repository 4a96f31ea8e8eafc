//! Bytes in and out of the serial port. Only the session writes, so that a line is never torn; the port itself is fed
//! from a pipe, so that nobody waits for it who has better to do.

use embassy_stm32::mode::Async;
use embassy_stm32::usart::{RingBufferedUartRx, UartTx};
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::pipe::Pipe;
use tumble_core::command::{Command, CommandError, LineEditor};

use crate::shared::{CONSOLE_ERRORS, FRAMES_DROPPED};

/// What waits to be sent: 90 ms of line.
const PIPE: usize = 4096;
/// Kept free of frames, so that a prompt finds room at once even while they stream.
const RESERVE: usize = 1024;
/// The longest line a person may type.
const LINE: usize = 80;

static OUT: Pipe<CriticalSectionRawMutex, PIPE> = Pipe::new();
/// Understood and misunderstood lines.
pub static LINES: Channel<CriticalSectionRawMutex, Result<Command, CommandError>, 4> = Channel::new();

/// Sends what stands in the pipe.
#[embassy_executor::task]
pub async fn transmit(mut port: UartTx<'static, Async>) -> ! {
    let mut chunk = [0; 256];
    loop {
        let length = OUT.read(&mut chunk).await;
        if port.write(&chunk[..length]).await.is_err() {
            CONSOLE_ERRORS.add(1);
        }
    }
}

/// Makes lines of what is received.
#[embassy_executor::task]
pub async fn receive(mut port: RingBufferedUartRx<'static>) -> ! {
    let mut editor = LineEditor::<LINE>::new();
    let mut chunk = [0; 64];
    loop {
        let Ok(length) = port.read(&mut chunk).await else {
            // Noise, a wrong baud rate, or a flood: the next read starts the reception again.
            CONSOLE_ERRORS.add(1);
            continue;
        };
        for byte in &chunk[..length] {
            if let Some(line) = editor.push(*byte) {
                LINES.send(line).await;
            }
        }
    }
}

/// Sends text, waiting for room.
pub async fn write(text: &str) {
    let mut rest = text.as_bytes();
    while !rest.is_empty() {
        let written = OUT.write(rest).await;
        rest = &rest[written..];
    }
}

/// Sends a frame if there is room for all of it beside [`RESERVE`]; else counts it as dropped.
pub fn try_write_frame(frame: &str) {
    if OUT.free_capacity() < frame.len() + RESERVE {
        FRAMES_DROPPED.add(1);
        return;
    }
    // The pipe is a ring and takes less than all at its end, so it may take two goes. Nobody else writes in between.
    let mut rest = frame.as_bytes();
    while let Ok(written @ 1..) = OUT.try_write(rest) {
        rest = &rest[written..];
        if rest.is_empty() {
            return;
        }
    }
}
