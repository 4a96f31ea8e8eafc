//! Tables of `tumble study paper`.

use std::fmt::{self, Write};

use crate::study::paper::published::LEVEL_DEG;
use crate::study::paper::story::{Statistics, Story, published};

const NAMES: [&str; 9] = ["k11", "k12", "k13", "k21", "k22", "k23", "k31", "k32", "k33"];

/// All of it.
pub fn paper(story: &Story) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ =
        errors(&mut text, story).and_then(|()| levels(&mut text, story)).and_then(|()| hypotheses(&mut text, story));
    text
}

fn errors(text: &mut String, story: &Story) -> fmt::Result {
    writeln!(text, "Tables 2 and 3: errors over {} runs, 1e-3, mean / standard deviation", story.runs)?;
    let published = published();
    let columns: Vec<&Statistics> = std::iter::once(&published).chain(&story.statistics).collect();
    write!(text, "  {:<4}", "")?;
    columns.iter().try_for_each(|column| write!(text, " {:>21}", column.method))?;
    writeln!(text)?;
    for (k, name) in NAMES.into_iter().enumerate() {
        write!(text, "  {name:<4}")?;
        for column in &columns {
            write!(text, " {:>21}", format!("{:.4} / {:.4}", 1e3 * column.mean[k], 1e3 * column.std[k]))?;
        }
        writeln!(text)?;
    }
    writeln!(text)
}

fn levels(text: &mut String, story: &Story) -> fmt::Result {
    writeln!(text, "Table 4: largest level error over 65 s of pure inertial navigation, degrees")?;
    for (method, [pitch, roll]) in LEVEL_DEG {
        writeln!(text, "  {method:<22} pitch {pitch:.3}, roll {roll:.3}: published, of one real recording")?;
    }
    for column in &story.statistics {
        writeln!(
            text,
            "  {:<22} {:.3}: mean over the runs, violent simulated tumbling",
            column.method, column.level_max_deg
        )?;
    }
    writeln!(text)
}

fn hypotheses(text: &mut String, story: &Story) -> fmt::Result {
    writeln!(
        text,
        "What would explain the published errors of K ({:.2} mrad rms, where no calibration at all leaves {:.2})?",
        1e3 * story.published_rms,
        1e3 * story.truth_rms
    )?;
    writeln!(text, "  {:<48} {:>7} {:>7}   k12 k13 k21 k23 k31 k32, mrad", "", "cosine", "size")?;
    for hypothesis in &story.hypotheses {
        let errors: Vec<String> = hypothesis.errors.iter().map(|error| format!("{:.2}", 1e3 * error)).collect();
        writeln!(
            text,
            "  {:<48} {:>7.2} {:>7.3}   {}",
            hypothesis.name,
            hypothesis.cosine,
            hypothesis.size,
            errors.join(" ")
        )?;
    }
    writeln!(text, "  A leaked accelerometer cross-axis error reappears in K times {:.2}.", story.leak_onto_gyro)?;
    writeln!(
        text,
        "  \"Nearest\" is of {} runs, each with headings of its own: with six numbers some run comes near by chance.",
        story.runs
    )?;
    writeln!(
        text,
        "  The published mean scale error has the size of what cos β leaves at a tilt of {:.2} degrees.",
        story.cos_beta_tilt_deg
    )
}
