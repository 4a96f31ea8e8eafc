//! What the paper prints: its Table 3 (means and standard deviations of errors over 100 runs) and Table 4.

/// k11 k12 k13 k21 k22 k23 k31 k32 k33, the paper's own method.
pub const MEAN: [f64; 9] = [-1.35e-3, -13.41e-3, 9.595e-3, -8.85e-3, -1.37e-3, -8.37e-3, -21.4e-3, -8.99e-3, -1.37e-3];
/// Likewise.
pub const STD: [f64; 9] = [3.31e-5, 5.26e-4, 1.07e-4, 1.85e-4, 3.39e-5, 1.019e-3, 4.3e-4, 1.062e-3, 3.72e-5];
/// Largest level errors over 65 s on its real sensor, degrees: pitch and roll, its method and the traditional one.
pub const LEVEL_DEG: [(&str, [f64; 2]); 2] = [("two-step", [0.625, 0.670]), ("traditional", [1.251, 1.383])];
/// Where the six non-orthogonalities stand among the nine.
pub const CROSS: [usize; 6] = [1, 2, 3, 5, 6, 7];
/// Likewise the scales.
pub const SCALE: [usize; 3] = [0, 4, 8];
