//! Many trials in a few numbers: errors by group against sigmas and bounds, and whether the covariance is true.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use tumble_core::estimate::PARAMETERS;

use super::trial::Trial;

/// Parameters of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Diagonal of the gyroscope's correction.
    GyroScale,
    /// The rest of it, the paper's K.
    GyroCross,
    /// Gyroscope bias.
    GyroBias,
    /// Accelerometer bias.
    AccelBias,
    /// Diagonal of the accelerometer's correction.
    AccelScale,
    /// The rest of it.
    AccelCross,
}

impl Group {
    /// In the order of tables.
    pub const ALL: [Self; 6] =
        [Self::GyroScale, Self::GyroCross, Self::GyroBias, Self::AccelBias, Self::AccelScale, Self::AccelCross];

    /// For a table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::GyroScale => "gyro scale",
            Self::GyroCross => "gyro non-orthogonality",
            Self::GyroBias => "gyro bias",
            Self::AccelBias => "accel bias",
            Self::AccelScale => "accel scale",
            Self::AccelCross => "accel non-orthogonality",
        }
    }

    /// Unit of a table, and how many of them are one of the parameter's.
    pub fn unit(self) -> (&'static str, f64) {
        match self {
            Self::GyroScale | Self::AccelScale => ("ppm", 1e6),
            Self::GyroCross | Self::AccelCross => ("urad", 1e6),
            Self::GyroBias => ("mdps", 1e3f64.to_degrees()),
            Self::AccelBias => ("ug", 1e6 / tumble_sim::STANDARD_GRAVITY_MPS2),
        }
    }

    /// Does parameter `index` belong to it?
    pub fn contains(self, index: usize) -> bool {
        let (sensor, within) = (index / 12, index % 12);
        let diagonal = within >= 3 && (within - 3).is_multiple_of(4);
        match self {
            Self::AccelBias => sensor == 0 && within < 3,
            Self::GyroBias => sensor == 1 && within < 3,
            Self::AccelScale => sensor == 0 && diagonal,
            Self::GyroScale => sensor == 1 && diagonal,
            Self::AccelCross => sensor == 0 && within >= 3 && !diagonal,
            Self::GyroCross => sensor == 1 && within >= 3 && !diagonal,
        }
    }
}

/// A group over all trials, in the group's unit. Over its parameters everything is a root mean square.
#[derive(Clone, Debug, Serialize)]
pub struct GroupSummary {
    /// Which.
    pub group: &'static str,
    /// Of all numbers here.
    pub unit: &'static str,
    /// Of a parameter's mean error.
    pub mean: f64,
    /// Of a parameter's standard deviation about its mean.
    pub std: f64,
    /// Of all errors.
    pub rms: f64,
    /// Of the estimator's own sigmas.
    pub sigma: f64,
    /// Of the Cramér–Rao sigmas.
    pub bound: f64,
    /// Of the bound for one who knows the lever arm.
    pub bound_lever_known: f64,
    /// Of the bound for one who does not know that a box turns about its face's normal.
    pub bound_axis_free: f64,
    /// `rms / bound`.
    pub ratio: f64,
    /// Share of errors within two of the estimator's sigmas; 0.954 if these are true.
    pub within_2_sigma: f64,
}

/// Normalised estimation error squared, `eᵀ P⁻¹ e` over the number of parameters, with the band in which its mean over
/// all trials lies with 95 % probability if the covariance is true.
#[derive(Clone, Debug, Serialize)]
pub struct Nees {
    /// Parameters that the data determine.
    pub parameters: usize,
    /// Mean over the trials.
    pub mean: f64,
    /// 2.5 and 97.5 % points of χ² with `parameters · trials` degrees of freedom, over these.
    pub band: (f64, f64),
    /// Does the mean lie within?
    pub inside: bool,
}

/// Indices of what has a sigma at all.
fn determined(trials: &[Trial]) -> Vec<usize> {
    (0..PARAMETERS).filter(|&i| trials.iter().all(|trial| trial.covariance[(i, i)] > 0.0)).collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value * value, count + 1.0));
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}

/// One line of a table.
pub fn group(trials: &[Trial], group: Group) -> GroupSummary {
    let indices: Vec<usize> = determined(trials).into_iter().filter(|&i| group.contains(i)).collect();
    let (unit, factor) = group.unit();
    let count = trials.len().max(1) as f64;
    let means: Vec<f64> =
        indices.iter().map(|&i| trials.iter().map(|trial| trial.error[i]).sum::<f64>() / count).collect();
    let over = |f: &dyn Fn(&Trial, usize) -> f64| {
        factor * rms(trials.iter().flat_map(|trial| indices.iter().map(move |&i| f(trial, i))))
    };
    let deviations = trials.iter().flat_map(|trial| indices.iter().zip(&means).map(|(&i, mean)| trial.error[i] - mean));
    let within = trials.iter().flat_map(|trial| indices.iter().map(move |&i| within_two_sigma(trial, i)));
    let all = over(&|trial, i| trial.error[i]);
    let bound = over(&|trial, i| trial.bound[i]);
    GroupSummary {
        group: group.name(),
        unit,
        mean: factor * rms(means.iter().copied()),
        std: factor * rms(deviations) * (count / (count - 1.0).max(1.0)).sqrt(),
        rms: all,
        sigma: over(&|trial, i| trial.covariance[(i, i)].sqrt()),
        bound,
        bound_lever_known: over(&|trial, i| trial.bound_lever_known[i]),
        bound_axis_free: over(&|trial, i| trial.bound_axis_free[i]),
        ratio: all / bound,
        within_2_sigma: within.filter(|within| *within).count() as f64 / (count * indices.len().max(1) as f64),
    }
}

