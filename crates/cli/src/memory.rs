//! How much memory a command will need, so that one that cannot end well says so before it begins.

use std::path::Path;
use std::sync::OnceLock;

use drypoint_mesh::io::{self, Estimate};
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Bytes below which nobody asks the system.
const PLENTY: u64 = 1 << 28;

/// Bytes below which nobody asks at all.
const LITTLE: u64 = 1 << 24;

/// Bytes of a picture for each pixel: as it is drawn, and once more as it is written. One of 8192 × 8192
/// took 8.
const PIXEL: u64 = 8;

/// What is done with a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// Its edges are found.
    Edges,
    /// It is drawn by its lines.
    Lines,
    /// Its edges are grouped, or it is drawn with patches.
    Patches,
}

/// Bytes that the program holds at most for each triangle, and for each vertex beside.
///
/// Measured as the largest resident size on a bumpy sphere of 1,003,520 triangles, as PLY with 501,762
/// vertices: `info` took 138 MB, `draw` 239 MB and 256 MB with `--lines all`; as STL, with three vertices
/// to a triangle, 40 MB more. `patches` took 310 MB with `--preset fast`, 372 MB with the default and
/// 566 MB with `--edges all`; `draw --show patches` 541 MB. With 10 million triangles `info` and `draw`
/// took 1.29 and 2.27 GB.
fn bytes_of(work: Work) -> [u64; 2] {
    match work {
        Work::Edges => [125, 20],
        Work::Lines => [245, 20],
        Work::Patches => [560, 20],
    }
}

/// Bytes that a reader holds at most for each triangle and vertex, in pieces and as a whole, beside the
/// file.
const READING: [u64; 2] = [24, 24];

/// Refuses a model for which there is not enough memory, as far as that can be told beforehand.
///
/// # Errors
/// The line that says so.
pub(crate) fn check(model: &Path, triangles: Option<u64>, work: Work) -> Result<(), String> {
    let estimate = match triangles {
        // Of a shape, which mostly has two to a vertex.
        Some(triangles) => Some(Estimate { bytes: 0, vertices: triangles / 2, triangles }),
        // What cannot be read is told of by the reader.
        None => io::estimate(model).ok().flatten(),
    };
    let needed = estimate.map_or(0, |estimate| needed(&estimate, work));
    verdict(&model.display().to_string(), needed, available(needed))
}

/// Refuses a picture of so many pixels for which there is not enough memory.
///
/// # Errors
/// The line that says so.
pub(crate) fn check_picture([width, height]: [u32; 2]) -> Result<(), String> {
    let needed = PIXEL * u64::from(width) * u64::from(height);
    verdict(&format!("--size {width}x{height}"), needed, available(needed))
}

/// Bytes at the time when most are held.
fn needed(estimate: &Estimate, work: Work) -> u64 {
    let of = |[triangle, vertex]: [u64; 2]| {
        let triangles = estimate.triangles.saturating_mul(triangle);
        triangles.saturating_add(estimate.vertices.saturating_mul(vertex))
    };
    // The file is forgotten as soon as it is read.
    estimate.bytes.saturating_add(of(READING)).max(of(bytes_of(work)))
}

fn verdict(name: &str, needed: u64, available: Option<u64>) -> Result<(), String> {
    match available.filter(|&available| needed > available) {
        None => Ok(()),
        Some(available) => {
            let [needed, available] = [needed, available].map(gigabytes);
            Err(format!("{name}: needs about {needed} GB of memory, and {available} GB are free"))
        }
    }
}

/// As a number of two digits or more.
fn gigabytes(bytes: u64) -> String {
    let gigabytes = bytes as f64 / 1e9;
    if gigabytes < 9.95 { format!("{gigabytes:.1}") } else { format!("{gigabytes:.0}") }
}

/// Bytes that the process may still have, as far as it matters to one that needs so many; `None` where
/// nobody says.
fn available(needed: u64) -> Option<u64> {
    let of_process = (needed >= LITTLE).then(address_space).flatten();
    let of_system = (needed >= PLENTY).then(free).flatten();
    of_process.into_iter().chain(of_system).min()
}

/// Bytes that the system could give now, or a container that we run in; `None` where it does not say.
fn free() -> Option<u64> {
    let wanted = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(wanted);
    let free = system.available_memory();
    // What the group has of the system's cache it can give back, so that only the rest counts.
    let of_group = |limits: sysinfo::CGroupLimits| limits.total_memory.saturating_sub(limits.rss);
    let free = system.cgroup_limits().map_or(free, |limits| free.min(of_group(limits)));
    (free > 0).then_some(free)
}

/// Addresses that the process took before it had threads.
static AT_START: OnceLock<Option<u64>> = OnceLock::new();

/// To be called before there are threads: what these reserve later is not to be counted twice.
pub(crate) fn remember_start() {
    AT_START.get_or_init(addresses_taken);
}

/// Bytes that `ulimit -v` leaves to the process, if it sets a limit: beside what it began with, or has taken by now,
/// and what each thread reserves for a heap and a stack of its own. Two more than work, for progress and for Ctrl-C.
#[cfg(target_os = "linux")]
fn address_space() -> Option<u64> {
    const THREAD: u64 = (64 + 8) << 20;
    let threads = rayon::current_num_threads() as u64 + 2;
    let limit = rustix::process::getrlimit(rustix::process::Resource::As).current?;
    let at_start = AT_START.get_or_init(addresses_taken).as_ref()?;
    Some(limit.saturating_sub((at_start + THREAD * threads).max(addresses_taken()?)))
}

#[cfg(target_os = "linux")]
fn addresses_taken() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = pages.split(' ').next()?.parse().ok()?;
    Some(pages * rustix::param::page_size() as u64)
}

/// Elsewhere a limit is set by other means, or binds nobody.
#[cfg(not(target_os = "linux"))]
fn address_space() -> Option<u64> {
    None
}

#[cfg(not(target_os = "linux"))]
fn addresses_taken() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_with_both_numbers() {
        let gb = 1_000_000_000;
        assert_eq!(verdict("a.ply", 3 * gb, Some(3 * gb)), Ok(()));
        assert_eq!(verdict("a.ply", 3 * gb, None), Ok(()));
        assert_eq!(
            verdict("a.ply", 41 * gb + 300_000_000, Some(23 * gb)),
            Err("a.ply: needs about 41 GB of memory, and 23 GB are free".to_owned())
        );
        assert_eq!(
            verdict("a.ply", gb, Some(gb / 20)),
            Err("a.ply: needs about 1.0 GB of memory, and 0.1 GB are free".to_owned())
        );
    }

    #[test]
    fn more_work_needs_more_memory() {
        let of = |bytes, vertices, triangles, work| {
            needed(&Estimate { bytes, vertices, triangles }, work)
        };
        let measured = [(Work::Edges, 138), (Work::Lines, 256), (Work::Patches, 566)];
        for (work, megabytes) in measured {
            let found = of(19_067_084, 501_762, 1_003_520, work) / 1_000_000;
            assert!((megabytes - 10..=megabytes + 10).contains(&found), "{work:?}: {found}");
        }
        // Comments alone.
        assert_eq!(of(5_000_000_000, 0, 0, Work::Edges), 5_000_000_000);
        assert_eq!(of(0, u64::MAX, u64::MAX, Work::Patches), u64::MAX);
    }

    #[test]
    fn the_system_says_what_is_free() {
        assert!(free().is_none_or(|free| free > 1 << 20));
        assert_eq!(available(LITTLE - 1), None);
    }
}
