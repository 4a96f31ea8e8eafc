//! What every effect's file needs.

pub(super) use super::bias::Triad;
pub(super) use super::kind::{Kind, Values};
pub(super) use super::model::Model;
pub(super) use super::units::{DPS, MG, PPM};
pub(super) use crate::STANDARD_GRAVITY_MPS2 as G;
pub(super) use crate::sensor::{Ideal, Instant, Parameter, Quantisation, Sample, Signal};
pub(super) use crate::world::{World, WorldConfig};
pub(super) use nalgebra::Vector3;
