//! What a view costs, and from where it is taken.

use drypoint_bounds::DoubleCone;

/// What a patch costs, in the time that one edge test takes: with t_P, t_A, a block of b edges, ξ
/// edges, and the probability H that the patch survives,
///
/// ```text
/// E = t_P + H (t_A + b ⌈ξ / b⌉)
/// ```
///
/// With t_A = 0 and b = 1 it is that of Tsiapkolis and Bénard (CGF 2024, §3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// t_P: time of one patch test, in edge tests; above 0. More makes patches larger.
    pub patch_test: f64,
    /// t_A: what a survivor costs beside its edges, in edge tests; 0 or more. It is what starting a
    /// loop, a workgroup or a branch that was guessed wrong costs. More makes patches larger.
    pub accepted_patch: f64,
    /// b: edges that the runtime tests at once, from 1; 0 counts as 1. A survivor costs whole
    /// blocks.
    pub block: u32,
    /// Most edges that a patch may hold, at least 1: a hard limit, unless it is `u32::MAX`.
    pub max_edges: u32,
    /// Most distinct vertices that the edges of a patch may end at, at least 2: a hard limit, unless
    /// it is `u32::MAX`.
    pub max_vertices: u32,
}

impl CostModel {
    /// As Tsiapkolis and Bénard measured it on their GPU (CGF 2024, §4.2).
    pub const PAPER: Self = Self {
        patch_test: 1.363,
        accepted_patch: 0.0,
        block: 1,
        max_edges: u32::MAX,
        max_vertices: u32::MAX,
    };

    /// The scalar reference path of `drypoint-cpu`, as measured on the bunny and the dragon: exact
    /// predicates make an edge test dear.
    pub const CPU_SCALAR: Self = Self { patch_test: 0.13, accepted_patch: 5.0, ..Self::PAPER };

    /// `drypoint-cpu`'s `Extractor`, found by trying on the bunny and the dragon with AVX-512. Most of t_A
    /// is a survivor's last block of 16 edges, which is half empty on average; counted so, and not by
    /// whole blocks, it lets edges move from patch to patch one by one.
    pub const CPU_SIMD: Self = Self { patch_test: 2.0, accepted_patch: 6.0, ..Self::PAPER };

    /// `drypoint-wgpu`, from what its shaders read. A patch test reads 48 bytes and an edge test 32, once each and in
    /// the order of memory, hence t_P; the paper measured 1.363. Edges of all survivors of a workgroup are dealt out to
    /// its lanes one after the other, so that no block is left half empty, and a survivor costs nothing beside its
    /// edges. Another 16 bytes are read for a contour edge, which is the same for any patches. On an NVIDIA H200 a
    /// patch test takes as long as 3.5 edge tests, but patches for that are no faster (`docs/experiments.md`).
    pub const GPU: Self = Self { patch_test: 48.0 / 32.0, ..Self::PAPER };

    /// For a mesh workgroup of its own for each survivor, which emits at most 64 vertices and 126 primitives
    /// (Tsiapkolis and Bénard, CGF 2024, §4.4). `drypoint-ash` shares workgroups out among survivors and is
    /// better off with [`CostModel::GPU`].
    pub const MESH_SHADER: Self =
        Self { block: 32, accepted_patch: 4.0, max_edges: 126, max_vertices: 64, ..Self::PAPER };

    /// Cost E of a patch of `edges` edges that survives with probability `acceptance`, in edge
    /// tests.
    pub fn patch(&self, acceptance: f64, edges: usize) -> f64 {
        let block = self.block.max(1) as usize;
        let tested = block * edges.div_ceil(block);
        self.patch_test + acceptance * (self.accepted_patch + tested as f64)
    }

    /// Whether a patch may hold that many edges, which end at that many vertices.
    pub fn admits(&self, edges: usize, vertices: usize) -> bool {
        let is_within = |count: usize, most: u32| most == u32::MAX || count <= most as usize;
        is_within(edges, self.max_edges.max(1)) && is_within(vertices, self.max_vertices.max(2))
    }
}

/// Number of distances in a [`ViewProfile`].
pub const VIEW_DISTANCES: usize = 4;

/// From how far away a mesh is looked at: a distribution of distances from the center of a patch,
/// and any direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewProfile {
    /// In units of half the longest side of the mesh's box, above 0.
    pub distances: [f64; VIEW_DISTANCES],
    /// How often each is taken, 0 or more; they sum up to 1.
    pub weights: [f64; VIEW_DISTANCES],
}

impl ViewProfile {
    /// The one distance for which Tsiapkolis and Bénard tune patches (CGF 2024, §4.2).
    pub const PAPER: Self = Self::at(10.0);

    /// Models that are looked at as a whole: the distances of Tsiapkolis and Bénard's views (CGF
    /// 2024, §4.3), the three farthest as one.
    pub const FAR: Self = Self {
        distances: [5.0, 10.0, 25.0, 75.0],
        weights: [1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 0.5],
    };

    /// Models that are walked through or looked at from close by.
    pub const NEAR: Self =
        Self { distances: [1.0, 2.0, 5.0, 10.0], weights: [0.25, 0.25, 0.25, 0.25] };

    /// One distance.
    pub const fn at(distance: f64) -> Self {
        Self { distances: [distance; VIEW_DISTANCES], weights: [1.0, 0.0, 0.0, 0.0] }
    }

    /// Probability that a patch survives, for a mesh whose unit of distance is `unit` model units.
    pub fn acceptance(&self, bound: &DoubleCone, unit: f64) -> f64 {
        let at = |(distance, weight): (&f64, &f64)| {
            // A weight of 0 says nothing, whatever the distance.
            if *weight == 0.0 { 0.0 } else { weight * bound.acceptance(distance * unit) }
        };
        self.distances.iter().zip(&self.weights).map(at).sum()
    }

    /// The single distance that comes nearest: the harmonic mean, since far away a patch survives
    /// with a probability that is linear in the reciprocal of the distance.
    pub fn mean_distance(&self) -> f64 {
        let reciprocal = |(distance, weight): (&f64, &f64)| {
            if *weight == 0.0 { 0.0 } else { weight / distance }
        };
        1.0 / self.distances.iter().zip(&self.weights).map(reciprocal).sum::<f64>()
    }
}
