//! One viewpoint, on many threads.

use drypoint_mesh::{EdgeId, Viewpoint};
use rayon::prelude::*;

use crate::contours::{Contours, Share};
use crate::faces::LANES;
use crate::simd::Label;
use crate::{Extractor, Statistics};

impl Extractor<'_> {
    /// The same as [`Extractor::edges`], on all threads of the current rayon pool. Pays where a view takes
    /// much longer than it takes threads to come together: on two of them, a mesh of a million edges takes
    /// longer so, and one of three million less.
    pub fn edges_on_threads(
        &self,
        viewpoint: Viewpoint,
        contours: &mut Contours<EdgeId>,
    ) -> Statistics {
        self.extract_on_threads(viewpoint, &self.edges, contours)
    }

    /// The same as [`Extractor::vertex_pairs`], in the way of [`Extractor::edges_on_threads`].
    pub fn vertex_pairs_on_threads(
        &self,
        viewpoint: Viewpoint,
        contours: &mut Contours<[u32; 2]>,
    ) -> Statistics {
        self.extract_on_threads(viewpoint, &self.pairs, contours)
    }

    fn extract_on_threads<T: Label>(
        &self,
        viewpoint: Viewpoint,
        labels: &[[T; LANES]],
        contours: &mut Contours<T>,
    ) -> Statistics {
        let Contours { found, shares, .. } = contours;
        let tiles_each = self.tiles.len().div_ceil(rayon::current_num_threads()).max(1);
        let count = self.tiles.len().div_ceil(tiles_each);
        if shares.len() < count {
            shares.resize_with(count, Share::default);
        }
        let shares = &mut shares[..count];
        let sight = self.sight(viewpoint);
        let look = |(tiles, share): (&[_], &mut Share<T>)| {
            share.found.statistics = Statistics::default();
            for tile in tiles {
                self.look_through(tile, sight, labels, (&mut share.scratch, &mut share.found));
            }
        };
        self.tiles.par_chunks(tiles_each).zip(&mut *shares).for_each(look);
        found.statistics = Statistics::default();
        for share in shares {
            let edges = share.found.edges();
            found.room(edges.len())[..edges.len()].copy_from_slice(edges);
            found.statistics += share.found.statistics;
        }
        found.statistics
    }
}
