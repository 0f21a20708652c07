//! Many viewpoints at a time.

use drypoint_mesh::{EdgeId, Viewpoint};
use rayon::prelude::*;

use crate::contours::{Found, Scratch};
use crate::extractor::Sight;
use crate::faces::LANES;
use crate::simd::Label;
use crate::{Extractor, Statistics};

/// What an [`Extractor`] found from many viewpoints, and memory for the next time: edge ids or vertex
/// pairs.
///
/// It grows to what the views need; a batch that needs no more allocates nothing.
#[derive(Clone, Debug)]
pub struct Batch<T> {
    views: Vec<View<T>>,
    count: usize,
    scratches: Vec<Scratch>,
}

#[derive(Clone, Debug)]
struct View<T> {
    sight: Sight,
    found: Found<T>,
}

impl<T> Default for Batch<T> {
    fn default() -> Self {
        Self { views: Vec::new(), count: 0, scratches: Vec::new() }
    }
}

impl<T> Batch<T> {
    /// How many viewpoints.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there was no viewpoint.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// What was found from the viewpoint of this number, and what it took.
    ///
    /// # Panics
    /// If there were fewer viewpoints.
    #[track_caller]
    pub fn view(&self, number: usize) -> (&[T], Statistics) {
        assert!(number < self.count, "view {number} of a batch of {}", self.count);
        let found = &self.views[number].found;
        (found.edges(), found.statistics)
    }

    /// The same of each viewpoint in turn.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&[T], Statistics)> {
        (0..self.count).map(|number| self.view(number))
    }
}

impl Extractor<'_> {
    /// Replaces `batch` by what [`Extractor::edges`] finds from each of `viewpoints`.
    ///
    /// Faster than one after the other where planes do not fit the second-level cache, from some 100,000
    /// edges on: tiles that do are looked at from all viewpoints in turn. Below that slower, by a fifth on
    /// the bunny (60,000 edges). On all threads of the current rayon pool, which share the viewpoints out.
    pub fn edges_of_batch(&self, viewpoints: &[Viewpoint], batch: &mut Batch<EdgeId>) {
        self.extract_batch(viewpoints, &self.edges, batch);
    }

    /// Replaces `batch` by what [`Extractor::vertex_pairs`] finds from each of `viewpoints`, in the
    /// way of [`Extractor::edges_of_batch`].
    pub fn vertex_pairs_of_batch(&self, viewpoints: &[Viewpoint], batch: &mut Batch<[u32; 2]>) {
        self.extract_batch(viewpoints, &self.pairs, batch);
    }

    fn extract_batch<T: Label>(
        &self,
        viewpoints: &[Viewpoint],
        labels: &[[T; LANES]],
        batch: &mut Batch<T>,
    ) {
        batch.count = viewpoints.len();
        for (index, &viewpoint) in viewpoints.iter().enumerate() {
            let sight = self.sight(viewpoint);
            if let Some(view) = batch.views.get_mut(index) {
                view.sight = sight;
                view.found.statistics = Statistics::default();
            } else {
                batch.views.push(View { sight, found: Found::default() });
            }
        }
        let views = &mut batch.views[..viewpoints.len()];
        let share = views.len().div_ceil(rayon::current_num_threads()).max(1);
        let shares = views.len().div_ceil(share);
        if batch.scratches.len() < shares {
            batch.scratches.resize_with(shares, Scratch::default);
        }
        let look = |(views, scratch): (&mut [View<T>], &mut Scratch)| {
            for tile in &self.tiles {
                for View { sight, found } in &mut *views {
                    self.look_through(tile, *sight, labels, (&mut *scratch, found));
                }
            }
        };
        if shares < 2 {
            views.chunks_mut(share).zip(&mut batch.scratches).for_each(look);
        } else {
            views.par_chunks_mut(share).zip(&mut batch.scratches[..shares]).for_each(look);
        }
    }
}
