//! `drypoint extract`: the edges that are found.

use crate::bench::{Bench, CORNER};

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
        "super_patches",
        "super_patches_tested",
        "super_patches_accepted",
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
fn patches_are_known_by_their_content() {
    let bench = Bench::new();
    bench.succeed("patches shape:icosphere:500 -o a.patches");
    let expected = bench.json("extract a.patches --eye 1,2,3 --json");
    std::fs::rename(bench.path().join("a.patches"), bench.path().join("asset.bin")).unwrap();
    assert_eq!(bench.json("extract asset.bin --eye 1,2,3 --json"), expected);
    bench.fail("info asset.bin", &["asset.bin", "patch file"]);
    bench.fail("patches asset.bin -o b.patches", &["asset.bin", "patch file"]);
    bench.fail("extract . --eye 1,2,3", &["folder"]);
}

#[test]
fn options_for_building_need_something_to_build() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.succeed("patches corner.obj -o a.patches");
    for option in
        ["--preset fast", "--profile near", "--bound mean", "--levels 2", "--runtime cpu-simd"]
    {
        let name = option.split(' ').next().unwrap();
        let words = [name, "--method patches"];
        bench.fail(&format!("extract corner.obj --eye 1,2,3 {option}"), &words);
        bench.fail(&format!("extract a.patches --eye 1,2,3 {option}"), &words);
    }
    let view = "extract corner.obj --eye 1,2,3 --json";
    let built = bench.json(&format!("{view} --method patches --preset fast --bound minimal"));
    assert_eq!(built["contour"], bench.json(view)["contour"]);
}
