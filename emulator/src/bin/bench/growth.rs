//! How the cost of an estimate grows with its session.

use tumble_core::estimate::state::STATES;
use tumble_core::estimate::two_step::filter;

use crate::feed::Session;

/// Multiply–adds that one observation needs: the gain, the state, and P's lower triangle.
fn multiply_adds(states: usize, coefficients: usize) -> usize {
    coefficients * states + 2 * states + states * (states + 1) / 2
}

/// Prints how one observation's cost grows with the number of states; `small` and `large` are instructions, of one coefficient
/// and of this many.
pub fn states(small: f64, large: f64, coefficients: usize) {
    let counts = [multiply_adds(filter::STATES, 1), multiply_adds(STATES, coefficients)];
    println!("\n{:27}{:>8}{:>17}{:>15}", "one observation", "states", "multiply-adds", "instructions");
    for (states, count, instructions) in [(filter::STATES, counts[0], small), (STATES, counts[1], large)] {
        println!("{:27}{states:>8}{count:>17}{instructions:>15.0}", "");
    }
    let power = |a: f64, b: f64| exponent(&[(filter::STATES as f64, a), (STATES as f64, b)]);
    println!(
        "From {} to {STATES} states multiply-adds grow to the power {:.2}, instructions {:.2}.",
        filter::STATES,
        power(counts[0] as f64, counts[1] as f64),
        power(small, large)
    );
}

/// Prints a table of whole estimates, and fits exponents. Refuses what the board did not estimate as the host did.
pub fn print(sessions: &[Session], results: &[(u32, f32)], instructions: &[u64]) -> Result<(), String> {
    println!(
        "\n{:27}{:>8}{:>9}{:>8}{:>15}{:>15}",
        "a whole estimate", "s", "records", "passes", "instructions", "a pass"
    );
    for ((session, result), count) in sessions.iter().zip(results).zip(instructions) {
        if result.0 != session.expected.0 || result.1 != session.expected.1 {
            return Err(format!("{}: the board found {result:?}, the host {:?}", session.name, session.expected));
        }
        let pass = count / u64::from(result.0);
        println!(
            "{:27}{:>8.0}{:>9}{:>8}{:>13.1} M{:>13.2} M",
            session.name,
            session.seconds,
            session.records,
            result.0,
            *count as f64 * 1e-6,
            pass as f64 * 1e-6
        );
    }
    if results.len() != sessions.len() || instructions.len() != sessions.len() {
        return Err(format!("{} of {} estimates came back", results.len(), sessions.len()));
    }
    let cost = |index: usize| instructions[index] as f64 / f64::from(results[index].0);
    let fit = |range: std::ops::Range<usize>, size: fn(&Session) -> f64| {
        exponent(&range.map(|index| (size(&sessions[index]), cost(index))).collect::<Vec<_>>())
    };
    println!(
        "A pass grows with the session's length to the power {:.2}, with the number of poses {:.2}.",
        fit(0..3, |session| session.seconds),
        fit(3..6, |session| session.records as f64)
    );
    Ok(())
}

/// Slope of a straight line through the logarithms.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, log| (sum.0 + log.0 / n, sum.1 + log.1 / n));
    let (xy, xx) =
        logs.iter().fold((0.0, 0.0), |sum, log| (sum.0 + (log.0 - x) * (log.1 - y), sum.1 + (log.0 - x).powi(2)));
    xy / xx
}
