//! What the program says about itself and about a mesh.

use crate::bench::{Bench, CORNER};

#[test]
fn help_has_examples() {
    let bench = Bench::new();
    for args in ["--help", "draw --help", "patches --help", "extract --help"] {
        assert!(bench.succeed(args).contains("Examples:"), "{args}");
    }
    for (command, words) in [
        ("", &["torus-knot", "cad-part", "huge-sphere"][..]),
        ("patches", &["fast", "default", "best", "paper", "far", "near", "tight", "mesh-shader"]),
        ("patches", &["--levels", "--partition", "super_patches", "peak_memory"]),
        ("draw", &["--show", "survivors", "--model", "--preset", "--method", "wgpu", "ash"]),
        ("draw", &["--method ash", "wgpu or ash", "Vulkan 1.3"]),
        ("draw", &["--animation", "--frames", "--animation-frames", "--turntable", "frames.json"]),
        ("info", &["rigid_share", "animations"]),
        ("patches", &["rest pose", "extract --animation"]),
        ("extract", &["--animation", "--time"]),
        (
            "extract",
            &["super_patches_tested", "--runtime", ".patches", "wgpu", "ash", "Vulkan 1.3"],
        ),
    ] {
        let help = bench.succeed(&format!("{command} --help"));
        for word in words {
            assert!(help.contains(word), "{command} --help: no {word}");
        }
    }
    assert!(bench.succeed("info --help").contains("MODEL"));
    assert!(bench.succeed("--version").starts_with("drypoint "));
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
    assert_eq!(report["materials"], serde_json::json!([]));
    assert!(bench.succeed("info corner.obj").contains("convex"));
}

#[test]
fn info_tells_the_faces_of_each_material() {
    let bench = Bench::new();
    let face = "f 1 2 3\n";
    let faces =
        format!("{face}usemtl wine\n{face}g a\n{face}usemtl gold\n{face}usemtl wine\n{face}");
    bench.write("bar.obj", format!("v 0 0 0\nv 1 0 0\nv 1 1 0\n{faces}"));
    let report = bench.json("info bar.obj --json");
    let expected = [("gold", 1), ("wine", 3)];
    let expected = expected.map(|(name, faces)| serde_json::json!({"name": name, "faces": faces}));
    assert_eq!(report["materials"], serde_json::json!(expected));
    assert!(bench.succeed("info bar.obj").contains("material            wine (3 faces)"));
}

#[test]
fn a_name_in_a_file_does_not_reach_the_terminal_as_it_is() {
    let bench = Bench::new();
    bench.write(
        "bell.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\ng \x1b[2J\x07\u{9b}é\u{202e}\nusemtl \x1bc\nf 1 2 3\n",
    );
    let text = bench.succeed("info bell.obj");
    assert!(text.contains(r"\u{1b}[2J\u{7}\u{9b}é\u{202e} (1 faces)"), "{text}");
    assert!(text.contains(r"\u{1b}c (1 faces)"), "{text}");
    // What a program reads is what the file says.
    assert_eq!(
        bench.json("info bell.obj --json")["parts"][0]["name"],
        "\x1b[2J\x07\u{9b}é\u{202e}"
    );
    let output = bench.run("extract \x1b[2J.obj --eye 1,2,3");
    assert!(String::from_utf8(output.stderr).unwrap().contains(r"\u{1b}[2J.obj: "));
}
