//! One file per command: plan, run, print.

mod audit;
mod audit_compositing;
mod audit_envmap;
mod audit_envmap_pictures;
mod audit_tables;
mod baseline;
mod bench;
mod bisect;
mod brought;
mod check;
mod check_residual;
mod composite;
mod converge;
mod converge_diff;
mod converge_references;
mod converge_refine;
mod converge_told;
mod convert;
mod demo;
mod drawn;
mod form_factors;
mod form_factors_check;
mod form_factors_compare;
mod form_factors_compare_told;
mod form_factors_repair;
mod form_factors_told;
mod inputs;
mod limits;
mod lit;
mod looks;
mod machine;
mod manual;
mod project;
mod receivers;
mod reference;
mod render;
mod report;
mod scan;
mod scene;
mod shade;
mod solve;
mod solve_by_shots;
mod spans;
mod split;
mod standpoint;
mod told;
mod validate;

use super::args::{AuditCommand, Cli, Command, ConvergeCommand, ConvergeOther, FormFactorsCommand, MatrixCommand};
use super::console::Console;
use super::exit::Failure;

/// Runs a command; returns its exit code.
pub fn run(cli: &Cli, console: &Console) -> Result<u8, Failure> {
    let kernel = inputs::kernel_kind(cli.global.kernel);
    match &cli.command {
        Command::Scene(command) => scene::run(command, console),
        Command::FormFactors(FormFactorsCommand::Cast(args)) => form_factors::run(args, kernel, console),
        Command::FormFactors(FormFactorsCommand::Matrix(MatrixCommand::Check(args))) => {
            form_factors_check::run(args, kernel, console)
        }
        Command::FormFactors(FormFactorsCommand::Matrix(MatrixCommand::Compare(args))) => {
            form_factors_compare::run(args, kernel, console)
        }
        Command::FormFactors(FormFactorsCommand::Matrix(MatrixCommand::Repair(args))) => {
            form_factors_repair::run(args, kernel, console)
        }
        Command::Reference(args) => reference::run(args, kernel, console),
        Command::Solve(args) => solve::run(args, kernel, console),
        Command::Compare(args) => check::compare(args, cli.global.kernel, console),
        Command::Check(args) => check::check(args, cli.global.kernel, console),
        Command::Baseline(command) => baseline::run(command, console),
        Command::Bisect(args) => bisect::run(args, cli.global.kernel, console),
        Command::Convert(args) => convert::run(args, console),
        Command::Converge(ConvergeCommand::Run(args)) => converge::run(args, cli.global.kernel, console),
        Command::Converge(ConvergeCommand::Other(ConvergeOther::Diff(args))) => converge_diff::run(args, console),
        Command::Audit(AuditCommand::Hemicube(args)) => audit::run(args, kernel, console),
        Command::Audit(AuditCommand::Envmap(args)) => audit_envmap::run(args, kernel, console),
        Command::Audit(AuditCommand::Compositing(args)) => audit_compositing::run(args, kernel, console),
        Command::Project(args) => project::run(args, kernel, console),
        Command::Scan(args) => scan::run(args, kernel, console),
        Command::Composite(args) => composite::run(args, console),
        Command::Shade(args) => shade::run(args, console),
        Command::Render(args) => render::run(args, kernel, console),
        Command::Report { directory } => report::run(directory, cli.global.kernel, console),
        Command::Demo { output } => demo::run(output, cli.global.kernel, console),
        Command::Receivers(args) => receivers::run(args, kernel, console),
        Command::Validate(command) => validate::run(command, kernel, console),
        Command::Setup(command) => machine::setup(command, console),
        Command::Completions(args) => manual::completions(args, console),
        Command::Man(args) => manual::man(args, console),
        Command::Schema => {
            Console::print(include_str!("../../../references/schema/check.schema.json").trim_end());
            Ok(super::exit::DONE)
        }
        Command::Doctor => machine::doctor(console),
    }
}
