//! Ways to group edges, and what views take through each.

use std::cell::OnceCell;
use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_baselines::{AnchoredCones, MeshletParams, Meshlets, Snch, SnchParams};
use drypoint_bounds::DoubleCone;
use drypoint_fusion::{FusionParams, Levels, PatchSet, ViewProfile, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint};
use drypoint_tests::compare::Expected;
use drypoint_tests::judges::{Judge, Tested};
use drypoint_tests::report::{
    CONES, Counts, Decomposition, FAST, MESHLETS, OURS, Partition, SNCH, SNCH_SINGLE, Sample, TB24,
    TWO_LEVELS, Views,
};
use drypoint_tests::viewpoints;

use crate::kept::Kept;
use crate::{Options, Section};

/// Viewpoints near the surface, and along the spiral.
const VIEWPOINTS: usize = 252;

/// c_max of the published method, the paper's own last.
const PARTITIONS: [u32; 4] = [512, 1024, 2048, 4096];

/// Most edges of a mesh that takes the slowest methods.
const MEDIUM: usize = 150_000;

/// A mesh, looked at with one filter.
pub(crate) struct Subject<'a> {
    pub(crate) name: &'a str,
    pub(crate) mesh: &'a Mesh,
    pub(crate) adjacency: &'a MeshAdjacency,
    pub(crate) filter: EdgeFilter,
    pub(crate) options: &'a Options,
    pub(crate) kept: &'a Kept,
    /// What is to be found; of use only for what is not kept.
    expected: OnceCell<Views<Expected>>,
}

/// A way to group edges.
#[derive(Clone, Copy)]
enum Way {
    Fused(FusionParams),
    Snch(u32),
    AnchoredCones,
    Meshlets,
}

/// What a way gives: bounds, and how many of them are tested one by one at most.
struct Grouped<'a> {
    judge: Box<dyn Judge + 'a>,
    bounds: usize,
    /// Mean radius and mean half-angle; the radius in model units.
    means: [Option<f64>; 2],
}

/// Patches; never cancelled.
pub(crate) fn fused(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    filter: EdgeFilter,
    params: &FusionParams,
) -> Result<PatchSet, String> {
    fuse(mesh, adjacency, filter, params, &|_| ControlFlow::Continue(()))
        .map_err(|error| error.to_string())
}

