//! A calibration as a list of named numbers: the protocol's `@param` lines and the contract's names.

use super::{Calibration, TriadEstimate};

/// One number of a calibration, under its name in `docs/protocol.md`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// `accel_bias_x`, `gyro_correction_xy` (row, column) and so on.
    pub name: &'static str,
    /// In [`Self::unit`]. A prior's number where it is not observable, to be shown to nobody.
    pub value: f32,
    /// One sigma; none for what is measured beside the calibration (its temperature).
    pub sigma: Option<f32>,
    /// `m/s^2`, `rad/s`, `1`, `degC` or `(rad/s)/(m/s^2)`.
    pub unit: &'static str,
    /// Do the data determine it?
    pub observable: bool,
}

#[rustfmt::skip]
const NAMES: [&str; 34] = [
    "accel_bias_x", "accel_bias_y", "accel_bias_z",
    "accel_correction_xx", "accel_correction_xy", "accel_correction_xz",
    "accel_correction_yx", "accel_correction_yy", "accel_correction_yz",
    "accel_correction_zx", "accel_correction_zy", "accel_correction_zz",
    "gyro_bias_x", "gyro_bias_y", "gyro_bias_z",
    "gyro_correction_xx", "gyro_correction_xy", "gyro_correction_xz",
    "gyro_correction_yx", "gyro_correction_yy", "gyro_correction_yz",
    "gyro_correction_zx", "gyro_correction_zy", "gyro_correction_zz",
    "calibration_temperature",
    "gyro_g_sensitivity_xx", "gyro_g_sensitivity_xy", "gyro_g_sensitivity_xz",
    "gyro_g_sensitivity_yx", "gyro_g_sensitivity_yy", "gyro_g_sensitivity_yz",
    "gyro_g_sensitivity_zx", "gyro_g_sensitivity_zy", "gyro_g_sensitivity_zz",
];
/// Where they begin.
const GYRO: usize = 12;
const TEMPERATURE: usize = 24;
const G_SENSITIVITY: usize = 25;

impl Calibration {
    /// How many numbers every calibration has.
    pub const PARAMETERS: usize = G_SENSITIVITY;

    /// All of them: accelerometer bias and correction, gyroscope bias and correction, temperature; and where there is one the sensitivity
    /// to force by rows.
    pub fn parameters(&self) -> impl Iterator<Item = Parameter> + '_ {
        let count = if self.g_sensitivity.is_some() { NAMES.len() } else { Self::PARAMETERS };
        NAMES.iter().take(count).enumerate().map(|(index, name)| self.parameter(index, name))
    }

    /// One function and not a chain of iterators, of which every loop over them would hold a copy (2 KB of the board's flash each).
    #[inline(never)]
    fn parameter(&self, index: usize, name: &'static str) -> Parameter {
        match index {
            0..GYRO => self.accelerometer.parameter(index, name, "m/s^2"),
            GYRO..TEMPERATURE => self.gyroscope.parameter(index - GYRO, name, "rad/s"),
            TEMPERATURE => {
                Parameter { name, value: self.temperature_degc, sigma: None, unit: "degC", observable: true }
            }
            _ => {
                let felt = self.g_sensitivity.unwrap_or_default();
                let at = ((index - G_SENSITIVITY) / 3, (index - G_SENSITIVITY) % 3);
                let sigma = Some(felt.sigma[at]);
                Parameter { name, value: felt.matrix[at], sigma, unit: "(rad/s)/(m/s^2)", observable: true }
            }
        }
    }
}

impl TriadEstimate {
    /// Bias 3, correction 9 by rows.
    fn parameter(&self, index: usize, name: &'static str, unit: &'static str) -> Parameter {
        let Some(k) = index.checked_sub(3) else {
            let (value, sigma) = (self.triad.bias[index], Some(self.bias_sigma[index]));
            return Parameter { name, value, sigma, unit, observable: true };
        };
        let at = (k / 3, k % 3);
        let (value, sigma) = (self.triad.correction[at], Some(self.correction_sigma[at]));
        Parameter { name, value, sigma, unit: "1", observable: self.observable[at.0][at.1] }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Fit, Frame, GSensitivity, Triad};
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn every_number_stands_under_its_own_name() {
        let triad = |offset: f32| TriadEstimate {
            triad: Triad {
                bias: Vector3::new(offset, offset + 1.0, offset + 2.0),
                correction: Matrix3::from_fn(|i, j| offset + 3.0 + (3 * i + j) as f32),
            },
            bias_sigma: Vector3::repeat(0.5),
            correction_sigma: Matrix3::repeat(0.25),
            observable: [[true, false, true]; 3],
        };
        let calibration = Calibration {
            accelerometer: triad(0.0),
            gyroscope: triad(12.0),
            g_sensitivity: None,
            frame: Frame::Box,
            temperature_degc: 24.0,
            fit: Fit::default(),
        };
        assert_eq!(calibration.parameters().count(), Calibration::PARAMETERS);
        for (i, parameter) in calibration.parameters().enumerate() {
            assert_eq!(parameter.value, i as f32, "{parameter:?}");
            assert_eq!(parameter.name.starts_with("gyro"), (12..24).contains(&i), "{parameter:?}");
        }
        let matrix = Matrix3::from_fn(|i, j| 25.0 + (3 * i + j) as f32);
        let felt = Calibration { g_sensitivity: Some(GSensitivity { matrix, sigma: matrix }), ..calibration };
        let all = felt.parameters().enumerate().skip(Calibration::PARAMETERS);
        assert_eq!(all.filter(|(i, p)| p.value == *i as f32 && p.name.starts_with("gyro_g_sensitivity")).count(), 9);
        let xy = calibration.parameters().find(|p| p.name == "gyro_correction_xy").expect("named");
        assert_eq!((xy.value, xy.observable, xy.unit), (16.0, false, "1"));
    }
}
