//! Hands cases to the image `conformance` and reads its results.
//!
//! The format of both files is `octruss_firmware::cases`. [`on_host`] runs the same cases with the
//! same function and memory of the same size on this machine: its results must be equal in every
//! word.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use octruss_firmware::cases::{
    self, CASE_WORDS_AT_MOST, CASES_MAGIC, Memory, RESULTS_MAGIC, Results, SECTION_END, Sink,
    Status, VERSION,
};

use super::{Error, Machine, Outcome, Run};

/// One case: see `octruss_firmware::cases`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// Its kind.
    pub kind: u32,
    /// A number that its results repeat.
    pub number: u32,
    /// What the kind says.
    pub words: Vec<u32>,
}

/// The results of one case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseResults {
    /// The case's number.
    pub number: u32,
    /// All sections but the last.
    pub sections: Vec<Section>,
    /// The last section: the status and its details.
    pub status: [u32; 4],
}

/// A part of a case's results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// What it holds.
    pub tag: u32,
    /// The words.
    pub words: Vec<u32>,
}

impl CaseResults {
    /// Whether the case was computed to its end.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.status == Status::Done.words()
    }

    /// The first place where these results are not `other`'s, for people; `None` if they are equal.
    #[must_use]
    pub fn first_difference(&self, other: &CaseResults) -> Option<String> {
        if self.number != other.number {
            return Some(format!("it is case {}, not {}", self.number, other.number));
        }
        for (place, (own, others)) in self.sections.iter().zip(&other.sections).enumerate() {
            if own.tag != others.tag || own.words.len() != others.words.len() {
                return Some(format!(
                    "section {place} has tag {} and {} words, not tag {} and {} words",
                    own.tag,
                    own.words.len(),
                    others.tag,
                    others.words.len()
                ));
            }
            let mut pairs = own.words.iter().zip(&others.words).enumerate();
            if let Some((word, (got, want))) = pairs.find(|(_, (got, want))| got != want) {
                return Some(format!(
                    "section {place} (tag {}), word {word}: got {got:#010x}, want {want:#010x}",
                    own.tag
                ));
            }
        }
        if self.status != other.status {
            return Some(format!("status {:?}, not {:?}", self.status, other.status));
        }
        let (own, others) = (self.sections.len(), other.sections.len());
        (own != others).then(|| format!("{own} sections, not {others}"))
    }
}

/// A file of results that is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultsError {
    /// It does not start as a file of results of this version does.
    Header,
    /// It ends within the results of a case, or has another number of cases than it says.
    CutShort,
    /// There is more behind the last case.
    Trailing,
}

impl fmt::Display for ResultsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ResultsError::Header => "results.bin is no file of results of this version",
            ResultsError::CutShort => "results.bin is cut short",
            ResultsError::Trailing => "results.bin goes on behind its last case",
        })
    }
}

impl std::error::Error for ResultsError {}

/// The bytes of a case file.
#[must_use]
pub fn encode(cases: &[Case]) -> Vec<u8> {
    let count = u32::try_from(cases.len()).unwrap_or(u32::MAX);
    let mut words = vec![CASES_MAGIC, VERSION, count];
    for case in cases {
        let length = u32::try_from(case.words.len()).unwrap_or(u32::MAX);
        words.extend([case.kind, case.number, length]);
        words.extend(&case.words);
    }
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Reads a file of results.
///
/// # Errors
///
/// [`ResultsError`] if it is none.
pub fn decode(bytes: &[u8]) -> Result<Vec<CaseResults>, ResultsError> {
    let (words, rest) = bytes.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(ResultsError::CutShort);
    }
    let mut words = words.iter().map(|word| u32::from_le_bytes(*word));
    let mut next = || words.next().ok_or(ResultsError::CutShort);
    if [next()?, next()?] != [RESULTS_MAGIC, VERSION] {
        return Err(ResultsError::Header);
    }
    let count = next()?;
    let mut results = Vec::new();
    for _ in 0..count {
        let mut case = CaseResults {
            number: next()?,
            sections: Vec::new(),
            status: [0; 4],
        };
        loop {
            let tag = next()?;
            let length = next()?;
            let words: Vec<u32> = (0..length).map(|_| next()).collect::<Result<_, _>>()?;
            if tag == SECTION_END {
                case.status = words.try_into().map_err(|_| ResultsError::Header)?;
                break;
            }
            case.sections.push(Section { tag, words });
        }
        results.push(case);
    }
    match next() {
        Err(_) => Ok(results),
        Ok(_) => Err(ResultsError::Trailing),
    }
}

/// Runs cases on an emulated processor. `directory` is made if needed and holds both files.
///
/// # Errors
///
/// Those of the runner, and files that cannot be written or read.
pub fn on_device(
    machine: Machine,
    image: &Path,
    directory: &Path,
    cases: &[Case],
    time_limit: Duration,
) -> Result<(Vec<CaseResults>, Outcome), Error> {
    let file_error = |action, path: PathBuf| {
        move |source| Error::File {
            action,
            path,
            source,
        }
    };
    fs::create_dir_all(directory).map_err(file_error("make", directory.to_path_buf()))?;
    let input = directory.join("cases.bin");
    fs::write(&input, encode(cases)).map_err(file_error("write", input))?;
    let outcome = Run::new(machine, image)
        .directory(directory)
        .time_limit(time_limit)
        .run()?;
    let output = directory.join("results.bin");
    let bytes = fs::read(&output).map_err(file_error("read", output.clone()))?;
    let results = decode(&bytes).map_err(|error| Error::File {
        action: "use",
        path: output,
        source: std::io::Error::new(std::io::ErrorKind::InvalidData, error),
    })?;
    Ok((results, outcome))
}

/// Runs cases on this machine with the device's function and memory of the device's size.
#[must_use]
pub fn on_host(cases: &[Case]) -> Vec<CaseResults> {
    let mut bytes = Bytes(Vec::new());
    let mut memory = Box::new(Memory::new());
    let count = u32::try_from(cases.len()).unwrap_or(u32::MAX);
    let mut results = Results::begin(&mut bytes, count);
    for case in cases {
        results.case(case.number);
        if case.words.len() > CASE_WORDS_AT_MOST {
            let words = u32::try_from(case.words.len()).unwrap_or(u32::MAX);
            results.end(Status::TooLong { words });
            continue;
        }
        // On a multiple of eight bytes, as the device's memory is.
        let pairs = case.words.chunks(2);
        let aligned: Vec<u64> = pairs
            .map(|pair| {
                let high = pair.get(1).copied().unwrap_or_default();
                u64::from(pair[0]) | u64::from(high) << 32
            })
            .collect();
        let words = zerocopy::IntoBytes::as_bytes(aligned.as_slice());
        let words = <[u32] as zerocopy::FromBytes>::ref_from_bytes(words).unwrap_or_default();
        cases::run(
            case.kind,
            &words[..case.words.len()],
            &mut memory,
            &mut results,
        );
    }
    decode(&bytes.0).unwrap_or_default()
}

/// Collects results.
struct Bytes(Vec<u8>);

impl Sink for Bytes {
    fn write(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }
}
