//! Looks into the generated code of core's kernels: is there a multiply-accumulate, does the loop keep off
//! the stack, is nothing called?
//!
//! The loop of a kernel is the shortest one that multiplies and accumulates; where a kernel jumps into an
//! unrolled line instead, it is that line. Exact counts are kept for each version of the compiler in
//! `xtask/snapshots/kernels.txt`; a version that is not there yet is no fault.

use std::collections::BTreeSet;
use std::path::Path;

use crate::command::{Failure, Program};
use crate::workspace;

/// The exact counts.
const SNAPSHOT: &str = "xtask/snapshots/kernels.txt";

/// Kernels that must be found in the image of a target.
const EXPECTED: [(&str, &[&str]); 2] = [
    (
        workspace::IMAGE_TARGET,
        &[
            "cortex_m::wide_q14_rows",
            "cortex_m::wide_q30_rows",
            "cortex_m::narrow_scaled_rows",
            "cortex_m::narrow_shifted_rows",
            "portable::sums",
        ],
    ),
    (
        workspace::IMAGE_TARGET_WITHOUT_DSP,
        &["portable::wide", "portable::sums"],
    ),
];

/// The code of one kernel.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Kernel {
    /// Its name, without the crate's and the compiler's mark.
    pub name: String,
    /// Instructions of the whole function.
    pub instructions: usize,
    /// Those of its loop.
    pub in_loop: usize,
    /// Multiply-accumulates of the loop.
    pub accumulates: usize,
    /// Instructions of the loop that touch the stack.
    pub stack: Vec<String>,
    /// Calls anywhere in the function.
    pub calls: Vec<String>,
}

impl Kernel {
    /// What is wrong with it.
    fn fault(&self) -> Option<String> {
        let name = &self.name;
        if self.accumulates == 0 {
            return Some(format!("{name} has no multiply-accumulate in a loop"));
        }
        if !self.stack.is_empty() {
            return Some(format!(
                "the loop of {name} touches the stack: {}",
                self.stack.join("; ")
            ));
        }
        let calls = || self.calls.join("; ");
        (!self.calls.is_empty()).then(|| format!("{name} calls: {}", calls()))
    }

    /// Its line of the snapshot behind compiler and target.
    fn line(&self) -> String {
        format!(
            "{} {} {} {}",
            self.name, self.instructions, self.in_loop, self.accumulates
        )
    }
}

/// Checks the kernels of the image `apply` of each target.
pub fn run() -> Result<(), Failure> {
    let compiler = compiler_version()?;
    let known = std::fs::read_to_string(workspace::root().join(SNAPSHOT))
        .map_err(|error| format!("cannot read {SNAPSHOT}: {error}"))?;
    for (target, expected) in EXPECTED {
        let image = workspace::target()?.join(target).join("release/apply");
        let kernels = kernels(&disassembly(&image)?);
        let faults: Vec<String> = kernels.iter().filter_map(Kernel::fault).collect();
        let missing = expected
            .iter()
            .filter(|name| !kernels.iter().any(|kernel| kernel.name == **name))
            .map(|name| format!("{name} is not in the image"));
        let faults: Vec<String> = faults.into_iter().chain(missing).collect();
        if !faults.is_empty() {
            return Err(format!(
                "the kernels for {target}:\n  {}",
                faults.join("\n  ")
            ));
        }
        println!(
            "Kernels for {target}: function, instructions, those of its loop, multiply-accumulates"
        );
        for kernel in &kernels {
            println!("  {}", kernel.line());
        }
        compare(&known, &format!("{compiler} {target} "), &kernels)?;
    }
    Ok(())
}

/// Holds the counts against those of the snapshot, if it has any of this compiler and target.
fn compare(known: &str, start: &str, kernels: &[Kernel]) -> Result<(), Failure> {
    let want: BTreeSet<String> = known
        .lines()
        .filter(|line| line.starts_with(start))
        .map(str::to_owned)
        .collect();
    let got: BTreeSet<String> = kernels
        .iter()
        .map(|kernel| format!("{start}{}", kernel.line()))
        .collect();
    let list = |lines: &BTreeSet<String>| {
        lines
            .iter()
            .map(|line| format!("\n  {line}"))
            .collect::<String>()
    };
    if want.is_empty() {
        println!(
            "No counts of this compiler yet; add to {SNAPSHOT}:{}",
            list(&got)
        );
        return Ok(());
    }
    if want == got {
        return Ok(());
    }
    Err(format!(
        "the kernels' counts are not those of {SNAPSHOT}; if the change is meant, write there:{}",
        list(&got)
    ))
}

/// "1.95.0".
fn compiler_version() -> Result<String, Failure> {
    let words = Program::new("rustc").args(["--version"]).output();
    let words = words.ok_or("rustc does not run: install Rust from https://rustup.rs")?;
    let version = words.split_whitespace().nth(1);
    version
        .map(str::to_owned)
        .ok_or_else(|| format!("rustc does not say its version: {words}"))
}

