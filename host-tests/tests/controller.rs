//! The controller on the host: which commands take effect on a tick, and whether telemetry names every one of them.

use std::path::Path;

use octruss_bake::bundle::BundleBytes;
use octruss_bake::drive::session::frame;
use octruss_firmware::controller::{BoardState, Controller, Memory, Motion, Parts, Queue};
use octruss_firmware::link::{COMMANDS_A_TICK, Command, Header};
use octruss_firmware::player::ROWS_A_PIECE;
use octruss_host_tests::performance::inverse::{Sources, bake_solver};

/// More commands than a tick takes, behind a restart on the same tick: what telemetry does not name must not take effect,
/// or a recorded run could not be repeated. The counts are those of docs/protocol.md.
#[test]
fn every_command_that_takes_effect_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let sources = Sources {
        cage: models.join("finger.msh"),
        model: models.join("finger.obj"),
        motion: models.join("finger-motion.csv"),
        folder: models,
    };
    bake_solver(directory.path(), &sources).unwrap();
    let bytes = BundleBytes::read(&directory.path().join("inverse.oct")).unwrap();
    let bundle = bytes.open().unwrap();
    let mut pose = vec![[0; 3]; bundle.rest_cage().len()];
    let mut piece = [[0; 3]; ROWS_A_PIECE];
    let memory = Memory {
        pose: &mut pose,
        piece: &mut piece,
    };
    let motion = Motion::new(Parts::open(&bundle).unwrap(), memory).unwrap();
    let mut queue = Queue::new();
    let mut controller = Controller::new(motion, &mut queue);
    let mut tick = |commands: &[(Command, u32)], first: u16| {
        let frames = (first..)
            .zip(commands)
            .flat_map(|(sequence, (command, due))| {
                frame(&command.payload(Header {
                    sequence,
                    due: *due,
                }))
            });
        let mut bytes = frames.collect::<Vec<u8>>().into_iter();
        controller.tick(|| bytes.next(), BoardState::default())
    };
    let watch = |clock: u32| Command::Watch {
        host_clock_us: clock,
        silence_ticks: 0,
    };

    let queries: Vec<_> = (1..=10).map(|clock| (watch(clock), 0)).collect();
    let record = tick(&queries, 1);
    assert_eq!(usize::from(record.accepted), COMMANDS_A_TICK);
    assert_eq!((record.faults.flood, record.host_clock_us), (2, 8));
    assert_eq!(record.sequences, [1, 2, 3, 4, 5, 6, 7, 8]);

    let mut commands = vec![(Command::Restart, 0)];
    commands.extend(queries);
    let record = tick(&commands, 20);
    assert_eq!((record.tick, usize::from(record.accepted)), (0, 8));
    assert_eq!(record.sequences, [20, 21, 22, 23, 24, 25, 26, 27]);
    assert_eq!((record.faults.flood, record.host_clock_us), (5, 7));

    // A later tick takes its eight all the same; one that has passed is rejected.
    let later: Vec<_> = (1..=9).map(|clock| (watch(clock), 3)).collect();
    assert_eq!(tick(&later, 40).accepted, 0);
    assert_eq!(tick(&[(watch(99), 1)], 50).faults.rejected, 1);
    let record = tick(&[], 0);
    assert_eq!((record.tick, record.accepted), (3, 8));
    assert_eq!((record.faults.flood, record.host_clock_us), (6, 8));
}