/// Gyroscope scale and non-orthogonality of one estimator over all trials, ppm and µrad: root mean squares over the
/// parameters of their mean errors and of their standard deviations.
#[derive(Clone, Debug, Serialize)]
pub struct EstimatorSummary {
    /// Which.
    pub estimator: &'static str,
    /// Sessions with numbers.
    pub runs: usize,
    /// Mean and standard deviation.
    pub scale_ppm: (f64, f64),
    /// Likewise.
    pub cross_urad: (f64, f64),
}

/// The device and what else was asked for.
pub fn estimators(trials: &[Trial]) -> Vec<EstimatorSummary> {
    ["device", "batch", "gravity", "two-step"].into_iter().filter_map(|name| estimator(trials, name)).collect()
}

fn estimator(trials: &[Trial], name: &'static str) -> Option<EstimatorSummary> {
    let error = |trial: &Trial| match name {
        "device" => Some(trial.error),
        _ => trial.others.iter().find(|other| other.0 == name).map(|other| other.1),
    };
    let errors: Vec<_> = trials.iter().filter_map(error).collect();
    let count = errors.len() as f64;
    let spread = |group: Group| {
        let each = |index: usize| {
            let mean = errors.iter().map(|error| error[index]).sum::<f64>() / count;
            let square: f64 = errors.iter().map(|error| (error[index] - mean).powi(2)).sum();
            (1e6 * mean, 1e6 * (square / (count - 1.0).max(1.0)).sqrt())
        };
        let all: Vec<_> = (0..PARAMETERS).filter(|&index| group.contains(index)).map(each).collect();
        (rms(all.iter().map(|one| one.0)), rms(all.iter().map(|one| one.1)))
    };
    (!errors.is_empty()).then(|| EstimatorSummary {
        estimator: name,
        runs: errors.len(),
        scale_ppm: spread(Group::GyroScale),
        cross_urad: spread(Group::GyroCross),
    })
}

fn within_two_sigma(trial: &Trial, index: usize) -> bool {
    trial.error[index].abs() < 2.0 * trial.covariance[(index, index)].sqrt()
}

/// Share of all parameters within two sigma.
pub fn within_2_sigma(trials: &[Trial]) -> f64 {
    let indices = determined(trials);
    let within = trials.iter().flat_map(|trial| indices.iter().map(move |&i| within_two_sigma(trial, i)));
    within.filter(|within| *within).count() as f64 / (trials.len() * indices.len()).max(1) as f64
}

/// Whether the covariance as a whole is true. None if one of them is not positive definite.
pub fn nees(trials: &[Trial]) -> Option<Nees> {
    let indices = determined(trials);
    let n = indices.len();
    let mut sum = 0.0;
    for trial in trials {
        // Scaled to unit diagonal: the parameters' sigmas differ by four decades.
        let sigma: Vec<f64> = indices.iter().map(|&i| trial.covariance[(i, i)].sqrt()).collect();
        let correlation =
            DMatrix::from_fn(n, n, |i, j| trial.covariance[(indices[i], indices[j])] / (sigma[i] * sigma[j]));
        let error = DVector::from_fn(n, |i, _| trial.error[indices[i]] / sigma[i]);
        sum += error.dot(&correlation.cholesky()?.solve(&error));
    }
    let dof = (n * trials.len()) as f64;
    let mean = sum / dof;
    let band = (chi_square_over_dof(dof, -1.959_964), chi_square_over_dof(dof, 1.959_964));
    Some(Nees { parameters: n, mean, band, inside: (band.0..=band.1).contains(&mean) })
}

/// Quantile of χ²_ν/ν at `z` standard normal deviations (Wilson & Hilferty 1931; exact to 1e-3 beyond 20 degrees).
pub fn chi_square_over_dof(dof: f64, z: f64) -> f64 {
    let spread = 2.0 / (9.0 * dof);
    (1.0 - spread + z * spread.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_belongs_to_one_group() {
        for index in 0..PARAMETERS {
            assert_eq!(Group::ALL.into_iter().filter(|group| group.contains(index)).count(), 1, "{index}");
        }
        assert!(Group::GyroScale.contains(15) && Group::GyroScale.contains(19) && Group::GyroScale.contains(23));
        assert_eq!((0..PARAMETERS).filter(|&i| Group::AccelCross.contains(i)).count(), 6);
    }

    #[test]
    fn the_band_is_the_tables() {
        // χ²₁₀₀: 74.222 and 129.561.
        assert!((chi_square_over_dof(100.0, -1.959_964) - 0.742_22).abs() < 1e-3);
        assert!((chi_square_over_dof(100.0, 1.959_964) - 1.295_61).abs() < 1e-3);
    }
}
