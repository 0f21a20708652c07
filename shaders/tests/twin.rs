//! The Rust twins of the shaders' tests, against the exact definition: what f32 may get wrong is within
//! the stated margin, and nothing beyond it is culled.
#![allow(
    clippy::cast_possible_truncation,
    reason = "coordinates are rounded on purpose, and meshes small"
)]

use std::ops::ControlFlow;

use drypoint_bounds::{DoubleCone, NormalCone, SpatializedNormalCone, Sphere};
use drypoint_fusion::{FusionParams, Levels, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, is_contour, shapes};
use drypoint_shaders::{Content, EdgePlanes, Frame, Group, MAX_PIECE};
use fastrand::Rng;
use glam::{DVec3, Vec3, Vec4};

fn patches(mesh: &Mesh, levels: Levels) -> PatchSet {
    let adjacency = MeshAdjacency::new(mesh);
    let params = FusionParams { levels, ..FusionParams::FAST };
    fuse(mesh, &adjacency, EdgeFilter::All, &params, &|_| ControlFlow::Continue(()))
        .expect("nothing stops it")
}

/// Viewpoints around the mesh and in it, on its vertices, in planes of its faces, and directions.
fn viewpoints(mesh: &Mesh, set: &PatchSet, rng: &mut Rng) -> Vec<Viewpoint> {
    let unit = mesh.bounds().map_or(1.0, |bounds| bounds.half_longest_side().max(1e-30));
    let center = mesh.bounds().map_or(DVec3::ZERO, |bounds| bounds.center());
    let mut direction = || DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5);
    let mut all = Vec::new();
    for distance in [0.0, 0.3, 1.0, 3.0, 100.0, 1e6, 1e20] {
        all.push(Viewpoint::at(center + direction() * distance * unit));
        all.push(Viewpoint::from_direction(direction()));
    }
    for wing in set.wings().iter().step_by(set.wings().len().div_ceil(8).max(1)) {
        let [a, b, c] = wing.left_face().map(|v| set.positions()[v as usize].as_dvec3());
        all.push(Viewpoint::at(a));
        all.push(Viewpoint::at(a + 3.0 * (b - a) - 5.0 * (c - a)));
        all.push(Viewpoint::from_direction(b - c));
    }
    all
}

/// The places of edges that a shader would find through `content`, in order.
fn found(content: &Content, viewpoint: Vec4) -> Vec<usize> {
    let survives = |group: &&Group| {
        let center = group.bound.center;
        let to_viewpoint = viewpoint.truncate() - viewpoint.w * center;
        group.bound.may_hold_contour_towards(to_viewpoint, viewpoint.w)
    };
    let through = |groups: &[Group]| -> Vec<usize> {
        let ranges = groups.iter().filter(survives);
        ranges.flat_map(|g| g.first as usize..(g.first + g.count) as usize).collect()
    };
    let patches = if content.super_patches.is_empty() {
        content.patches.clone()
    } else {
        through(&content.super_patches).into_iter().map(|patch| content.patches[patch]).collect()
    };
    let mut edges = through(&patches);
    edges.retain(|&edge| content.planes[edge].is_contour(viewpoint));
    edges
}

#[test]
fn what_is_found_is_exact_but_for_the_margin() {
    let mut rng = Rng::with_seed(7);
    let (mut sure, mut doubtful) = (0, 0);
    for shape in shapes::all() {
        for levels in [Levels::One, Levels::Two] {
            let set = patches(&shape.mesh, levels);
            let content = Content::new(&[&set]);
            let planes: Vec<_> = set
                .wings()
                .iter()
                .map(|wing| EdgePlanes::in_f64(set.positions(), wing, &content.frames[0]))
                .collect();
            for viewpoint in viewpoints(&shape.mesh, &set, &mut rng) {
                let seen = content.frames[0].viewpoint(viewpoint);
                let found = found(&content, seen);
                for (place, wing) in set.wings().iter().enumerate() {
                    if EdgePlanes::is_doubtful(&planes[place], seen) {
                        doubtful += 1;
                        continue;
                    }
                    sure += 1;
                    let expected = is_contour(set.positions(), wing, viewpoint);
                    let is_found = found.binary_search(&place).is_ok();
                    assert_eq!(is_found, expected, "{}, {viewpoint:?}, {wing:?}", shape.name);
                }
            }
        }
    }
    assert!(
        doubtful * 4 < sure,
        "{doubtful} doubtful, {sure} sure: the margin would hide anything"
    );
}

