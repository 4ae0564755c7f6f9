//! The `etalon` program.

fn main() -> std::process::ExitCode {
    std::process::ExitCode::from(etalon::cli::run(std::env::args_os().collect()))
}
