//! Disks that are full, folders that cannot be written, programs that are killed, and patches of another
//! mesh: what was there is kept, or replaced whole.

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::bench::{Bench, CORNER};

/// The program with these arguments, not yet started.
fn program(bench: &Bench, args: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_drypoint"));
    command.args(args.split_whitespace()).current_dir(bench.path());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// It failed with status 1 and one line that holds every one of `words`.
#[track_caller]
fn check_failed(output: &Output, words: &[&str]) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
    for word in words {
        assert!(errors.contains(word), "no {word:?} in: {errors}");
    }
}

/// Writes a drawing, a picture and patches.
const WRITERS: [&str; 3] = [
    "draw shape:torus-knot:2000 -o out.svg",
    "draw shape:torus-knot:2000 --size 600x600 -o out.png",
    "patches shape:torus-knot:2000 --preset fast -o out.patches",
];

/// Runs `line` in a shell in which no file may grow beyond some kilobytes. Full disks behave alike, and need
/// a system of their own.
#[cfg(unix)]
fn with_a_full_disk(bench: &Bench, line: &str) -> Output {
    let script = format!("trap '' XFSZ; ulimit -f 4; {line}");
    let program = env!("CARGO_BIN_EXE_drypoint");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script]).env("drypoint", program).current_dir(bench.path());
    shell.output().unwrap()
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_what_was_there() {
    for args in WRITERS {
        let bench = Bench::new();
        let name = args.rsplit(' ').next().unwrap();
        for before in [None, Some("precious")] {
            if let Some(content) = before {
                bench.write(name, content);
            }
            let files = bench.files();
            let output = with_a_full_disk(&bench, &format!("exec \"$drypoint\" {args}"));
            check_failed(&output, &[name, "too large"]);
            assert_eq!(bench.files(), files, "{args}");
        }
        // The limit is what it failed for.
        bench.succeed(args);
        assert!(std::fs::metadata(bench.path().join(name)).unwrap().len() > 4096, "{args}");
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_behind_standard_output_is_told() {
    let bench = Bench::new();
    for (args, name) in [
        ("draw shape:torus-knot:2000 -o -", "out.svg"),
        ("patches shape:torus-knot:2000 --preset fast -o -", "out.patches"),
        ("extract shape:torus-knot:2000 --eye 1,2,3 --json", "out.json"),
    ] {
        let output = with_a_full_disk(&bench, &format!("exec \"$drypoint\" {args} > {name}"));
        check_failed(&output, &["standard output", "too large"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_that_takes_nothing_is_told() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.fail("patches corner.obj -o /dev/full", &["/dev/full", "cannot write"]);
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = program(&bench, "draw corner.obj -o -").stdout(full).output().unwrap();
    check_failed(&output, &["standard output"]);
}

/// Nobody can be told, and the exit status says it all the same.
#[cfg(target_os = "linux")]
#[test]
fn standard_error_that_takes_nothing_changes_nothing() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let code = |command: &str| {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        program(&bench, command).stderr(full).output().unwrap().status.code()
    };
    assert_eq!(code("extract corner.obj --eye 1,2,3"), Some(0));
    assert_eq!(code("draw corner.obj --size 5000x5000 -o a.svg"), Some(0));
    assert_eq!(code("draw missing.obj"), Some(1));
}

#[cfg(unix)]
#[test]
fn what_may_not_be_written_is_told_before_the_work() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let locked = bench.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o555)).unwrap();
    // Permissions stop nobody who is root; the folder of devices that the kernel knows does.
    let is_root = std::fs::write(locked.join("probe"), "").is_ok();
    let folder = if is_root { "/sys" } else { "locked" };
    if Path::new(folder).is_dir() {
        for name in ["out.svg", "out.png"] {
            // It would take hours.
            let long = format!("draw shape:bumpy-sphere:9000000 -o {folder}/{name}");
            let output = program(&bench, &long).output().unwrap();
            check_failed(&output, &[folder, name, "cannot write"]);
        }
        let long = "draw shape:bumpy-sphere:9000000 --turntable 60 --frames";
        let output = program(&bench, &format!("{long} {folder}/turn")).output().unwrap();
        check_failed(&output, &[folder, "turn", "cannot write"]);
    }
    bench.write("out.svg", "precious");
    let file = bench.path().join("out.svg");
    std::fs::set_permissions(&file, PermissionsExt::from_mode(0o444)).unwrap();
    let output = program(&bench, "draw shape:cube -o out.svg").output().unwrap();
    check_failed(&output, &["out.svg", "read-only"]);
    assert_eq!(std::fs::read(&file).unwrap(), b"precious");
}

/// Names of files that are being written beside the output.
fn unfinished(bench: &Bench) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(bench.path()).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.extension().is_some_and(|extension| extension == "part")).collect()
}

