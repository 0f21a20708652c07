//! The program as a user runs it: shapes of JSON, exit status, messages, files left behind.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// A folder of its own for each test, as the working folder of the program.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path().join(name), content).unwrap();
    }

    fn run(&self, args: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_drypoint"))
            .args(args.split_whitespace())
            .current_dir(self.path())
            .output()
            .unwrap()
    }

    #[track_caller]
    fn succeed(&self, args: &str) -> String {
        let output = self.run(args);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "drypoint {args}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    #[track_caller]
    fn json(&self, args: &str) -> Value {
        serde_json::from_str(&self.succeed(args)).unwrap()
    }

    /// Fails with status 1 and one line that holds every one of `words`; the folder is as it was.
    #[track_caller]
    fn fail(&self, args: &str, words: &[&str]) {
        let before = self.files();
        let output = self.run(args);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "drypoint {args}: {errors}");
        assert_eq!(errors.lines().count(), 1, "drypoint {args}: {errors}");
        assert!(output.stdout.is_empty(), "drypoint {args} printed something");
        for word in words {
            assert!(errors.contains(word), "drypoint {args}: no {word:?} in: {errors}");
        }
        assert_eq!(self.files(), before, "drypoint {args} left something behind");
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let entries = std::fs::read_dir(self.path()).unwrap().map(|entry| entry.unwrap());
        let named = |entry: std::fs::DirEntry| {
            (
                entry.file_name().into_string().unwrap(),
                std::fs::read(entry.path()).unwrap_or_default(),
            )
        };
        let mut files: Vec<_> = entries.map(named).collect();
        files.sort();
        files
    }
}

/// The unit corner: a tetrahedron with its right angle at the origin.
const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn extract_prints_the_contract() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let found = bench.json("extract corner.obj --eye 9,9,9 --json");
    let keys: Vec<_> = found.as_object().unwrap().keys().map(String::as_str).collect();
    let mut expected = vec![
        "method",
        "edges",
        "patches",
        "patches_tested",
        "patches_accepted",
        "edges_tested",
        "contour_edges",
        "contour",
    ];
    expected.sort_unstable();
    let mut sorted = keys;
    sorted.sort_unstable();
    assert_eq!(sorted, expected);
    assert_eq!(found["method"], "brute-force");
    assert_eq!(found["contour"], serde_json::json!([[1, 2], [1, 3], [2, 3]]));
    assert_eq!(found["contour_edges"], 3);
    assert_eq!(bench.succeed("extract corner.obj --eye 9,9,9"), "1 2\n1 3\n2 3\n");
    // In the plane of three faces, in front of them by the tie rule; behind the fourth.
    let tie = bench.json("extract corner.obj --eye 0,0,0 --json");
    assert_eq!(tie["contour"], serde_json::json!([[1, 2], [1, 3], [2, 3]]));
}

#[test]
fn all_methods_and_a_saved_asset_agree() {
    let bench = Bench::new();
    for (view, edges) in [("--eye 1,2,3", "convex"), ("--direction 0,0,1", "all")] {
        let shape = "shape:bumpy-sphere:2000";
        let expected = bench.json(&format!("extract {shape} {view} --edges {edges} --json"));
        assert!(expected["contour_edges"].as_u64().unwrap() > 20);
        bench.succeed(&format!("patches {shape} -o a.patches --edges {edges}"));
        for way in [
            format!("extract {shape} {view} --edges {edges} --method patches --json"),
            format!("extract a.patches {view} --json"),
            format!("extract a.patches {view} --edges {edges} --method brute-force --json"),
        ] {
            let found = bench.json(&way);
            assert_eq!(found["contour"], expected["contour"], "{way}");
            assert_eq!(found["edges"], expected["edges"], "{way}");
        }
    }
    bench.fail("extract a.patches --eye 1,2,3 --edges convex", &["a.patches", "all edges"]);
}

#[test]
fn patches_prints_the_contract_and_saves_the_same_bytes() {
    let bench = Bench::new();
    let built = bench.json("patches shape:icosphere:1000 -o a.patches --json");
    assert_eq!(built["edges"], 1500 * 980 / 1000, "an icosphere of 980 triangles");
    for key in ["patches", "mean_half_angle", "max_half_angle", "mean_t", "expected_cost"] {
        assert!(built[key].as_f64().unwrap() > 0.0, "{key}");
    }
    assert!(built["build_seconds"].is_f64() && !built["peak_memory"].is_string());
    bench.succeed("patches shape:icosphere:1000 -o b.patches");
    let files = bench.files();
    assert_eq!(files.len(), 2);
    assert_eq!(files[0].1, files[1].1);
    let full = &files[0].1;
    bench.write("short.patches", &full[..full.len() / 2]);
    bench.fail("extract short.patches --eye 1,2,3", &["short.patches"]);
    bench.write("foreign.patches", CORNER);
    bench.fail("extract foreign.patches --eye 1,2,3", &["foreign.patches"]);
    bench.fail("draw a.patches", &["a.patches", "mesh itself"]);
}

