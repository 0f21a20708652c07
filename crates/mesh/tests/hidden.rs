//! `EdgeFilter::Convex` drops nothing that can be seen: on closed surfaces without
//! self-intersection, from anywhere but inside the solid.

#[path = "oracle/exact.rs"]
mod exact;

use drypoint_mesh::{EdgeClass, EdgeFilter, Mesh, MeshAdjacency, Viewpoint, contour_edges, shapes};
use exact::side;
use glam::{DVec3, I64Vec3, Vec3};
use proptest::prelude::*;

/// Unit cubes of a 3 × 3 × 3 block, one bit each, sheared so that no face need be axis-aligned.
#[derive(Clone, Copy, Debug)]
struct Solid {
    cells: u32,
    /// Columns of a matrix of determinant 1.
    axes: [I64Vec3; 3],
}

impl Solid {
    fn is_filled(&self, cell: I64Vec3) -> bool {
        let [x, y, z] = cell.to_array();
        [x, y, z].iter().all(|c| (0..3).contains(c)) && self.cells >> (x + 3 * y + 9 * z) & 1 == 1
    }

    fn sheared(&self, point: DVec3) -> DVec3 {
        let [x, y, z] = self.axes.map(|axis| axis.as_dvec3());
        point.x * x + point.y * y + point.z * z
    }

    /// Whether a ball around the point is filled. In halves of a cell.
    fn is_inside(&self, halves: I64Vec3) -> bool {
        let [x, y, z] = halves.to_array().map(|h| (h - 1).div_euclid(2)..=h.div_euclid(2));
        let touched = x.flat_map(|x| y.clone().map(move |y| (x, y)));
        let mut touched = touched.flat_map(|(x, y)| z.clone().map(move |z| I64Vec3::new(x, y, z)));
        touched.all(|cell| self.is_filled(cell))
    }

    /// What the filter drops, seen from a point given in halves of a cell: contour edges, and those
    /// of them that nothing covers. `None` inside.
    fn dropped_and_bare(&self, mesh: &Mesh, halves: I64Vec3) -> Option<(usize, usize)> {
        let eye = self.sheared(0.5 * halves.as_dvec3());
        (!self.is_inside(halves)).then(|| dropped_and_bare(mesh, eye))
    }

