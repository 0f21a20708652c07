//! What ran, and where.

use clap::ValueEnum;
use drypoint_cpu::Instructions;
use drypoint_tests::report::{Machine, Run};
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};
use xxhash_rust::xxh3::xxh3_64;

use crate::Options;

pub(crate) fn machine() -> Machine {
    let wanted = RefreshKind::nothing()
        .with_cpu(CpuRefreshKind::nothing())
        .with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(wanted);
    let processor =
        system.cpus().first().map_or(String::new(), |cpu| cpu.brand().trim().to_owned());
    Machine {
        processor,
        threads: rayon::current_num_threads(),
        instructions: Instructions::newest().to_string(),
        memory: system.total_memory() as f64 / 1e9,
        system: System::long_os_version().unwrap_or_default(),
    }
}

pub(crate) fn run(options: &Options) -> Run {
    let mut command = "cargo xtask bench".to_owned();
    for (is_on, option) in [(options.quick, " --quick"), (options.fresh, " --fresh")] {
        command += if is_on { option } else { "" };
    }
    for section in options.only.iter().filter_map(ValueEnum::to_possible_value) {
        command += &format!(" --only {}", section.get_name());
    }
    // The names only: where files lie is nobody's business.
    for name in options.files.iter().filter_map(|path| path.file_name()) {
        command += &format!(" {}", name.to_string_lossy());
    }
    Run {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: commit().to_owned(),
        command,
        rounds: options.rounds(),
        is_quick: options.quick,
    }
}

/// What must be the same for measurements to belong together: all of this program's bytes, and where it
/// runs.
pub(crate) fn program() -> Result<String, String> {
    let bytes = std::env::current_exe().and_then(std::fs::read);
    let bytes = bytes.map_err(|error| format!("cannot read this program: {error}"))?;
    let Machine { processor, threads, instructions, .. } = machine();
    Ok(format!("{:016x} {processor} {threads} {instructions}", xxh3_64(&bytes)))
}

/// Of the repository that it was built in, if `cargo xtask bench` built it.
fn commit() -> &'static str {
    option_env!("DRYPOINT_COMMIT").unwrap_or("unknown")
}
