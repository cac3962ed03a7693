//! Starts other programs and turns what goes wrong into sentences.

use std::env;
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::process::{Command, Stdio};

use crate::workspace;

/// A sentence that says what failed and, where it is known, what to do.
pub type Failure = String;

/// A program to be started at the root of the workspace.
pub struct Program(Command);

impl Program {
    /// The program `name` from the search path.
    pub fn new(name: impl AsRef<OsStr>) -> Self {
        let mut command = Command::new(name);
        command.current_dir(workspace::root());
        Program(command)
    }

    /// The cargo that runs this program.
    pub fn cargo() -> Self {
        Program::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
    }

    /// Adds arguments.
    pub fn args<Argument: AsRef<OsStr>>(
        mut self,
        arguments: impl IntoIterator<Item = Argument>,
    ) -> Self {
        self.0.args(arguments);
        self
    }

    /// Sets a variable of its environment.
    pub fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.0.env(name, value);
        self
    }

    /// The command line, for people.
    pub fn line(&self) -> String {
        let name = std::path::Path::new(self.0.get_program());
        let mut line = name
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        for argument in self.0.get_args() {
            line.push(' ');
            line.push_str(&argument.to_string_lossy());
        }
        line
    }

    /// Says what it does, runs it and demands success.
    pub fn run(mut self) -> Result<(), Failure> {
        let line = self.line();
        println!("> {line}");
        match self.0.status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(format!("`{line}` failed ({status})")),
            Err(error) => Err(format!("`{line}` does not start: {error}")),
        }
    }

    /// Runs it silently and returns what it prints; `None` if it is not installed or fails.
    pub fn output(mut self) -> Option<String> {
        let output = self
            .0
            .stdin(Stdio::null())
            .stderr(Stdio::null())
            .output()
            .ok()?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        output.status.success().then_some(text)
    }

    /// Whether the program can be started at all; the arguments should do no harm.
    pub fn exists(mut self) -> bool {
        let silent = self
            .0
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        match silent.status() {
            Ok(_) => true,
            Err(error) => error.kind() != ErrorKind::NotFound,
        }
    }
}
