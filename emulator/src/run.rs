//! One power-on to power-off of the board: rigless runs the core on its own thread, and stops when it is told to.
//!
//! The thread waits inside the driver at each stop, with the models settled and no instruction half done, for
//! the host's next command. So everything the host does to the board happens between two instructions.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use rigless::emulator::{self, Driver, Hit, Host, Settled, Start, Stop};
use rigless::image::Image;
use rigless::session::Session;
use rigless::time::VirtualNanos;

use crate::flash::SharedFlash;
use crate::machine::BlackPill;
use crate::memory_map::FLASH_BASE;

/// The flash interface's registers, whose accesses are where a power cut can begin.
const FLASH_REGISTERS: u64 = 0x4002_3C00;
const FLASH_REGISTERS_END: u64 = 0x4002_4000;
/// The unique id and flash size words of the system memory (RM0383 section 24).
const UNIQUE_ID: u64 = 0x1FFF_7A10;
const FLASH_SIZE_KB: u64 = 0x1FFF_7A22;

pub type Task = Box<dyn FnOnce(&mut Session<BlackPill>, &mut dyn Host) + Send>;

enum Command {
    RunUntil(VirtualNanos),
    Do(Task),
    Off,
}

/// Where a run stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Standing {
    pub at_ns: u64,
    pub instructions: u64,
    /// The run is over, and why, where it did not end because the host switched it off.
    pub ended: Option<String>,
}

/// What the host and the run's thread share.
#[derive(Debug, Clone, Default)]
pub struct Shared {
    pub hits: Arc<Mutex<Vec<Hit>>>,
    pub stop_at_hits: Arc<AtomicBool>,
}

#[derive(Debug)]
pub struct Run {
    commands: Sender<Command>,
    standings: Receiver<Standing>,
    thread: Option<JoinHandle<()>>,
    last: Standing,
}

struct HostDriver {
    commands: Receiver<Command>,
    standings: Sender<Standing>,
    shared: Shared,
    flash: SharedFlash,
}

impl Driver<BlackPill> for HostDriver {
    fn on_settled(&mut self, session: &mut Session<BlackPill>, _host: &mut dyn Host, settled: Settled) {
        match settled {
            Settled::Access { access, .. } => {
                let flash = access.address >= FLASH_BASE
                    && (access.address < FLASH_BASE + 0x8_0000
                        || (FLASH_REGISTERS..FLASH_REGISTERS_END).contains(&access.address));
                if flash && self.flash.lock().expect("no panic holds it").dead() {
                    session.run_until(access.virtual_time);
                }
            }
            Settled::Hit(hit) => {
                self.shared.hits.lock().expect("no panic holds it").push(hit);
                if self.shared.stop_at_hits.load(Ordering::Relaxed) {
                    session.run_until(hit.at);
                }
            }
            _ => {}
        }
    }

    fn on_stop(&mut self, session: &mut Session<BlackPill>, stop: Stop, host: &mut dyn Host) -> Option<VirtualNanos> {
        let standing = Standing {
            at_ns: stop.at.0,
            instructions: stop.instruction_count,
            ended: session.take_error().map(|error| error.to_string()),
        };
        self.standings.send(standing).ok()?;
        loop {
            match self.commands.recv().ok()? {
                Command::RunUntil(until) => return Some(until.max(stop.at)),
                Command::Do(task) => task(session, host),
                Command::Off => return None,
            }
        }
    }
}

/// The images a powered board holds: its flash whole, and the factory's words.
fn images(flash: &SharedFlash) -> Result<Vec<Image>, String> {
    let cells = flash.lock().expect("no panic holds it").bytes().to_vec();
    let place = |name: &str, bytes: Vec<u8>, at| {
        Image::new(Path::new(name), bytes, Some(at)).map_err(|error| error.to_string())
    };
    Ok(vec![
        place("flash", cells, FLASH_BASE)?,
        place("unique-id", b"TUMBLE-EMU-1".to_vec(), UNIQUE_ID)?,
        place("flash-size", 512_u16.to_le_bytes().to_vec(), FLASH_SIZE_KB)?,
    ])
}

impl Run {
    /// Powers `machine` up and stops before its first instruction.
    pub fn start(machine: BlackPill, flash: &SharedFlash, shared: Shared) -> Result<Self, String> {
        let (commands, to_run) = channel();
        let (from_run, standings) = channel();
        let images = images(flash)?;
        let session = Session::new(Box::new(machine), 0, VirtualNanos(0)).map_err(|error| error.to_string())?;
        let driver = HostDriver { commands: to_run, standings: from_run.clone(), shared, flash: Arc::clone(flash) };
        let thread = std::thread::spawn(move || {
            if let Err(error) = emulator::run(session, &Start::new(&images), driver) {
                let ended = Some(error.to_string());
                // Nobody listens once the host has dropped the board.
                let _ = from_run.send(Standing { at_ns: 0, instructions: 0, ended });
            }
        });
        let last = Standing { at_ns: 0, instructions: 0, ended: None };
        let mut run = Self { commands, standings, thread: Some(thread), last };
        run.wait();
        match &run.last.ended {
            Some(why) => Err(why.clone()),
            None => Ok(run),
        }
    }

    #[must_use]
    pub fn standing(&self) -> &Standing {
        &self.last
    }

    fn wait(&mut self) {
        match self.standings.recv() {
            Ok(Standing { ended: Some(why), .. }) => self.last.ended = Some(why),
            Ok(standing) => self.last = standing,
            Err(_) => self.last.ended = Some("the run's thread ended without a word".to_owned()),
        }
    }

    /// Runs to `until_ns` of the run's clock, or to a stop before it.
    pub fn run_until(&mut self, until_ns: u64) -> &Standing {
        if self.last.ended.is_none() {
            if self.commands.send(Command::RunUntil(VirtualNanos(until_ns))).is_ok() {
                self.wait();
            } else {
                self.last.ended = Some("the run's thread has gone".to_owned());
            }
        }
        &self.last
    }

    /// Does `task` where the run stands, and answers what it answered.
    pub fn at_stop<T: Send + 'static>(
        &self,
        task: impl FnOnce(&mut Session<BlackPill>, &mut dyn Host) -> T + Send + 'static,
    ) -> Option<T> {
        let (answer, answered) = channel();
        let task: Task = Box::new(move |session, host| {
            // A host that no longer waits needs no answer.
            let _ = answer.send(task(session, host));
        });
        self.commands.send(Command::Do(task)).ok()?;
        answered.recv().ok()
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        // A run that has ended hears nothing, and needs not.
        let _ = self.commands.send(Command::Off);
        if let Some(thread) = self.thread.take() {
            // A panic in the models was reported on its own thread already.
            let _ = thread.join();
        }
    }
}