/// Waits until something was written to a file beside the output, or the program is done.
fn wait_for_writing(bench: &Bench, child: &mut Child) {
    let is_begun = || {
        let sizes = unfinished(bench).into_iter().map(std::fs::metadata);
        sizes.flatten().any(|file| file.len() > 0)
    };
    while !is_begun() && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
}

#[test]
fn a_program_that_is_killed_leaves_the_old_file_or_the_new_one() {
    let bench = Bench::new();
    let args = "patches shape:icosphere:20000 --preset fast -o out.patches";
    let start = Instant::now();
    bench.succeed(args);
    let whole = start.elapsed();
    let path = bench.path().join("out.patches");
    let new = std::fs::read(&path).unwrap();
    assert!(new.len() > 500_000, "{} bytes are written in no time", new.len());
    let old = b"precious".to_vec();
    let (mut kept, mut while_writing) = (0, 0);
    for turn in 0..16u32 {
        std::fs::write(&path, &old).unwrap();
        let mut child = program(&bench, args).spawn().unwrap();
        if turn < 8 {
            std::thread::sleep(whole * turn / 8);
        } else {
            wait_for_writing(&bench, &mut child);
            std::thread::sleep(Duration::from_micros(100) * (turn - 8));
        }
        // SIGKILL, or what is like it: nothing can be cleaned up.
        child.kill().unwrap();
        child.wait().unwrap();
        let found = std::fs::read(&path).unwrap();
        assert!(found == old || found == new, "{} bytes of neither", found.len());
        kept += usize::from(found == old);
        while_writing += unfinished(&bench).len();
        // The next one does not stumble over what is left.
        if turn % 4 == 3 {
            bench.succeed(args);
            assert!(std::fs::read(&path).unwrap() == new);
        }
        unfinished(&bench).iter().for_each(|path| std::fs::remove_file(path).unwrap());
    }
    assert!(kept > 4, "it was never killed in time");
    assert!(while_writing > 0, "it was never killed while it wrote");
}

#[test]
fn of_two_programs_that_write_one_file_one_wins_whole() {
    let bench = Bench::new();
    let args = ["torus-knot:3000", "icosphere:2000"]
        .map(|shape| format!("patches shape:{shape} --preset fast -o out.patches"));
    let path = bench.path().join("out.patches");
    let whole = args.each_ref().map(|args| {
        bench.succeed(args);
        std::fs::read(&path).unwrap()
    });
    for turn in 0..8 {
        let children = args.each_ref().map(|args| program(&bench, args).spawn().unwrap());
        for child in children {
            assert!(child.wait_with_output().unwrap().status.success());
        }
        assert!(whole.contains(&std::fs::read(&path).unwrap()), "in turn {turn}");
        assert_eq!(bench.files().len(), 1, "something was left behind");
    }
}

#[test]
fn a_folder_that_vanishes_is_told() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path().join("folder")).unwrap();
    let args = "patches shape:bumpy-sphere:400000 --preset fast -o folder/out.patches";
    let child = program(&bench, args).spawn().unwrap();
    // Gone before it is looked for or while patches are built: it is told either way.
    std::thread::sleep(Duration::from_millis(20));
    std::fs::remove_dir_all(bench.path().join("folder")).unwrap();
    let output = child.wait_with_output().unwrap();
    check_failed(&output, &["out.patches", "the folder does not exist"]);
    assert_eq!(bench.files(), []);
}

