//! The controller's serial link against frames that are made wrong in known ways.
//!
//! The frames are made by this file's own COBS and CRC-32, written from their definitions (Cheshire and Baker 1999;
//! the polynomial 0x04c11db7 of IEEE 802.3, reflected), so that the crates are held to them too.

use octruss_firmware::link::wire::{self, ENCODED_BYTES};
use octruss_firmware::link::{
    BYTES_A_TICK, Command, FRAMES_A_TICK, Faults, Goal, Header, RING_BYTES, Receiver, Ring, Target,
    Telemetry,
};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn crc32(bytes: &[u8]) -> u32 {
    let mut register = u32::MAX;
    for byte in bytes {
        register ^= u32::from(*byte);
        for _ in 0..8 {
            let carry = register & 1;
            register >>= 1;
            if carry == 1 {
                register ^= 0xedb8_8320;
            }
        }
    }
    !register
}

/// A frame without its zero. No payload here is as long as a COBS block of 254 bytes.
fn frame(payload: &[u8]) -> Vec<u8> {
    let mut checked = payload.to_vec();
    checked.extend(crc32(payload).to_le_bytes());
    assert!(checked.len() < 254);
    let blocks = checked.split(|byte| *byte == 0);
    blocks
        .flat_map(|block| std::iter::once(block.len() as u8 + 1).chain(block.iter().copied()))
        .collect()
}

fn hear(receiver: &mut Receiver, bytes: &[u8]) -> Vec<(Header, Command)> {
    let mut heard = Vec::new();
    for piece in bytes.chunks(BYTES_A_TICK) {
        let mut bytes = piece.iter().copied();
        receiver.tick(
            || bytes.next(),
            |header, command| {
                heard.push((header, command));
                true
            },
        );
    }
    heard
}

fn query(sequence: u16) -> Vec<u8> {
    let mut payload = sequence.to_le_bytes().to_vec();
    payload.extend([0, 0, 0, 0, 4]);
    payload
}

fn ended(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.push(0);
    bytes
}

#[test]
fn the_checksum_is_that_of_the_catalogue() {
    // "123456789" gives 0xcbf43926 in the catalogue of parametrised CRC algorithms.
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
}

#[test]
fn every_command_is_framed_as_written_and_read_back() {
    let goals = (0..12).map(|effector| Goal {
        effector,
        place: [i32::MIN, 0, i32::MAX],
    });
    let targets = (0..16).map(|channel| Target {
        channel,
        amplitude: -1,
    });
    let commands = [
        Command::Goals(goals.collect()),
        Command::Actuators(targets.collect()),
        Command::Hold,
        Command::Query,
        Command::Watch {
            host_clock_us: 0x0102_0304,
            silence_ticks: 7,
        },
        Command::Restart,
    ];
    for (sequence, command) in (0..).zip(commands) {
        let header = Header { sequence, due: 258 };
        let payload = command.payload(header);
        let mut out = [0xaa; ENCODED_BYTES + 1];
        let length = wire::encode(&payload, &mut out).unwrap();
        assert_eq!(out[..length], ended(frame(&payload)), "{command:?}");
        assert_eq!(Command::read(&payload), Ok((header, command.clone())));
        for cut in 0..payload.len() {
            assert!(Command::read(&payload[..cut]).is_err(), "{command:?} {cut}");
        }
        let heard = hear(&mut Receiver::new(), &out[..length]);
        assert_eq!(heard, [(header, command)]);
    }
    // The table of docs/protocol.md, byte for byte.
    let watch = Command::Watch {
        host_clock_us: 0x0403_0201,
        silence_ticks: 50,
    };
    let header = Header {
        sequence: 0x0605,
        due: 9,
    };
    let expected = [5, 6, 9, 0, 0, 0, 5, 1, 2, 3, 4, 50, 0, 0, 0];
    assert_eq!(watch.payload(header)[..], expected);
}

#[test]
fn telemetry_is_read_back() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..200 {
        let mut bytes = [0; octruss_firmware::link::TELEMETRY_BYTES];
        random.fill_bytes(&mut bytes);
        // The count of commands takes four bytes and never more than two of them.
        let accepted = 40 + 4 * Faults::COUNT;
        bytes[accepted + 2..accepted + 4].fill(0);
        let telemetry = Telemetry::read(&bytes).unwrap();
        assert_eq!(telemetry.payload()[..], bytes);
        assert_eq!(Telemetry::read(&bytes[1..]), None);
    }
}

#[test]
fn a_full_ring_loses_bytes_and_counts_them() {
    let mut ring = Ring::new();
    let (mut filler, mut drain) = ring.split();
    for number in 0..RING_BYTES + 9 {
        filler.put(number as u8);
    }
    // One slot stays free.
    assert_eq!(drain.lost(), 10);
    for number in 0..RING_BYTES - 1 {
        assert_eq!(drain.take(), Some(number as u8));
    }
    assert_eq!(drain.take(), None);
    // The frame that the loss cut is refused; the next one is heard.
    let mut receiver = Receiver::new();
    let mut stream = ended(frame(&query(1)));
    stream.remove(3);
    stream.extend(ended(frame(&query(2))));
    stream.into_iter().for_each(|byte| filler.put(byte));
    let mut heard = 0;
    receiver.tick(
        || drain.take(),
        |_, _| {
            heard += 1;
            true
        },
    );
    assert_eq!((heard, receiver.faults().refused()), (1, 1));
}

