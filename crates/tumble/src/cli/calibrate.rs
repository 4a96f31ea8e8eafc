//! `tumble calibrate`.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use tumble_core::calibration::Verdict;
use tumble_core::estimate::Conditions;
use tumble_core::estimate::two_step::Variant;
use tumble_core::sample::Ranges;

use super::output::Progress;
use super::{Refusal, TurnsWord, output};
use crate::calibrate::{self, Method, Session};
use crate::diagnose::carry::{Carry, carry};
use crate::diagnose::diagnosis::Diagnosis;
use crate::faults::{self, Mended};
use crate::omissions;
use crate::output::{Report, table};
use crate::recording::{BoxFaces, Inference, Reading, Recording, as_board_reads};
use crate::settle;
use crate::widen::widen;

/// Where the axes of compensated data come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Reference {
    /// The faces of the box, taken as square
    Box,
    /// Gravity alone; the accelerometer defines the axes
    Gravity,
}

/// What computes the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum EstimatorWord {
    /// The board's own, in its own arithmetic
    Device,
    /// The same problem in one piece, in double precision, from the samples
    Batch,
    /// Gravity over rests alone, as `imu_tk` has it
    Gravity,
    /// The paper's two-step method, correctly coded; takes the box as square
    TwoStep,
    /// The same as its published results look
    TwoStepLiteral,
    /// The paper's comparison method
    Traditional,
}

impl From<EstimatorWord> for Method {
    fn from(word: EstimatorWord) -> Self {
        match word {
            EstimatorWord::Device => Self::Device,
            EstimatorWord::Batch => Self::Batch,
            EstimatorWord::Gravity => Self::Gravity,
            EstimatorWord::TwoStep => Self::TwoStep(Variant::Corrected),
            EstimatorWord::TwoStepLiteral => Self::TwoStep(Variant::Literal),
            EstimatorWord::Traditional => Self::TwoStep(Variant::Traditional),
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Recording to calibrate from
    #[arg(value_name = "REC.csv")]
    recording: PathBuf,
    /// Print the contract's JSON object instead of a table
    #[arg(long)]
    json: bool,
    /// What computes the numbers
    #[arg(long, value_enum, default_value_t = EstimatorWord::Device)]
    estimator: EstimatorWord,
    /// What defines the axes, instead of what the recording states of its box
    #[arg(long, value_enum)]
    reference: Option<Reference>,
    /// How turns end, instead of what the recording states
    #[arg(long, value_enum)]
    turns: Option<TurnsWord>,
    /// Carry this effect too (see `tumble diagnose`): it is fitted and taken out of the readings first
    #[arg(long, value_name = "ID")]
    with: Vec<String>,
    /// First round every reading to the board's counts (±2000 °/s, ±16 g), as a replay on the emulated board does
    #[arg(long)]
    board_counts: bool,
    /// Do not look for physics that bends the numbers and that they do not hold (2 to 10 s)
    #[arg(long)]
    quick: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    match Recording::read(&arguments.recording) {
        Ok(recording) => estimate(arguments, &recording),
        Err(error) => {
            let refusal = Refusal::from(error);
            if arguments.json {
                print_json(&Report::refused(refusal.reasons.clone()))?;
            }
            Err(refusal)
        }
    }
}

fn estimate(arguments: &Arguments, recording: &Recording) -> Result<(), Refusal> {
    let inference = Inference::of(recording);
    let readings = readings(arguments, recording, &inference);
    // What an emulated board is given is not mended.
    let Mended { mut readings, lost, remarks } = match arguments.board_counts {
        true => Mended { readings, lost: inference.missing(), remarks: Vec::new() },
        false => faults::mend(recording, &inference, readings),
    };
    let conditions = conditions(arguments, recording);
    let mut progress = Progress::new();
    let before = (arguments.asks() && !arguments.with.is_empty()).then(|| ask(recording, conditions, &mut progress));
    let carry = taken_out(arguments, recording, conditions, before.as_ref(), &mut readings)?;
    let session = Session { readings: &readings, origin_s: recording.origin_s(), lost, conditions };
    let method = arguments.estimator.into();
    let mut outcome = session.run(method, &mut |share| progress.share("estimating", share));
    if let Some(carry) = &carry {
        widen(carry, &session, method, &mut outcome, |share| progress.share("how sure of it", share));
    }
    remarks.into_iter().for_each(|remark| outcome.warn(remark));
    outcome.reasons.extend(settle::unstated_gravity(&recording.metadata));
    if arguments.asks() && outcome.verdict != Verdict::Rejected {
        let diagnosis = before.unwrap_or_else(|| ask(recording, conditions, &mut progress));
        omissions::tell(&diagnosis, &arguments.with, &mut outcome);
    }
    drop(progress);
    let report = Report::of(&outcome).carrying(carry.map_or_else(Vec::new, |carry| carry.effects));
    if arguments.json {
        print_json(&report)?;
    } else {
        output::print(&(table::recording(recording, &inference) + &table::report(&report)))?;
    }
    if report.is_accepted() { Ok(()) } else { Err(rejected(&arguments.recording, &report)) }
}

impl Arguments {
    /// Is the diagnosis asked what the numbers leave out? The references have a model of their own, and an emulated board asks nobody.
    fn asks(&self) -> bool {
        let own_model = matches!(self.estimator, EstimatorWord::Device | EstimatorWord::Batch);
        own_model && !self.board_counts && !self.quick
    }
}

fn ask(recording: &Recording, conditions: Conditions, progress: &mut Progress) -> Diagnosis {
    omissions::ask(recording, conditions, |what, share| progress.share(what, share))
}

/// What is to be carried, taken out of the readings; it is fitted beside what else was found.
fn taken_out(
    arguments: &Arguments,
    recording: &Recording,
    conditions: Conditions,
    diagnosis: Option<&Diagnosis>,
    readings: &mut [Reading],
) -> Result<Option<Carry>, Refusal> {
    let mut ids: Vec<String> = Vec::new();
    arguments.with.iter().for_each(|id| ids.extend((!ids.contains(id)).then(|| id.clone())));
    if ids.is_empty() {
        return Ok(None);
    }
    let found = diagnosis.into_iter().flat_map(|diagnosis| &diagnosis.effects);
    let beside: Vec<String> = found.map(|found| found.id.clone()).collect();
    carry(recording, conditions, &ids, &beside, readings).map(Some).map_err(Refusal::one)
}

fn readings(arguments: &Arguments, recording: &Recording, inference: &Inference) -> Vec<Reading> {
    let mut readings = recording.samples(inference);
    if arguments.board_counts {
        for reading in &mut readings {
            *reading = as_board_reads(reading, &Ranges::WIDEST);
        }
    }
    readings
}

fn conditions(arguments: &Arguments, recording: &Recording) -> Conditions {
    let stated = calibrate::conditions(&recording.metadata);
    Conditions {
        stops: arguments.turns.map_or(stated.stops, Into::into),
        faces: match arguments.reference {
            Some(Reference::Box) => BoxFaces::Square,
            Some(Reference::Gravity) => BoxFaces::Unknown,
            None => stated.faces,
        },
        ..stated
    }
}

fn print_json(report: &Report) -> Result<(), Refusal> {
    Ok(output::print(&(serde_json::to_string(report)? + "\n"))?)
}

fn rejected(file: &Path, report: &Report) -> Refusal {
    let file = file.display();
    if report.reasons.is_empty() {
        return Refusal::one(format!("{file}: rejected"));
    }
    let reasons = report.reasons.iter().map(|reason| format!("{file}: rejected: {reason}")).collect();
    Refusal { reasons, status: 1 }
}
