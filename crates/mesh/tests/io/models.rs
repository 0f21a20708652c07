//! Real models, found through the environment variable `DRYPOINT_MODELS`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use drypoint_mesh::io::read;

/// Faces, interior and boundary edges of a model as it is stored, and its parts.
#[track_caller]
fn check(name: &str, faces: usize, edges: Option<(usize, usize)>, parts: usize) {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS").map(PathBuf::from) else { return };
    let model = read(&folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let triangles = model.mesh.triangles();
    assert_eq!((triangles.len(), model.parts.len()), (faces, parts), "{name}");
    assert_eq!(model.parts.last().unwrap().triangles.end as usize, faces, "{name}");
    if let Some(expected) = edges {
        let mut faces_of = BTreeMap::<[u32; 2], usize>::new();
        for [a, b] in triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]) {
            *faces_of.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
        let of = |count| faces_of.values().filter(|&&faces| faces == count).count();
        assert_eq!((of(2), of(1)), expected, "{name}");
    }
}

#[test]
fn models_have_the_faces_and_edges_that_are_known() {
    check("stanford-bunny.obj", 69_451, Some((104_065, 223)), 1);
    check("dragon_vrip.ply", 871_414, Some((1_304_986, 4_270)), 1);
    check("armadillo.obj", 99_994, Some((149_991, 0)), 1);
    check("fandisk.obj", 12_946, Some((19_419, 0)), 1);
    check("cow.obj", 5_804, Some((8_706, 0)), 1);
    check("spot.obj", 5_856, Some((8_784, 0)), 1);
    check("teapot.obj", 6_320, Some((8_962, 1_036)), 1);
    check("suzanne.obj", 968, Some((1_429, 42)), 1);
    check("beetle-alt.obj", 38_656, Some((57_416, 1_136)), 1);
    check("sponza.obj", 33_663, Some((47_108, 6_773)), 124);
    check("RobotExpressive.glb", 3_234, None, 19);
    check("BrainStem.glb", 61_666, None, 59);
    check("Fox.glb", 576, None, 1);
}

/// Boxes of the rest pose, in the model's units: what stands upright and how tall.
#[test]
fn skinned_models_stand_upright() {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS").map(PathBuf::from) else { return };
    for (name, lowest, highest) in [
        ("RobotExpressive.glb", -0.02, 4.48),
        ("BrainStem.glb", 0.02, 1.82),
        // The fox rests as it is bound, so this is the box that the file states.
        ("Fox.glb", -0.12, 78.91),
    ] {
        let bounds = read(&folder.join(name)).unwrap().mesh.bounds().unwrap();
        let found = [bounds.min.y, bounds.max.y].map(|y| (100.0 * y).round() / 100.0);
        assert_eq!(found, [lowest, highest], "{name}");
    }
}
