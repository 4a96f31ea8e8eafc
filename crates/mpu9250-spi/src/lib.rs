#![no_std]
//! Driver.
