//! The bus as a script of expected transfers, and the transfers a start consists of.

use embassy_futures::block_on;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::spi::{Mock, Transaction};
use mpu9250_spi::{Configuration, Mpu9250, Register};

pub type Script = Vec<Transaction<u8>>;

pub fn write(register: Register, value: u8) -> Script {
    vec![
        Transaction::transaction_start(),
        Transaction::write_vec(vec![register.0, value]),
        Transaction::transaction_end(),
    ]
}

pub fn read(register: Register, value: u8) -> Script {
    vec![
        Transaction::transaction_start(),
        Transaction::transfer_in_place(vec![register.0 | 0x80, 0], vec![0xEE, value]),
        Transaction::transaction_end(),
    ]
}

pub fn write_checked(register: Register, value: u8) -> Script {
    [write(register, value), read(register, value)].concat()
}

pub fn burst(bytes: [u8; 15]) -> Script {
    let mut sent = vec![0; 16];
    sent[0] = 0x3A | 0x80;
    let answer = [&[0xEE][..], &bytes].concat();
    vec![Transaction::transaction_start(), Transaction::transfer_in_place(sent, answer), Transaction::transaction_end()]
}

/// What comes before the configuration.
pub fn wake_up(who_am_i: u8) -> Script {
    [write(Register::PWR_MGMT_1, 0x80), read(Register::WHO_AM_I, who_am_i)].concat()
}

pub fn configuration(configuration: &Configuration) -> Script {
    configuration.writes().into_iter().flat_map(|(register, value)| write_checked(register, value)).collect()
}

/// Runs `what` on a part that answers by the script, all of which must be used up.
pub fn run<T>(script: Script, what: impl AsyncFnOnce(&mut Mpu9250<Mock<u8>, NoopDelay>) -> T) -> T {
    let mut bus = Mock::new(&script);
    let mut device = Mpu9250::new(bus.clone(), NoopDelay::new());
    let result = block_on(what(&mut device));
    bus.done();
    result
}
