//! The Black Pill (STM32F411CE) with its MPU-9250, emulated: the product's firmware image runs on it unmodified.

pub mod board;
pub mod exti;
pub mod flash;
pub mod flash_array;
pub mod inspect;
pub mod machine;
pub mod memory_map;
pub mod mpu9250;
pub mod part;
pub mod run;
pub mod sensor_wires;
pub mod serial_wire;
pub mod stall;
pub mod story;
pub mod timer;
pub mod world;

pub use board::{Board, BoardError, BoardOptions, Stopped};
pub use flash_array::FlashTiming;
pub use inspect::Arrival;
pub use mpu9250::{SensorFault, SensorOptions};
pub use world::{AtRest, PhysicalSample, STANDARD_GRAVITY_MPS2, SensorWorld};
