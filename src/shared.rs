//! What the tasks tell each other: queues, and counters that only grow.

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use mpu9250_spi::{Identity, SelfTest};
use portable_atomic::{AtomicBool, AtomicU32, Ordering};
use tumble_core::sample::Counts;

use crate::fault::Fault;

/// One reading on its way from the interrupt to the session.
#[derive(Clone, Copy)]
pub struct Stamped {
    /// Counts readings since start, those that were missed included, so that a gap is a lost sample.
    pub seq: u32,
    /// Microseconds since start, by the crystal, at data-ready.
    pub t_us: u64,
    /// The reading.
    pub counts: Counts,
}

/// What happens to the sensor.
pub enum SensorEvent {
    /// It answers and is set up; whether it samples is not known yet.
    Started(Identity),
    /// The first reading since has come.
    Running,
    /// It does not run. Told once, and again every few seconds while it lasts.
    Failed(Fault),
    /// The answer to [`SensorRequest::SelfTest`].
    SelfTest(Result<SelfTest, Fault>),
}

/// What the session asks of sampling.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum SensorRequest {
    /// Run the sensor's self-test.
    SelfTest,
    /// Stop, answer on [`PAUSED`], and wait for [`RESUME`]: the flash is about to be erased, which stops the core.
    Pause,
}

/// 128 readings are 640 ms, the longest the session may be busy without losing one: a slice of computing takes 10 ms,
/// a full console 90 ms, programming a record 10 ms.
pub static SAMPLES: Channel<CriticalSectionRawMutex, Stamped, 128> = Channel::new();
/// Sensor to session.
pub static SENSOR_EVENTS: Channel<CriticalSectionRawMutex, SensorEvent, 4> = Channel::new();
/// Session to sensor.
pub static SENSOR_REQUEST: Signal<CriticalSectionRawMutex, SensorRequest> = Signal::new();
/// Sampling has stopped.
pub static PAUSED: Signal<CriticalSectionRawMutex, ()> = Signal::new();
/// Sampling may go on.
pub static RESUME: Signal<CriticalSectionRawMutex, ()> = Signal::new();

/// A counter that `info` shows.
pub struct Counter(AtomicU32);

impl Counter {
    const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// Adds.
    pub fn add(&self, n: u32) {
        self.0.fetch_add(n, Ordering::Relaxed);
    }

    /// The count so far.
    pub fn get(&self) -> u32 {
        self.0.load(Ordering::Relaxed)
    }
}

/// Readings taken.
pub static SAMPLES_TAKEN: Counter = Counter::new();
/// Data-ready instants that passed unread.
pub static OVERRUNS: Counter = Counter::new();
/// Transfers that failed or brought what is no reading.
pub static SAMPLE_ERRORS: Counter = Counter::new();
/// Readings the session was too busy to take.
pub static QUEUE_OVERFLOWS: Counter = Counter::new();
/// Times the sensor was started, the first included.
pub static SENSOR_STARTS: Counter = Counter::new();
/// Frames that found no room on the console.
pub static FRAMES_DROPPED: Counter = Counter::new();
/// Console input lost to noise or overrun.
pub static CONSOLE_ERRORS: Counter = Counter::new();

/// A task's sign of life, set by it and taken by the supervisor.
pub struct Alive(AtomicBool);

impl Alive {
    const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// The task is alive.
    pub fn show(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Was it since last asked?
    pub fn take(&self) -> bool {
        self.0.swap(false, Ordering::Relaxed)
    }
}

/// Sampling goes round its loop, with a sensor or without.
pub static SAMPLING_ALIVE: Alive = Alive::new();
/// The session goes round its loop.
pub static SESSION_ALIVE: Alive = Alive::new();
