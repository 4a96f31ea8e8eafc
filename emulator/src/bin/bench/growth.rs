//! How the cost of an estimate grows with its session.

use crate::feed::Session;

/// Prints a table, and fits exponents. Refuses what the board did not estimate as the host did.
pub fn print(sessions: &[Session], results: &[(u32, f32)], instructions: &[u64]) -> Result<(), String> {
    println!("\n{:27}{:>8}{:>9}{:>8}{:>15}{:>15}", "a whole estimate", "s", "records", "passes", "instructions", "a pass");
    for ((session, result), count) in sessions.iter().zip(results).zip(instructions) {
        if result.0 != session.expected.0 || result.1 != session.expected.1 {
            println!("{}", format!("{}: the board found {result:?}, the host {:?}", session.name, session.expected));
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
    println!("A pass grows with the session's length to the power {:.2}, with the number of poses {:.2}.",
        fit(0..3, |session| session.seconds), fit(3..6, |session| session.records as f64));
    Ok(())
}

/// Slope of a straight line through the logarithms.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, log| (sum.0 + log.0 / n, sum.1 + log.1 / n));
    let (xy, xx) = logs.iter().fold((0.0, 0.0), |sum, log| {
        (sum.0 + (log.0 - x) * (log.1 - y), sum.1 + (log.0 - x).powi(2))
    });
    xy / xx
}