impl<'a> Subject<'a> {
    pub(crate) fn new(
        (name, mesh, adjacency): (&'a str, &'a Mesh, &'a MeshAdjacency),
        filter: EdgeFilter,
        (options, kept): (&'a Options, &'a Kept),
    ) -> Self {
        Self { name, mesh, adjacency, filter, options, kept, expected: OnceCell::new() }
    }

    /// By the definition, from all three sets of viewpoints.
    fn expected(&self) -> &Views<Expected> {
        self.expected.get_or_init(|| {
            let look = |from: &[Viewpoint]| {
                Expected::by_definition(self.mesh, self.adjacency, self.filter, from)
            };
            Views {
                far: look(&viewpoints::protocol(self.mesh)),
                near: look(&viewpoints::near(self.mesh, VIEWPOINTS)),
                spiral: look(&viewpoints::spiral(self.mesh, VIEWPOINTS)),
            }
        })
    }

    /// What is measured once for the same mesh and the same filter.
    fn or_measure<T>(
        &self,
        what: &str,
        measure: impl FnOnce() -> Result<T, String>,
    ) -> Result<T, String>
    where
        T: serde::Serialize + serde::de::DeserializeOwned,
    {
        let key = format!("{:016x}", drypoint_fusion::mesh_hash(self.mesh));
        self.kept.or_measure(&format!("{}, {:?}, {what}", self.name, self.filter), &key, measure)
    }

    /// How many contour edges views have.
    pub(crate) fn contours(&self) -> Result<Views<Sample>, String> {
        self.or_measure("contours", || {
            let Views { far, near, spiral } = self.expected();
            let count = |expected: &Expected| Sample::of(expected.counts());
            Ok(Views { far: count(far), near: count(near), spiral: count(spiral) })
        })
    }

    /// The published method for each size of groups.
    pub(crate) fn partitions(&self) -> Result<Vec<Partition>, String> {
        if !self.options.wants(Section::Partitions) {
            return Ok(Vec::new());
        }
        let sizes = if self.options.quick { &PARTITIONS[..1] } else { &PARTITIONS[..] };
        let partition = |&edges: &u32| {
            self.or_measure(&format!("c_max {edges}"), || {
                let params = FusionParams::PAPER.with_max_partition(Some(edges));
                let start = Instant::now();
                let set = fused(self.mesh, self.adjacency, self.filter, &params)?;
                let seconds = start.elapsed().as_secs_f64();
                let tested = self
                    .expected()
                    .far
                    .watch("patches", &set)
                    .map_err(|wrong| wrong.to_string())?;
                let patches = set.patches().len();
                Ok(Partition { edges, seconds, patches, tested: Counts::of(&tested) })
            })
        };
        sizes.iter().map(partition).collect()
    }

    /// What views take through each way.
    pub(crate) fn decompositions(&self) -> Result<Vec<Decomposition>, String> {
        if !self.options.wants(Section::Decompositions) {
            return Ok(Vec::new());
        }
        let measured = |(name, way): &(&'static str, Way)| {
            self.or_measure(name, || self.decomposition(name, *way))
        };
        self.ways().iter().map(measured).collect()
    }

    /// Those that are quick enough for a mesh of this size.
    fn ways(&self) -> Vec<(&'static str, Way)> {
        let edges = self.adjacency.edges(self.filter).count();
        let (is_quick, is_medium) = (self.options.quick, edges <= MEDIUM);
        let default = FusionParams::DEFAULT;
        let mut ways = vec![
            (FAST, Way::Fused(FusionParams::FAST)),
            (OURS, Way::Fused(default)),
            (TWO_LEVELS, Way::Fused(FusionParams { levels: Levels::Two, ..default })),
            ("patches (NEAR)", Way::Fused(FusionParams { views: ViewProfile::NEAR, ..default })),
            (SNCH, Way::Snch(SnchParams::default().edges_per_leaf)),
            (CONES, Way::AnchoredCones),
            (MESHLETS, Way::Meshlets),
        ];
        if self.filter == EdgeFilter::All {
            // Those that a paper has figures of, and ours beside them.
            ways.retain(|(name, _)| [OURS, CONES].contains(name) && is_medium && !is_quick);
        } else if !is_quick {
            ways.push((SNCH_SINGLE, Way::Snch(1)));
            ways.push(("TB24, Mean Sphere", Way::Fused(FusionParams::PAPER_MEAN)));
            ways.push((TB24, Way::Fused(FusionParams::PAPER)));
            if is_medium {
                ways.insert(2, ("patches (BEST)", Way::Fused(FusionParams::BEST)));
            }
        }
        ways
    }

    fn decomposition(&self, name: &'static str, way: Way) -> Result<Decomposition, String> {
        let start = Instant::now();
        let grouped = self.grouped(way)?;
        let seconds = start.elapsed().as_secs_f64();
        let watch = |expected: &Expected| {
            let views: Vec<Tested> =
                expected.watch(name, grouped.judge.as_ref()).map_err(|wrong| wrong.to_string())?;
            Ok::<_, String>(Counts::of(&views))
        };
        let Views { far, near, spiral } = self.expected();
        let unit = self.mesh.bounds().map_or(1.0, |bounds| bounds.half_longest_side());
        let [radius, half_angle] = grouped.means;
        Ok(Decomposition {
            name: name.to_owned(),
            seconds,
            bounds: grouped.bounds,
            radius: radius.map(|radius| radius / unit),
            half_angle: half_angle.unwrap_or(0.0),
            tested: Views { far: watch(far)?, near: watch(near)?, spiral: watch(spiral)? },
        })
    }

    fn grouped(&self, way: Way) -> Result<Grouped<'a>, String> {
        let (mesh, adjacency, filter) = (self.mesh, self.adjacency, self.filter);
        Ok(match way {
            Way::Fused(params) => {
                let set = fused(mesh, adjacency, filter, &params)?;
                let bounds = set.patches().len() + set.super_patches().len();
                let means = means(set.patches().iter().map(|patch| patch.bound));
                Grouped { judge: Box::new(set), bounds, means }
            }
            Way::Snch(edges_per_leaf) => {
                let snch = Snch::new(mesh, adjacency, filter, &SnchParams { edges_per_leaf });
                let means = means(snch.bounds().iter().copied());
                Grouped { bounds: snch.nodes(), means, judge: Box::new(snch) }
            }
            Way::Meshlets => {
                let meshlets = Meshlets::new(mesh, adjacency, filter, &MeshletParams::default());
                let means = means(meshlets.bounds());
                Grouped { bounds: meshlets.len(), means, judge: Box::new(meshlets) }
            }
            Way::AnchoredCones => {
                let cones = AnchoredCones::new(mesh, adjacency, filter, &Default::default());
                let [_, half_angle] = mean_of(cones.half_angles().map(|angle| [0.0, angle]));
                Grouped { bounds: cones.nodes(), means: [None, half_angle], judge: Box::new(cones) }
            }
        })
    }
}

/// Mean t cos α and mean α of those that can be culled.
fn means(bounds: impl Iterator<Item = DoubleCone>) -> [Option<f64>; 2] {
    let measures = |bound: DoubleCone| {
        let tan_squared = f64::from(bound.tan_squared);
        [f64::from(bound.apex_distance) / (1.0 + tan_squared).sqrt(), tan_squared.sqrt().atan()]
    };
    mean_of(bounds.filter(|bound| *bound != DoubleCone::ALWAYS).map(measures))
}

/// None of nothing.
fn mean_of(pairs: impl Iterator<Item = [f64; 2]>) -> [Option<f64>; 2] {
    let (mut sums, mut count) = ([0.0; 2], 0);
    for [a, b] in pairs {
        sums = [sums[0] + a, sums[1] + b];
        count += 1;
    }
    sums.map(|sum| (count > 0).then(|| sum / f64::from(count)))
}
