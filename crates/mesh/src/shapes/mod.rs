//! Procedural meshes, asked for by property, by name, or one by one.
//!
//! They are the meshes of tests, examples and benches: the same on every call, of any size up to
//! [`MOST_TRIANGLES`], in linear time and memory.
//!
//! ```
//! use drypoint_mesh::{MeshAdjacency, shapes};
//!
//! for shapes::NamedMesh { name, mesh } in shapes::closed() {
//!     assert_eq!(MeshAdjacency::new(&mesh).report().boundary, 0, "{name}");
//! }
//! let knot = shapes::by_name("torus-knot", 10_000).unwrap();
//! assert!(knot.triangles().len().abs_diff(10_000) < 100);
//! ```

mod defects;
mod dirt;
mod grids;
mod part;
mod small;
mod spheres;

use glam::Vec3;

pub use defects::{
    duplicated_sphere, dust_sphere, far_sphere, flipped_sphere, huge_sphere, moved_sphere,
    sliver_sphere, split_sphere, tiny_sphere, vast_sphere,
};
pub use dirt::{
    flipped_shells, littered_sphere, mixed_units, sliver_fan, stack, t_junctions, zero_area_thicket,
};
pub use grids::{mobius_strip, open_cylinder, open_grid, torus_knot};
pub use part::cad_part;
pub use small::{
    book, cube, cubes_sharing_an_edge, empty, folded_sheet, one_triangle, tetrahedron,
    zero_area_fan,
};
pub use spheres::{bumpy_sphere, icosphere};

use crate::Mesh;

/// The largest count a shape is made with; larger wishes get this. The mesh of a smooth shape then
/// takes about 2 GB.
pub const MOST_TRIANGLES: usize = 100_000_000;

/// A mesh and what to call it in a message.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMesh {
    /// In kebab case, one of [`NAMES`]; with its count where several sizes of one shape are needed.
    pub name: &'static str,
    /// The mesh.
    pub mesh: Mesh,
}

type Make = fn(usize) -> Mesh;

const SHAPES: [(&str, Make); 32] = [
    ("icosphere", icosphere),
    ("torus-knot", torus_knot),
    ("bumpy-sphere", bumpy_sphere),
    ("cad-part", cad_part),
    ("tetrahedron", |_| tetrahedron()),
    ("cube", |_| cube()),
    ("open-grid", open_grid),
    ("open-cylinder", open_cylinder),
    ("mobius-strip", mobius_strip),
    ("one-triangle", |_| one_triangle()),
    ("empty", |_| empty()),
    ("cubes-sharing-an-edge", |_| cubes_sharing_an_edge()),
    ("book", book),
    ("folded-sheet", |_| folded_sheet()),
    ("zero-area-fan", |_| zero_area_fan()),
    ("sliver-sphere", sliver_sphere),
    ("split-sphere", split_sphere),
    ("flipped-sphere", flipped_sphere),
    ("duplicated-sphere", duplicated_sphere),
    ("moved-sphere", moved_sphere),
    ("tiny-sphere", tiny_sphere),
    ("huge-sphere", huge_sphere),
    ("dust-sphere", dust_sphere),
    ("vast-sphere", vast_sphere),
    ("far-sphere", far_sphere),
    ("littered-sphere", littered_sphere),
    ("t-junctions", t_junctions),
    ("flipped-shells", flipped_shells),
    ("sliver-fan", sliver_fan),
    ("zero-area-thicket", zero_area_thicket),
    ("stack", stack),
    ("mixed-units", mixed_units),
];

/// Every name that [`by_name`] knows.
pub const NAMES: &[&str] = &{
    let mut names = [""; SHAPES.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = SHAPES[i].0;
        i += 1;
    }
    names
};

/// The shape of that name with about that many triangles; shapes of a fixed size ignore the count,
/// a book has as many pages. `None` if there is no such name.
pub fn by_name(name: &str, triangles: usize) -> Option<Mesh> {
    SHAPES.iter().find(|(known, _)| *known == name).map(|(_, make)| make(triangles))
}

