//! Which lines are drawn, and as what.

use std::f64::consts::FRAC_PI_2;

use drypoint_mesh::{EdgeClass, EdgeId, HalfEdge, Mesh, MeshAdjacency, dihedral_angle};
use glam::DVec3;

use crate::{LineClass, LineOptions};

/// A straight piece of line: an edge of the mesh, or a piece of where two of its faces cross.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Its ends, which [`Segments::position`] places. Those of an edge are welded vertices, in the
    /// direction of the wing; others are numbered from the number of vertices on.
    pub ends: [u32; 2],
    /// The faces that it lies in: those on the left and the right of an edge, of a boundary edge one
    /// of them twice; or the two that cross.
    pub faces: [u32; 2],
    /// The edge; of a non-manifold one the first wing of the class that it is drawn as. `None` where faces cross.
    pub edge: Option<EdgeId>,
}

impl Segment {
    fn along(adjacency: &MeshAdjacency, edge: EdgeId) -> Self {
        let wing = adjacency.wing(edge);
        let [left, right] = adjacency.sides(edge);
        let right = if right == HalfEdge::NONE { left } else { right };
        let faces = [left, right].map(HalfEdge::triangle);
        Self { ends: [wing.tail, wing.head], faces, edge: Some(edge) }
    }
}

/// The lines to draw in one view, by class: edges by id and none twice, then what is no edge.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Segments {
    /// In the order of [`LineClass::ALL`].
    by_class: [Vec<Segment>; LineClass::ALL.len()],
    /// Number of vertices.
    first_point: u32,
    /// The ends that are no vertices.
    points: Vec<DVec3>,
}

impl Segments {
    /// Takes `contours` as they are, in any order, and adds the other lines as `options` ask. An
    /// edge is drawn once, for the first reason in the order of [`LineClass::ALL`], and the wings of
    /// a non-manifold edge are one line; none has length zero. Intersections that run along an edge
    /// which is drawn are left out. Linear but for a sort of what is drawn, and a search in the runs
    /// of materials for each edge.
    ///
    /// A face and its own copy count as one: they are a contour from everywhere, but a surface that is
    /// stored several times should look like one that is stored once. Where it ends, it has a boundary.
    ///
    /// Without `contours`, creases that are contours in this view are creases.
    ///
    /// # Panics
    /// If an edge is not one of `adjacency`.
    pub fn new(
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
        contours: &[EdgeId],
        options: &LineOptions<'_>,
    ) -> Self {
        let looked_at = LineOptions { intersections: None, ..*options } != LineOptions::default();
        let candidates = looked_at.then(|| adjacency.edge_ids()).into_iter().flatten();
        let copies = Copies::new(adjacency);
        let others = candidates.filter_map(|edge| {
            if copies.is_copy(edge) {
                let is_end = options.boundary && copies.is_end(edge);
                return is_end.then_some((LineClass::Boundary, edge));
            }
            Some((class_of(mesh, adjacency, edge, options)?, edge))
        });
        let mut lines: Vec<_> = contours
            .iter()
            .filter(|&&edge| !copies.is_copy(edge))
            .map(|&edge| (LineClass::Contour, edge))
            .chain(others)
            .map(|(class, edge)| (adjacency.wing(edge).ends(), class, edge))
            .collect();
        lines.sort_unstable();
        lines.dedup_by_key(|line| line.0);

        let mut segments = Self { first_point: vertex_count(mesh), ..Self::default() };
        if let Some(intersections) = options.intersections {
            let is_drawn = |edge| lines.binary_search_by_key(&edge, |line| line.0).is_ok();
            let apart = intersections.segments(segments.first_point);
            let apart = apart.filter(|(_, edges)| !edges.iter().flatten().any(|&e| is_drawn(e)));
            segments.by_class[LineClass::Intersection as usize].extend(apart.map(|(s, _)| s));
            segments.points = intersections.points().to_vec();
        }
        lines.sort_unstable_by_key(|line| line.2);
        for (_, class, edge) in lines {
            segments.by_class[class as usize].push(Segment::along(adjacency, edge));
        }
        segments
    }

    /// The segments of one class: edges by id, intersections by the faces that cross.
    pub fn of(&self, class: LineClass) -> &[Segment] {
        &self.by_class[class as usize]
    }

    /// Where an end of a segment is.
    ///
    /// # Panics
    /// If `end` is not one of a segment, or `mesh` another than the lines were found in.
    pub fn position(&self, mesh: &Mesh, end: u32) -> DVec3 {
        match end.checked_sub(self.first_point) {
            Some(point) => self.points[point as usize],
            None => mesh.position(end).as_dvec3(),
        }
    }
}

