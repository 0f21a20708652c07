//! Models that move: what is said of them, poses, and the contour edges in them.

use std::path::PathBuf;

use serde_json::json;

use crate::bench::{Bench, CORNER};
use crate::moving;

#[test]
fn info_tells_what_can_move() {
    let bench = Bench::new();
    moving::write(&bench);
    let report = bench.json("info moving.gltf --json");
    let animations = json!([
        {"name": "bend", "duration": 1.0, "channels": 1},
        {"name": "slide", "duration": 2.0, "channels": 1},
        {"name": "grow", "duration": 0.5, "channels": 1},
    ]);
    assert_eq!(report["animations"], animations);
    // Three crates of one shape, and the bottom of the tube; its top is displaced.
    assert_eq!((&report["rigid_parts"], &report["rigid_shapes"]), (&5.into(), &3.into()));
    assert_eq!(report["instances"], 3);
    let share = report["rigid_share"].as_f64().unwrap();
    assert!(0.5 < share && share < 0.9, "{share}");
    let text = bench.succeed("info moving.gltf");
    for words in ["rigid edges", "slide (2.000 s", "instances"] {
        assert!(text.contains(words), "no {words} in: {text}");
    }
    bench.write("corner.obj", CORNER);
    let still = bench.json("info corner.obj --json");
    assert!(still.get("animations").or(still.get("rigid_share")).is_none());
}

#[test]
fn animations_are_known_by_name_and_number() {
    let bench = Bench::new();
    moving::write(&bench);
    let view = "extract moving.gltf --eye 5,9,7 --json";
    let slid = bench.json(&format!("{view} --animation slide --time 1.5"));
    assert_eq!(bench.json(&format!("{view} --animation 1 --time 1.5")), slid);
    assert_ne!(bench.json(&format!("{view} --animation 1")), slid);
    let missing = ["no animation 'dance'", "bend, slide, grow"];
    bench.fail("draw moving.gltf -o a.svg --animation dance", &missing);
    bench.fail("draw moving.gltf -o a.svg --animation 3", &["no animation '3'"]);
    bench.fail(&format!("{view} --animation dance"), &missing);
    bench.fail("draw moving.gltf --frames a --animation dance", &missing);
    bench.fail("draw moving.gltf -o a.svg --time 1", &["--animation"]);
    bench.write("corner.obj", CORNER);
    let none = ["--animation", "corner.obj has no animations"];
    bench.fail("draw corner.obj -o a.svg --animation bend", &none);
    bench.fail("extract corner.obj --eye 1,2,3 --animation bend", &none);
    bench.fail("extract moving.gltf --eye 1,2,3 --animation bend --method ash", &["--method ash"]);
    bench.succeed("patches moving.gltf -o a.patches");
    let at_rest = ["--animation", "a.patches", "at rest"];
    bench.fail("draw a.patches --model moving.gltf -o a.svg --animation bend", &at_rest);
    bench.fail("extract a.patches --eye 1,2,3 --animation bend", &at_rest);
}

#[test]
fn before_and_after_an_animation_the_model_stays() {
    let bench = Bench::new();
    moving::write(&bench);
    let at = |time: &str| bench.succeed(&format!("draw moving.gltf -o - --animation bend {time}"));
    assert_eq!(at("--time -7"), at("--time 0"));
    assert_eq!(at(""), at("--time 0"));
    assert_eq!(at("--time 1e9"), at("--time 1"));
    assert_ne!(at("--time 0.5"), at("--time 1"));
    // The first key is the rest pose.
    assert_eq!(at(""), bench.succeed("draw moving.gltf -o -"));
}

/// All methods find the same contour edges.
#[track_caller]
fn check_methods(bench: &Bench, model: &str, animation: &str, time: f64) {
    for view in ["--eye 5,9,7", "--direction 1,0.25,-3 --edges all", "--eye 0.1,2,0.2"] {
        let view = format!("extract {model} --animation {animation} --time {time} {view} --json");
        let expected = bench.json(&view);
        let found = bench.json(&format!("{view} --method patches --preset fast"));
        assert!(expected["contour_edges"].as_u64().unwrap() > 0, "{view}");
        assert_eq!(found["contour"], expected["contour"], "{view}");
        assert_eq!(found["edges"], expected["edges"], "{view}");
        assert_eq!((&expected["patches"], &found["method"]), (&0.into(), &"patches".into()));
        assert!(found["patches"].as_u64().unwrap() > 0, "{view}");
    }
}

#[test]
fn all_methods_agree_in_every_pose() {
    let bench = Bench::new();
    moving::write(&bench);
    for (animation, duration) in [("bend", 1.0), ("slide", 2.0), ("grow", 0.5)] {
        for step in 0..4 {
            check_methods(&bench, "moving.gltf", animation, f64::from(step) * duration / 3.0);
        }
    }
    let rest = bench.json("extract moving.gltf --eye 5,9,7 --json");
    let first = bench.json("extract moving.gltf --eye 5,9,7 --json --animation bend");
    assert_eq!(first["contour"], rest["contour"], "at rest nothing has moved");
    let sum =
        bench.json("extract moving.gltf --eye 5,9,7 --json --animation bend --method patches");
    let less = sum["edges_tested"].as_u64() < sum["edges"].as_u64();
    assert!(less && sum["patches_accepted"].as_u64() < sum["patches"].as_u64(), "{sum}");
}

#[test]
fn all_methods_agree_on_real_models() {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS").map(PathBuf::from) else { return };
    let bench = Bench::new();
    for name in ["BrainStem.glb", "RobotExpressive.glb", "Fox.glb"] {
        let model = folder.join(name);
        if !model.exists() {
            continue;
        }
        let model = model.display();
        let report = bench.json(&format!("info {model} --json"));
        // A few of the animations, at a time that is no key of theirs.
        let animations = report["animations"].as_array().unwrap();
        for (number, animation) in animations.iter().enumerate().step_by(5) {
            let time = 0.37 * animation["duration"].as_f64().unwrap();
            check_methods(&bench, &model.to_string(), &number.to_string(), time);
        }
    }
}
