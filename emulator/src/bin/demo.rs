//! `cargo xtask demo`: the main story on the emulated board, with the real firmware image. See `emulator::story`.

use std::path::PathBuf;
use std::process::ExitCode;

use emulator::story::narrator::Telling;
use emulator::story::replay;
use emulator::story::stage::Cast;
use emulator::story::whole::{self, Script};

const USAGE: &str = "demo [--firmware ELF] [--seed N] [--by-hand] [--verbose] [--json] [--brief] [--replay REC.csv]

  --firmware ELF    the image to run; otherwise the environment's TUMBLE_FIRMWARE
  --seed N          of sensor, hands, noise and the person's decisions (1)
  --by-hand         turns end by eye, good to 2 degrees, and not against a fence, good to 0.1
  --verbose         every line of the console, and what the LED shows
  --json            one JSON object on standard output and nothing else
  --brief           calibrate, store and find again only: no tumbling, no verify
  --replay REC.csv  feed the sensor from a recording instead of a person";

#[derive(Debug)]
struct Options {
    firmware: PathBuf,
    seed: u64,
    by_hand: bool,
    verbose: bool,
    json: bool,
    script: Script,
    replay: Option<PathBuf>,
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let firmware = std::env::var_os("TUMBLE_FIRMWARE").unwrap_or_default().into();
        let mut options = Self {
            firmware,
            seed: 1,
            by_hand: false,
            verbose: false,
            json: false,
            script: Script::default(),
            replay: None,
        };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            match word.as_str() {
                "--firmware" => options.firmware = value()?.into(),
                "--seed" => options.seed = value()?.parse().map_err(|_| "--seed takes a whole number".to_owned())?,
                "--replay" => options.replay = Some(value()?.into()),
                "--by-hand" => options.by_hand = true,
                "--verbose" => options.verbose = true,
                "--brief" => options.script = Script::CALIBRATION,
                "--json" => options.json = true,
                "--help" | "-h" => return Ok(None),
                _ => return Err(format!("{word} is no option of the demo")),
            }
        }
        if options.firmware.as_os_str().is_empty() {
            return Err("which firmware? Give --firmware ELF, or run `cargo xtask demo`, which builds it".to_owned());
        }
        Ok(Some(options))
    }

    fn telling(&self) -> Telling {
        match (self.json, self.verbose) {
            (true, _) => Telling::Nothing,
            (false, true) => Telling::Everything,
            (false, false) => Telling::Story,
        }
    }
}

fn main() -> ExitCode {
    let options = match Options::parse(std::env::args().skip(1)) {
        Ok(Some(options)) => options,
        Ok(None) => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        Err(wrong) => {
            eprintln!("demo: {wrong}\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let done = std::fs::read(&options.firmware)
        .map_err(|error| format!("{}: {error}", options.firmware.display()))
        .and_then(|elf| if options.replay.is_some() { play(&elf, &options) } else { tell(&elf, &options) });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("demo: {why}");
            ExitCode::FAILURE
        }
    }
}

fn tell(elf: &[u8], options: &Options) -> Result<(), String> {
    let cast = Cast { telling: options.telling(), ..Cast::new(options.seed, options.by_hand) };
    if !options.json {
        let turns = if options.by_hand { "by hand" } else { "against a fence" };
        println!("Seed {}, turns {turns}. The person hears only the console and sees only the LED.", options.seed);
    }
    let outcome = whole::tell(elf, &cast, options.script).map_err(|failure| failure.to_string())?;
    if options.json {
        println!("{}", outcome.json(&cast));
    } else {
        outcome.print(options.script);
    }
    let failed = outcome.checks.failed();
    if failed.is_empty() { Ok(()) } else { Err(format!("these did not hold:\n  {}", failed.join("\n  "))) }
}

fn play(elf: &[u8], options: &Options) -> Result<(), String> {
    let file = options.replay.as_deref().unwrap_or_else(|| std::path::Path::new(""));
    let replayed = replay::replay(elf, file, options.telling()).map_err(|failure| failure.to_string())?;
    if options.json {
        println!("{}", replayed.json());
    } else {
        replayed.print();
    }
    if replayed.same_on_host == Some(false) {
        return Err("board and host compute different numbers from the same samples".to_owned());
    }
    if replayed.is_accepted() { Ok(()) } else { Err(format!("the board judged: {}", replayed.verdict)) }
}
