//! Classes of lines, and what lines belong to.

use serde_json::Value;

use crate::bench::{Bench, CORNER};

/// A box in a floor, with a lid of another material.
const BOX_IN_FLOOR: &str = "\
v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0
v -1 -1 -0.7\nv 1 -1 -0.7\nv 1 1 -0.7\nv -1 1 -0.7\nv -1 -1 2\nv 1 -1 2\nv 1 1 2\nv -1 1 2
o the floor\nusemtl oak & elm\nf 1 2 3 4
o box\nusemtl red\nf 8 7 6 5\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\nusemtl blue\nf 9 10 11 12
";

const VIEW: &str = "--eye 9,-7,8 --up 0,0,1";

fn drawn(options: &str) -> (Value, String) {
    let bench = Bench::new();
    bench.write("box.obj", BOX_IN_FLOOR);
    let json = bench.json(&format!("draw box.obj -o a.svg {VIEW} {options} --json"));
    (json, std::fs::read_to_string(bench.path().join("a.svg")).unwrap())
}

#[test]
fn each_class_is_its_own() {
    let (all, svg) = drawn("--lines all");
    let count = |json: &Value, class: &str| json[class]["segments"].as_u64();
    let expected = [("contour", 6), ("boundary", 4), ("material", 2), ("crease", 4)];
    for (class, expected) in expected {
        assert_eq!(count(&all, class), Some(expected), "{class}");
    }
    let line = &all["intersection"];
    assert_eq!(line["chains"], 1);
    let [seen, hidden] = ["visible_length", "hidden_length"].map(|l| line[l].as_f64().unwrap());
    assert!(seen > 100.0 && hidden > 100.0, "{line}");
    for class in ["contour", "boundary", "material", "crease", "intersection"] {
        assert!(svg.contains(&format!("<g class=\"{class}\"")), "{class}");
        let (alone, _) = drawn(&format!("--lines {class}"));
        let classes: Vec<_> =
            alone.as_object().unwrap().keys().filter(|key| !key.ends_with('s')).collect();
        assert_eq!(classes, [class]);
    }
    let (few, svg) = drawn("--lines contour,intersection");
    assert_eq!(few["intersection"], all["intersection"]);
    assert!(few["crease"].is_null() && !svg.contains("boundary"));
    let (default, _) = drawn("");
    assert!(default["intersection"].is_null() && default["boundary"].is_object());
    // Without contours, edges are drawn for the next reason.
    let (rest, _) = drawn("--lines material,crease");
    assert_eq!([count(&rest, "material"), count(&rest, "crease")], [Some(4), Some(8)]);
}

#[test]
fn lines_name_their_part_and_material() {
    let (json, svg) = drawn("--lines all");
    for key in ["parts", "materials"] {
        let named = json[key].as_object().unwrap();
        for class in ["contour", "boundary", "material", "crease", "intersection"] {
            let total: f64 = named.values().filter_map(|lengths| lengths[class].as_f64()).sum();
            let expected = json[class]["visible_length"].as_f64().unwrap();
            assert!((total - expected).abs() < 1e-6, "{key}, {class}: {total}, not {expected}");
        }
    }
    let names = |key: &str| json[key].as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(names("parts"), ["box", "the floor"]);
    assert_eq!(names("materials"), ["blue", "oak & elm", "red"]);
    let floor = r#"data-material="oak &amp; elm" data-part="the floor""#;
    let path = |class: &str, what: &str| {
        let group = svg.split("<g ").find(|group| group.contains(&format!("class=\"{class}\"")));
        group.unwrap().lines().any(|line| line.contains(what))
    };
    assert!(path("boundary", floor) && path("intersection", floor) && !path("contour", floor));
    assert!(path("contour", r#"data-material="blue" data-part="box""#));
    assert!(path("intersection", "data-faces=") && !path("contour", "data-faces="));
}

#[test]
fn a_model_of_one_part_names_nothing() {
    let bench = Bench::new();
    bench.write("corner.obj", CORNER);
    bench.write("named.obj", format!("o corner\n{CORNER}"));
    for name in ["corner.obj", "named.obj", "shape:cube"] {
        let json = bench.json(&format!("draw {name} -o a.svg --lines all --json"));
        assert!(json["parts"].is_null() && json["materials"].is_null());
        let svg = std::fs::read_to_string(bench.path().join("a.svg")).unwrap();
        assert!(!svg.contains("data-part") && !svg.contains("data-material"));
    }
    // Of a model that has names a page without lines says so, too.
    bench.write("two.obj", format!("o a\n{CORNER}o b\n{CORNER}"));
    let json = bench.json("draw two.obj -o a.svg --json --eye 9,9,9 --target 20,20,20");
    assert_eq!([&json["parts"], &json["materials"]], [&serde_json::json!({}); 2]);
    bench.write("red.obj", format!("usemtl red\n{CORNER}"));
    let json = bench.json("draw red.obj -o a.svg --json");
    assert_eq!(json["materials"]["red"]["contour"], json["contour"]["visible_length"]);
}