fn disassembly(image: &Path) -> Result<String, Failure> {
    let program = Program::new(workspace::llvm_tool("llvm-objdump")?)
        .args(["--disassemble", "--no-show-raw-insn", "--demangle"])
        .args([image]);
    let line = program.line();
    program.output().ok_or_else(|| format!("`{line}` failed"))
}

/// The kernels in a disassembly.
fn kernels(code: &str) -> Vec<Kernel> {
    let mut kernels: Vec<Kernel> = code
        .split("\n\n")
        .filter_map(|function| {
            let mut lines = function.trim_start().lines();
            let name = kernel_name(lines.next()?)?;
            let code: Vec<Instruction> = lines.filter_map(Instruction::read).collect();
            Some(judge(name, &code))
        })
        .collect();
    kernels.sort();
    kernels
}

/// The name in the first line of a function of a kernel: address, then
/// `<octruss::deform::kernel::NAME::MARK>:`.
fn kernel_name(line: &str) -> Option<String> {
    let (_, name) = line.split_once("<octruss::deform::kernel::")?;
    let (name, _) = name.strip_suffix(">:")?.rsplit_once("::")?;
    Some(name.to_owned())
}

/// One instruction.
#[derive(Clone, Debug)]
struct Instruction {
    address: u64,
    mnemonic: String,
    operands: String,
}

impl Instruction {
    /// Reads a line of a disassembly: address, colon, mnemonic, operands.
    fn read(line: &str) -> Option<Self> {
        let (address, rest) = line.split_once(':')?;
        let address = u64::from_str_radix(address.trim(), 16).ok()?;
        let rest = rest.trim();
        let (mnemonic, operands) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        (!mnemonic.starts_with(['.', '<'])).then(|| Self {
            address,
            mnemonic: mnemonic.trim_end_matches(".w").to_owned(),
            operands: operands.trim().to_owned(),
        })
    }

    /// `smlal`, `smlad`, `smlabb`, `mla` and their kin.
    fn accumulates(&self) -> bool {
        self.mnemonic.starts_with("smla") || self.mnemonic == "mla" || self.mnemonic == "umlal"
    }

    fn calls(&self) -> bool {
        self.mnemonic == "bl" || self.mnemonic == "blx"
    }

    /// Jumps to an address that a register or the memory holds.
    fn jumps_anywhere(&self) -> bool {
        let loads = self.mnemonic.starts_with("ldr") && self.operands.starts_with("pc");
        loads || self.mnemonic == "bx"
    }

    /// The address that a branch within the function goes to.
    fn branch(&self) -> Option<u64> {
        let is_branch = self.mnemonic.starts_with('b')
            && !self.calls()
            && !["bx", "bic", "bics", "bfi", "bfc", "bkpt"].contains(&self.mnemonic.as_str());
        let address = self.operands.split_whitespace().find_map(|word| {
            let digits = word.strip_prefix("0x")?;
            u64::from_str_radix(digits, 16).ok()
        });
        address.filter(|_| is_branch || self.mnemonic.starts_with("cb"))
    }

    fn touches_stack(&self, has_frame: bool) -> bool {
        let names = |register: &str| {
            let mut words = self.operands.split(|c: char| !c.is_ascii_alphanumeric());
            words.any(|word| word == register)
        };
        let on_frame = has_frame && self.operands.contains("[r7");
        names("sp") || on_frame || self.mnemonic == "push" || self.mnemonic == "pop"
    }

    fn text(&self) -> String {
        format!("{:x} {} {}", self.address, self.mnemonic, self.operands)
    }
}

fn judge(name: String, code: &[Instruction]) -> Kernel {
    // With a frame pointer, which is r7, the stack is reached through that too.
    let has_frame = code
        .iter()
        .any(|one| one.mnemonic.starts_with("add") && one.operands.starts_with("r7, sp"));
    let hot = hot_loop(code);
    let all = |is: &dyn Fn(&Instruction) -> bool, part: &[Instruction]| -> Vec<String> {
        let found = part.iter().filter(|one| is(one));
        found.map(Instruction::text).collect()
    };
    Kernel {
        name,
        instructions: code.len(),
        in_loop: hot.len(),
        accumulates: hot.iter().filter(|one| one.accumulates()).count(),
        stack: all(&|one| one.touches_stack(has_frame), hot),
        calls: all(&Instruction::calls, code),
    }
}

