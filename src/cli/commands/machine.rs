//! `etalon setup embree` and `etalon doctor`

use crate::cli::args::SetupCommand;
use crate::cli::console::Console;
use crate::cli::exit::{self, Failure};
use crate::cli::{doctor, setup};
use serde_json::json;

pub fn setup(command: &SetupCommand, console: &Console) -> Result<u8, Failure> {
    match command {
        SetupCommand::Embree => {
            let report = setup::setup_embree()
                .map_err(|e| Failure::input(format!("{e}; {}", setup::SetupError::consolation())))?;
            console.result(&report.to_string(), &json!(report));
            Ok(exit::DONE)
        }
    }
}

pub fn doctor(console: &Console) -> Result<u8, Failure> {
    let report = doctor::examine();
    console.result(&report.to_string(), &json!(report));
    // Without Embree all is well; a kernel that fails its self-test is not.
    Ok(if report.self_test.passed { exit::DONE } else { exit::FAIL })
}
