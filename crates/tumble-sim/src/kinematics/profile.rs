//! Smooth time profiles from 0 to 1.

use super::Jet;

/// Septic ease from 0 at `start_s` to 1 at `start_s + duration_s`: `35u⁴ − 84u⁵ + 70u⁶ − 20u⁷`.
///
/// The least polynomial whose first three derivatives vanish at both ends (a minimum-snap move), so angular
/// acceleration is continuous and jerk-free where a move meets a rest. Peak rate is 2.19 per duration.
pub fn ease(t_s: f64, start_s: f64, duration_s: f64) -> Jet {
    let u = (t_s - start_s) / duration_s;
    if u <= 0.0 || u.is_nan() {
        return Jet::constant(0.0);
    }
    if u >= 1.0 {
        return Jet::constant(1.0);
    }
    let rest = 1.0 - u;
    Jet {
        value: u.powi(4) * (35.0 - u * (84.0 - u * (70.0 - 20.0 * u))),
        rate: 140.0 * (u * rest).powi(3) / duration_s,
        accel: 420.0 * (u * rest).powi(2) * (1.0 - 2.0 * u) / (duration_s * duration_s),
    }
}

/// From 0 to 1 with a rate that ramps up over the fraction `ramp` of the duration, holds, and ramps down.
///
/// The ramps are quintic in the rate, `10x³ − 15x⁴ + 6x⁵`, so rate, acceleration and jerk are continuous. `ramp` is
/// kept within 0.01 to 0.5; at 0.5 there is no plateau.
pub fn cruise(t_s: f64, start_s: f64, duration_s: f64, ramp: f64) -> Jet {
    let ramp = ramp.clamp(0.01, 0.5);
    let u = (t_s - start_s) / duration_s;
    if u <= 0.0 || u.is_nan() {
        return Jet::constant(0.0);
    }
    if u >= 1.0 {
        return Jet::constant(1.0);
    }
    // Covered distance in units of full rate times duration; the whole is 1 − ramp.
    let (covered, rate, accel) = if u < ramp {
        let (g, dg, ddg) = quintic_ramp(u / ramp);
        (ramp * g, dg, ddg / ramp)
    } else if u > 1.0 - ramp {
        let (g, dg, ddg) = quintic_ramp((1.0 - u) / ramp);
        (1.0 - ramp - ramp * g, dg, -ddg / ramp)
    } else {
        (u - 0.5 * ramp, 1.0, 0.0)
    };
    Jet { value: covered, rate: rate / duration_s, accel: accel / (duration_s * duration_s) } * (1.0 / (1.0 - ramp))
}

/// The quintic smooth-step's integral, value and derivative at `x` in 0 to 1.
fn quintic_ramp(x: f64) -> (f64, f64, f64) {
    let integral = x.powi(4) * (2.5 - x * (3.0 - x));
    let value = x.powi(3) * (10.0 - x * (15.0 - 6.0 * x));
    (integral, value, 30.0 * (x * (1.0 - x)).powi(2))
}

/// 0, rising over `edge_s` to 1, and falling over `edge_s` back to 0 at the end. `edge_s` is at most half the duration.
pub fn window(t_s: f64, start_s: f64, duration_s: f64, edge_s: f64) -> Jet {
    let edge_s = edge_s.min(0.5 * duration_s);
    ease(t_s, start_s, edge_s) - ease(t_s, start_s + duration_s - edge_s, edge_s)
}

/// 0 at both ends and 1 in the middle: `4e(1 − e)` of [`ease`].
pub fn bump(t_s: f64, start_s: f64, duration_s: f64) -> Jet {
    let e = ease(t_s, start_s, duration_s);
    e * (Jet::constant(1.0) - e) * 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of value and rate agree with the stated derivatives, and the ends are exact.
    fn check(f: impl Fn(f64) -> Jet, end: f64) {
        let h = 1e-5;
        for i in 0..=2000 {
            let t = -0.5 + i as f64 * 0.002_001;
            let (before, here, after) = (f(t - h), f(t), f(t + h));
            assert!(((after.value - before.value) / (2.0 * h) - here.rate).abs() < 1e-6, "rate at {t}");
            assert!(((after.rate - before.rate) / (2.0 * h) - here.accel).abs() < 1e-5, "acceleration at {t}");
        }
        assert_eq!(f(-1.0), Jet::constant(0.0));
        assert!((f(10.0).value - end).abs() < 1e-15 && f(10.0).rate == 0.0);
    }

    #[test]
    fn profiles_have_exact_derivatives() {
        check(|t| ease(t, 0.0, 3.0), 1.0);
        check(|t| cruise(t, 0.0, 3.0, 0.15), 1.0);
        check(|t| cruise(t, 0.0, 3.0, 0.5), 1.0);
        check(|t| window(t, 0.0, 3.0, 0.7), 0.0);
        check(|t| bump(t, 0.0, 3.0), 0.0);
        check(|t| window(t, 0.0, 3.0, 0.7) * (Jet::phase(4.0, 1.0, t) + Jet::phase(2.0, 0.3, t).cos()).sin(), 0.0);
    }
}
