//! `tumble simulate`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Refusal, output};
use crate::simulate::{Plan, SchemeName};

/// What is simulated. Unless said otherwise: a table tilted by 1.5°, a square box with the sensor (3, 2, 1) cm off its
/// centre, turns against a fence, and an MPU-9250 within its data sheet at 200 Hz.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Recording to write
    #[arg(short, long, value_name = "REC.csv")]
    output: PathBuf,
    /// Where to write the true parameters; they are told to nobody else
    #[arg(long, value_name = "TRUTH.json")]
    truth: Option<PathBuf>,
    /// What the person does; double, or single with --paper
    #[arg(long, value_enum)]
    scheme: Option<SchemeName>,
    /// Draws the sensor's errors and all chance
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Sensor and table of the paper's simulation (its Table 1)
    #[arg(long)]
    paper: bool,
    /// Tilt of the table, degrees
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    tilt_deg: Option<f64>,
    /// Sensor's place in the box, cm from the axis of the turns
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', num_args = 3, allow_hyphen_values = true)]
    lever_cm: Option<Vec<f64>>,
    /// TurnStops end by eye, to 2°
    #[arg(long, conflicts_with = "fenced")]
    by_hand: bool,
    /// TurnStops end against a stop, to 0.1°
    #[arg(long)]
    fenced: bool,
    /// Amplitude by which the axis of a turn wobbles, degrees
    #[arg(long, value_name = "DEG")]
    wobble_deg: Option<f64>,
    /// Further imperfection with its size, or all of them: bias_drift (°/s), clock (fraction), wobble (°), lever (m),
    /// crooked_box (°), temperature_ramp (°C), tilt (°), by_hand (°), all
    #[arg(long = "imperfection", value_name = "NAME[=SIZE]")]
    imperfections: Vec<String>,
    /// Round to the sensor's counts and clip at the ends of its ranges
    #[arg(long)]
    counts: bool,
    /// Full scale of the gyroscope with --counts, °/s
    #[arg(long, value_name = "DPS", default_value_t = 2000.0, requires = "counts")]
    gyro_range_dps: f64,
    /// Full scale of the accelerometer with --counts, g
    #[arg(long, value_name = "G", default_value_t = 16.0, requires = "counts")]
    accel_range_g: f64,
    /// Samples a second
    #[arg(long, value_name = "HZ", default_value_t = 200.0)]
    rate_hz: f64,
    /// No noise at all
    #[arg(long)]
    noiseless: bool,
}

impl Arguments {
    fn scheme(&self) -> SchemeName {
        self.scheme.unwrap_or(if self.paper { SchemeName::Single } else { SchemeName::Double })
    }

    fn plan(&self) -> Plan {
        let lever_cm = self.lever_cm.as_deref().and_then(|v| <[f64; 3]>::try_from(v).ok());
        Plan {
            scheme: self.scheme(),
            seed: self.seed,
            paper: self.paper,
            tilt_deg: self.tilt_deg,
            lever_cm,
            by_hand: if self.by_hand { Some(true) } else { self.fenced.then_some(false) },
            wobble_deg: self.wobble_deg,
            imperfections: self.imperfections.clone(),
            ranges: self.counts.then_some((self.gyro_range_dps, self.accel_range_g)),
            rate_hz: self.rate_hz,
            noiseless: self.noiseless,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Refusal> {
    // A plan comes from the command line alone, so that what is wrong with it is wrong usage.
    let made = arguments.plan().make().map_err(|error| Refusal { status: 2, ..Refusal::from(error) })?;
    made.recording.write_file(&arguments.output)?;
    if let Some(path) = &arguments.truth {
        let text = serde_json::to_string_pretty(&made.truth)? + "\n";
        std::fs::write(path, text).map_err(|error| Refusal::one(format!("{}: {error}", path.display())))?;
    }
    let rows = &made.recording.rows;
    let length_s = rows.last().map_or(0.0, |row| row.t_s);
    let name = arguments.scheme().to_possible_value().map_or(String::new(), |v| v.get_name().to_owned());
    output::print(&format!(
        "{}: {} samples, {length_s:.1} s, scheme {name}, seed {}\n",
        arguments.output.display(),
        rows.len(),
        arguments.seed
    ))?;
    Ok(())
}
