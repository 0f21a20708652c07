//! Why lines are drawn, and which are asked for.

use crate::{FaceNames, Intersections};

/// Why a line is drawn. An edge with several reasons is drawn once, for the first of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LineClass {
    /// One face towards the viewer, one away.
    Contour,
    /// The surface ends: an edge of one face.
    Boundary,
    /// Two materials meet. It comes before a crease, because a border that leaves the crease it runs
    /// along would else change its class with every bend of the surface.
    Material,
    /// The surface bends sharply, in any view.
    Crease,
    /// Surfaces pass through each other, with no edge there.
    Intersection,
}

impl LineClass {
    /// Every class, in the order in which one wins over the next.
    pub const ALL: [Self; 5] =
        [Self::Contour, Self::Boundary, Self::Material, Self::Crease, Self::Intersection];

    /// `contour`, `boundary`, `material`, `crease` or `intersection`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Contour => "contour",
            Self::Boundary => "boundary",
            Self::Material => "material",
            Self::Crease => "crease",
            Self::Intersection => "intersection",
        }
    }
}

/// Which lines to draw beside the contours: none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineOptions<'a> {
    /// Draws edges of one face.
    pub boundary: bool,
    /// Draws interior edges whose dihedral angle is at least this, in radians, either way. 0 draws
    /// all that are not flat.
    pub crease_angle: Option<f64>,
    /// Draws edges between faces whose material has another name; of an edge of three faces or more
    /// if any two do.
    pub materials: Option<&'a FaceNames>,
    /// Draws these, which must be of the same mesh.
    pub intersections: Option<&'a Intersections>,
}
