//! The whole story: empty flash, a guided calibration, a power cut, the record found again, compensated data, a check on
//! fresh poses.

use std::time::Instant;

use serde_json::json;

use super::Failure;
use super::acts::{self, Session};
use super::checks::Checks;
use super::inertial::LevelError;
use super::levelling::{self, Alignment, Levels};
use super::parameters::Parameters;
use super::score::{Rms, Score};
use super::stage::{Cast, Stage};
use super::tally;

/// How much of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Script {
    /// Length of each of both tumblings; none to leave them out.
    pub tumble_s: Option<f64>,
    pub verify: bool,
}

impl Default for Script {
    fn default() -> Self {
        Self { tumble_s: Some(65.0), verify: true }
    }
}

impl Script {
    /// The calibration and what is left of it after the power cycle, for those who want many.
    pub const CALIBRATION: Self = Self { tumble_s: None, verify: false };
}

/// What it came to.
#[derive(Debug, Clone)]
pub struct Outcome {
    pub session: Session,
    pub score: Score,
    pub levels: Levels,
    pub delivered: LevelError,
    pub checks: Checks,
    pub virtual_s: f64,
    pub instructions: u64,
    pub host_s: f64,
    pub stack: Option<(usize, usize)>,
}

/// Tells it, on standard output if the cast is to be told of.
pub fn tell(elf: &[u8], cast: &Cast, script: Script) -> Result<Outcome, Failure> {
    let started = Instant::now();
    let mut stage = Stage::new(elf, cast)?;
    let mut checks = Checks::default();

    stage.narrator.act("Act 1. The power comes on; the flash is empty. The board guides, the person does.");
    let hello = acts::boot(&mut stage)?;
    let state = hello.value("calibration").unwrap_or("none");
    checks.note("it starts with no calibration", state == "none", format!("calibration={state}"));
    let session = acts::calibrate(&mut stage, 0)?;
    let truth = stage.theatre.with(|world| world.truth_between(session.from_s, session.to_s))?;
    let score = Score::new(&truth.in_box, &session.parameters);
    tally::judge_session(&mut checks, &session, &score);
    let told = format!(
        "the estimate took {:.2} s and {:.1} million instructions on the microcontroller",
        session.estimate.seconds,
        session.estimate.instructions as f64 * 1e-6
    );
    stage.narrator.host(stage.now_s(), &told);
    tally::judge_counters(&mut checks, "while calibrating", &acts::info(&mut stage)?);

    stage.narrator.act("Act 2. The power is cut for half a second. What does the board remember?");
    // The session's use of it is the largest, and what is painted at power-on goes with the power.
    let calibrating = stage.board.stack_high_water();
    stage.power_cycle(0.5)?;
    let hello = acts::boot(&mut stage)?;
    let read_back = if session.stored { acts::export(&mut stage)? } else { Parameters::default() };
    tally::judge_record(&mut checks, hello.value("calibration").unwrap_or("none"), &session.parameters, &read_back);

    let mut outcome = Outcome {
        session,
        score,
        levels: Levels::default(),
        delivered: LevelError::default(),
        checks,
        virtual_s: 0.0,
        instructions: 0,
        host_s: 0.0,
        stack: calibrating,
    };
    if outcome.session.stored {
        if let Some(seconds) = script.tumble_s {
            stage.narrator.act("Act 3. The person tumbles the box in the hands, twice.");
            tumble(&mut stage, &mut outcome, &read_back, &truth.in_box, seconds)?;
        }
        if script.verify {
            stage.narrator.act("Act 4. How does one know that it is right? Six fresh poses.");
            verify(&mut stage, &mut outcome.checks)?;
        }
        tally::judge_counters(&mut outcome.checks, "after the power cycle", &acts::info(&mut stage)?);
    }
    let odd: Vec<String> = stage.board.gaps().into_iter().chain(stage.board.resets().iter().map(reset)).collect();
    outcome.checks.note("the firmware never reset and met no gap of the emulator", odd.is_empty(), odd.join("; "));
    outcome.virtual_s = stage.now_s();
    outcome.instructions = stage.board.instructions();
    outcome.stack = outcome.stack.max(stage.board.stack_high_water());
    outcome.host_s = started.elapsed().as_secs_f64();
    Ok(outcome)
}

