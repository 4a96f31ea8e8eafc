use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use core::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{SMatrix, Vector3};

use super::dense;
use super::filter::{Covariance, Filter, Innovation, Motion, POSITION, STATES, STEP_MULTIPLY_ADDS, State};
use super::strapdown::Pattern;
use crate::estimate::six_face::Real;

/// Multiplications and divisions so far; one test alone counts.
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// Counts them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted(f64);

macro_rules! operator {
    ($trait:ident, $name:ident, $operation:tt, $counts:literal) => {
        impl $trait for Counted {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                COUNT.fetch_add(usize::from($counts), Ordering::Relaxed);
                Self(self.0 $operation other.0)
            }
        }
    };
}
operator!(Add, add, +, false);
operator!(Sub, sub, -, false);
operator!(Mul, mul, *, true);
operator!(Div, div, /, true);

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Counted {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl SubAssign for Counted {
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

fn motion() -> Motion<f64> {
    Motion {
        tau_s: 0.08,
        drive: SMatrix::from_fn(|i, j| 0.05 * ((3 * i + 2 * j) as f64).sin()),
        impulse: Vector3::new(0.02, -0.01, 0.8),
        attitude_variance: 1e-9,
        velocity_variance: 3e-7,
    }
}

fn cast<T: Real>(motion: &Motion<f64>) -> Motion<T> {
    let c = nalgebra::convert::<f64, T>;
    Motion {
        tau_s: c(motion.tau_s),
        drive: motion.drive.map(c),
        impulse: motion.impulse.map(c),
        attitude_variance: c(motion.attitude_variance),
        velocity_variance: c(motion.velocity_variance),
    }
}

fn prior<T: Real>() -> Filter<T> {
    let sigma = [1e-4, 1e-4, 1e-5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2, 1e-2];
    let c = nalgebra::convert::<f64, T>;
    Filter::new(
        State::from_fn(|i, _| c(1e-3 * i as f64 * sigma[i])),
        Covariance::from_diagonal(&State::from_fn(|i, _| c(sigma[i] * sigma[i]))),
    )
}

/// Hundred steps of the sparse filter against the dense one: largest difference over the element's own scale.
fn against_dense<T: Real>() -> f64 {
    let mut filter = prior::<T>();
    let (mut state, mut covariance) = (*filter.state(), *filter.covariance());
    for step in 0..100 {
        let mut motion = motion();
        motion.drive *= (0.1 * f64::from(step)).cos();
        let motion = cast::<T>(&motion);
        let position = Vector3::new(1e-4, -2e-4, 3e-5).map(nalgebra::convert::<f64, T>);
        let variance: T = nalgebra::convert(1e-6);
        let (f, q) = (dense::transition(&motion), dense::process(&motion));
        (state, covariance) = dense::step(&state, &covariance, &f, &q, &position, variance).expect("regular");
        dense::sparse_step(&mut filter, &motion, &position, variance);
    }
    assert_eq!(*filter.covariance(), filter.covariance().transpose());
    let to = |value: T| nalgebra::try_convert::<T, f64>(value).expect("a number");
    let sigma = |i: usize| to(covariance[(i, i)]).sqrt();
    (0..STATES).fold(0.0, |largest: f64, i| {
        let row = (0..STATES).fold(0.0f64, |largest, j| {
            largest.max(to(filter.covariance()[(i, j)] - covariance[(i, j)]).abs() / (sigma(i) * sigma(j)))
        });
        largest.max(row).max(to(filter.state()[i] - state[i]).abs() / sigma(i))
    })
}

#[test]
fn the_sparse_step_is_the_dense_one() {
    let (double, single) = (against_dense::<f64>(), against_dense::<f32>());
    assert!(double < 1e-9, "{double}");
    assert!(single < 5e-3, "{single}");
}

#[test]
fn a_step_costs_what_it_says() {
    let c = Counted;
    let plain = prior::<f64>();
    let m = motion();
    let mut filter = Filter::new(plain.state().map(c), plain.covariance().map(c));
    let motion = Motion {
        tau_s: c(m.tau_s),
        drive: m.drive.map(c),
        impulse: m.impulse.map(c),
        attitude_variance: c(m.attitude_variance),
        velocity_variance: c(m.velocity_variance),
    };
    COUNT.store(0, Ordering::Relaxed);
    filter.predict(&motion);
    let nis: [Innovation<Counted>; 3] = core::array::from_fn(|axis| filter.observe(POSITION + axis, c(0.0), c(1e-6)));
    // Q's six additions come without a multiplication.
    assert_eq!(COUNT.load(Ordering::Relaxed) + 6, STEP_MULTIPLY_ADDS);
    const { assert!(STEP_MULTIPLY_ADDS < 1000) };
    assert!(nis.iter().all(|innovation| innovation.variance.0 >= 1e-6));
}

#[test]
fn patterns_are_what_their_matrices_say() {
    let k = SMatrix::<f64, 6, 1>::from([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    let angle = Vector3::new(0.7, -0.4, 1.1);
    for pattern in [Pattern::NonOrthogonality, Pattern::ScaleAndSkew] {
        let difference: Vector3<f64> = pattern.correction(&k) * angle - pattern.matrix(&angle) * k;
        assert!(difference.norm() < 1e-12);
    }
    let paper = Pattern::NonOrthogonality.correction(&k);
    assert_eq!((paper[(0, 1)], paper[(1, 2)], paper[(2, 0)], paper[(1, 1)]), (0.1, 0.4, 0.5, 0.0));
    let skew = Pattern::ScaleAndSkew.correction(&k);
    assert!(
        (skew
            - nalgebra::Matrix3::from_diagonal(&Vector3::new(0.1, 0.2, 0.3))
            - Vector3::new(0.4, 0.5, 0.6).cross_matrix())
        .norm()
            < 1e-12
    );
}