/// Viewpoints at a multiple of the margin from a face: f32 must be sure of its side from 1 on, and is
/// mistaken now and then well below.
#[test]
fn the_margin_is_what_f32_needs() {
    let mut rng = Rng::with_seed(8);
    let mut mistaken_below = 0;
    for _ in 0..200_000 {
        let mut coordinate = || (rng.f32() - 0.5) * 2.0;
        let mut point = || Vec3::new(coordinate(), coordinate(), coordinate());
        let positions = [point(), point(), point(), point()];
        let frame = Frame { center: DVec3::ZERO, scale: 1.0 };
        let wing = drypoint_mesh::Wing { tail: 0, head: 1, left: 2, right: 3 };
        let [a, b, c] = [0, 1, 2].map(|i| positions[i].as_dvec3());
        let normal = (b - a).cross(c - a).normalize();
        let reach = 4f64.powi(rng.i32(0..8));
        let along = (b - a) * (rng.f64() - 0.5) * reach + (c - a) * (rng.f64() - 0.5) * reach;
        for (share, must_be_right) in [(1.01, true), (0.02, false)] {
            let sign = if rng.bool() { 1.0 } else { -1.0 };
            let on_plane = a + along;
            let margin = EdgePlanes::doubt(frame.viewpoint(Viewpoint::at(on_plane)))
                / f64::from(frame.viewpoint(Viewpoint::at(on_plane)).w);
            let viewpoint = Viewpoint::at(on_plane + normal * margin * share * sign);
            let seen = frame.viewpoint(viewpoint);
            let planes = EdgePlanes::new(&positions, &wing, &frame);
            // From beyond this face alone: compared with a face that is always seen from the front.
            let is_front = !EdgePlanes { right: Vec4::ZERO, ..planes }.is_contour(seen);
            if must_be_right {
                assert_eq!(is_front, sign > 0.0, "{positions:?} {viewpoint:?}");
            } else if is_front != (sign > 0.0) {
                mistaken_below += 1;
            }
        }
    }
    assert!(mistaken_below > 100, "{mistaken_below}: the margin is far larger than it has to be");
}

/// All edges of a face decide alike about it: contours close.
#[test]
fn planes_of_a_face_are_the_same_for_each_edge() {
    for shape in shapes::all() {
        let adjacency = MeshAdjacency::new(&shape.mesh);
        let content = Content::without_patches(&shape.mesh, &adjacency, EdgeFilter::All);
        let mut planes = std::collections::BTreeMap::new();
        for (edge, ends) in content.planes.iter().zip(&content.ends) {
            let wing = adjacency.wing(ends.edge);
            for (face, plane) in [(wing.left_face(), edge.left), (wing.right_face(), edge.right)] {
                let mut corners = face;
                corners.sort_unstable();
                let turns = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
                let is_even = turns.iter().any(|turn| turn.map(|i| face[i]) == corners);
                let plane = if is_even { plane } else { -plane };
                let first = *planes.entry(corners).or_insert(plane);
                assert_eq!(first, plane, "{}: {face:?}", shape.name);
            }
        }
    }
}

#[test]
fn content_holds_every_edge_once_and_chunks_do_too() {
    for levels in [Levels::One, Levels::Two] {
        let sets = [2_000, 300].map(|count| patches(&shapes::torus_knot(count), levels));
        let content = Content::new(&[&sets[0], &sets[1]]);
        assert_eq!(content.edge_count() as usize, sets[0].wings().len() + sets[1].wings().len());
        assert_eq!(content.parts[1], content.parts[0].end..content.edge_count());
        for most in [u32::MAX, 1_000, MAX_PIECE] {
            let chunks = content.chunks(most, if most == MAX_PIECE { 3 } else { u32::MAX });
            let mut next = 0;
            for chunk in &chunks {
                assert_eq!(chunk.edges.start, next);
                assert!(chunk.edges.end - chunk.edges.start <= most);
                next = chunk.edges.end;
                let length = chunk.edges.end - chunk.edges.start;
                follow_on(&chunk.patches, length);
                if levels == Levels::Two {
                    follow_on(&chunk.super_patches, chunk.patches.len() as u32);
                }
                let parts: u32 = chunk.parts.iter().map(|(_, edges)| edges.end - edges.start).sum();
                assert_eq!(parts, length);
            }
            assert_eq!(next, content.edge_count());
            let weights = |groups: &dyn Fn(&drypoint_shaders::Chunk) -> Vec<Group>| -> u32 {
                chunks.iter().flat_map(groups).map(|group| group.weight).sum()
            };
            let patches = sets[0].patches().len() + sets[1].patches().len();
            assert_eq!(weights(&|chunk| chunk.patches.clone()) as usize, patches);
            let supers = sets[0].super_patches().len() + sets[1].super_patches().len();
            assert_eq!(weights(&|chunk| chunk.super_patches.clone()) as usize, supers);
        }
    }
}

/// Groups follow one another from 0 to `end`.
#[track_caller]
fn follow_on(groups: &[Group], end: u32) {
    let mut next = 0;
    for group in groups {
        assert_eq!(group.first, next);
        assert!(group.count > 0);
        next += group.count;
    }
    assert_eq!(next, end);
}