fn reset((t_s, cause): &(f64, String)) -> String {
    format!("reset by {cause} at {t_s:.1} s")
}

fn tumble(
    stage: &mut Stage,
    outcome: &mut Outcome,
    parameters: &Parameters,
    truth: &tumble_sim::sensor::FrameTruth,
    seconds: f64,
) -> Result<(), Failure> {
    let raw = acts::tumble(stage, "raw", seconds)?;
    let alignment = Alignment::new(stage, &raw)?;
    outcome.levels = levelling::of_raw(stage, &raw, &alignment, parameters, truth);
    let cal = acts::tumble(stage, "cal", seconds)?;
    let later = alignment.later(stage);
    outcome.delivered = levelling::of_delivered(stage, &cal, &later.delivered_rates(stage, &cal));
    let digit = parameters.compensation().and_then(|compensation| later.worst_digit(&cal, &compensation));
    tally::judge_streams(&mut outcome.checks, &raw, &cal, &alignment, digit);
    tally::judge_levels(&mut outcome.checks, &outcome.levels, &outcome.delivered);
    Ok(())
}

fn verify(stage: &mut Stage, checks: &mut Checks) -> Result<(), Failure> {
    let line = acts::verify(stage)?;
    let detail = format!(
        "{} poses, gravity rms {} mg, level at most {}°",
        line.value("poses").unwrap_or("-"),
        line.value("gravity_rms_mg").unwrap_or("-"),
        line.value("level_max_deg").unwrap_or("-")
    );
    checks.note("verify passes on fresh poses", line.says("@verified verdict=pass"), detail);
    Ok(())
}

impl Outcome {
    /// Tables, checks and times.
    pub fn print(&self, script: Script) {
        if !self.session.parameters.0.is_empty() {
            self.score.print();
        }
        if let Some(seconds) = script.tumble_s.filter(|_| self.session.stored) {
            tally::print_levels(seconds, &self.levels, &self.delivered);
        }
        self.checks.print();
        if let Some((used, size)) = self.stack {
            println!("\nstack: {used} of {size} bytes used at most");
        }
        println!(
            "{:.1} virtual seconds, {:.2} thousand million instructions, {:.1} s on this machine",
            self.virtual_s,
            self.instructions as f64 * 1e-9,
            self.host_s
        );
    }

    /// One line of JSON, for those who run many seeds.
    #[must_use]
    pub fn json(&self, cast: &Cast) -> String {
        let Rms { gyro_bias_mdps, gyro_scale_ppm, gyro_cross_urad, accel_bias_ug, accel_scale_ppm, accel_cross_urad } =
            self.score.rms();
        let level = |error: &LevelError| json!([error.mean_deg, error.max_deg, error.final_deg]);
        let sigmas: Vec<Option<f64>> = self.score.0.iter().map(super::score::Row::sigmas).collect();
        json!({
            "seed": cast.seed, "by_hand": cast.by_hand, "ok": self.checks.all_held(), "failed": self.checks.failed(),
            "verdict": self.session.verdict, "reasons": self.session.reasons,
            "rms": { "gyro_bias_mdps": gyro_bias_mdps, "gyro_scale_ppm": gyro_scale_ppm,
                "gyro_cross_urad": gyro_cross_urad, "accel_bias_ug": accel_bias_ug,
                "accel_scale_ppm": accel_scale_ppm, "accel_cross_urad": accel_cross_urad },
            "within_2_sigma": self.score.within(2.0), "parameters": self.score.0.len(), "sigmas": sigmas,
            "level_deg": { "raw": level(&self.levels.raw), "raw_less_bias": level(&self.levels.raw_less_bias),
                "compensated": level(&self.levels.compensated), "perfect": level(&self.levels.perfect),
                "delivered": level(&self.delivered) },
            "estimate": { "virtual_s": self.session.estimate.seconds,
                "instructions": self.session.estimate.instructions },
            "virtual_s": self.virtual_s, "host_s": self.host_s,
        })
        .to_string()
    }
}
