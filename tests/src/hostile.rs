//! Bytes from anywhere, and what must hold of them: nothing panics, what is read is sound, and
//! every extractor finds what the definition says.
//!
//! The fuzz targets call these functions, and `tests/corpus.rs` calls them on what fuzzing left
//! behind. `fuzz/src/lib.rs` takes this file and those that it needs by their paths, so that
//! fuzzing builds no GPU.

use std::sync::LazyLock;

use drypoint_cpu::{
    Contours, Extractor, Instructions, Statistics, extract_all_wings, extract_patches,
};
use drypoint_fusion::{PatchFile, PatchSet};
use drypoint_mesh::io::{Dropped, Format, Model, ReadOptions, parse_in_pieces};
use drypoint_mesh::rig::{Rig, Skin};
use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint};
use glam::DVec3;
use rayon::{ThreadPool, ThreadPoolBuilder};
use xxhash_rust::xxh3::xxh3_64;

use crate::soup;

/// Takes bytes from anywhere, and panics where something does not hold.
pub type Check = fn(&[u8]);

/// Each kind of input by the name of its fuzz target, which is also that of its corpus.
pub const CHECKS: [(&str, Check); 6] = [
    ("extract", soup::check),
    ("gltf", |bytes| check_file(Format::Gltf, bytes)),
    ("obj", |bytes| check_file(Format::Obj, bytes)),
    ("patch_file", check_patch_file),
    ("ply", |bytes| check_file(Format::Ply, bytes)),
    ("stl", |bytes| check_file(Format::Stl, bytes)),
];

/// Files longer than this are not looked at: a reader is linear, and a fuzzer that tries long ones
/// tries few.
const LONGEST: usize = 1 << 16;

/// One thread, and several however few the machine has.
static POOLS: LazyLock<[ThreadPool; 2]> = LazyLock::new(|| {
    [1, 3].map(|n| ThreadPoolBuilder::new().num_threads(n).build().expect("threads can be started"))
});

/// Reads `bytes` as a mesh file, whole and in small pieces, on one thread and on several, with what is
/// not finite left out and refused: each time refused in one line or read as a sound model, and the same
/// in pieces as whole.
///
/// # Panics
/// Where that does not hold.
pub fn check_file(format: Format, bytes: &[u8]) {
    if bytes.len() > LONGEST {
        return;
    }
    Format::of_content(bytes);
    // The size of the pieces depends on the bytes, so that small changes move the cuts.
    let size = 1 + bytes.iter().fold(bytes.len(), |sum, &b| sum + usize::from(b)) % 97;
    let [alone, together] = &*POOLS;
    for strict in [false, true] {
        let read = |size| {
            let options = ReadOptions { strict };
            parse_in_pieces(format, bytes, size, None, &options).map_err(|e| e.to_string())
        };
        let whole = alone.install(|| read(usize::MAX / 2));
        let pieces = together.install(|| read(size));
        match (whole, pieces) {
            (Ok(model), Ok(pieces)) => {
                assert!(model == pieces, "another model in pieces of {size} bytes");
                assert!(!strict || model.dropped == Dropped::default(), "dropped all the same");
                check_model(&model);
            }
            (Err(error), Err(pieces)) => {
                assert_eq!(error, pieces, "another error in pieces of {size} bytes");
                assert!(!error.is_empty() && !error.contains(['\n', '\r']), "{error:?} is no line");
                assert!(error.len() < 1000, "{} bytes of an error", error.len());
            }
            (whole, pieces) => panic!("{:?} whole, {:?} in pieces", whole.err(), pieces.err()),
        }
    }
}

fn check_model(model: &Model) {
    let Model { mesh, parts, materials, dropped, rig, rig_vertices } = model;
    let (vertices, triangles) = (mesh.positions().len(), mesh.triangles().len());
    assert!(triangles > 0, "a model of nothing");
    assert!(mesh.positions().iter().all(|p| p.is_finite()), "a position is not finite");
    let used = mesh.triangles().iter().flatten();
    assert!(used.max().is_none_or(|&v| (v as usize) < vertices), "an index is out of range");
    for parts in [parts, materials] {
        let mut end = 0;
        for part in parts {
            assert_eq!(part.triangles.start, end, "parts do not follow one another");
            assert!(part.triangles.end > end, "an empty part");
            end = part.triangles.end;
        }
        assert_eq!(end as usize, triangles, "parts do not cover the triangles");
    }
    assert!(materials.windows(2).all(|two| two[0].name != two[1].name), "a material in two runs");
    assert!(dropped.vertices <= vertices, "more was dropped than there is");
    if triangles < 10_000 {
        let adjacency = MeshAdjacency::new(mesh);
        assert_eq!(adjacency.report().faces, triangles);
        match rig {
            Some(rig) => check_rig(rig, rig_vertices, mesh),
            None => assert!(rig_vertices.is_empty(), "vertices of no rig"),
        }
    }
}

