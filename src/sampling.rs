//! Data-ready to queue, in an interrupt executor that preempts all computing. Time is taken first, then the reading.
//!
//! The sensor's INT line is latched until the burst reads it, and its *level* is waited for: an edge wait would lose
//! edges that come between two waits. What can go wrong ends in a [`Fault`] that the session reports; this task then
//! starts the sensor afresh, for ever.

use embassy_futures::select::{Either, select};
use embassy_stm32::exti::ExtiInput;
use embassy_stm32::mode::Async;
use embassy_time::{Duration, Instant, TimeoutError, Timer, with_timeout};
use mpu9250_spi::{Configuration, Reading};
use tumble_core::sample::{Cadence, Counts};

use crate::board::Sensor;
use crate::fault::Fault;
use crate::shared::{
    OVERRUNS, PAUSED, QUEUE_OVERFLOWS, RESUME, SAMPLE_ERRORS, SAMPLES, SAMPLES_TAKEN, SAMPLING_ALIVE, SENSOR_EVENTS,
    SENSOR_REQUEST, SENSOR_STARTS, SensorEvent, SensorRequest, Stamped,
};

/// Without data-ready for twenty periods, something is wrong and not only late.
const DATA_READY_TIMEOUT: Duration = Duration::from_millis(100);
/// A burst takes 0.2 ms; one that has not ended after this never will.
const TRANSFER_TIMEOUT: Duration = Duration::from_millis(20);
/// Failed bursts in a row after which the sensor is started afresh: 25 ms of data.
const ERRORS_BEFORE_RESTART: u32 = 5;
/// Old readings in a row, a millisecond apart, after which data-ready hangs high and does not only come early.
const STALE_BEFORE_FAULT: u32 = 50;
/// Between two attempts to start the sensor.
const RETRY: Duration = Duration::from_millis(1000);
/// A fault that lasts is told again this often.
const REPEAT: Duration = Duration::from_secs(5);
/// Two sectors of at most 4 s each, and the core stands still meanwhile: this counts only time in between.
const PAUSE_MOST_QUARTER_SECONDS: u32 = 40;

/// The task. Never ends.
#[embassy_executor::task]
pub async fn run(sensor: Sensor, data_ready: ExtiInput<'static, Async>) -> ! {
    let configuration = Configuration::default();
    let mut sampling = Sampling {
        sensor,
        data_ready,
        configuration,
        cadence: Cadence::new(),
        seq: 0,
        last_us: None,
        expected_gap: false,
    };
    let mut told: Option<(u8, Instant)> = None;
    loop {
        SAMPLING_ALIVE.show();
        let fault = sampling.start_and_sample().await;
        fault.log();
        sampling.expected_gap = true;
        let again = told.is_some_and(|(code, at)| code == fault.trouble().code() && at.elapsed() < REPEAT);
        if !again && SENSOR_EVENTS.try_send(SensorEvent::Failed(fault)).is_ok() {
            told = Some((fault.trouble().code(), Instant::now()));
        }
        match select(Timer::after(RETRY), SENSOR_REQUEST.wait()).await {
            Either::First(()) => {}
            Either::Second(SensorRequest::Pause) => pause().await,
            Either::Second(SensorRequest::SelfTest) => tell(SensorEvent::SelfTest(Err(fault))).await,
        }
    }
}

struct Sampling {
    sensor: Sensor,
    data_ready: ExtiInput<'static, Async>,
    configuration: Configuration,
    cadence: Cadence,
    seq: u32,
    last_us: Option<u64>,
    /// The next gap is of our own making: a pause, a self-test, a restart.
    expected_gap: bool,
}

