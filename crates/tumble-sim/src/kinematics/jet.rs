//! A scalar with its first and second time derivative.

use core::ops::{Add, AddAssign, Mul, Neg, Sub};

/// `(x, ẋ, ẍ)`: arithmetic on jets is the product and chain rule, so every motion built from them has exact derivatives
/// and no numerical differentiation is needed anywhere.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet {
    /// `x`.
    pub value: f64,
    /// `ẋ`, per second.
    pub rate: f64,
    /// `ẍ`, per second squared.
    pub accel: f64,
}

impl Jet {
    /// A constant.
    pub const fn constant(value: f64) -> Self {
        Self { value, rate: 0.0, accel: 0.0 }
    }

    /// `phase + omega·t`, the argument of an oscillation.
    pub const fn phase(omega_rad_s: f64, phase_rad: f64, t_s: f64) -> Self {
        Self { value: phase_rad + omega_rad_s * t_s, rate: omega_rad_s, accel: 0.0 }
    }

    /// `sin(x)`.
    pub fn sin(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(sin, cos, -sin)
    }

    /// `cos(x)`.
    pub fn cos(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(cos, -sin, -cos)
    }

    /// Chain rule for `f(x)` with `f`, `f'`, `f''` at `x`.
    fn chain(self, f: f64, df: f64, ddf: f64) -> Self {
        Self { value: f, rate: df * self.rate, accel: df * self.accel + ddf * self.rate * self.rate }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, rate: self.rate + o.rate, accel: self.accel + o.accel }
    }
}

impl AddAssign for Jet {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Self { value: self.value * k, rate: self.rate * k, accel: self.accel * k }
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            rate: self.rate * o.value + self.value * o.rate,
            accel: self.accel * o.value + 2.0 * self.rate * o.rate + self.value * o.accel,
        }
    }
}
