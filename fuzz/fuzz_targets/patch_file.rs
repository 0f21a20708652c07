//! Bytes as a patches file: refused with a reason, or good for everything that patches are for.
#![no_main]

use drypoint_cpu::{extract_all_wings, extract_patches};
use drypoint_fusion::PatchSet;
use drypoint_mesh::Viewpoint;
use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use xxhash_rust::xxh3::xxh3_64;

const CHECKSUM: std::ops::Range<usize> = 16..24;
const LENGTH: std::ops::Range<usize> = 24..32;

fuzz_target!(|bytes: &[u8]| {
    let _ = PatchSet::from_bytes(bytes);
    let bytes = sealed(bytes.to_vec());
    let Ok(set) = PatchSet::from_bytes(&bytes) else { return };
    assert_eq!(set.to_bytes(), bytes, "not the same bytes again");
    let _ = (set.validate(), set.summary(), set.expected_cost());
    let (mut by_patches, mut by_force) = (Vec::new(), Vec::new());
    for viewpoint in viewpoints(&set) {
        let statistics = extract_patches(&set, viewpoint, &mut by_patches);
        extract_all_wings(&set, viewpoint, &mut by_force);
        assert!(statistics.edges_tested <= set.wings().len());
        assert!(by_patches.len() <= by_force.len(), "more from patches than there are");
    }
});

/// Makes length and checksum right.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    if bytes.len() >= LENGTH.end {
        let length = (bytes.len() as u64).to_le_bytes();
        bytes[LENGTH].copy_from_slice(&length);
        let rest = [&bytes[..CHECKSUM.start], &bytes[CHECKSUM.end..]].concat();
        bytes[CHECKSUM].copy_from_slice(&xxh3_64(&rest).to_le_bytes());
    }
    bytes
}

/// Far, on a vertex, in the first patch's axis, and orthographic.
fn viewpoints(set: &PatchSet) -> [Viewpoint; 4] {
    let vertex = set.positions().first().map_or(DVec3::ZERO, |p| p.as_dvec3());
    let axis = set.patches().first().map_or(DVec3::Y, |patch| patch.bound.axis.as_dvec3());
    [
        Viewpoint::at(DVec3::new(3.0, -20.0, 7.0)),
        Viewpoint::at(vertex),
        Viewpoint::at(vertex + axis),
        Viewpoint::from_direction(DVec3::new(1.0, 2.0, -0.5)),
    ]
}