#[test]
fn patches_of_another_mesh_are_refused() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.succeed("patches corner.obj -o a.patches");
    bench.succeed("draw a.patches --model corner.obj -o out.svg");
    // As many of each, but a vertex elsewhere, or triangles in another order or the other way round.
    for (name, from, to) in [
        ("moved.obj", "v 0 0 1\n", "v 0 0 1.0000001\n"),
        ("sorted.obj", "f 1 3 2\nf 1 2 4\n", "f 1 2 4\nf 1 3 2\n"),
        ("turned.obj", "f 2 3 4\n", "f 2 4 3\n"),
    ] {
        let other = CORNER.replace(from, to);
        assert_ne!(other, CORNER);
        bench.write(name, other);
        let words = ["a.patches", "not built from", name];
        bench.fail(&format!("draw a.patches --model {name} -o out.svg"), &words);
    }
    bench.fail("draw a.patches --model shape:cube -o out.svg", &["a.patches", "not built from"]);
}

#[test]
fn patches_that_are_cut_or_changed_are_refused() {
    let bench = Bench::new();
    bench.succeed("patches shape:icosphere:80 --preset fast -o a.patches");
    let whole = std::fs::read(bench.path().join("a.patches")).unwrap();
    for length in [0, 1, 7, 8, 31, 200, 256, whole.len() / 2, whole.len() - 1] {
        bench.write("cut.patches", &whole[..length]);
        bench.fail("extract cut.patches --eye 1,2,3", &["cut.patches"]);
    }
    for at in [8, 20, 30, 180, 300, whole.len() - 1] {
        let mut changed = whole.clone();
        changed[at] ^= 0x41;
        bench.write("changed.patches", &changed);
        bench.fail("extract changed.patches --eye 1,2,3", &["changed.patches"]);
    }
    bench.write("long.patches", [&whole[..], b"\n"].concat());
    bench.fail("extract long.patches --eye 1,2,3", &["long.patches"]);
}

#[test]
fn nothing_is_written_over_what_is_read() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.succeed("patches corner.obj -o a.patches");
    bench.fail("patches a.patches -o a.patches", &["a.patches", "patch file"]);
    bench.fail("patches corner.obj -o corner.obj", &["corner.obj", ".patches"]);
    bench.fail("draw corner.obj -o corner.obj", &["corner.obj"]);
    bench.fail("draw a.patches --model corner.obj -o corner.obj", &["corner.obj"]);
    bench.fail("draw a.patches --model corner.obj -o a.patches", &["a.patches"]);
}

/// Runs the program in a shell in which it may have so many kilobytes.
#[cfg(target_os = "linux")]
fn with_little_memory(bench: &Bench, kilobytes: u32, args: &str) -> Output {
    let mut shell = Command::new("sh");
    let script = format!("ulimit -v {kilobytes}; exec \"$drypoint\" {args}");
    shell.args(["-c", &script]).env("drypoint", env!("CARGO_BIN_EXE_drypoint"));
    // Without memory, a backtrace would wait for itself.
    shell.current_dir(bench.path()).env("RUST_BACKTRACE", "0").env("RAYON_NUM_THREADS", "2");
    shell.output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn what_a_shell_allows_is_all_that_there_is() {
    let bench = Bench::new();
    for (args, name, needed) in [
        ("draw shape:bumpy-sphere:9000000 -o out.svg", "bumpy-sphere", "2.3 GB"),
        ("draw shape:bumpy-sphere:1000000 -o out.svg", "bumpy-sphere", "0.3 GB"),
        ("draw shape:cube --size 16384x16384 -o out.png", "--size", "2.1 GB"),
        (
            "draw shape:cube --turntable 4 --format png --size 9000x9000 --frames turn",
            "--size",
            "0.6 GB",
        ),
    ] {
        let output = with_little_memory(&bench, 500_000, args);
        check_failed(&output, &[name, &format!("needs about {needed} of memory, and 0.")]);
        assert!(bench.files().is_empty(), "{args}");
    }
    // What fits is done, however many threads have begun by then.
    for args in ["draw shape:bumpy-sphere:200000 -o out.svg", "draw shape:cube -o out.png"] {
        let output = with_little_memory(&bench, 500_000, args);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}
