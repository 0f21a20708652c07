//! `--method wgpu`.

use crate::bench::Bench;
use crate::{gpu, moving};

#[test]
fn what_is_visible_is_drawn_and_nothing_else() {
    gpu::what_is_visible_is_drawn_and_nothing_else("wgpu");
}

#[test]
fn a_picture_has_its_colors_and_its_name() {
    gpu::a_picture_has_its_colors_and_its_name("wgpu");
}

#[test]
fn the_same_edges_are_found() {
    gpu::the_same_edges_are_found("wgpu");
}

#[test]
fn every_shape_has_the_contour_of_brute_force() {
    gpu::every_shape_has_the_contour_of_brute_force("wgpu");
}

#[test]
fn patches_change_nothing_that_is_drawn() {
    gpu::patches_change_nothing_that_is_drawn("wgpu");
}

#[test]
fn models_that_move_are_posed() {
    if gpu::is_without_gpu() {
        return;
    }
    let bench = Bench::new();
    moving::write(&bench);
    for pose in ["bend --time 0.37", "slide --time 1.21", "grow --time 0.4"] {
        for view in ["--eye 5,9,7", "--direction 1,0.25,-3 --edges all"] {
            let view = format!("extract moving.gltf --animation {pose} {view} --json");
            let expected = bench.json(&view);
            let found = bench.json(&format!("{view} --method wgpu"));
            assert_eq!(found["contour"], expected["contour"], "{view}");
            assert_eq!((&found["method"], &found["edges"]), (&"wgpu".into(), &expected["edges"]));
            assert!(found["patches"].as_u64().unwrap() > 0, "{view}");
        }
    }
}

#[test]
fn what_it_cannot_do_is_refused() {
    gpu::what_it_cannot_do_is_refused("wgpu");
}

#[test]
fn no_adapter_is_one_line() {
    let variables = &[("WGPU_ADAPTER_NAME", "no such adapter")];
    gpu::no_device_is_one_line("wgpu", variables, "no GPU adapter is available");
}
