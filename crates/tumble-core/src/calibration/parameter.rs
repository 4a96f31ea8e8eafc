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
    /// `m/s^2`, `rad/s`, `1` or `degC`.
    pub unit: &'static str,
    /// Do the data determine it?
    pub observable: bool,
}

const BIAS: [[&str; 3]; 2] =
    [["accel_bias_x", "accel_bias_y", "accel_bias_z"], ["gyro_bias_x", "gyro_bias_y", "gyro_bias_z"]];
#[rustfmt::skip]
const CORRECTION: [[&str; 9]; 2] = [
    ["accel_correction_xx", "accel_correction_xy", "accel_correction_xz",
     "accel_correction_yx", "accel_correction_yy", "accel_correction_yz",
     "accel_correction_zx", "accel_correction_zy", "accel_correction_zz"],
    ["gyro_correction_xx", "gyro_correction_xy", "gyro_correction_xz",
     "gyro_correction_yx", "gyro_correction_yy", "gyro_correction_yz",
     "gyro_correction_zx", "gyro_correction_zy", "gyro_correction_zz"],
];

impl Calibration {
    /// How many numbers a calibration has.
    pub const PARAMETERS: usize = 25;

    /// All of them: accelerometer bias and correction, gyroscope bias and correction, temperature.
    pub fn parameters(&self) -> impl Iterator<Item = Parameter> {
        let [accel, gyro] = BIAS;
        let temperature = Parameter {
            name: "calibration_temperature",
            value: self.temperature_degc,
            sigma: None,
            unit: "degC",
            observable: true,
        };
        self.accelerometer
            .parameters(accel, CORRECTION[0], "m/s^2")
            .chain(self.gyroscope.parameters(gyro, CORRECTION[1], "rad/s"))
            .chain(core::iter::once(temperature))
    }
}

impl TriadEstimate {
    fn parameters(
        self,
        bias: [&'static str; 3],
        correction: [&'static str; 9],
        unit: &'static str,
    ) -> impl Iterator<Item = Parameter> {
        let biases = bias.into_iter().enumerate().map(move |(i, name)| Parameter {
            name,
            value: self.triad.bias[i],
            sigma: Some(self.bias_sigma[i]),
            unit,
            observable: true,
        });
        let corrections = correction.into_iter().enumerate().map(move |(k, name)| {
            let at = (k / 3, k % 3);
            Parameter {
                name,
                value: self.triad.correction[at],
                sigma: Some(self.correction_sigma[at]),
                unit: "1",
                observable: self.observable[at.0][at.1],
            }
        });
        biases.chain(corrections)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Fit, Frame, Triad};
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
            frame: Frame::Box,
            temperature_degc: 24.0,
            fit: Fit::default(),
        };
        assert_eq!(calibration.parameters().count(), Calibration::PARAMETERS);
        for (i, parameter) in calibration.parameters().enumerate() {
            assert_eq!(parameter.value, i as f32, "{parameter:?}");
            assert_eq!(parameter.name.starts_with("gyro"), (12..24).contains(&i), "{parameter:?}");
        }
        let xy = calibration.parameters().find(|p| p.name == "gyro_correction_xy").expect("named");
        assert_eq!((xy.value, xy.observable, xy.unit), (16.0, false, "1"));
    }
}
