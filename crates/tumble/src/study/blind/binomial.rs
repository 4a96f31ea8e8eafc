//! Exact intervals of a share (Clopper & Pearson 1934).

/// The interval that holds the true share with 95 % certainty, for `hits` out of `count`.
pub fn interval(hits: usize, count: usize) -> (f64, f64) {
    if count == 0 {
        return (0.0, 1.0);
    }
    // The lower end makes `hits` or more happen with 2.5 %, the upper end `hits` or fewer.
    let low = if hits == 0 { 0.0 } else { solve(|p| 1.0 - at_most(hits - 1, count, p) < 0.025) };
    let high = if hits == count { 1.0 } else { solve(|p| at_most(hits, count, p) > 0.025) };
    (low, high)
}

/// The share up to which a condition holds, by bisection: 60 halvings are below 1e-18.
fn solve(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Probability of `hits` or fewer.
fn at_most(hits: usize, count: usize, p: f64) -> f64 {
    let ln_gamma = |n: usize| libm::lgamma(n as f64 + 1.0);
    let term = |k: usize| {
        let ways = ln_gamma(count) - ln_gamma(k) - ln_gamma(count - k);
        (ways + k as f64 * p.ln() + (count - k) as f64 * (1.0 - p).ln()).exp()
    };
    (0..=hits).map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::interval;

    #[test]
    fn as_published() {
        // 0 of n: 1 − 0.025^(1/n); 5 of 500 by R's binom.test: 0.003255 to 0.023178.
        let (low, high) = interval(0, 500);
        assert!(low == 0.0 && (high - (1.0 - 0.025f64.powf(1.0 / 500.0))).abs() < 1e-9);
        let (low, high) = interval(5, 500);
        assert!((low - 0.003255).abs() < 2e-6 && (high - 0.023178).abs() < 2e-5, "{low} {high}");
        let (low, high) = interval(20, 20);
        assert!((low - 0.025f64.powf(1.0 / 20.0)).abs() < 1e-9 && high == 1.0);
        assert_eq!(interval(0, 0), (0.0, 1.0));
    }
}
