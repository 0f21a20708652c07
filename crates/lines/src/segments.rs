//! Which edges are drawn, and as what.

use std::f64::consts::FRAC_PI_2;

use drypoint_mesh::{EdgeClass, EdgeId, Mesh, MeshAdjacency, dihedral_angle};

/// Why an edge is drawn. An edge with several reasons is drawn once, for the first of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineClass {
    /// One face towards the viewer, one away.
    Contour,
    /// The surface ends: an edge of one face.
    Boundary,
    /// The surface bends sharply, in any view.
    Crease,
}

impl LineClass {
    /// Every class, in the order in which one wins over the next.
    pub const ALL: [Self; 3] = [Self::Contour, Self::Boundary, Self::Crease];

    /// `contour`, `boundary` or `crease`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Contour => "contour",
            Self::Boundary => "boundary",
            Self::Crease => "crease",
        }
    }
}

/// Which lines to draw beside the contours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineOptions {
    /// Draws edges of one face.
    pub boundary: bool,
    /// Draws interior edges whose dihedral angle is at least this, in radians, either way. 0 draws
    /// all that are not flat.
    pub crease_angle: Option<f64>,
}

/// A straight piece of line: an edge of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Its ends as welded vertices, in the direction of the wing.
    pub ends: [u32; 2],
    /// The edge; the first of its wings if it is non-manifold.
    pub edge: EdgeId,
}

/// The edges to draw in one view, by class. None twice, none of length zero, each list by edge id.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Segments {
    contour: Vec<Segment>,
    boundary: Vec<Segment>,
    crease: Vec<Segment>,
}

impl Segments {
    /// Takes `contours` as they are, in any order, and adds boundary edges and creases as `options`
    /// ask. An edge is drawn once: as a contour rather than as a boundary rather than as a crease,
    /// and the wings of a non-manifold edge are one line. Linear but for a sort of what is drawn.
    ///
    /// At a non-manifold edge a face and its own copy count as one: they are a contour from
    /// everywhere, but a surface that is stored twice should look like one that is stored once.
    ///
    /// Without `contours`, creases that are contours in this view are creases.
    ///
    /// # Panics
    /// If an edge is not one of `adjacency`.
    pub fn new(
        mesh: &Mesh,
        adjacency: &MeshAdjacency,
        contours: &[EdgeId],
        options: &LineOptions,
    ) -> Self {
        let others = options.boundary || options.crease_angle.is_some();
        let candidates = others.then(|| adjacency.edge_ids()).into_iter().flatten();
        let others = candidates.filter_map(|edge| match (adjacency.class(edge), options) {
            (EdgeClass::Boundary, options) => {
                options.boundary.then_some((LineClass::Boundary, edge))
            }
            (class, LineOptions { crease_angle: Some(least), .. }) => {
                let angle = dihedral_angle(mesh, &adjacency.wing(edge)).abs();
                // A flat edge bends by 0, or by π where the surface folds back upon itself.
                let bends = class != EdgeClass::Flat || angle > FRAC_PI_2;
                (bends && angle >= *least).then_some((LineClass::Crease, edge))
            }
            _ => None,
        });
        let is_copy = |edge: EdgeId| {
            let wing = adjacency.wing(edge);
            adjacency.class(edge) == EdgeClass::NonManifold && wing.left == wing.right
        };
        let mut lines: Vec<_> = contours
            .iter()
            .map(|&edge| (LineClass::Contour, edge))
            .chain(others)
            .filter(|&(_, edge)| !is_copy(edge))
            .map(|(class, edge)| (adjacency.wing(edge).ends(), class, edge))
            .collect();
        lines.sort_unstable();
        lines.dedup_by_key(|line| line.0);
        lines.sort_unstable_by_key(|line| line.2);

        let mut segments = Self::default();
        for (_, class, edge) in lines {
            let wing = adjacency.wing(edge);
            let segment = Segment { ends: [wing.tail, wing.head], edge };
            match class {
                LineClass::Contour => segments.contour.push(segment),
                LineClass::Boundary => segments.boundary.push(segment),
                LineClass::Crease => segments.crease.push(segment),
            }
        }
        segments
    }

    /// The segments of one class, by edge id.
    pub fn of(&self, class: LineClass) -> &[Segment] {
        match class {
            LineClass::Contour => &self.contour,
            LineClass::Boundary => &self.boundary,
            LineClass::Crease => &self.crease,
        }
    }
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::{EdgeFilter, Viewpoint, contour_edges, shapes};
    use glam::DVec3;

    use super::*;

    const ALL: LineOptions = LineOptions { boundary: true, crease_angle: Some(1.0) };

    /// Counts of contours, boundaries and creases, seen from (9, 9, 9).
    #[track_caller]
    fn check(mesh: &Mesh, options: LineOptions, expected: [usize; 3]) {
        let adjacency = MeshAdjacency::new(mesh);
        let mut contours = Vec::new();
        let viewpoint = Viewpoint::at(DVec3::splat(9.0));
        contour_edges(mesh, &adjacency, viewpoint, EdgeFilter::All, &mut contours);
        let segments = Segments::new(mesh, &adjacency, &contours, &options);
        assert_eq!(LineClass::ALL.map(|class| segments.of(class).len()), expected);
        let mut drawn: Vec<[u32; 2]> = Vec::new();
        for class in LineClass::ALL {
            assert!(segments.of(class).is_sorted_by_key(|segment| segment.edge));
            for &Segment { ends, edge } in segments.of(class) {
                assert_eq!(ends, [adjacency.wing(edge).tail, adjacency.wing(edge).head]);
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
    fn an_edge_is_drawn_once_for_its_first_reason() {
        let cube = shapes::cube();
        check(&cube, LineOptions::default(), [6, 0, 0]);
        check(&cube, ALL, [6, 0, 6]);
        check(&cube, LineOptions { crease_angle: Some(0.0), ..ALL }, [6, 0, 6]);
        check(&cube, LineOptions { crease_angle: Some(1.6), ..ALL }, [6, 0, 0]);
        check(&shapes::one_triangle(), ALL, [0, 3, 0]);
        check(&shapes::one_triangle(), LineOptions { boundary: false, ..ALL }, [0, 0, 0]);
        check(&shapes::empty(), ALL, [0, 0, 0]);
    }

    #[test]
    fn several_wings_are_one_line() {
        // Of the 23 edges the common one parts the front of one cube from the back of the other.
        check(&shapes::cubes_sharing_an_edge(), ALL, [13, 0, 10]);
        check(&shapes::book(5), ALL, [1, 10, 0]);
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
        check(&shapes::zero_area_fan(), ALL, [0, 10, 0]);
    }
}