/// Closed manifolds, consistently wound, outside outwards, without self-intersection and without
/// faces of no area, every vertex at a place of its own.
pub fn closed() -> Vec<NamedMesh> {
    named([
        ("tetrahedron", tetrahedron()),
        ("cube", cube()),
        ("icosahedron", icosphere(20)),
        ("icosphere", icosphere(1280)),
        ("torus-knot", torus_knot(2000)),
        ("bumpy-sphere", bumpy_sphere(2000)),
        ("cad-part-672", cad_part(672)),
        ("cad-part", cad_part(2688)),
    ])
}

/// Surfaces with boundary edges. All but the Möbius strip have an inside and an outside.
pub fn with_boundary() -> Vec<NamedMesh> {
    named([
        ("one-triangle", one_triangle()),
        ("open-grid", open_grid(1000)),
        ("open-cylinder", open_cylinder(500)),
        ("mobius-strip", mobius_strip(500)),
    ])
}

/// Meshes with edges of three faces or more.
pub fn non_manifold() -> Vec<NamedMesh> {
    named([
        ("cubes-sharing-an-edge", cubes_sharing_an_edge()),
        ("book-3", book(3)),
        ("book-16", book(16)),
        ("book-40", book(40)),
        ("duplicated-sphere", duplicated_sphere(500)),
    ])
}

/// Meshes with edges of two faces that disagree on which side is outside.
pub fn inconsistent() -> Vec<NamedMesh> {
    named([
        ("mobius-strip", mobius_strip(500)),
        ("flipped-icosahedron", flipped_sphere(20)),
        ("flipped-sphere", flipped_sphere(500)),
    ])
}

/// Meshes with faces that have no area, or that lie upon each other back to back.
pub fn degenerate() -> Vec<NamedMesh> {
    named([
        ("zero-area-fan", zero_area_fan()),
        ("folded-sheet", folded_sheet()),
        ("sliver-icosahedron", sliver_sphere(20)),
        ("sliver-sphere", sliver_sphere(1000)),
    ])
}

/// Meshes with several vertices at one position.
pub fn duplicate_vertices() -> Vec<NamedMesh> {
    named([("split-sphere", split_sphere(500)), ("sliver-sphere", sliver_sphere(1000))])
}

/// Closed meshes far from the origin, far from unit size, or both.
pub fn far_from_origin() -> Vec<NamedMesh> {
    named([
        ("moved-sphere", moved_sphere(1280)),
        ("tiny-sphere", tiny_sphere(1280)),
        ("huge-sphere", huge_sphere(1280)),
        ("dust-sphere", dust_sphere(320)),
        ("vast-sphere", vast_sphere(320)),
    ])
}

/// What exports, joins and conversions of units leave behind.
pub fn dirty() -> Vec<NamedMesh> {
    named([
        ("far-sphere", far_sphere(1280)),
        ("littered-sphere", littered_sphere(320)),
        ("t-junctions", t_junctions(84)),
        ("flipped-shells", flipped_shells(240)),
        ("sliver-fan", sliver_fan(500)),
        ("zero-area-thicket", zero_area_thicket(1200)),
        ("stack", stack(20)),
        ("mixed-units", mixed_units(240)),
    ])
}

/// Every mesh of the lists above once, and the empty one.
pub fn all() -> Vec<NamedMesh> {
    let mut all = named([("empty", empty())]);
    let lists = [
        closed(),
        with_boundary(),
        non_manifold(),
        inconsistent(),
        degenerate(),
        duplicate_vertices(),
        far_from_origin(),
        dirty(),
    ];
    for shape in lists.into_iter().flatten() {
        if all.iter().all(|known: &NamedMesh| known.name != shape.name) {
            all.push(shape);
        }
    }
    all
}

fn named<const N: usize>(shapes: [(&'static str, Mesh); N]) -> Vec<NamedMesh> {
    shapes.map(|(name, mesh)| NamedMesh { name, mesh }).into()
}

/// The count that a shape is made with.
fn wish(triangles: usize) -> u32 {
    u32::try_from(triangles.min(MOST_TRIANGLES)).unwrap_or(u32::MAX)
}

fn build(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(positions, triangles).expect("a shape names its own, finite vertices")
}
