//! What no extraction through the same patches can be faster than.

use std::hint::black_box;
use std::ops::Range;

use drypoint_fusion::{Patch, PatchSet};
use drypoint_mesh::{EdgeId, Viewpoint, Wing, is_contour};

/// Edges in a block of an [`Extractor`](drypoint_cpu::Extractor).
const LANES: usize = 16;

/// The planes of a block, by cache lines.
type Planes = [[u64; 8]; 4];

/// Reads the blocks of the patches that views accept, and writes as many ids as they see, from where
/// these lie: which blocks, and how many, is known before.
pub(crate) struct Floor {
    planes: Vec<Planes>,
    ids: Vec<[EdgeId; LANES]>,
    views: Vec<View>,
    found: Vec<EdgeId>,
}

/// What is read and written for a viewpoint.
#[derive(Default)]
struct View {
    accepted: Vec<u32>,
    /// Those of them that have contour edges, and how many.
    hits: Vec<(u32, usize)>,
}

impl Floor {
    /// Of patches on one level.
    pub(crate) fn new(patches: &PatchSet, viewpoints: &[Viewpoint]) -> Self {
        let all = patches.patches();
        let blocks = |places: Range<u32>| {
            let end = places.end;
            places.step_by(LANES).map(move |first| first as usize..end.min(first + 16) as usize)
        };
        let held: Vec<Vec<Range<usize>>> = (all.iter().map(Patch::edges))
            .chain([patches.always_tested()])
            .map(|places| blocks(places).collect())
            .collect();
        let ids = held.iter().flatten().map(|places| {
            let ids = &patches.edge_ids()[places.clone()];
            std::array::from_fn(|lane| ids[lane % ids.len()])
        });
        let ids: Vec<_> = ids.collect();
        let view = |&viewpoint: &Viewpoint| {
            let sees = |wing: &&Wing| is_contour(patches.positions(), wing, viewpoint);
            let (mut view, mut number) = (View::default(), 0);
            for (patch, blocks) in held.iter().enumerate() {
                let is_accepted =
                    all.get(patch).is_none_or(|patch| patch.bound.may_hold_contour(viewpoint));
                for places in blocks {
                    if is_accepted {
                        view.accepted.push(number);
                        let count = patches.wings()[places.clone()].iter().filter(sees).count();
                        view.hits.extend((count > 0).then_some((number, count)));
                    }
                    number += 1;
                }
            }
            view
        };
        let views = viewpoints.iter().map(view).collect();
        let found = vec![EdgeId(0); patches.edge_ids().len() + LANES];
        Self { planes: vec![[[1; 8]; 4]; ids.len()], ids, views, found }
    }

    /// From as many viewpoints, the first ones.
    pub(crate) fn look(&mut self, viewpoints: &[Viewpoint]) {
        for view in &self.views[..viewpoints.len()] {
            let mut read = 0;
            for &block in &view.accepted {
                let [a, b, c, d] = &self.planes[block as usize];
                read |= a[0] | b[0] | c[0] | d[0];
            }
            black_box(read);
            let mut end = 0;
            for &(block, count) in &view.hits {
                self.found[end..end + LANES].copy_from_slice(&self.ids[block as usize]);
                end += count;
            }
            black_box(&self.found);
        }
    }
}
