//! Vertices at no finite position: left out with a count, or refused. And files that claim too much.

use crate::bench::{Bench, CORNER};

/// The corner, and a triangle and a square beside it that use a vertex which is nowhere.
fn island() -> String {
    CORNER.to_owned() + "v nan 5 5\nv 1e999 0 0\nf 1 2 5\nf 1 2 3 5\n"
}

#[test]
fn islands_are_left_out_with_a_count() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.write("island.obj", island());
    let report = bench.json("info island.obj --json");
    for (key, count) in
        [("faces", 4), ("dropped_faces", 2), ("vertices", 6), ("dropped_vertices", 2)]
    {
        assert_eq!(report[key], count, "{key}");
    }
    assert_eq!(bench.json("info corner.obj --json")["dropped_faces"], 0);
    assert!(bench.succeed("info island.obj").contains("faces left out               2"));
    for command in
        ["draw MODEL.obj -o MODEL.svg", "extract MODEL.obj --eye 3,4,5", "info MODEL.obj"]
    {
        let output = bench.run(&command.replace("MODEL", "island"));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{errors}");
        let expected =
            "drypoint: island.obj: left out what is at no finite position: vertices 2, faces 2";
        assert_eq!(errors.lines().next(), Some(expected), "{command}");
        let warned =
            String::from_utf8(bench.run(&command.replace("MODEL", "corner")).stderr).unwrap();
        assert!(!warned.contains("left out"), "{command}");
    }
    // What is left is the corner.
    let drawn = |name: &str| std::fs::read_to_string(bench.path().join(name)).unwrap();
    assert_eq!(drawn("island.svg").replace("island", "corner"), drawn("corner.svg"));
    let patches = bench.json("patches island.obj -o island.patches --json");
    assert_eq!(patches["edges"], 6);
    assert_eq!(
        bench.succeed("extract island.obj --eye 3,4,5"),
        bench.succeed("extract corner.obj --eye 3,4,5")
    );
}

#[test]
fn strict_refuses_islands() {
    let bench = Bench::new();
    bench.write("island.obj", island());
    bench.write("corner.obj", CORNER);
    for command in [
        "draw MODEL -o a.svg",
        "patches MODEL -o a.patches",
        "extract MODEL --eye 1,2,3",
        "info MODEL",
    ] {
        let of = |model| format!("{} --strict", command.replace("MODEL", model));
        bench.fail(&of("island.obj"), &["island.obj: line 9: vertex 5 is at (NaN, 5, 5)"]);
        bench.succeed(&of("corner.obj"));
        let _ = std::fs::remove_file(bench.path().join("a.svg"));
        let _ = std::fs::remove_file(bench.path().join("a.patches"));
    }
}

#[test]
fn a_file_that_claims_too_much_is_cut_off_and_not_too_large() {
    let bench = Bench::new();
    for encoding in ["ascii", "binary_little_endian"] {
        let header = format!(
            "ply\nformat {encoding} 1.0\nelement vertex 2147483648\nproperty float x\nproperty float y\n\
             property float z\nelement face 2147483648\nproperty list uchar int vertex_indices\nend_header\n"
        );
        bench.write("a.ply", header + "0 0 0\n1 0 0\n");
        bench.fail(
            "draw a.ply -o a.svg",
            &["the file ends after", "of 2147483648 rows of \"vertex\""],
        );
    }
}
