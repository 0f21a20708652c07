//! Pictures of a decomposition: each edge's share of the surface in the colour of its patch, as
//! Figure 1 of Tsiapkolis and Bénard (CGF 2024).

use drypoint_fusion::PatchSet;
use drypoint_lines::{Area, Camera, Color, Occluders, Tint, tinted_areas};
use drypoint_mesh::{HalfEdge, Mesh, MeshAdjacency, Viewpoint};
use glam::DVec3;
use serde::Serialize;

use crate::palette;

/// Greys of what no patch in colour holds, by how it faces the viewer.
const GREYS: usize = 8;

/// The tint of edges that are always tested.
const ALWAYS_TESTED: usize = GREYS;

/// The tint of the first patch.
const FIRST_PATCH: usize = GREYS + 1;

/// Pixels by which survivors are drawn larger than they are.
const SPREAD: f64 = 1.5;

/// The whole decomposition, or what of it is tested from a viewpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    Patches,
    Survivors,
}

/// What was shown, in the shape that scripts read.
#[derive(Debug, Serialize)]
pub(crate) struct Counts {
    edges: usize,
    patches: usize,
    super_patches: usize,
    /// Patches that may hold a contour edge from here.
    survivors: usize,
    /// Edges in them, and those that are always tested.
    edges_tested: usize,
}

/// What patches survive from a viewpoint, by index.
fn survivors(patches: &PatchSet, viewpoint: Viewpoint) -> Vec<bool> {
    let mut may: Vec<bool> =
        patches.patches().iter().map(|patch| patch.bound.may_hold_contour(viewpoint)).collect();
    for group in patches.super_patches() {
        if !group.bound.may_hold_contour(viewpoint) {
            let range = group.patches();
            may[range.start as usize..range.end as usize].fill(false);
        }
    }
    may
}

/// Counts what is tested from a viewpoint.
pub(crate) fn counts(patches: &PatchSet, viewpoint: Viewpoint) -> Counts {
    let survivors = survivors(patches, viewpoint);
    let tested = patches.patches().iter().zip(&survivors).filter(|(_, survives)| **survives);
    Counts {
        edges: patches.wings().len(),
        patches: patches.patches().len(),
        super_patches: patches.super_patches().len(),
        survivors: tested.clone().count(),
        edges_tested: tested.map(|(patch, _)| patch.edge_count as usize).sum::<usize>()
            + patches.always_tested().len(),
    }
}

/// What of the decomposition is visible.
pub(crate) fn areas(
    patches: &PatchSet,
    occluders: &Occluders<'_>,
    adjacency: &MeshAdjacency,
    camera: &Camera,
    shown: Shown,
) -> Vec<Area> {
    let mesh = occluders.mesh();
    let mut owners = owners(patches, adjacency, mesh);
    let tints = tints(patches, &owners, shown);
    let is_shown = match shown {
        Shown::Patches => {
            share(&mut owners, adjacency);
            vec![true; patches.patches().len()]
        }
        Shown::Survivors => survivors(patches, camera.viewpoint()),
    };
    let towards_viewer = towards_viewer(mesh, camera.viewpoint());
    let thirds: Vec<[usize; 3]> = (0u32..)
        .zip(&owners)
        .map(|(face, owners)| {
            let grey = grey(mesh, face, towards_viewer);
            let in_color = |tint: &usize| *tint < FIRST_PATCH || is_shown[*tint - FIRST_PATCH];
            owners.map(|tint| tint.filter(in_color).unwrap_or(grey))
        })
        .collect();
    tinted_areas(occluders, adjacency, camera, &tints, &thirds)
}

