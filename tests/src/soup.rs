//! Triangles of any kind, spelled by bytes: shared, doubled and collapsed corners, faces without
//! area, T-junctions, coordinates of any size a hair apart; and viewpoints on vertices and in planes.

use std::ops::ControlFlow;

use drypoint_baselines::{AnchoredCones, Meshlets, Snch, SnchParams};
use drypoint_fusion::{Method, PatchSet, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use glam::{DVec3, Vec3};

use crate::compare::Expected;
use crate::judges::Judge;
use crate::{boundary, presets};

/// Most of each in one soup: every extractor is compared on it, for each filter.
const VERTICES: usize = 64;
const TRIANGLES: usize = 48;
const VIEWPOINTS: usize = 12;
/// Most edges that the published method and hierarchies of boxes are tried on: faces that lie upon each
/// other by the dozen have thousands, all of one cost and one box, over which they take seconds.
const EDGES_ALIKE: usize = 300;

/// A mesh, from where it is looked at, and how patches are made of it.
#[derive(Clone, Debug)]
pub struct Soup {
    /// Any triangles.
    pub mesh: Mesh,
    /// At most 12.
    pub viewpoints: Vec<Viewpoint>,
    /// Index of a preset.
    pub preset: usize,
}

impl Soup {
    /// What `bytes` spell. The first byte chooses the preset; then each command is a byte followed
    /// by what it needs, zeros at the end. Any bytes spell something, and a few changed ones
    /// something similar.
    pub fn spelled(bytes: &[u8]) -> Self {
        let mut letters = Letters(bytes);
        let preset = usize::from(letters.next());
        let mut positions: Vec<Vec3> = Vec::new();
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        let mut wishes = Vec::new();
        while !letters.0.is_empty() {
            match letters.next() % 16 {
                letter @ 0..7 if positions.len() < VERTICES => {
                    let vertex = letters.vertex(letter, &positions);
                    positions.push(vertex);
                }
                letter @ 7..12 if triangles.len() < TRIANGLES => {
                    let triangle = letters.triangle(letter, &triangles);
                    triangles.push(triangle);
                }
                letter @ 12.. if wishes.len() < VIEWPOINTS => {
                    wishes.push((letter, letters.take::<6>()));
                }
                _ => {}
            }
        }
        // Corners are named before all vertices are known.
        if positions.is_empty() {
            triangles.clear();
        }
        let count = u32::try_from(positions.len()).expect("they are few");
        for corner in triangles.iter_mut().flatten() {
            *corner %= count;
        }
        let mesh = Mesh::new(positions, triangles).expect("corners are in range, positions finite");
        let viewpoint = |(letter, six)| viewpoint(letter, six, &mesh);
        let viewpoints = wishes.into_iter().map(viewpoint).collect();
        Self { mesh, viewpoints, preset }
    }
}

/// What is left of the bytes.
struct Letters<'a>(&'a [u8]);

impl Letters<'_> {
    fn next(&mut self) -> u8 {
        let [byte] = self.take();
        byte
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (taken, rest) = self.0.split_at(N.min(self.0.len()));
        self.0 = rest;
        std::array::from_fn(|i| taken.get(i).copied().unwrap_or(0))
    }

    fn vertex(&mut self, letter: u8, known: &[Vec3]) -> Vec3 {
        let pick = |byte: u8| match known.len() {
            0 => Vec3::ZERO,
            count => known[usize::from(byte) % count],
        };
        let position = match letter {
            // Small whole numbers, so that much is collinear and coplanar.
            0 | 1 => Vec3::from_array(self.take::<3>().map(|b| f32::from(b.cast_signed() % 8))),
            // From 2⁻¹²⁸ to beyond f32.
            2 => {
                let bytes = self.take::<6>().map(u8::cast_signed);
                let value = |i: usize| f32::from(bytes[i]) * f32::from(bytes[i + 3]).exp2();
                Vec3::new(value(0), value(1), value(2))
            }
            3 => Vec3::from_array([(); 3].map(|()| f32::from_le_bytes(self.take()))),
            // A vertex that is there, and the middle of two.
            4 => pick(self.next()),
            5 => pick(self.next()).midpoint(pick(self.next())),
            // One that is there, but for some steps of f32.
            _ => {
                let [from, axis, steps] = self.take();
                let mut position = pick(from);
                let coordinate = &mut position[usize::from(axis % 3)];
                let bits = coordinate.to_bits().wrapping_add_signed(steps.cast_signed().into());
                *coordinate = f32::from_bits(bits);
                position
            }
        };
        let finite = |x: f32| if x.is_nan() { 0.0 } else { x.clamp(f32::MIN, f32::MAX) };
        Vec3::from_array(position.to_array().map(finite))
    }

    fn triangle(&mut self, letter: u8, known: &[[u32; 3]]) -> [u32; 3] {
        let Some(&[_, b, c]) = known.last().filter(|_| letter > 8) else {
            return self.take::<3>().map(u32::from);
        };
        let byte = self.next();
        let [i, j, k] = known[usize::from(byte) % known.len()];
        match letter {
            // The next of a strip.
            9 => [c, b, byte.into()],
            // One that is there, once more or turned over.
            10 => [i, j, k],
            _ => [k, j, i],
        }
    }
}