impl Sampling {
    /// Starts the sensor and samples until something fails.
    async fn start_and_sample(&mut self) -> Fault {
        let identity = match self.sensor.start(&self.configuration).await {
            Ok(identity) => identity,
            Err(error) => return Fault::Sensor(error),
        };
        SENSOR_STARTS.add(1);
        self.cadence = Cadence::new();
        tell(SensorEvent::Started(identity)).await;
        let (mut errors, mut stale, mut told) = (0, 0, false);
        loop {
            SAMPLING_ALIVE.show();
            let ready = select(self.data_ready.wait_for_high(), SENSOR_REQUEST.wait());
            match with_timeout(DATA_READY_TIMEOUT, ready).await {
                Err(TimeoutError) => return self.why_no_data_ready().await,
                Ok(Either::Second(request)) => self.serve(request).await,
                Ok(Either::First(())) => {
                    let t_us = Instant::now().as_micros();
                    match self.read().await {
                        Ok(reading) if reading.status.is_fresh() => {
                            (errors, stale) = (0, 0);
                            self.queue(t_us, &reading);
                            told = told || SENSOR_EVENTS.try_send(SensorEvent::Running).is_ok();
                        }
                        Ok(_) => {
                            stale += 1;
                            Timer::after_millis(1).await;
                        }
                        Err(fault) => {
                            SAMPLE_ERRORS.add(1);
                            errors += 1;
                            if errors >= ERRORS_BEFORE_RESTART {
                                return fault;
                            }
                        }
                    }
                    if stale >= STALE_BEFORE_FAULT {
                        return Fault::DataReadyHigh;
                    }
                }
            }
        }
    }

    async fn read(&mut self) -> Result<Reading, Fault> {
        match with_timeout(TRANSFER_TIMEOUT, self.sensor.read()).await {
            Ok(read) => read.map_err(Fault::Sensor),
            Err(TimeoutError) => Err(Fault::TransferHangs),
        }
    }

    /// Counts what was missed and passes the reading on. A full queue loses this reading, which `seq` then shows.
    fn queue(&mut self, t_us: u64, reading: &Reading) {
        let gap_us = self.last_us.map(|last| t_us.saturating_sub(last));
        let missed = match gap_us {
            Some(gap_us) if !self.expected_gap => self.cadence.missed(gap_us),
            _ => 0,
        };
        OVERRUNS.add(missed);
        self.expected_gap = false;
        self.last_us = Some(t_us);
        self.seq = self.seq.wrapping_add(1 + missed);
        SAMPLES_TAKEN.add(1);
        let counts = Counts { gyro: reading.gyro, accel: reading.accel, temperature: reading.temperature };
        if SAMPLES.try_send(Stamped { seq: self.seq, t_us, counts }).is_err() {
            QUEUE_OVERFLOWS.add(1);
        }
    }

    /// The line stayed low. A sensor that forgot its settings lost power; one that holds data has no wire to us.
    async fn why_no_data_ready(&mut self) -> Fault {
        if let Err(error) = self.sensor.check(&self.configuration).await {
            return Fault::Sensor(error);
        }
        match self.read().await {
            Err(fault) => fault,
            Ok(reading) if reading.status.is_fresh() => Fault::DataReadyLow,
            Ok(_) => Fault::Silent,
        }
    }

    async fn serve(&mut self, request: SensorRequest) {
        self.expected_gap = true;
        match request {
            SensorRequest::Pause => pause().await,
            SensorRequest::SelfTest => {
                let result = self.sensor.self_test(&self.configuration).await.map_err(Fault::Sensor);
                tell(SensorEvent::SelfTest(result)).await;
            }
        }
    }
}

async fn tell(event: SensorEvent) {
    // The session takes events within one slice of computing; should it not, data go first.
    let _ = with_timeout(Duration::from_millis(200), SENSOR_EVENTS.send(event)).await;
}

/// Stands still until told to go on, but no longer than any erase takes, lest a lost signal stop us for ever.
async fn pause() {
    RESUME.reset();
    PAUSED.signal(());
    for _ in 0..PAUSE_MOST_QUARTER_SECONDS {
        SAMPLING_ALIVE.show();
        if with_timeout(Duration::from_millis(250), RESUME.wait()).await.is_ok() {
            return;
        }
    }
}
