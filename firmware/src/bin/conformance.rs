//! Runs core on the cases of a file and writes raw results: see `octruss_firmware::cases`.
//!
//! Reads `cases.bin` and writes `results.bin`, both in the directory in which the emulator or the
//! debugger was started.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use octruss_firmware::cases::{
    self, CASE_HEADER_WORDS, CASE_WORDS_AT_MOST, CASES_MAGIC, FILE_HEADER_WORDS, Memory, Results,
    Sink, Status, VERSION,
};
use octruss_firmware::exit::{self, Ending, figure};
use octruss_firmware::files::{Input, Output};
use octruss_firmware::sections::section_bytes;
use octruss_firmware::stack;
use zerocopy::IntoBytes;

/// A case's words, aligned so that a bundle among them is.
#[repr(align(8))]
struct CaseWords([u32; CASE_WORDS_AT_MOST]);

#[entry]
fn main() -> ! {
    static mut MEMORY: Memory = Memory::new();
    static mut WORDS: CaseWords = CaseWords([0; CASE_WORDS_AT_MOST]);
    static mut BUFFER: [u8; BUFFER_BYTES] = [0; BUFFER_BYTES];

    let mut input = Input::open(c"cases.bin");
    let header: [u32; FILE_HEADER_WORDS] = read_words(&mut input);
    let [CASES_MAGIC, VERSION, cases] = header else {
        refuse("cases.bin is no case file of this version")
    };
    let mut output = Buffered {
        file: Output::create(c"results.bin"),
        buffer: BUFFER,
        filled: 0,
    };
    let mut results = Results::begin(&mut output, cases);
    for _ in 0..cases {
        let [kind, number, length]: [u32; CASE_HEADER_WORDS] = read_words(&mut input);
        results.case(number);
        match WORDS.0.get_mut(..length as usize) {
            Some(words) => {
                fill(&mut input, words.as_mut_bytes());
                cases::run(kind, words, MEMORY, &mut results);
            }
            None => {
                for _ in 0..length {
                    let _: [u32; 1] = read_words(&mut input);
                }
                results.end(Status::TooLong { words: length });
            }
        }
        if !stack::is_sound() {
            // Statics may be overwritten, the logger's among them: the exit code says it all.
            exit::stop(Ending::StackOverflowed)
        }
    }
    output.flush();
    report(cases);
    exit::finish()
}

/// Figures for the host.
fn report(cases: u32) {
    let sections = section_bytes();
    figure("cases", cases);
    figure("stack bytes", stack::bytes_used_at_most() as u32);
    figure("flash bytes", sections.flash as u32);
    figure("static RAM bytes", sections.ram as u32);
}

/// Reads `N` words; the file has them.
fn read_words<const N: usize>(input: &mut Input) -> [u32; N] {
    let mut words = [0; N];
    fill(input, words.as_mut_bytes());
    words
}

/// Fills `bytes`; the file has them.
fn fill(input: &mut Input, bytes: &mut [u8]) {
    if input.read(bytes) != bytes.len() {
        refuse("cases.bin is cut short")
    }
}

fn refuse(reason: &str) -> ! {
    defmt::error!("{=str}", reason);
    exit::stop(Ending::Refused)
}

/// Bytes that are collected before the host is called: results come in small pieces, and every
/// call stops the processor.
const BUFFER_BYTES: usize = 2048;

/// A file that is written in large pieces.
struct Buffered<'a> {
    file: Output,
    buffer: &'a mut [u8; BUFFER_BYTES],
    filled: usize,
}

impl Buffered<'_> {
    fn flush(&mut self) {
        self.file
            .write(self.buffer.get(..self.filled).unwrap_or_default());
        self.filled = 0;
    }
}

impl Sink for Buffered<'_> {
    fn write(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let free = self.buffer.get_mut(self.filled..).unwrap_or_default();
            let count = free.len().min(bytes.len());
            let (now, later) = bytes.split_at(count);
            free[..count].copy_from_slice(now);
            self.filled += count;
            bytes = later;
            if self.filled == BUFFER_BYTES {
                self.flush();
            }
        }
    }
}
