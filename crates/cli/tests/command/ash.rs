//! `--method ash`.

use crate::gpu;

#[test]
fn what_is_visible_is_drawn_and_nothing_else() {
    gpu::what_is_visible_is_drawn_and_nothing_else("ash");
}

#[test]
fn a_picture_has_its_colors_and_its_name() {
    gpu::a_picture_has_its_colors_and_its_name("ash");
}

#[test]
fn the_same_edges_are_found() {
    gpu::the_same_edges_are_found("ash");
}

#[test]
fn every_shape_has_the_contour_of_brute_force() {
    gpu::every_shape_has_the_contour_of_brute_force("ash");
}

#[test]
fn patches_change_nothing_that_is_drawn() {
    gpu::patches_change_nothing_that_is_drawn("ash");
}

#[test]
fn what_it_cannot_do_is_refused() {
    gpu::what_it_cannot_do_is_refused("ash");
}

#[test]
fn no_driver_is_one_line() {
    // The second for loaders from before 2022.
    let variables = &[("VK_DRIVER_FILES", "none.json"), ("VK_ICD_FILENAMES", "none.json")];
    gpu::no_device_is_one_line("ash", variables, "no Vulkan driver can be loaded");
}

/// Both draw strokes by the same shader; two devices may round the ends of lines each its own way.
#[cfg(feature = "wgpu")]
#[test]
fn a_picture_is_that_of_wgpu() {
    if gpu::is_without_gpu() {
        return;
    }
    let bench = crate::bench::Bench::new();
    for shape in ["torus-knot", "bumpy-sphere", "cad-part"] {
        for view in ["--view iso", "--view front --ortho --width 4", "--azimuth 20 --fov 90"] {
            let args = format!("shape:{shape}:5000 {view} --size 300x200 --color blue");
            let [ours, other] =
                ["ash", "wgpu"].map(|method| gpu::Ink::draw(&bench, method, &args).pixels);
            let inked = other.chunks(4).filter(|pixel| pixel[0] < 128).count();
            let differs = |(one, other): (&u8, &u8)| one.abs_diff(*other) > 32;
            let pairs = ours.chunks(4).zip(other.chunks(4));
            let different = pairs.filter(|(a, b)| a.iter().zip(*b).any(differs)).count();
            assert!(inked > 200, "{args}: only {inked} pixels");
            assert!(200 * different <= inked, "{args}: {different} of {inked} pixels differ");
        }
    }
}
