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
use static_cell::{ConstStaticCell, StaticCell};
use tumble_core::command::{Command, CommandError};
use tumble_core::estimate::Estimator;
use tumble_core::message::{Message, Trouble};
use tumble_core::procedure::{Phase, Procedure, Setup};
use tumble_core::record::Origin;
use tumble_core::sample::Ranges;
use tumble_core::session::{Effect, Session};
use tumble_core::tape::Tape;

use crate::board::ParameterFlash;
use crate::console;
use crate::fault::Fault;
use crate::shared::{SAMPLES, SENSOR_EVENTS, SESSION_ALIVE, SensorEvent, Stamped};
use keeper::{Keeper, firmware_version};
use lamp::Lamp;
use stream::Stream;
use voice::Voice;

/// What the sensor is set to.
const RANGES: Ranges = Ranges::WIDEST;

/// Records of 14 bytes: 12 a second while it moves, 2 at rest. A double scheme by a slow hand takes 2000.
const RECORDS: usize = 3072;
/// Rests, turns and moves. A double scheme without a mistake has 40.
const SEGMENTS: usize = 144;

/// The whole estimate, what it is made from and what it is made in, takes less than half of the memory.
const _: () = assert!(size_of::<Tape<RECORDS, SEGMENTS>>() + size_of::<Estimator<SEGMENTS>>() <= 64 * 1024);

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
    session: &'static mut Session<'static, RECORDS, SEGMENTS>,
}

/// The task's body. Never ends.
pub async fn run(flash: ParameterFlash, reset_cause: &'static str) -> ! {
    /// Half of the memory, so not on the stack.
    static TAPE: ConstStaticCell<Tape<RECORDS, SEGMENTS>> = ConstStaticCell::new(Tape::new());
    static SESSION: StaticCell<Session<RECORDS, SEGMENTS>> = StaticCell::new();
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
        session: SESSION.init_with(|| Session::new(TAPE.take())),
    };
    let mut unreadable = desk.keeper.load().await.err().map(Message::Error);
    desk.put_in_force();
    let mut second = Ticker::every(Duration::from_secs(1));
    loop {
        SESSION_ALIVE.show();
        match next(&mut second, desk.session.is_computing()).await {
            Input::Sample(sample) => desk.sample(&sample),
            Input::Line(line) => desk.line(line).await,
            Input::Sensor(event) => {
                desk.sensor(event).await;
                if let Some(message) = unreadable.take() {
                    desk.voice.say(&message).await;
                }
            }
            Input::Second => desk.session.second(now_us()),
            Input::Idle => desk.session.work(now_us()),
        }
        desk.carry_out().await;
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
    fn sample(&mut self, stamped: &Stamped) {
        let lost = self.last_seq.map_or(0, |last| stamped.seq.wrapping_sub(last).wrapping_sub(1));
        self.last_seq = Some(stamped.seq);
        let sample = RANGES.to_si(stamped.t_us, &stamped.counts);
        self.stream.sample(stamped, &sample, self.keeper.in_force());
        if lost > 0 {
            self.session.lost(lost);
        }
        self.session.sample(&sample, stamped.counts.clipped());
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
        self.session.command(now_us(), command);
    }

    /// What the session asks for, which may lead to more.
    async fn carry_out(&mut self) {
        while let Some(effect) = self.session.next_effect() {
            match effect {
                Effect::Say(message) => self.voice.say(&message).await,
                Effect::Remind(message) => self.voice.remind(&message).await,
                Effect::Led(pattern) => self.lamp.session(pattern),
                Effect::SayParameters => {
                    if let Some(calibration) = self.session.estimated() {
                        for parameter in calibration.parameters() {
                            self.voice.say(&Message::Param(parameter)).await;
                        }
                    }
                }
                Effect::Store => self.store().await,
            }
        }
    }

    async fn store(&mut self) {
        // The session asks for it right after it accepted one.
        let Some(accepted) = self.session.accepted().copied() else { return };
        let origin = Origin {
            generation: 0,
            firmware: firmware_version(),
            whoami: self.identity.map_or(0, |identity| identity.who_am_i),
            ranges: RANGES,
            setup: self.setup,
        };
        let result = self.keeper.store(origin, &accepted).await;
        self.session.stored(now_us(), result);
    }

    /// Tells the session what compensates from now on.
    fn put_in_force(&mut self) {
        let record = self.keeper.in_force();
        self.session.set_in_force(now_us(), record.map(|record| record.calibration.calibration()));
    }

    fn is_in_session(&self) -> bool {
        self.session.phase() != Phase::Idle
    }

    async fn sensor(&mut self, event: SensorEvent) {
        match event {
            SensorEvent::Started(identity) => {
                self.identity = Some(identity);
                self.keeper.fit(identity.who_am_i);
                self.put_in_force();
                self.hello().await;
                if identity.standing() == Standing::Relative {
                    defmt::warn!("identity {=u8:#x} is a relative of the MPU9250", identity.who_am_i);
                }
            }
            SensorEvent::Running => {
                self.lamp.well();
                if self.trouble.take().is_some() {
                    self.info().await;
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
}

fn now_us() -> u64 {
    Instant::now().as_micros()
}