/// At rest a rig is the mesh; in no pose does it panic.
fn check_rig(rig: &Rig, vertices: &[u32], mesh: &Mesh) {
    let rest = rig.mesh(&rig.rest()).expect("it is finite at rest");
    assert_eq!(rest.positions().len(), vertices.len());
    for (position, &source) in rest.positions().iter().zip(vertices) {
        assert_eq!(*position, mesh.position(source), "a rig that rests elsewhere");
    }
    let triangles = rest.triangles().iter().map(|t| t.map(|v| vertices[v as usize]));
    assert!(triangles.eq(mesh.triangles().iter().copied()), "a rig of other triangles");
    let skin = Skin::new(rig).expect("it is finite at rest");
    let viewpoint = Viewpoint::at(DVec3::new(3.0, -20.0, 7.0));
    let mut contours = Vec::new();
    for animation in 0..rig.animations().len() {
        for seconds in [-1.0, 0.0, 0.5, 1e9] {
            let pose = rig.pose_at(animation, seconds);
            if rig.mesh(&pose).is_ok() {
                skin.contour_edges(rig, &pose, viewpoint, EdgeFilter::All, &mut contours);
            }
        }
    }
}

/// Where a patches file has its checksum and its length.
const CHECKSUM: std::ops::Range<usize> = 16..24;
const LENGTH: std::ops::Range<usize> = 24..32;

/// Loads `bytes` as patches, then once more with length and checksum made right, so that they get
/// past both: refused with a reason, or good for everything that patches are for.
///
/// # Panics
/// Where that does not hold.
pub fn check_patch_file(bytes: &[u8]) {
    if let Err(error) = PatchSet::from_bytes(bytes) {
        assert!(!error.to_string().contains(['\n', '\r']), "not a line: {error}");
    }
    let bytes = sealed(bytes.to_vec());
    let Ok(set) = PatchSet::from_bytes(&bytes) else { return };
    assert_eq!(set.to_bytes(), bytes, "not the same bytes again");
    // What an allocator gives begins at a multiple of 4.
    let file = PatchFile::parse(&bytes).expect("it is the same file");
    assert!(file.to_patch_set() == set, "another asset in place");
    let _ = (set.summary(), set.expected_cost());
    let is_valid = set.validate().is_ok();
    let extractors: Vec<Extractor<'_>> =
        Instructions::ALL.into_iter().filter_map(|with| Extractor::with(&set, with)).collect();
    let (mut by_patches, mut by_force) = (Vec::new(), Vec::new());
    let mut contours = Contours::default();
    for viewpoint in around(&set) {
        let statistics = extract_patches(&set, viewpoint, &mut by_patches);
        extract_all_wings(&set, viewpoint, &mut by_force);
        assert!(statistics.edges_tested <= set.wings().len());
        let (found, all) = (sorted(&by_patches), sorted(&by_force));
        // Bounds that hold lose nothing; whatever they say, nothing is invented. Kernels look at edges of
        // several patches at once, and so find some that a bound that does not hold would lose.
        assert!(!is_valid || found == all, "patches that are valid lose edges");
        assert!(is_within(&found, &all), "patches invent edges");
        for extractor in &extractors {
            let seen = extractor.edges(viewpoint, &mut contours);
            let seen = Statistics { contour_edges: statistics.contour_edges, ..seen };
            assert_eq!(seen, statistics);
            let by_kernels = sorted(&contours);
            assert!(is_within(&found, &by_kernels), "kernels lose edges");
            assert!(is_within(&by_kernels, &all), "kernels invent edges");
        }
    }
}

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
fn around(set: &PatchSet) -> [Viewpoint; 4] {
    let vertex = set.positions().first().map_or(DVec3::ZERO, |p| p.as_dvec3());
    let axis = set.patches().first().map_or(DVec3::Y, |patch| patch.bound.axis.as_dvec3());
    [
        Viewpoint::at(DVec3::new(3.0, -20.0, 7.0)),
        Viewpoint::at(vertex),
        Viewpoint::at(vertex + axis),
        Viewpoint::from_direction(DVec3::new(1.0, 2.0, -0.5)),
    ]
}

/// Whether `few` are among `many`, as often as they are there. Both sorted.
fn is_within(few: &[EdgeId], many: &[EdgeId]) -> bool {
    let mut many = many.iter();
    few.iter().all(|edge| many.any(|other| other == edge))
}

fn sorted(edges: &[EdgeId]) -> Vec<EdgeId> {
    let mut edges = edges.to_vec();
    edges.sort_unstable();
    edges
}