#[test]
fn info_counts() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let report = bench.json("info corner.obj --json --vertices");
    for (key, count) in [
        ("faces", 4),
        ("vertices", 4),
        ("welded_vertices", 4),
        ("interior", 6),
        ("boundary", 0),
        ("non_manifold", 0),
        ("inconsistent", 0),
        ("degenerate", 0),
        ("convex", 6),
        ("flat", 0),
        ("concave", 0),
    ] {
        assert_eq!(report[key], count, "{key}");
    }
    assert_eq!(
        report["bounds"],
        serde_json::json!({"min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 1.0]})
    );
    assert_eq!(report["positions"][3], serde_json::json!([0.0, 0.0, 1.0]));
    assert_eq!(report["parts"].as_array().unwrap().len(), 1);
    assert!(bench.succeed("info corner.obj").contains("convex"));
}

#[test]
fn draw_alone_draws_a_shape() {
    let bench = Bench::new();
    bench.succeed("draw");
    let files = bench.files();
    assert_eq!(files.len(), 1);
    assert_eq!(files[0].0, "torus-knot.svg");
    assert!(String::from_utf8_lossy(&files[0].1).contains("class=\"contour\""));
}

#[test]
fn draw_writes_svg_png_and_statistics() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let drawn =
        bench.json("draw corner.obj -o a.svg --json --lines contour,crease --hidden dashed");
    assert!(drawn["contour"]["visible_length"].as_f64().unwrap() > 100.0);
    bench.succeed("draw corner.obj -o a.png --size 120x80");
    let files = bench.files();
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["a.png", "a.svg", "corner.obj"]);
    assert!(files[0].1.starts_with(b"\x89PNG"));
    let svg = bench.succeed("draw corner.obj -o - --ortho --view front");
    assert!(svg.trim_start().starts_with('<') && svg.contains("<svg"));
}

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
        ("garbage.stl", b"\x93\x00\xff\xfe\x01 garbage\x00\n\x07", &[]),
        ("garbage.glb", b"\x93\x00\xff\xfe\x01 garbage\x00\n\x07", &[]),
        ("range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", &["line 4", "9"]),
        ("nan.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", &["line 2"]),
        ("inf.obj", b"v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n", &["line 3"]),
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

#[test]
fn faces_without_area_make_no_picture() {
    let bench = Bench::new();
    bench.write("flat.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nv 5 5 5\nf 1 2 3\nf 2 3 4\n");
    bench.fail("draw flat.obj -o out.svg", &["flat.obj", "area"]);
    assert_eq!(bench.json("info flat.obj --json")["degenerate"], 2);
    assert_eq!(bench.json("extract flat.obj --eye 1,2,3 --json")["contour_edges"], 0);
}

#[test]
fn bad_options_say_what_is_wrong() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    std::fs::create_dir(bench.path().join("folder")).unwrap();
    for (options, words) in [
        ("--eye 1,2", &["--eye", "three numbers"][..]),
        ("--eye 1,2,nan", &["--eye", "finite"]),
        ("--eye 1,2,3 --target 1,2,3", &["eye", "target"]),
        ("--eye 0.25,9,0.25 --target 0.25,0,0.25 --up 0,1,0", &["up"]),
        ("--fov 180", &["fov"]),
        ("--fov 0", &["fov"]),
        ("--hidden maybe", &["maybe", "dashed"]),
        ("--lines contour,hatching", &["hatching", "boundary"]),
        ("--view above", &["above", "top"]),
        ("--size 0x10", &["--size"]),
        ("--size 800", &["--size"]),
        ("--width -1", &["width"]),
        ("--color burple", &["burple"]),
        ("--margin -5", &["margin"]),
        ("--margin 5000", &["margin"]),
        ("--ortho --height 0", &["height"]),
        ("--height 3", &["--ortho"]),
        ("--crease-angle 270", &["crease-angle"]),
        ("--distance 0 --view front", &["distance"]),
        ("--distance 3 --ortho", &["distance", "ortho"]),
        ("--elevation 100", &["elevation", "90"]),
        ("--specks -1", &["specks"]),
        ("--width 0.001", &["width"]),
        ("-o - --json", &["--json"]),
        ("--view front --up 0,0,0", &["--up"]),
        ("--wibble", &["--wibble"]),
        ("-o out.bmp", &["out.bmp", ".svg"]),
        ("-o nowhere/out.svg", &["nowhere/out.svg", "folder"]),
        ("-o folder", &["folder"]),
    ] {
        bench.fail(&format!("draw corner.obj {options}"), words);
    }
    bench.fail("extract corner.obj", &["--eye", "--direction"]);
    bench.fail("extract corner.obj --eye 1,2,3 --sphere mean", &["--sphere", "--method patches"]);
    bench.fail("patches corner.obj -o corner.obj", &["corner.obj", ".patches"]);
    bench.fail("patches corner.obj -o - --json", &["--json"]);
    bench.fail("draw folder", &["folder"]);
    bench.fail("extract corner.obj --eye 1,2,3 --direction 1,2,3", &["--direction"]);
    bench.fail("extract corner.obj --direction 0,0,0", &["--direction"]);
    bench.fail("extract corner.obj --eye 1,2,3 --method magic", &["magic", "brute-force"]);
    bench.fail("patches corner.obj", &["--output"]);
    bench.fail("patches corner.obj -o nowhere/a.patches", &["nowhere/a.patches"]);
    bench.fail("paint corner.obj", &["paint"]);
}