/// The shortest loop that multiplies and accumulates and does not jump anywhere; without one, the line
/// between a jump to anywhere and the last multiply-accumulate behind it.
fn hot_loop(code: &[Instruction]) -> &[Instruction] {
    let loops = code.iter().enumerate().filter_map(|(last, one)| {
        let target = one.branch()?;
        let first = code[..=last].iter().position(|one| one.address == target)?;
        let body = &code[first..=last];
        let is_kernel = body.iter().any(Instruction::accumulates)
            && !body.iter().any(Instruction::jumps_anywhere);
        is_kernel.then_some(body)
    });
    if let Some(shortest) = loops.min_by_key(|body| body.len()) {
        return shortest;
    }
    let Some(last) = code.iter().rposition(Instruction::accumulates) else {
        return &[];
    };
    let jump = code[..last].iter().rposition(Instruction::jumps_anywhere);
    jump.map_or(&[], |jump| &code[jump + 1..=last])
}

#[cfg(test)]
mod tests {
    use super::{Kernel, compare, kernels};

    /// A loop as the compiler makes it, with a frame pointer.
    const SOUND: &str = "\n00000400 <octruss::deform::kernel::portable::wide::h0123456789abcdef>:\n     400:      \tpush\t{r4, r7, lr}\n     402:      \tadd\tr7, sp, #0x4\n     404:      \tldr\tr0, [sp, #0x8]\n     406:      \tldrsh\tr3, [r2, #2]!\n     40a:      \tldr\tr4, [r1, #12]!\n     40e:      \tsmlal\tr5, r6, r4, r3\n     412:      \tsubs\tr0, #0x1\n     414:      \tbne\t0x406 <octruss::deform::kernel::portable::wide::h0123456789abcdef+0x6> @ imm = #-0x12\n     416:      \tpop\t{r4, r7, pc}\n";

    /// An unrolled line that is entered anywhere, with a loop over rows around it.
    const LINE: &str = "\n00000500 <octruss::deform::kernel::cortex_m::narrow_scaled_rows::habc>:\n     500:      \tpush.w\t{r4, lr}\n     504:      \tldr.w\tr11, [sp]\n     508:      \tldr.w\tpc, [sp, #0x4]\n     50c:      \tldm.w\tr11!, {r0, r1, r2}\n     510:      \tsmlad\tr4, r0, r3, r4\n     514:      \tsmlad\tr5, r1, r3, r5\n     518:      \tldrd\tr3, r12, [sp, #12]\n     51c:      \tbne.w\t0x504 <octruss::deform::kernel::cortex_m::narrow_scaled_rows::habc+0x4> @ imm = #-0x1c\n     520:      \tpop.w\t{r4, pc}\n";

    fn only(code: &str) -> Kernel {
        let [kernel] = kernels(code).try_into().expect("one kernel");
        kernel
    }

    #[test]
    fn a_sound_loop_passes() {
        let kernel = only(SOUND);
        assert_eq!(kernel.fault(), None);
        assert_eq!(kernel.line(), "portable::wide 9 5 1");
        let kernel = only(LINE);
        assert_eq!(kernel.fault(), None);
        assert_eq!(kernel.line(), "cortex_m::narrow_scaled_rows 9 3 2");
    }

    #[test]
    fn a_spill_is_found() {
        let spilled = SOUND.replace("subs\tr0, #0x1", "str\tr3, [sp, #0x8]");
        let fault = only(&spilled).fault().expect("a fault");
        assert_eq!(
            fault,
            "the loop of portable::wide touches the stack: 412 str r3, [sp, #0x8]"
        );
        let by_frame = SOUND.replace("subs\tr0, #0x1", "ldr\tr0, [r7, #0x10]");
        assert!(only(&by_frame).fault().is_some());
        let in_line = LINE.replace(
            "smlad\tr5, r1, r3, r5",
            "ldr.w\tr5, [sp, #0x8]\n     516:      \tsmlad\tr5, r1, r3, r5",
        );
        assert!(only(&in_line).fault().is_some());
    }

    #[test]
    fn a_lost_multiply_accumulate_is_found() {
        let lost = SOUND.replace("smlal\tr5, r6, r4, r3", "mul\tr5, r4, r3");
        assert_eq!(
            only(&lost).fault().expect("a fault"),
            "portable::wide has no multiply-accumulate in a loop"
        );
        let lost = LINE.replace("smlad", "smuad");
        assert!(only(&lost).fault().is_some());
    }

    #[test]
    fn a_call_is_found() {
        let panics = SOUND.replace("push\t{r4, r7, lr}", "bl\t0x900 <core::panicking::panic>");
        assert_eq!(
            only(&panics).fault().expect("a fault"),
            "portable::wide calls: 400 bl 0x900 <core::panicking::panic>"
        );
    }

    #[test]
    fn counts_are_held_to_the_snapshot() {
        let kernels = [only(SOUND)];
        let start = "1.95.0 target ";
        let line = "1.95.0 target portable::wide 9 5 1\n";
        assert_eq!(compare(line, start, &kernels), Ok(()));
        assert_eq!(
            compare("1.94.0 target portable::wide 1 1 1\n", start, &kernels),
            Ok(())
        );
        assert!(compare("1.95.0 target portable::wide 9 4 1\n", start, &kernels).is_err());
        assert!(compare(line, start, &[]).is_err());
    }
}
