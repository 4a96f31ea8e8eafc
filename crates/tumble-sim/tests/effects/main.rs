//! Every effect has the size that was asked for. The expected values are computed here from the equations, and share no
//! code with the models.

mod common;
mod foreign;
mod inject;
mod motion;
mod registry;
mod sensor;
mod stream;