#[test]
fn well_defined_pictures_from_odd_places() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    // Inside the mesh every face looks away: no contour, a valid picture.
    let inside = bench.json("draw corner.obj -o in.svg --eye 0.1,0.1,0.1 --target 9,9,9 --json");
    assert_eq!(inside["contour"]["segments"], 0);
    // On a vertex, on a face, straight from above without --up.
    for view in ["--eye 0,0,0 --target 1,1,1", "--eye 0.2,0.2,0 --target 1,1,1", "--view top"] {
        bench.succeed(&format!("draw corner.obj -o odd.svg {view}"));
    }
}

/// Length in pixels of the visible lines of a class.
#[track_caller]
fn visible(bench: &Bench, class: &str, args: &str) -> f64 {
    bench.json(&format!("draw {args} --json"))[class]["visible_length"].as_f64().unwrap()
}

#[test]
fn a_target_is_in_the_middle_and_the_model_on_the_page() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    for target in ["0,0,100", "0.5,0.5,-100", "0.5,0.5,0.5"] {
        for ortho in ["", "--ortho"] {
            let args = format!("corner.obj -o a.svg --view front --target {target} {ortho}");
            assert!(visible(&bench, "contour", &args) > 30.0, "{args}");
        }
    }
}

#[test]
fn creases_alone_are_all_there() {
    let bench = Bench::new();
    let creases = bench.json("draw shape:cube -o a.svg --lines crease --json");
    assert_eq!(creases["crease"]["segments"], 12);
    let both = bench.json("draw shape:cube -o a.svg --lines contour,crease --json");
    assert_eq!((&both["contour"]["segments"], &both["crease"]["segments"]), (&6.into(), &6.into()));
}

#[test]
fn a_surface_stored_twice_looks_like_one_stored_once() {
    let bench = Bench::new();
    let once = CORNER.to_owned();
    let faces = CORNER.lines().filter(|line| line.starts_with('f'));
    let turned = |line: &str| {
        let corners: Vec<_> = line.split(' ').collect();
        format!("f {} {} {}\n", corners[3], corners[2], corners[1])
    };
    bench.write("once.obj", &once);
    bench.write(
        "same.obj",
        once.clone() + &faces.clone().map(|f| format!("{f}\n")).collect::<String>(),
    );
    bench.write("both.obj", once + &faces.map(turned).collect::<String>());
    let expected = visible(&bench, "contour", "once.obj -o a.svg --view front");
    for name in ["same.obj", "both.obj"] {
        let found = visible(&bench, "contour", &format!("{name} -o a.svg --view front"));
        assert!((found - expected).abs() < 1e-6, "{name}: {found}, not {expected}");
    }
}

#[test]
fn a_solid_turned_inside_out_is_seen() {
    let bench = Bench::new();
    bench.write("out.obj", CORNER);
    bench.write(
        "in.obj",
        CORNER
            .replace("f 1 3 2", "f 1 2 3")
            .replace("f 1 2 4", "f 1 4 2")
            .replace("f 1 4 3", "f 1 3 4")
            .replace("f 2 3 4", "f 2 4 3"),
    );
    let [out, turned] = ["out.obj", "in.obj"]
        .map(|name| visible(&bench, "contour", &format!("{name} -o a.svg --view front")));
    assert!(turned > 100.0 && (turned - out).abs() < 1e-6, "{turned}, not {out}");
}

#[test]
fn a_blank_page_is_told() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    let output = bench.run("draw corner.obj -o a.svg --eye 9,9,9 --target 20,20,20");
    assert!(output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("no line of corner.obj"));
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

#[test]
fn help_has_examples() {
    let bench = Bench::new();
    for args in ["--help", "draw --help", "patches --help", "extract --help"] {
        assert!(bench.succeed(args).contains("Examples:"), "{args}");
    }
    assert!(bench.succeed("info --help").contains("MODEL"));
    assert!(bench.succeed("--version").starts_with("drypoint "));
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing_behind() {
    let bench = Bench::new();
    let child = Command::new(env!("CARGO_BIN_EXE_drypoint"))
        .args(["patches", "shape:bumpy-sphere:500000", "-o", "long.patches"])
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
