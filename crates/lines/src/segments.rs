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
        let mut lines: Vec<_> = contours
            .iter()
            .map(|&edge| (LineClass::Contour, edge))
            .chain(others)
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
