//! The programs behind `cargo xtask bench` and `cargo xtask validate`, as they are run alone.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use drypoint_mesh::shapes;
use drypoint_tests::report::{MESHLETS, OURS, Report, SNCH};

/// Without the folder of models, whatever is set.
fn run(program: &str, arguments: &[&str], folder: &Path) -> Output {
    Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .env_remove("DRYPOINT_MODELS")
        .output()
        .unwrap()
}

/// A mesh file in `folder`, small enough for a test.
fn write_mesh(folder: &Path) {
    let mesh = shapes::bumpy_sphere(500);
    let mut text = String::new();
    for p in mesh.positions() {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    for [a, b, c] in mesh.triangles() {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    fs::write(folder.join("bumpy.obj"), text).unwrap();
}

#[test]
fn the_benchmark_reports_and_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_mesh(folder);
    let bench = |more: &[&str]| {
        let arguments = [&["-o", "out", "--quick", "--rounds", "1", "bumpy.obj"], more].concat();
        run(env!("CARGO_BIN_EXE_bench"), &arguments, folder)
    };
    let output = bench(&[]);
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("bumpy-decompositions") && text.contains("| anchored cones |"), "{text}");
    let report = || -> Report {
        serde_json::from_str(&fs::read_to_string(folder.join("out/report.json")).unwrap()).unwrap()
    };
    let first = report();
    let mesh = first.mesh("bumpy").unwrap();
    for name in [OURS, SNCH, MESHLETS] {
        let tested = &mesh.decomposition(name).unwrap().tested.far.edges;
        assert_eq!(tested.counts.len(), 252, "{name}");
        assert!(tested.mean > mesh.contours.far.mean && tested.mean <= mesh.edges as f64, "{name}");
    }
    assert!(mesh.times.len() > 10 && mesh.best_brute_force().is_some());
    assert!(fs::read_to_string(folder.join("out/report.html")).unwrap().contains("<svg"));

    // Times would not be the same if they were measured again.
    assert!(bench(&[]).status.success());
    assert_eq!(report().meshes, first.meshes);
    assert!(bench(&["--fresh", "--only", "times"]).status.success());
    let third = report();
    assert_ne!(third.meshes[0].times, first.meshes[0].times);
    assert!(third.meshes[0].decompositions.is_empty());
}

#[test]
fn what_cannot_be_measured_is_said_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let check = |arguments: &[&str], says: &str| {
        let output = run(env!("CARGO_BIN_EXE_bench"), arguments, folder.path());
        assert!(!output.status.success());
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(says), "{error}");
        assert!(!folder.path().join("out/report.json").exists());
    };
    check(&["-o", "out", "missing.obj"], "missing.obj: cannot be read");
    check(&["-o", "out", "--docs", "nowhere", "x.obj"], "--docs: nowhere");
    check(&["-o", "out", "a/x.obj", "b/x.ply"], "two meshes have the name x");
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    check(&["-o", "out", "--docs", root, "x.obj"], "no mesh is given for the mark");
    check(&["-o", "out", "--docs", root, "--quick"], "no --quick");
    check(&["-o", "out", "--from", "none.json"], "none.json");
    check(&["-o", "out", "--rounds", "0"], "--rounds");
}

/// An adapter that there is not, and for a machine that has one a run on it.
#[test]
fn without_a_gpu_its_sections_are_left_out_unless_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_mesh(folder);
    let bench = |adapter: Option<&str>, more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bench"));
        let arguments = ["-o", "out", "--quick", "--rounds", "1", "bumpy.obj"];
        command.args(arguments).args(more).current_dir(folder).env_remove("DRYPOINT_MODELS");
        command.envs(adapter.map(|name| ("WGPU_ADAPTER_NAME", name)));
        command.output().unwrap()
    };
    let report = || -> Report {
        serde_json::from_str(&fs::read_to_string(folder.join("out/report.json")).unwrap()).unwrap()
    };
    let nowhere = Some("no such adapter");
    for section in ["gpu", "gpu-calibration"] {
        let output = bench(nowhere, &["--only", section]);
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && error.contains("no GPU adapter"), "{error}");
    }
    let output = bench(nowhere, &[]);
    assert!(output.status.success(), "{output:?}");
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(error.matches("nothing is measured on a GPU").count(), 1, "{error}");
    assert!(report().gpu.is_none() && report().meshes[0].gpu.is_none());

    if std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1") {
        return;
    }
    let output = bench(None, &["--only", "gpu", "--only", "gpu-calibration"]);
    assert!(output.status.success(), "{output:?}");
    let mesh = &report().meshes[0];
    assert!(report().is_on_gpu_alone() && mesh.gpu.is_some());
    // Four widths, where workgroups of 256 are allowed.
    assert_eq!(mesh.gpu_calibration.len(), 4);
}

#[test]
fn validation_says_what_agreed() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--only", "icosphere", "--preset", "s", "--json", "agreed.json"];
    let output = run(env!("CARGO_BIN_EXE_validate"), &arguments, folder.path());
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("every extractor agrees with the definition: "), "{text}");
    let json = fs::read_to_string(folder.path().join("agreed.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["disagreement"].is_null());
    let rows = json["agreements"].as_array().unwrap();
    for name in ["fast", "snch", "anchored-cones", "meshlets"] {
        assert!(rows.iter().any(|row| row["grouped_by"] == name), "{name}");
    }
    for nothing in [["--only", "no such mesh"], ["--preset", "no such preset"]] {
        let output = run(env!("CARGO_BIN_EXE_validate"), &nothing, folder.path());
        assert!(!output.status.success(), "{nothing:?}");
    }
}
