//! `drypoint draw` with patches: the same lines, and pictures of the decomposition.

use crate::bench::{Bench, CORNER};

#[test]
fn a_patch_file_draws_what_its_mesh_draws() {
    let bench = Bench::new();
    // A closed shape, for which convex edges are enough, and an open one, for which they are not.
    for (shape, edges) in [
        ("shape:torus-knot:2000", "convex"),
        ("shape:torus-knot:2000", "all"),
        ("shape:open-grid:200", "convex"),
        ("shape:open-grid:200", "all"),
    ] {
        bench.succeed(&format!("patches {shape} -o a.patches --edges {edges}"));
        for view in ["--view front", "--view bottom --ortho"] {
            bench.succeed(&format!("draw a.patches --model {shape} -o a.svg {view}"));
            bench.succeed(&format!("draw {shape} -o b.svg {view}"));
            let [a, b] = ["a.svg", "b.svg"].map(|name| {
                let svg = std::fs::read_to_string(bench.path().join(name)).unwrap();
                svg[svg.find("</title>").unwrap()..].to_owned()
            });
            assert!(a == b && a.contains("<path"), "{shape} {edges} {view}");
        }
    }
}

#[test]
fn a_patch_file_wants_its_own_mesh() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.write("other.obj", CORNER.replace("v 1 0 0", "v 2 0 0"));
    bench.succeed("patches corner.obj -o a.patches");
    bench.fail("draw a.patches", &["a.patches", "--model"]);
    bench.fail("draw a.patches --model other.obj", &["a.patches", "other.obj"]);
    bench.fail("draw a.patches --model a.patches", &["a.patches", "mesh"]);
    bench.fail("draw a.patches --model missing.obj", &["missing.obj"]);
    let show = "draw a.patches --model corner.obj --show patches";
    bench.fail(&format!("{show} --preset fast"), &["--preset", "a.patches"]);
    bench.fail(&format!("{show} --edges all"), &["--edges", "a.patches", "convex"]);
    bench.succeed(&format!("{show} --edges convex -o a.svg"));
}

/// The classes of the areas in an SVG.
fn areas(svg: &str) -> Vec<&str> {
    let after = svg.split("<g class=\"areas\"").nth(1).unwrap_or_default();
    let group = after.split("</g>").next().unwrap_or_default();
    group.split(" class=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect()
}

#[test]
fn patches_and_survivors_are_shown() {
    let bench = Bench::new();
    let shape = "shape:bumpy-sphere:3000";
    bench.succeed(&format!("patches {shape} -o a.patches"));
    let counts = bench.json("extract a.patches --direction 0,0,1 --json");
    let view = "--view front --ortho --size 200x200";
    let mut shown = Vec::new();
    for show in ["patches", "survivors"] {
        let args = format!("draw a.patches --model {shape} --show {show} {view}");
        let drawn = bench.json(&format!("{args} -o a.svg --json"))["patches"].clone();
        assert_eq!(drawn["patches"], counts["patches"]);
        assert_eq!(drawn["survivors"], counts["patches_accepted"]);
        assert_eq!(drawn["edges_tested"], counts["edges_tested"]);
        let svg = std::fs::read_to_string(bench.path().join("a.svg")).unwrap();
        let found: Vec<_> = areas(&svg).into_iter().map(str::to_owned).collect();
        shown.push(found.iter().filter(|name| name.starts_with("patch-")).count());
        assert_eq!(found.iter().any(|name| name.starts_with("rest-")), show == "survivors");
        // The same from the mesh alone, and the same twice.
        bench.succeed(&format!("draw {shape} --show {show} {view} -o b.svg"));
        let [a, b] = ["a.svg", "b.svg"].map(|name| {
            let svg = std::fs::read_to_string(bench.path().join(name)).unwrap();
            svg[svg.find("</title>").unwrap()..].to_owned()
        });
        assert!(a == b, "{show}");
        bench.succeed(&format!("{args} -o {show}.png"));
    }
    let survivors = usize::try_from(counts["patches_accepted"].as_u64().unwrap()).unwrap();
    let patches = usize::try_from(counts["patches"].as_u64().unwrap()).unwrap();
    assert!(0 < shown[1] && shown[1] <= survivors, "{shown:?} of {survivors}");
    assert!(patches / 4 < shown[0] && shown[0] < patches, "{shown:?} of {patches}");
    let plain = bench.json(&format!("draw {shape} {view} -o a.svg --json"));
    assert!(plain.get("patches").is_none());
}

#[test]
fn shapes_of_every_kind_are_shown() {
    let bench = Bench::new();
    for shape in [
        "cube",
        "one-triangle",
        "cubes-sharing-an-edge",
        "folded-sheet",
        "duplicated-sphere:200",
        "book:5",
    ] {
        for options in ["--show patches", "--show survivors --edges all --levels 2"] {
            bench.succeed(&format!("draw shape:{shape} -o a.svg --size 90x90 {options}"));
        }
    }
    // From within, where faces reach behind the eye.
    let inside = "draw shape:cube --eye 0.1,0.2,0.3 --target 5,0.5,0.4 --size 90x90 --edges all";
    bench.succeed(&format!("{inside} --show patches -o a.svg"));
    let svg = std::fs::read_to_string(bench.path().join("a.svg")).unwrap();
    assert!(!areas(&svg).is_empty());
}
