//! The drivers of actuators against mocks of their buses: the bytes are those of the parts' data sheets.

use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
use embedded_hal_mock::eh1::pwm::{Mock as PwmMock, Transaction as PwmTransaction};
use octruss_firmware::actuators::{Pca9685, Pulse, PulseError, PwmActuators};

const ADDRESS: u8 = Pca9685::<Mock>::ADDRESS;

/// The transfers of a start at 50 Hz: 25 MHz / (4096 * 50) = 122.07, so the prescaler is 121, 0x79, as in the data
/// sheet's formula.
fn start() -> Vec<Transaction> {
    let mut off = vec![0x06];
    off.extend([0, 0, 0, 0x10].repeat(16));
    vec![
        Transaction::write(ADDRESS, vec![0x00, 0x30]),
        Transaction::write(ADDRESS, vec![0xfe, 0x79]),
        Transaction::write(ADDRESS, off),
        Transaction::write(ADDRESS, vec![0x00, 0x20]),
    ]
}

#[test]
fn one_transfer_sets_all_channels() {
    let mut all = vec![0x06];
    // Never, always, and 4096 * 2048 / 4095 = 2048.50, up: 0x0801.
    all.extend([0, 0, 0, 0x10]);
    all.extend([0, 0x10, 0, 0]);
    all.extend([0, 0, 0x01, 0x08].repeat(14));
    let mut expected = start();
    expected.push(Transaction::write(ADDRESS, all));
    let mut chip = Pca9685::start(Mock::new(&expected), ADDRESS, Pulse::WHOLE, 50).unwrap();
    let mut set_points = [2048; 16];
    (set_points[0], set_points[1]) = (0, 4095);
    chip.set(&set_points).unwrap();
    chip.release().done();
}

#[test]
fn servos_get_one_to_two_milliseconds() {
    let mut all = vec![0x06];
    // 205 = 0x00cd and 410 = 0x019a.
    all.extend([0, 0, 0xcd, 0x00]);
    all.extend([0, 0, 0x9a, 0x01].repeat(15));
    let mut expected = start();
    expected.push(Transaction::write(ADDRESS, all));
    let mut chip = Pca9685::start(Mock::new(&expected), ADDRESS, Pulse::SERVO, 50).unwrap();
    let mut set_points = [u16::MAX; 16];
    set_points[0] = 0;
    chip.set(&set_points).unwrap();
    chip.release().done();
    assert_eq!(Pulse::new(2, 1), Err(PulseError));
    assert_eq!(Pulse::new(0, 4097), Err(PulseError));
}

#[test]
fn the_bus_says_what_went_wrong() {
    let failing = Transaction::write(ADDRESS, vec![0x00, 0x30]).with_error(ErrorKind::Other);
    let mut bus = Mock::new(&[failing]);
    let started = Pca9685::start(bus.clone(), ADDRESS, Pulse::WHOLE, 50);
    assert_eq!(started.err(), Some(ErrorKind::Other));
    bus.done();
}

#[test]
fn outputs_get_their_part_of_the_period() {
    // A period of 819 counts; a fraction is cut to whole counts by embedded_hal: 819 * 4090 / 4095 = 818.
    let expected = |duty| {
        let set = PwmTransaction::set_duty_cycle(duty);
        PwmMock::new(&[PwmTransaction::max_duty_cycle(819), set])
    };
    let outputs = [expected(0), expected(818), expected(819)];
    let mut actuators = PwmActuators::new(outputs);
    actuators.set(&[0, 4090, u16::MAX, 7]).unwrap();
    for mut output in actuators.release() {
        output.done();
    }
}
