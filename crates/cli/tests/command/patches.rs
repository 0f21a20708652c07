//! `drypoint patches`: the asset.

use crate::bench::{Bench, CORNER};

#[test]
fn patches_prints_the_contract_and_saves_the_same_bytes() {
    let bench = Bench::new();
    let built = bench.json("patches shape:icosphere:1000 -o a.patches --json");
    assert_eq!(built["edges"], 1500 * 980 / 1000, "an icosphere of 980 triangles");
    for key in ["patches", "mean_half_angle", "max_half_angle", "mean_t", "expected_cost"] {
        assert!(built[key].as_f64().unwrap() > 0.0, "{key}");
    }
    assert!(built["build_seconds"].is_f64());
    for (key, value) in
        [("preset", "default"), ("profile", "far"), ("bound", "tight"), ("runtime", "paper")]
    {
        assert_eq!(built[key], value, "{key}");
    }
    assert_eq!((&built["levels"], &built["super_patches"]), (&1.into(), &0.into()));
    assert!(built["always_tested"].is_u64());
    bench.succeed("patches shape:icosphere:1000 -o b.patches");
    let files = bench.files();
    assert_eq!(files.len(), 2);
    assert_eq!(files[0].1, files[1].1);
    let full = &files[0].1;
    bench.write("short.patches", &full[..full.len() / 2]);
    bench.fail("extract short.patches --eye 1,2,3", &["short.patches"]);
    bench.write("foreign.patches", CORNER);
    bench.fail("extract foreign.patches --eye 1,2,3", &["foreign.patches"]);
}

#[test]
fn what_was_asked_for_is_in_the_asset_and_in_the_json() {
    let bench = Bench::new();
    let shape = "shape:bumpy-sphere:1000";
    for (options, key, value) in [
        ("--preset fast", "preset", "fast"),
        ("--preset best", "preset", "best"),
        ("--preset paper", "profile", "paper"),
        ("--preset paper", "bound", "reduced"),
        ("--preset paper --bound mean", "bound", "mean"),
        ("--preset paper --bound tight --partition none", "bound", "tight"),
        ("--profile near", "profile", "near"),
        ("--profile 2.5", "profile", "2.5"),
        ("--bound minimal", "bound", "minimal"),
        ("--runtime mesh-shader", "runtime", "mesh-shader"),
        ("--runtime gpu", "runtime", "gpu"),
    ] {
        let built = bench.json(&format!("patches {shape} -o a.patches {options} --json"));
        assert_eq!(built[key], value, "{options}");
    }
    let cost = |options: &str| {
        bench.json(&format!("patches {shape} -o a.patches {options} --json"))["expected_cost"]
            .as_f64()
            .unwrap()
    };
    assert!(cost("--profile near") > cost("--profile far"), "from nearby more is tested");
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    for (options, words) in [
        ("--partition 512", ["--partition", "--preset paper"]),
        ("--preset best --partition none", ["--partition", "--preset paper"]),
        ("--preset paper --partition 1", ["--partition", "from 2"]),
        ("--preset paper --runtime gpu", ["--runtime", "--preset paper"]),
        ("--preset quick", ["quick", "fast"]),
        ("--profile 0", ["--profile", "above 0"]),
        ("--profile -3", ["--profile", "above 0"]),
        ("--profile nearby", ["--profile", "near"]),
        ("--bound loose", ["loose", "tight"]),
        ("--levels 3", ["--levels", "1 or 2"]),
        ("--runtime abacus", ["abacus", "cpu-simd"]),
    ] {
        bench.fail(&format!("patches corner.obj -o a.patches {options}"), &words);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn peak_memory_is_that_of_the_process() {
    let bench = Bench::new();
    let peak = |triangles: usize| {
        let shape = format!("shape:icosphere:{triangles}");
        let built = bench.json(&format!("patches {shape} -o a.patches --preset fast --json"));
        built["peak_memory"].as_u64().unwrap()
    };
    let (small, large) = (peak(20), peak(20_000));
    // The positions, triangles and edges alone take a megabyte and a half.
    assert!(small > 500_000 && large > small + 1_500_000, "{small}, {large}");
}