/// Viewpoints beside the border of what an ideal cone culls, which the frame holds exactly: where rounding
/// the center anew moves that border by more than arithmetic does.
#[test]
fn bounds_in_the_frame_cull_nothing_that_they_did_not() {
    let mut rng = Rng::with_seed(9);
    let (mut kept, mut culled) = (0, 0);
    for _ in 0..400_000 {
        let mut coordinate = || 2.0 * rng.f64() - 1.0;
        let mut direction = || DVec3::new(coordinate(), coordinate(), coordinate());
        let (axis, aside) = (direction().normalize(), direction());
        let frame = Frame { center: direction().normalize(), scale: 1.0 };
        let center = (direction() * 1e-3).as_vec3();
        let half_angle = rng.f64() * 1.3 + 0.01;
        let (sin, cos) = half_angle.sin_cos();
        let cone = NormalCone { axis, sin, cos };
        let sphere = Sphere { center: center.as_dvec3(), radius: 1e-4 * rng.f64() };
        let bound = DoubleCone::from(SpatializedNormalCone { cone, sphere });
        let apex_distance = sphere.radius / cos;

        let across = (aside - aside.dot(axis) * axis).normalize() * 1e-4 * rng.f64();
        let height = apex_distance + across.length() * half_angle.tan();
        let beyond = if rng.bool() { 0.0 } else { 4e-6 * rng.f64() };
        let on_border = frame.point(sphere.center + (height + beyond) * axis + across);
        let seen = on_border.as_vec3().extend(1.0);
        // Where the ideal cone has the viewpoint that the frame can hold.
        let w = seen.truncate().as_dvec3() - frame.point(sphere.center);
        let height = axis.dot(w).abs();
        let across = (w - axis.dot(w) * axis).length();
        let may_hold =
            height <= apex_distance || height - apex_distance <= half_angle.tan() * across;
        let framed = frame.bound(&bound);
        let survives = framed.may_hold_contour_towards(seen.truncate() - framed.center, 1.0);
        assert!(survives || !may_hold, "{bound:?} {seen}");
        if survives { kept += 1 } else { culled += 1 }
    }
    assert!(
        kept > 100_000 && culled > 1_000,
        "{kept} kept, {culled} culled: not beside the border"
    );
}

/// Corners so far apart that f64 does not hold their differences: its normal may be any, and is not trusted.
#[test]
fn faces_that_f64_does_not_hold_are_doubtful() {
    let far = 1e20;
    let positions = [
        Vec3::new(1.0, 2.0, 0.0),
        Vec3::new(far, far, 0.0),
        Vec3::new(2.0 * far, 2.0 * far, 0.0),
        Vec3::new(far, 0.0, far),
    ];
    let frame = Frame::new(positions);
    let wing = drypoint_mesh::Wing { tail: 0, head: 1, left: 2, right: 3 };
    let planes = EdgePlanes::in_f64(&positions, &wing, &frame);
    assert!(planes[0].is_nan() && EdgePlanes::is_doubtful(&planes, Vec4::new(0.1, 0.2, -0.9, 1.0)));
    // The same without what is too small beside the rest: the left face has no area.
    let near = positions.map(|position| position / far + Vec3::ONE);
    let planes = EdgePlanes::in_f64(&near, &wing, &Frame::new(near));
    assert!(planes[0] == glam::DVec4::ZERO && planes[1].is_finite());
}

#[test]
fn frames_hold_meshes_of_any_size_and_place() {
    for (center, size) in [(0.0, 1.0), (1e6, 3.0), (-1e30, 1e28), (1e-30, 1e-30), (5.0, 0.0)] {
        let positions = [-1.0, 1.0].map(|side| Vec3::splat((center + side * size) as f32));
        let frame = Frame::new(positions);
        let longest = positions.map(|p| frame.point(p.as_dvec3()).abs().max_element());
        assert!(longest.iter().all(|&x| x <= 1.0), "{longest:?}");
        assert!(size == 0.0 || longest[0] > 0.49, "{longest:?}");
        let viewpoint = frame.viewpoint(Viewpoint::at(DVec3::splat(center)));
        assert!(viewpoint.is_finite() && viewpoint.w > 0.0, "{viewpoint}");
    }
    let far = Frame::new([Vec3::ZERO]).viewpoint(Viewpoint::at(DVec3::new(1e60, 0.0, 0.0)));
    assert!(far.is_finite() && far.x > 0.4, "{far}");
    let tiny = Frame::new([Vec3::splat(-1e-30), Vec3::splat(1e-30)]);
    let far = tiny.viewpoint(Viewpoint::at(DVec3::new(0.0, 1e290, 0.0)));
    assert!(far.is_finite() && far.y > 0.4, "{far}");
}