/// Edges between a face and its own copy, which is how a surface that is stored several times ends.
struct Copies<'a> {
    adjacency: &'a MeshAdjacency,
    /// Edges of three faces or more at which different faces meet, sorted.
    joints: Vec<[u32; 2]>,
}

impl<'a> Copies<'a> {
    /// Linear, where there is an edge of three faces or more.
    fn new(adjacency: &'a MeshAdjacency) -> Self {
        let mut copies = Self { adjacency, joints: Vec::new() };
        if adjacency.report().non_manifold > 0 {
            let is_joint = |&edge: &EdgeId| {
                adjacency.class(edge) == EdgeClass::NonManifold && !copies.is_copy(edge)
            };
            let joints = adjacency.edge_ids().filter(is_joint);
            copies.joints = joints.map(|edge| adjacency.wing(edge).ends()).collect();
            copies.joints.sort_unstable();
        }
        copies
    }

    /// Whether a wing has one face on both sides, stored twice and wound alike, or among others.
    fn is_copy(&self, edge: EdgeId) -> bool {
        let wing = self.adjacency.wing(edge);
        let class = self.adjacency.class(edge);
        wing.left == wing.right
            && [EdgeClass::NonManifold, EdgeClass::Inconsistent].contains(&class)
    }

    /// Whether no other face meets the copies there.
    fn is_end(&self, edge: EdgeId) -> bool {
        self.joints.binary_search(&self.adjacency.wing(edge).ends()).is_err()
    }
}

/// The number of vertices, which triangles index.
fn vertex_count(mesh: &Mesh) -> u32 {
    u32::try_from(mesh.positions().len()).unwrap_or(u32::MAX)
}