#[test]
fn a_flood_is_refused_beyond_what_a_tick_takes() {
    let mut receiver = Receiver::new();
    let stream: Vec<u8> = (0..44).flat_map(|n| ended(frame(&query(n)))).collect();
    assert_eq!(hear(&mut receiver, &stream).len(), FRAMES_A_TICK);
    assert_eq!(receiver.faults().flood, 12);
    // Every byte of a tick's share is looked at, and not one more.
    let mut taken = 0;
    receiver.tick(
        || {
            taken += 1;
            Some(1)
        },
        |_, _| true,
    );
    assert_eq!(taken, BYTES_A_TICK);
}

#[test]
fn sequence_numbers_go_forward_and_wrap() {
    let mut receiver = Receiver::new();
    let mut sequences = |sequences: &[u16]| {
        let stream = sequences.iter().flat_map(|n| ended(frame(&query(*n))));
        hear(&mut receiver, &stream.collect::<Vec<_>>()).len()
    };
    assert_eq!(sequences(&[65_534, 65_535, 0, 3]), 4);
    assert_eq!(sequences(&[3, 2, 65_535]), 0);
    assert_eq!(sequences(&[3 + 32_768]), 0);
    assert_eq!(sequences(&[3 + 32_767]), 1);
    let faults = receiver.faults();
    assert_eq!(
        (faults.repeated, faults.out_of_order, faults.skipped),
        (1, 3, 2 + 32_766)
    );
    let restart = Command::Restart.payload(Header {
        sequence: 5,
        due: 0,
    });
    assert_eq!(hear(&mut receiver, &ended(frame(&restart))).len(), 1);
    assert_eq!(hear(&mut receiver, &ended(frame(&restart))).len(), 0);
}

/// Sends `count` wrong frames, a sound one after every hundredth, and demands that only the sound ones are heard and
/// that each of the others is counted once, by its kind where the kind leaves no choice.
fn fuzz(count: u32, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut receiver = Receiver::new();
    let mut sequence = 0_u16;
    let mut sound = 0_u32;
    let mut kinds = [0_u32; 7];
    assert_eq!(hear(&mut receiver, &ended(frame(&query(0)))).len(), 1);
    for number in 0..count {
        let kind = random.random_range(0..kinds.len());
        kinds[kind] += 1;
        let mut bytes = frame(&query(sequence.wrapping_add(1)));
        match kind {
            // A cut.
            0 => bytes.truncate(random.random_range(1..bytes.len())),
            // A changed bit that leaves no zero.
            1 => loop {
                let (place, bit) = (
                    random.random_range(0..bytes.len()),
                    random.random_range(0..8),
                );
                let changed = bytes[place] ^ (1 << bit);
                if changed != 0 {
                    bytes[place] = changed;
                    break;
                }
            },
            // Garbage.
            2 => {
                let length = random.random_range(1..ENCODED_BYTES);
                bytes = (0..length).map(|_| random.random_range(1..=255)).collect();
            }
            // Longer than a frame may be.
            3 => {
                let length = ENCODED_BYTES + random.random_range(1..400);
                bytes = (0..length).map(|_| random.random_range(1..=255)).collect();
            }
            4 => bytes = frame(&query(sequence)),
            5 => {
                bytes = frame(&query(
                    sequence.wrapping_sub(random.random_range(1..1 << 15)),
                ))
            }
            // An unknown command, or a known one with a wrong body, with a sound checksum.
            _ => {
                let mut payload = query(sequence.wrapping_add(1));
                match random.random_range(0..3) {
                    0 => payload[6] = random.random_range(7..=255),
                    1 => payload.push(random.random()),
                    _ => payload[6] = 0,
                }
                bytes = frame(&payload);
            }
        }
        let heard = hear(&mut receiver, &ended(bytes));
        assert!(heard.is_empty(), "frame {number} of kind {kind}: {heard:?}");
        assert_eq!(receiver.faults().refused(), number + 1, "kind {kind}");
        if number % 100 == 99 {
            sequence = sequence.wrapping_add(1);
            sound += hear(&mut receiver, &ended(frame(&query(sequence)))).len() as u32;
        }
    }
    let faults = receiver.faults();
    assert_eq!(sound, count / 100);
    assert_eq!(
        [
            faults.oversize,
            faults.repeated,
            faults.out_of_order,
            faults.unknown
        ],
        kinds[3..]
    );
    assert_eq!(
        faults.truncated + faults.checksum,
        kinds[0] + kinds[1] + kinds[2]
    );
    assert_eq!((faults.flood, faults.skipped), (0, 0));
}

#[test]
fn wrong_frames_are_refused_and_counted() {
    fuzz(20_000, 7);
}

#[test]
#[ignore = "a million frames: cargo xtask verify"]
fn a_million_wrong_frames_are_refused_and_counted() {
    fuzz(1_000_000, 11);
}