    /// The surface: two triangles for each side of a filled cell next to an empty one.
    fn mesh(&self) -> Mesh {
        let units = [I64Vec3::X, I64Vec3::Y, I64Vec3::Z];
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for index in 0..27 {
            let cell = I64Vec3::new(index % 3, index / 3 % 3, index / 9);
            for (axis, sign) in (0..3).flat_map(|axis| [(axis, 1), (axis, -1)]) {
                if !self.is_filled(cell) || self.is_filled(cell + sign * units[axis]) {
                    continue;
                }
                let (u, v) = (units[(axis + 1) % 3], units[(axis + 2) % 3]);
                let start = if sign > 0 { cell + units[axis] } else { cell };
                let corners = [start, start + u, start + u + v, start + v];
                let first = u32::try_from(positions.len()).unwrap();
                positions.extend(corners.map(|p| self.sheared(p.as_dvec3()).as_vec3()));
                let order = if sign > 0 { [0, 1, 2, 3] } else { [0, 3, 2, 1] };
                let [a, b, c, d] = order.map(|corner| first + corner);
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        Mesh::new(positions, triangles).unwrap()
    }
}

/// Whether a face covers `target` seen from `eye`: meets the segment between them before its end,
/// exactly, rims included.
fn is_covered(mesh: &Mesh, eye: DVec3, target: DVec3) -> bool {
    mesh.triangles().iter().any(|t| {
        let [a, b, c] = t.map(|v| mesh.position(v).as_dvec3());
        let [at_eye, at_target] = [eye, target].map(|p| side([a, b, c], p));
        let turns = [[a, b], [b, c], [c, a]].map(|[p, q]| side([eye, target, p], q));
        at_target != 0
            && at_eye * at_target <= 0
            && (turns.iter().all(|&s| s >= 0) || turns.iter().all(|&s| s <= 0))
    })
}

/// Contour edges that the filter drops, and how many of them nothing covers.
fn dropped_and_bare(mesh: &Mesh, eye: DVec3) -> (usize, usize) {
    let adjacency = MeshAdjacency::new(mesh);
    let mut contours = Vec::new();
    contour_edges(mesh, &adjacency, Viewpoint::at(eye), EdgeFilter::All, &mut contours);
    contours.retain(|&edge| !adjacency.keeps(edge, EdgeFilter::Convex));
    let is_bare = |edge| {
        let [p, q] = adjacency.wing(edge).ends().map(|v| mesh.position(v).as_dvec3());
        // At the middle, and near both ends.
        [0.5, 0.0625, 0.9375].iter().any(|t| !is_covered(mesh, eye, p + *t * (q - p)))
    };
    (contours.len(), contours.iter().filter(|&&edge| is_bare(edge)).count())
}

const UPRIGHT: [I64Vec3; 3] = [I64Vec3::X, I64Vec3::Y, I64Vec3::Z];

#[test]
fn concave_contours_are_covered() {
    // An L of three cubes, a U of five, and a block of eight without one.
    for cells in [0b1011, 0b10_1111, 0b1011 << 9 | 0b1_1011] {
        for axes in [UPRIGHT, [I64Vec3::X, I64Vec3::new(2, 1, 0), I64Vec3::new(-1, 3, 1)]] {
            let solid = Solid { cells, axes };
            let mesh = solid.mesh();
            let eyes = (0..11 * 11 * 11).map(|i| I64Vec3::new(i % 11, i / 11 % 11, i / 121) - 3);
            let (mut dropped, mut views) = (0, 0);
            for eye in eyes {
                let Some(found) = solid.dropped_and_bare(&mesh, eye) else { continue };
                assert_eq!(found.1, 0, "{solid:?} from {eye} halves");
                dropped += found.0;
                views += 1;
            }
            assert!(dropped > views / 10, "{dropped} edges in {views} views: nothing was tested");
        }
    }
}

/// Products of shears.
fn axes() -> impl Strategy<Value = [I64Vec3; 3]> {
    prop::collection::vec((0usize..3, 1usize..3, -2i64..3), 0..4).prop_map(|shears| {
        let mut axes = UPRIGHT;
        for (to, step, times) in shears {
            axes[to] += times * axes[(to + step) % 3];
        }
        axes
    })
}

fn eye() -> impl Strategy<Value = I64Vec3> {
    [-6i64..13, -6i64..13, -6i64..13].prop_map(I64Vec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn what_the_filter_drops_is_covered(
        cells in any::<u32>(), fewer in any::<u32>(), axes in axes(),
        eyes in prop::collection::vec(eye(), 6),
    ) {
        for cells in [cells, cells & fewer] {
            let solid = Solid { cells, axes };
            let mesh = solid.mesh();
            for &eye in &eyes {
                let bare = solid.dropped_and_bare(&mesh, eye).map_or(0, |(_, bare)| bare);
                prop_assert_eq!(bare, 0, "{:?} from {} halves", solid, eye);
            }
        }
    }
}

#[test]
fn folds_are_seen_and_kept() {
    let fold = shapes::folded_sheet();
    for eye in [DVec3::new(0.5, 0.5, 1.0), DVec3::new(-3.0, 9.0, -0.01)] {
        assert_eq!(dropped_and_bare(&fold, eye), (0, 0));
    }
    assert_eq!(MeshAdjacency::new(&fold).edges(EdgeFilter::Convex).count(), 3);
}

#[test]
fn an_open_valley_can_be_seen_past_its_back() {
    // Two sheets that meet in a valley along the z axis, and an eye under the steeper one.
    let corners = [Vec3::ZERO, Vec3::Z, Vec3::new(-1.0, 0.0, 0.0), Vec3::new(1.0, 1.0, 0.0)];
    let mesh = Mesh::new(corners.into(), vec![[1, 0, 2], [0, 1, 3]]).unwrap();
    let adjacency = MeshAdjacency::new(&mesh);
    let valley = adjacency.edges(EdgeFilter::All).next().unwrap();
    assert_eq!(adjacency.class(valley), EdgeClass::Concave);
    assert_eq!(dropped_and_bare(&mesh, DVec3::new(2.0, 1.0, 0.5)), (1, 1));
}