fn viewpoint(letter: u8, [kind, x, y, z, ex, ey]: [u8; 6], mesh: &Mesh) -> Viewpoint {
    let [x, y, z] = [x, y, z].map(|b| f64::from(b.cast_signed()));
    let whole = DVec3::new(x, y, z);
    let corners = match mesh.triangles() {
        [] => [DVec3::ZERO; 3],
        some => some[usize::from(kind) % some.len()].map(|v| mesh.position(v).as_dvec3()),
    };
    let [a, b, c] = corners;
    let (u, v) = (b - a, c - a);
    match (letter, kind % 4) {
        // As small or as large as a viewpoint may be.
        (12, 0 | 1) => Viewpoint::at(whole / 4.0),
        (12, _) => {
            let [ex, ey] = [ex, ey].map(|e| (1.4 * f64::from(e.cast_signed())).exp2());
            Viewpoint::at(DVec3::new(x * ex, y * ey, z * ex))
        }
        // In the plane of a face, where f64 can hold that; on a vertex.
        (13, _) => Viewpoint::at(a + x / 4.0 * u + y / 4.0 * v),
        // Off it by little.
        (14, _) => {
            let hair = (f64::from(ex) / -4.0).exp2() * z;
            Viewpoint::at(a + x / 4.0 * u + y / 4.0 * v + hair * u.cross(v).normalize_or_zero())
        }
        (_, 0 | 1) => Viewpoint::from_direction(whole),
        // Along a face.
        _ => Viewpoint::from_direction(x * u + y * v),
    }
}

/// Compares every extractor with the definition on what `bytes` spell: the brute forces, patches of
/// one preset and the baselines, with each instruction set and both filters; and patches from their
/// cull boundaries.
///
/// # Panics
/// Where one disagrees.
pub fn check(bytes: &[u8]) {
    let Soup { mesh, viewpoints, preset } = Soup::spelled(bytes);
    let adjacency = MeshAdjacency::new(&mesh);
    for filter in [EdgeFilter::Convex, EdgeFilter::All] {
        let expected = Expected::new(&mesh, &adjacency, filter, &viewpoints);
        let expected = expected.unwrap_or_else(|wrong| panic!("{filter:?}: {wrong}"));
        let edges = adjacency.edges(filter).count();
        let mut presets = presets::for_edges(edges);
        presets.retain(|(_, params)| {
            edges <= EDGES_ALIKE || matches!(params.method, Method::Planes { .. })
        });
        let (name, params) = presets[preset % presets.len()];
        let set = fuse(&mesh, &adjacency, filter, &params, &|_| ControlFlow::Continue(()));
        let set = set.expect("presets are possible");
        let agreed = expected.compare(&set);
        agreed.unwrap_or_else(|wrong| panic!("{filter:?}, {name}: {wrong}"));
        set.validate().unwrap_or_else(|wrong| panic!("{filter:?}, {name}: {wrong}"));
        let matched = set.validate_against(&mesh, &adjacency);
        matched.unwrap_or_else(|wrong| panic!("{filter:?}, {name}: {wrong}"));
        let loaded = PatchSet::from_bytes(&set.to_bytes());
        assert!(loaded.is_ok_and(|loaded| loaded == set), "{name} is another when loaded");
        boundary::look(&set, 0).unwrap_or_else(|lost| panic!("{filter:?}, {name}: {lost:?}"));
        let single = SnchParams { edges_per_leaf: 1 };
        let agree = |name, judge: &dyn Judge| {
            let agreed = expected.agreement(name, judge);
            agreed.unwrap_or_else(|wrong| panic!("{filter:?}: {wrong}"));
        };
        if edges <= EDGES_ALIKE {
            agree("snch", &Snch::new(&mesh, &adjacency, filter, &SnchParams::default()));
            agree("snch-single", &Snch::new(&mesh, &adjacency, filter, &single));
        }
        agree("cones", &AnchoredCones::new(&mesh, &adjacency, filter, &Default::default()));
        agree("meshlets", &Meshlets::new(&mesh, &adjacency, filter, &Default::default()));
    }
}