/// For each third of each face the tint of the edge at its side, if an edge of `patches` is there.
fn owners(patches: &PatchSet, adjacency: &MeshAdjacency, mesh: &Mesh) -> Vec<[Option<usize>; 3]> {
    let mut owners = vec![[None; 3]; mesh.triangles().len()];
    let held = patches.patches().iter().enumerate();
    let held = held.map(|(index, patch)| (FIRST_PATCH + index, patch.edges()));
    for (tint, places) in held.chain([(ALWAYS_TESTED, patches.always_tested())]) {
        for place in places {
            for half in adjacency.sides(patches.edge_ids()[place as usize]) {
                if half != HalfEdge::NONE {
                    // Of the wings of a non-manifold edge the first has its side.
                    owners[half.triangle() as usize][half.corner()].get_or_insert(tint);
                }
            }
        }
    }
    owners
}

/// Gives the thirds of edges that no patch holds to others of the same face, and faces without any
/// to a neighbor, so that the surface is covered. Large regions without edges stay as they are.
fn share(owners: &mut [[Option<usize>; 3]], adjacency: &MeshAdjacency) {
    let within = |owners: &mut [[Option<usize>; 3]]| {
        for thirds in owners {
            let [a, b, c] = *thirds;
            *thirds = [a.or(b).or(c), b.or(c).or(a), c.or(a).or(b)];
        }
    };
    within(owners);
    let mut across = Vec::new();
    for edge in adjacency.edge_ids() {
        let [left, right] = adjacency.sides(edge);
        if right != HalfEdge::NONE {
            for (to, from) in [(left, right), (right, left)] {
                let owner = |half: HalfEdge| owners[half.triangle() as usize][half.corner()];
                if let (None, Some(tint)) = (owner(to), owner(from)) {
                    across.push((to, tint));
                }
            }
        }
    }
    for (half, tint) in across {
        owners[half.triangle() as usize][half.corner()].get_or_insert(tint);
    }
    within(owners);
}

fn tints(patches: &PatchSet, owners: &[[Option<usize>; 3]], shown: Shown) -> Vec<Tint> {
    // What survives does so because it is seen from the side, and would be hard to see.
    let spread = if shown == Shown::Survivors { SPREAD } else { 0.0 };
    let greys = (0..GREYS).map(|i| {
        let level = 255 - u8::try_from(7 * (GREYS - 1 - i)).unwrap_or_default();
        Tint { name: format!("rest-{i}"), color: Color::opaque(level, level, level), spread: 0.0 }
    });
    let always =
        Tint { name: "always-tested".into(), color: Color::opaque(150, 150, 150), spread: 0.0 };
    let mut neighbors: Vec<[u32; 2]> = owners
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter_map(|[a, b]| {
            let patch = |tint: Option<usize>| u32::try_from(tint?.checked_sub(FIRST_PATCH)?).ok();
            let [a, b] = [patch(a)?, patch(b)?];
            (a != b).then(|| [a.min(b), a.max(b)])
        })
        .collect();
    neighbors.sort_unstable();
    neighbors.dedup();
    let mut families = vec![None; patches.patches().len()];
    for (index, group) in patches.super_patches().iter().enumerate() {
        let range = group.patches();
        families[range.start as usize..range.end as usize].fill(Some(index));
    }
    let colors = palette::colors(&families, &neighbors).into_iter().enumerate();
    let named = colors.map(|(i, color)| Tint { name: format!("patch-{i}"), color, spread });
    greys.chain([always]).chain(named).collect()
}

/// The grey of a face: lighter where it faces a viewer far away, so that what is flat is of one grey.
fn grey(mesh: &Mesh, face: u32, towards_viewer: DVec3) -> usize {
    let [a, b, c] = mesh.corners(face).map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or(DVec3::ZERO);
    // Off the steps between greys, on which a flat face would be of two by rounding.
    let facing = normal.dot(towards_viewer).abs() - 1e-6;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates at 0")]
    let level = (facing * GREYS as f64) as usize;
    level.min(GREYS - 1)
}

/// From the middle of the mesh, of length 1.
fn towards_viewer(mesh: &Mesh, viewpoint: Viewpoint) -> DVec3 {
    let center = mesh.bounds().map_or(DVec3::ZERO, |bounds| bounds.center());
    let origin = if viewpoint.is_point() { center } else { DVec3::ZERO };
    (viewpoint.xyz() - origin).normalize_or(DVec3::Z)
}
