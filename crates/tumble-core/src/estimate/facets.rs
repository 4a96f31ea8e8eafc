//! How crooked a box that is called square is: the marginal likelihood of its faces' variance, where table and frame are free.
//!
//! At the first rest of every visit the face's normal in frame n is `(R n)ₓᵧ = p + (R [n×] ρ)ₓᵧ − (R e)ₓᵧ`: p the table, ρ a common
//! rotation of the box's frame, which faces alone define, e the face's own error. Six faces give twelve such numbers for
//! two and three unknowns; the squares that are left have seven degrees of freedom.

use nalgebra::{Matrix3, Vector3};

use super::normal::{Normal, mean_variance};

/// A face of a box that its owner calls square, rad: 0.5 µm on 5 cm.
pub const SQUARE: f32 = 5e-6;
/// The grid's sigmas grow by √2 from there, to 41 mrad (2.4°).
const GRID: usize = 25;
/// Twice the logarithm of the likelihood's ratio from which a box is said not to be square: ½χ²₁ exceeds it once in a thousand
/// sessions.
const CERTAIN: f32 = 9.55;

/// No table leans by more than this, and no face by more from the first one, 1 (10° and 6°): what does is no face on a table.
pub const LEANING: f32 = 0.17;
const APART: f32 = 0.1;

/// Sums over a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Facets {
    normal: Normal<6>,
    first: Option<Vector3<f32>>,
    noise: f32,
    count: f32,
}

impl Facets {
    /// Can a face with this normal lie on the table?
    pub fn admits(&self, normal_n: &Vector3<f32>) -> bool {
        let apart = self.first.map_or(0.0, |first| (normal_n - first).xy().norm());
        normal_n.xy().norm() < LEANING && apart < APART
    }

    /// The normal of the face that came to lie on the table as the filter has it, and the variance of a component of it.
    pub fn take(&mut self, normal_b: &Vector3<f32>, normal_n: &Vector3<f32>, to_n: &Matrix3<f32>, noise: f32) {
        // About the first one, so that `f32` does not lose the residuals beside the table's tilt.
        let left = normal_n - *self.first.get_or_insert(*normal_n);
        let frame = to_n * normal_b.cross_matrix();
        for axis in 0..2 {
            let table = [0, 1].map(|of| if of == axis { 1.0 } else { 0.0 });
            let row = [table[0], table[1], frame[(axis, 0)], frame[(axis, 1)], frame[(axis, 2)], left[axis]];
            self.normal.take(&row, 1.0);
        }
        self.noise += 2.0 * noise;
        self.count += 2.0;
    }

    /// Are there faces enough to tell if they agree?
    pub fn agree_or_not(&self) -> bool {
        self.count >= 6.0
    }

    /// Mean of the posterior of a face's variance, rad², a square box being as likely as a crooked one before, and whether it is certain
    /// that faces err at all. Faces that err by less than the rests' levels are known (0.02° is 200 µrad, a rest of 2.5 s knows 130) are not
    /// told from square ones for certain; their variance is believed by the odds.
    pub fn variance(&self) -> Option<(f32, bool)> {
        let mut normal = self.normal;
        let freedom = self.count - normal.eliminate(5) as f32;
        if freedom < 1.0 {
            return None;
        }
        let (squares, noise) = (normal.at(5, 5), self.noise / self.count);
        let log = |variance: f32| -0.5 * (freedom * libm::logf(noise + variance) + squares / (noise + variance));
        let likeliest = (squares / freedom - noise).max(0.0);
        let certain = 2.0 * (log(likeliest) - log(0.0)) > CERTAIN;
        let grid = (0..GRID).map(|step| SQUARE * SQUARE * libm::exp2f(step as f32));
        Some((mean_variance(grid, (GRID - 1) as f32, |_, variance| log(variance)), certain))
    }
}
