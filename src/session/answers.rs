//! The words that are about the board.

use embassy_time::Instant;
use tumble_core::command::{CalAction, Command, StreamKind, WORDS};
use tumble_core::message::{Hello, Info, Message, Recording, Streaming, Task, Trouble};

use super::{Desk, RANGES};
use crate::board;
use crate::shared::{
    CONSOLE_ERRORS, FRAMES_DROPPED, OVERRUNS, QUEUE_OVERFLOWS, SAMPLE_ERRORS, SAMPLES_TAKEN, SENSOR_REQUEST,
    SENSOR_STARTS, SensorRequest,
};

impl Desk {
    /// Carries out a word that is not the session's, and says so.
    pub(super) async fn answer(&mut self, command: Command) {
        match command {
            Command::Help => {
                for word in &WORDS {
                    self.voice.say(&Message::Help(word)).await;
                }
                self.voice.say(&Message::Ok(command)).await;
            }
            Command::Info => self.info().await,
            Command::Cal(action) => self.cal(action).await,
            Command::Stream(kind) => self.stream(kind).await,
            Command::Record => self.record().await,
            Command::SelfTest => self.start_self_test().await,
            // The session's; never sent here.
            Command::Calibrate(_) | Command::Redo(_) | Command::Finish | Command::Cancel | Command::Verify => {}
        }
    }

    /// As in `@hello` and `@info`. A sensor that has not answered has no name.
    pub(super) fn about(&self) -> Hello {
        let whoami_read = match self.trouble {
            Some(Trouble::SensorMissing { whoami } | Trouble::SensorForeign { whoami }) => whoami,
            _ => 0,
        };
        Hello {
            firmware: env!("CARGO_PKG_VERSION"),
            board: board::NAME,
            sensor: self.identity.map_or("", |identity| identity.name()),
            whoami: self.identity.map_or(whoami_read, |identity| identity.who_am_i),
            reset: self.reset_cause,
            calibration: self.keeper.state(),
        }
    }

    pub(super) async fn info(&mut self) {
        let info = Info {
            hello: self.about(),
            ranges: RANGES,
            rate_hz: self.stream.measured_rate_hz().unwrap_or(0.0),
            samples: SAMPLES_TAKEN.get(),
            overruns: OVERRUNS.get(),
            sample_errors: SAMPLE_ERRORS.get(),
            uptime_us: Instant::now().as_micros(),
        };
        self.voice.say(&Message::Info(info)).await;
        let counters = [
            ("queue_overflows", &QUEUE_OVERFLOWS),
            ("frames_dropped", &FRAMES_DROPPED),
            ("sensor_starts", &SENSOR_STARTS),
            ("console_errors", &CONSOLE_ERRORS),
        ];
        for (name, counter) in counters {
            self.voice.say(&Message::Counter { name, value: u64::from(counter.get()) }).await;
        }
        if let Some(trouble) = &self.trouble {
            self.voice.say(&Message::Error(trouble.clone())).await;
        }
        self.voice.say(&Message::Ok(Command::Info)).await;
    }

    async fn cal(&mut self, action: CalAction) {
        if action == CalAction::Reset {
            self.voice.say(&Message::Busy { task: Task::Store, percent: 0 }).await;
            let erased = self.keeper.forget().await.map_or_else(Message::Error, |()| Message::Erased);
            self.put_in_force();
            self.voice.say(&erased).await;
        } else {
            let Some(record) = self.keeper.in_force().copied() else {
                return self.voice.say(&Message::Error(Trouble::NoCalibration)).await;
            };
            for parameter in record.calibration.calibration().parameters() {
                let message = Message::Param(parameter);
                match action {
                    CalAction::Export => self.voice.remind(&message).await,
                    CalAction::Show | CalAction::Reset => self.voice.say(&message).await,
                }
            }
        }
        self.voice.say(&Message::Ok(Command::Cal(action))).await;
    }

    async fn stream(&mut self, kind: StreamKind) {
        if kind == StreamKind::Cal && self.keeper.in_force().is_none() {
            return self.voice.say(&Message::Error(Trouble::NoCalibration)).await;
        }
        self.voice.say(&Message::Ok(Command::Stream(kind))).await;
        self.begin_stream(kind).await;
    }

    async fn record(&mut self) {
        self.voice.say(&Message::Ok(Command::Record)).await;
        let recording = Recording {
            sensor: self.about().sensor,
            rate_hz: self.stream.rate_hz(),
            ranges: RANGES,
            setup: self.setup,
        };
        self.voice.say(&Message::Recording(recording)).await;
        self.begin_stream(StreamKind::Raw).await;
    }

    /// Frames come after the line that says what they are; if there can be none, the reason comes too.
    async fn begin_stream(&mut self, kind: StreamKind) {
        self.stream.kind = kind;
        let streaming = Streaming { kind, rate_hz: self.stream.rate_hz(), ranges: RANGES };
        self.voice.say(&Message::Stream(streaming)).await;
        if let (Some(trouble), true) = (&self.trouble, kind != StreamKind::Off) {
            self.voice.say(&Message::Error(trouble.clone())).await;
        }
    }

    async fn start_self_test(&mut self) {
        if let Some(trouble) = &self.trouble {
            self.voice.say(&Message::Error(trouble.clone())).await;
        } else if self.is_in_session() {
            let why = "It would shake the session's data. Type \"cancel\" first, or wait until it is done.";
            self.voice.say(&Message::Error(Trouble::NotNow { command: Command::SelfTest, why })).await;
        } else {
            SENSOR_REQUEST.signal(SensorRequest::SelfTest);
        }
    }
}
