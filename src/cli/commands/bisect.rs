//! `etalon bisect`: a check with the exit codes that `git bisect run` takes.

use super::check;
use crate::cli::args::{BisectArgs, CheckArgs, Kernel};
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::metrics::Verdict;
use std::path::Path;

/// Good: `git bisect` marks the commit so.
const GOOD: u8 = 0;
/// Bad.
const BAD: u8 = 1;
/// Cannot be told: the commit is skipped.
const SKIP: u8 = 125;
/// Anything above 127 ends the bisection: the fault lies not with the commit.
const ABORT: u8 = 128;

/// Runs the check, with better references while it is open. A solution that is not there or cannot be read is the commit's
/// own trouble (it did not build, or crashed): skipped. Whatever else is wrong would be wrong at every commit: it ends the
/// bisection.
pub fn run(args: &BisectArgs, kernel: Kernel, console: &Console) -> Result<u8, Failure> {
    let check = &args.check;
    if check.compare.residual.residual {
        return Err(abort(Failure::input("a bisection is judged by a reference: leave out --residual")));
    }
    if let Err(failure) = readable(&check.compare.solution) {
        console.failure(&failure);
        return Ok(SKIP);
    }
    match check::checked(check, true, kernel, console) {
        Ok(record) => {
            check::show(&record, console)?;
            Ok(code(record.decision.as_ref().map_or(Verdict::Inconclusive, |d| d.verdict)))
        }
        Err(failure) if is_of_solution(&failure, check) => {
            console.failure(&failure);
            Ok(SKIP)
        }
        Err(failure) => Err(abort(failure)),
    }
}

fn code(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Pass => GOOD,
        Verdict::Fail => BAD,
        Verdict::Inconclusive => SKIP,
    }
}

fn readable(solution: &Path) -> Result<(), Failure> {
    match std::fs::metadata(solution) {
        Ok(_) => Ok(()),
        Err(e) => Err(crate::io::FileError::system(solution, "read", &e).into()),
    }
}

/// True if the place of a failure is the solution itself.
fn is_of_solution(failure: &Failure, check: &CheckArgs) -> bool {
    failure.code == exit::BAD_INPUT && failure.place.starts_with(&check.compare.solution.display().to_string())
}

fn abort(failure: Failure) -> Failure {
    Failure { code: ABORT, ..failure }
}
