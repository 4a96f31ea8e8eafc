//! Carries: samples and words into the core's session, what the session asks for out into the world, and the answers to
//! the words that are about the board and not about calibrating.

mod answers;
mod keeper;
mod lamp;
mod stream;
mod voice;

use core::future::pending;

use embassy_futures::select::{Either5, select5};
use embassy_futures::yield_now;
use embassy_time::{Duration, Instant, Ticker};
use mpu9250_spi::{Identity, SelfTest, Standing};
use tumble_core::command::{Command, CommandError};
use tumble_core::message::{Message, Trouble};
use tumble_core::procedure::{Procedure, Setup};
use tumble_core::sample::Ranges;

use crate::board::ParameterFlash;
use crate::console;
use crate::fault::Fault;
use crate::shared::{SAMPLES, SENSOR_EVENTS, SESSION_ALIVE, SensorEvent, Stamped};
use keeper::Keeper;
use lamp::Lamp;
use stream::Stream;
use voice::Voice;

/// What the sensor is set to.
const RANGES: Ranges = Ranges::WIDEST;

/// What can happen to the session.
enum Input {
    Sample(Stamped),
    Line(Result<Command, CommandError>),
    Sensor(SensorEvent),
    Second,
    /// Nothing else is waiting: time for a slice of computing.
    Idle,
}

/// Everything the session's task holds.
struct Desk {
    voice: Voice,
    keeper: Keeper,
    lamp: Lamp,
    stream: Stream,
    reset_cause: &'static str,
    /// Known once the sensor has answered.
    identity: Option<Identity>,
    /// Why there are no samples, while there are none.
    trouble: Option<Trouble>,
    said_hello: bool,
    /// As last stated with `calibrate`.
    setup: Setup,
    last_seq: Option<u32>,
}

/// The task's body. Never ends.
pub async fn run(flash: ParameterFlash, reset_cause: &'static str) -> ! {
    let mut desk = Desk {
        voice: Voice::default(),
        keeper: Keeper::new(flash),
        lamp: Lamp::default(),
        stream: Stream::default(),
        reset_cause,
        identity: None,
        trouble: None,
        said_hello: false,
        setup: Setup::default(),
        last_seq: None,
    };
    let unreadable = desk.keeper.load().await.err();
    let mut second = Ticker::every(Duration::from_secs(1));
    let mut unreadable = unreadable.map(Message::Error);
    loop {
        SESSION_ALIVE.show();
        match next(&mut second, desk.is_computing()).await {
            Input::Sample(sample) => desk.sample(&sample).await,
            Input::Line(line) => desk.line(line).await,
            Input::Sensor(event) => {
                desk.sensor(event).await;
                if let Some(message) = unreadable.take() {
                    desk.voice.say(&message).await;
                }
            }
            Input::Second => desk.second().await,
            Input::Idle => desk.work().await,
        }
    }
}

/// The next thing that happens, samples first. While the core computes, its slices fill the time in between, and the
/// other tasks get theirs.
async fn next(second: &mut Ticker, computing: bool) -> Input {
    let idle = async {
        if computing {
            yield_now().await;
        } else {
            pending::<()>().await;
        }
    };
    match select5(SAMPLES.receive(), console::LINES.receive(), SENSOR_EVENTS.receive(), second.next(), idle).await {
        Either5::First(sample) => Input::Sample(sample),
        Either5::Second(line) => Input::Line(line),
        Either5::Third(event) => Input::Sensor(event),
        Either5::Fourth(()) => Input::Second,
        Either5::Fifth(()) => Input::Idle,
    }
}

impl Desk {
    async fn sample(&mut self, stamped: &Stamped) {
        let lost = self.last_seq.map_or(0, |last| stamped.seq.wrapping_sub(last).wrapping_sub(1));
        self.last_seq = Some(stamped.seq);
        let sample = RANGES.to_si(stamped.t_us, &stamped.counts);
        self.stream.sample(stamped, &sample, self.keeper.in_force());
        let _ = (lost, sample);
    }

    async fn line(&mut self, line: Result<Command, CommandError>) {
        match line {
            Err(error) => self.voice.say(&Message::Error(Trouble::Word(error))).await,
            Ok(command) if Procedure::owns(command) => self.session_word(command).await,
            Ok(command) => self.answer(command).await,
        }
    }

    async fn session_word(&mut self, command: Command) {
        if let Some(trouble) = &self.trouble {
            return self.voice.say(&Message::Error(trouble.clone())).await;
        }
        if let Command::Calibrate(setup) = command {
            self.setup = setup;
        }
    }

    async fn sensor(&mut self, event: SensorEvent) {
        match event {
            SensorEvent::Started(identity) => {
                self.identity = Some(identity);
                self.trouble = None;
                self.lamp.well();
                self.hello().await;
                if identity.standing() == Standing::Relative {
                    defmt::warn!("identity {=u8:#x} is a relative of the MPU9250", identity.who_am_i);
                }
            }
            SensorEvent::Failed(fault) => {
                let trouble = fault.trouble();
                self.lamp.ill(trouble.code());
                self.stream.interrupted();
                self.trouble = Some(trouble.clone());
                self.hello().await;
                self.voice.say(&Message::Error(trouble)).await;
            }
            SensorEvent::SelfTest(result) => self.self_test(result).await,
        }
    }

    async fn hello(&mut self) {
        if !self.said_hello {
            self.said_hello = true;
            self.voice.say(&Message::Hello(self.about())).await;
        }
    }

    async fn self_test(&mut self, result: Result<SelfTest, Fault>) {
        let test = match result {
            Ok(test) => test,
            Err(fault) => return self.voice.say(&Message::Error(fault.trouble())).await,
        };
        let names = ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"];
        for (axis, result) in names.into_iter().zip(test.gyro.iter().chain(&test.accel)) {
            self.voice.say(&Message::SelfTest { axis, response: result.response, ok: result.ok }).await;
        }
        self.voice.say(&Message::Ok(Command::SelfTest)).await;
    }

    async fn second(&mut self) {
        let _ = Instant::now();
    }

    fn is_computing(&self) -> bool {
        false
    }

    async fn work(&mut self) {}
}
