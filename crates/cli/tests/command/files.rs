//! Files that are bad, and files that are left behind.

use std::process::Command;

use crate::bench::{Bench, CORNER};

#[test]
fn bad_files_say_what_is_wrong_and_where() {
    let bench = Bench::new();
    let cases: &[(&str, &[u8], &[&str])] = &[
        ("empty.obj", b"", &["empty"]),
        ("empty.ply", b"", &["empty"]),
        ("empty.stl", b"", &["empty"]),
        ("empty.glb", b"", &["empty"]),
        ("garbage.obj", b"\x93\x00\xff\xfe\x01 garbage\x00\n\x07", &[]),
        ("garbage.ply", b"\x93\x00\xff\xfe\x01 garbage\x00\n\x07", &[]),
        ("garbage.stl", b"\x93\x00\xff\xfe\x01 garbage\x00\n\x07", &["STL", "solid"]),
        ("garbage.glb", b"\x93\x00\xff\xfe\x01 garbage\x00\n\x07", &[]),
        ("range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", &["line 4", "9"]),
        ("nan.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", &["faces left out: 1", "no finite"]),
        (
            "inf.obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n",
            &["faces left out: 1", "no finite"],
        ),
        ("faceless.obj", b"v 0 0 0\nv 1 0 0\n", &["no faces"]),
        ("really.ply", CORNER.as_bytes(), &[]),
        ("mesh.xyz", CORNER.as_bytes(), &["xyz"]),
        (
            "cut.ply",
            b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
              property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
              end_header\n0 0 0\n1 0 0\n",
            &[],
        ),
    ];
    for (name, content, _) in cases {
        bench.write(name, content);
    }
    for (name, _, words) in cases {
        let mut words = words.to_vec();
        words.push(name);
        bench.fail(&format!("draw {name} -o out.svg"), &words);
        bench.fail(&format!("info {name}"), &words);
        bench.fail(&format!("extract {name} --eye 1,2,3"), &words);
        bench.fail(&format!("patches {name} -o out.patches"), &words);
    }
    bench.fail("draw missing.obj", &["missing.obj"]);
    bench.fail("draw shape:teapotahedron", &["teapotahedron", "torus-knot"]);
    bench.fail("draw shape:icosphere:many", &["many"]);
}

#[cfg(unix)]
#[test]
fn no_output_is_left_by_a_run_that_failed() {
    let bench = Bench::new();
    for command in ["draw shape:cube -o a.svg --json", "patches shape:cube -o a.patches --json"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let status = Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .args(command.split_whitespace())
            .current_dir(bench.path())
            .stdout(full)
            .stderr(std::process::Stdio::null())
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(1), "{command}");
        assert!(bench.files().is_empty(), "{command}");
    }
}

#[test]
fn a_file_that_was_there_is_replaced_whole_or_kept() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.write("out.svg", "precious");
    bench.fail("draw missing.obj -o out.svg", &["missing.obj"]);
    bench.succeed("draw corner.obj -o out.svg");
    assert!(bench.files()[1].1.starts_with(b"<"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing_behind() {
    let bench = Bench::new();
    let child = Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .args(["patches", "shape:bumpy-sphere:500000", "-o", "long.patches", "--preset", "paper"])
        .current_dir(bench.path())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // Long enough to have started, far too short to have finished.
    std::thread::sleep(std::time::Duration::from_millis(500));
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "drypoint: interrupted\n");
    assert_eq!(bench.files(), []);
}
