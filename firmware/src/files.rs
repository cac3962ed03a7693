//! Files of the host, through semihosting.
//!
//! Each call stops the processor for the host, so callers move kilobytes at a time. A name is
//! relative to the directory in which the emulator or the debugger was started.

use core::ffi::CStr;

use semihosting::fs::File;
use semihosting::io::{Read, Write};

use crate::exit::{self, Ending};

/// A file that is read from its start to its end.
pub struct Input {
    file: File,
    name: &'static CStr,
}

impl Input {
    /// Opens a file. A file that is not there ends the image: it cannot do its work.
    #[must_use]
    pub fn open(name: &'static CStr) -> Self {
        match File::open(name) {
            Ok(file) => Input { file, name },
            Err(_) => refuse("cannot open", name),
        }
    }

    /// Fills `bytes` as far as the file goes and returns how many it filled.
    #[must_use]
    pub fn read(&mut self, bytes: &mut [u8]) -> usize {
        let mut filled = 0;
        while let Some(rest) = bytes.get_mut(filled..).filter(|rest| !rest.is_empty()) {
            match self.file.read(rest) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(_) => refuse("cannot read", self.name),
            }
        }
        filled
    }
}

/// A file that is written from its start.
pub struct Output {
    file: File,
    name: &'static CStr,
}

impl Output {
    /// Makes a file, or empties the one that is there. Ends the image where that fails.
    #[must_use]
    pub fn create(name: &'static CStr) -> Self {
        match File::create(name) {
            Ok(file) => Output { file, name },
            Err(_) => refuse("cannot create", name),
        }
    }

    /// Writes all of `bytes`.
    pub fn write(&mut self, bytes: &[u8]) {
        if self.file.write_all(bytes).is_err() {
            refuse("cannot write", self.name)
        }
    }
}

/// Says which file failed and ends the image.
fn refuse(what: &str, name: &CStr) -> ! {
    defmt::error!(
        "{=str} the host's file {=str}",
        what,
        name.to_str().unwrap_or("?")
    );
    exit::stop(Ending::Refused)
}
