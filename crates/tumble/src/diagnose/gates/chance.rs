//! Tail probabilities as natural logarithms: gates look far out, where probabilities themselves underflow.

/// ln of the share of false alarms that one gate may give on a clean recording: 1e-5 by its own arithmetic. Eighteen
/// gates then give 1.8e-4; that leaves a factor of ten of the 0.2 % allowed to assumptions that hold only nearly.
pub const LN_ALARM: f64 = -11.5;

/// ln P(X ≥ `count`) of a Poisson variable, by Chernoff's bound: never too small. Zero where `count` is no surprise.
pub fn ln_poisson_tail(count: f64, mean: f64) -> f64 {
    if count <= mean || count <= 0.0 {
        return 0.0;
    }
    let mean = mean.max(1e-12);
    count - mean - count * (count / mean).ln()
}

/// ln P(X ≥ `count`) of `total` fair coins, by Hoeffding's bound.
pub fn ln_coin_tail(count: f64, total: f64) -> f64 {
    let over = count - 0.5 * total;
    if over <= 0.0 || total <= 0.0 { 0.0 } else { -2.0 * over * over / total }
}

/// ln P(mean of `freedom` squared normals ≥ `ratio`), by Chernoff's bound.
pub fn ln_mean_square_tail(ratio: f64, freedom: f64) -> f64 {
    if ratio <= 1.0 { 0.0 } else { -0.5 * freedom * (ratio - 1.0 - ratio.ln()) }
}

/// The ratio whose bound in [`ln_mean_square_tail`] is `ln_p`.
pub fn mean_square_quantile(ln_p: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (1.0, 2.0 + 4.0 * -ln_p / freedom.max(1.0));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if ln_mean_square_tail(middle, freedom) > ln_p { low = middle } else { high = middle }
    }
    high
}

/// One-sided 95 % of a normal: what a limit leaves to chance.
pub const SURE: f64 = 1.645;

/// The non-centrality λ at which a χ² of `freedom` is above `threshold` in 95 of 100: λ − 1.645·√(2·(freedom + 2λ)) =
/// threshold − freedom, by its mean and variance.
pub fn shift_seen(threshold: f64, freedom: f64) -> f64 {
    // With y = √(freedom + 2λ): y² − 2·1.645·√2·y = 2·threshold − freedom.
    let (half, rest) = (SURE * std::f64::consts::SQRT_2, (2.0 * threshold - freedom).max(0.0));
    (0.5 * ((half + (half * half + rest).sqrt()).powi(2) - freedom)).max(0.0)
}

/// The mean of a count that reaches `count` in 95 of 100: m − 1.645·√m = count (a Poisson variable, nearly normal).
pub fn mean_seen(count: f64) -> f64 {
    (0.5 * (SURE + (SURE * SURE + 4.0 * count).sqrt())).powi(2)
}

/// Middle value; NaN of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    quantile(&mut values, 0.5)
}

/// Value at a share of the order; NaN of nothing.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let index = ((values.len() - 1) as f64 * share).round() as usize;
    *values.select_nth_unstable_by(index, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_bound() {
        // P(Poisson(1) ≥ 10) = 1.1e-7; P(χ²₂/2 ≥ 12) = e⁻¹²; 90 of 100 coins: 1.5e-17.
        assert!((-16.1..-12.0).contains(&ln_poisson_tail(10.0, 1.0)));
        assert!((-12.1..-8.0).contains(&ln_mean_square_tail(12.0, 2.0)));
        assert!((-38.8..-31.0).contains(&ln_coin_tail(90.0, 100.0)));
        let ratio = mean_square_quantile(-9.0, 20.0);
        assert!((ln_mean_square_tail(ratio, 20.0) + 9.0).abs() < 1e-6);
        let shift = shift_seen(60.0, 24.0);
        assert!((shift - SURE * (2.0 * (24.0 + 2.0 * shift)).sqrt() - 36.0).abs() < 1e-9);
        // One degree: (z + √λ)² is below v where z is below √v − √λ, in 5 of 100 cases at −1.645. The normal is 7 % high, 3 % in size.
        let exact = (20.0f64.sqrt() + SURE).powi(2);
        assert!((shift_seen(20.0, 1.0) / exact - 1.0).abs() < 0.08);
    }
}