/// Why an edge is drawn in any view.
fn class_of(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    edge: EdgeId,
    options: &LineOptions<'_>,
) -> Option<LineClass> {
    let class = adjacency.class(edge);
    if class == EdgeClass::Boundary {
        return options.boundary.then_some(LineClass::Boundary);
    }
    if let Some(materials) = options.materials {
        let [left, right] = adjacency.sides(edge).map(|side| materials.of(side.triangle()));
        if left != right {
            return Some(LineClass::Material);
        }
    }
    let least = options.crease_angle?;
    let angle = dihedral_angle(mesh, &adjacency.wing(edge)).abs();
    // A flat edge bends by 0, or by π where the surface folds back upon itself.
    let bends = class != EdgeClass::Flat || angle > FRAC_PI_2;
    (bends && angle >= least).then_some(LineClass::Crease)
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::{EdgeFilter, Viewpoint, contour_edges, shapes};
    use glam::DVec3;

    use super::*;
    use crate::FaceNames;

    const ALL: LineOptions<'_> = LineOptions {
        boundary: true,
        crease_angle: Some(1.0),
        materials: None,
        intersections: None,
    };

    /// Counts of contours, boundaries, creases and borders of materials, seen from (9, 9, 9).
    #[track_caller]
    fn check(mesh: &Mesh, options: LineOptions<'_>, expected: [usize; 4]) {
        let adjacency = MeshAdjacency::new(mesh);
        let mut contours = Vec::new();
        let viewpoint = Viewpoint::at(DVec3::splat(9.0));
        contour_edges(mesh, &adjacency, viewpoint, EdgeFilter::All, &mut contours);
        let segments = Segments::new(mesh, &adjacency, &contours, &options);
        let counts =
            [LineClass::Contour, LineClass::Boundary, LineClass::Crease, LineClass::Material];
        assert_eq!(counts.map(|class| segments.of(class).len()), expected);
        let mut drawn: Vec<[u32; 2]> = Vec::new();
        for class in LineClass::ALL {
            assert!(segments.of(class).is_sorted_by_key(|segment| segment.edge));
            for &Segment { ends, faces, edge } in segments.of(class) {
                let wing = adjacency.wing(edge.unwrap());
                assert_eq!(ends, [wing.tail, wing.head]);
                for face in faces {
                    let corners = mesh.triangles()[face as usize];
                    let welded = corners.map(|v| adjacency.representatives()[v as usize]);
                    assert!(ends.iter().all(|end| welded.contains(end)));
                }
                assert_ne!(mesh.position(ends[0]), mesh.position(ends[1]));
                drawn.push([ends[0].min(ends[1]), ends[0].max(ends[1])]);
            }
        }
        let count = drawn.len();
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn.len(), count, "an edge is drawn twice");
    }

    #[test]
    fn a_surface_that_is_stored_several_times_looks_like_one() {
        let sheet = shapes::open_grid(18);
        for mesh in [shapes::one_triangle(), shapes::cube(), sheet] {
            let once = |options| {
                let adjacency = MeshAdjacency::new(&mesh);
                let mut contours = Vec::new();
                let viewpoint = Viewpoint::at(DVec3::splat(9.0));
                contour_edges(&mesh, &adjacency, viewpoint, EdgeFilter::All, &mut contours);
                let segments = Segments::new(&mesh, &adjacency, &contours, &options);
                let classes = [
                    LineClass::Contour,
                    LineClass::Boundary,
                    LineClass::Crease,
                    LineClass::Material,
                ];
                classes.map(|class| segments.of(class).len())
            };
            for times in 2..5 {
                let triangles = vec![mesh.triangles(); times].concat();
                let copied = Mesh::new(mesh.positions().to_vec(), triangles).unwrap();
                for options in [ALL, LineOptions { boundary: false, ..ALL }] {
                    check(&copied, options, once(options));
                }
            }
        }
    }

    #[test]
    fn an_edge_is_drawn_once_for_its_first_reason() {
        let cube = shapes::cube();
        check(&cube, LineOptions::default(), [6, 0, 0, 0]);
        check(&cube, ALL, [6, 0, 6, 0]);
        check(&cube, LineOptions { crease_angle: Some(0.0), ..ALL }, [6, 0, 6, 0]);
        check(&cube, LineOptions { crease_angle: Some(1.6), ..ALL }, [6, 0, 0, 0]);
        check(&shapes::one_triangle(), ALL, [0, 3, 0, 0]);
        check(&shapes::one_triangle(), LineOptions { boundary: false, ..ALL }, [0, 0, 0, 0]);
        check(&shapes::empty(), ALL, [0, 0, 0, 0]);
    }

    #[test]
    fn several_wings_are_one_line() {
        // Of the 23 edges the common one parts the front of one cube from the back of the other.
        check(&shapes::cubes_sharing_an_edge(), ALL, [13, 0, 10, 0]);
        check(&shapes::book(5), ALL, [1, 10, 0, 0]);
    }

    #[test]
    fn a_fold_is_a_crease() {
        let mesh = shapes::folded_sheet();
        let adjacency = MeshAdjacency::new(&mesh);
        let segments = Segments::new(&mesh, &adjacency, &[], &ALL);
        assert_eq!(segments.of(LineClass::Crease).len(), 3);
    }

    #[test]
    fn no_line_has_length_zero() {
        check(&shapes::zero_area_fan(), ALL, [0, 10, 0, 0]);
    }

    #[test]
    fn two_materials_have_a_border() {
        let cube = shapes::cube();
        let is_top = |face: u32| cube.corners(face).iter().all(|p| p.z == 1.0);
        let top = FaceNames::new((0..12).filter(|&f| is_top(f)).map(|f| ("red", f..f + 1)));
        let materials = LineOptions { materials: Some(&top), ..LineOptions::default() };
        let adjacency = MeshAdjacency::new(&cube);
        let alone = Segments::new(&cube, &adjacency, &[], &materials);
        assert_eq!(alone.of(LineClass::Material).len(), 4);
        // Contours come first, creases last.
        check(&cube, materials, [6, 0, 0, 2]);
        check(&cube, LineOptions { materials: Some(&top), ..ALL }, [6, 0, 4, 2]);
        let one = FaceNames::new([("red", 0..6), ("red", 6..12)]);
        check(&cube, LineOptions { materials: Some(&one), ..ALL }, [6, 0, 6, 0]);
        // The spine of a book, and an edge between two faces in one plane.
        let pages = FaceNames::new([("red", 0..4), ("blue", 4..5)]);
        let materials = LineOptions { materials: Some(&pages), ..ALL };
        check(&shapes::book(5), materials, [1, 10, 0, 0]);
        let book = shapes::book(5);
        let unseen = Segments::new(&book, &MeshAdjacency::new(&book), &[], &materials);
        assert_eq!(unseen.of(LineClass::Material).len(), 1);
        let grid = shapes::open_grid(2);
        let halves = FaceNames::new([("", 0..1), ("blue", 1..2)]);
        check(&grid, LineOptions { materials: Some(&halves), ..ALL }, [0, 4, 0, 1]);
    }
}
