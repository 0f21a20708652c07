//! The command `drypoint`.

mod animation;
mod args;
mod draw;
mod extract;
mod folder;
mod frames;
mod fusion;
mod gpu;
mod info;
mod lines;
mod memory;
mod output;
mod palette;
mod patches;
mod progress;
mod rigged;
mod show;
mod source;
mod view;

use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use args::{Cli, Command};

fn main() -> ExitCode {
    memory::remember_start();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return explain(&error),
    };
    let result = output::stop_cleanly_on_ctrl_c().and_then(|()| match cli.command {
        Command::Draw(args) => draw::run(&args),
        Command::Patches(args) => patches::run(&args),
        Command::Extract(args) => extract::run(&args),
        Command::Info(args) => info::run(&args),
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => fail(&why),
    }
}

/// Help and version as they are; anything wrong with the arguments in one line.
fn explain(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            // A reader that has gone away is no error.
            let _ = error.print();
            ExitCode::SUCCESS
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            fail("no command given; 'drypoint --help' lists them")
        }
        _ => {
            let text = error.to_string();
            let lines = text.lines().map(str::trim);
            let wanted = lines.filter(|l| {
                !l.is_empty() && !l.starts_with("For more information") && !l.starts_with("tip:")
            });
            let line =
                wanted.take_while(|l| !l.starts_with("Usage:")).collect::<Vec<_>>().join(" ");
            fail(line.strip_prefix("error: ").unwrap_or(&line))
        }
    }
}

fn fail(why: &str) -> ExitCode {
    output::tell(&format!("drypoint: {why}"));
    ExitCode::FAILURE
}
