//! `--method wgpu`.

use crate::gpu;

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
fn what_it_cannot_do_is_refused() {
    gpu::what_it_cannot_do_is_refused("wgpu");
}

#[test]
fn no_adapter_is_one_line() {
    let variables = &[("WGPU_ADAPTER_NAME", "no such adapter")];
    gpu::no_device_is_one_line("wgpu", variables, "no GPU adapter is available");
}
