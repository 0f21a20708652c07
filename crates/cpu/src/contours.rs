//! Memory for what is found.

use std::ops::Deref;

use bytemuck::Zeroable;

use crate::Statistics;
use crate::exact::Hit;
use crate::kernels::SLACK;

/// What an extractor found, and memory for the next time: edge ids or vertex pairs, as a slice.
///
/// It grows once to the places of all edges, and never again for the same extractor and the same calls;
/// what threads find of one view, to what the views need.
#[derive(Clone, Debug)]
pub struct Contours<T> {
    pub(crate) found: Found<T>,
    pub(crate) scratch: Scratch,
    pub(crate) shares: Vec<Share<T>>,
}

impl<T> Default for Contours<T> {
    fn default() -> Self {
        Self { found: Found::default(), scratch: Scratch::default(), shares: Vec::new() }
    }
}

impl<'a, T> IntoIterator for &'a Contours<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// What one of many threads found.
#[derive(Clone, Debug)]
pub(crate) struct Share<T> {
    pub(crate) found: Found<T>,
    pub(crate) scratch: Scratch,
}

impl<T> Default for Share<T> {
    fn default() -> Self {
        Self { found: Found::default(), scratch: Scratch::default() }
    }
}

impl<T> Deref for Contours<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        self.found.edges()
    }
}

/// Contour edges, and how many tests it took.
#[derive(Clone, Debug)]
pub(crate) struct Found<T> {
    edges: Vec<T>,
    pub(crate) statistics: Statistics,
}

impl<T> Default for Found<T> {
    fn default() -> Self {
        Self { edges: Vec::new(), statistics: Statistics::default() }
    }
}

impl<T> Found<T> {
    pub(crate) fn edges(&self) -> &[T] {
        &self.edges[..self.statistics.contour_edges]
    }
}

impl<T: bytemuck::Pod> Found<T> {
    /// Places for so many more edges, and [`SLACK`] more.
    pub(crate) fn room(&mut self, edges: usize) -> &mut [T] {
        let count = self.statistics.contour_edges;
        grow(&mut self.edges, count + edges + SLACK);
        &mut self.edges[count..]
    }
}

/// Numbers of bounds and of blocks, from one kernel to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) survivors: Vec<u32>,
    pub(crate) bound_blocks: Vec<u32>,
    pub(crate) edge_blocks: Vec<u32>,
    pub(crate) hits: Vec<Hit>,
    pub(crate) doubtful: Vec<usize>,
}

impl Scratch {
    /// For so many bounds of a level, blocks of bounds and blocks of edges, and [`SLACK`] more of each.
    pub(crate) fn make_room(&mut self, [bounds, bound_blocks, edge_blocks]: [usize; 3]) {
        grow(&mut self.survivors, bounds + SLACK);
        grow(&mut self.bound_blocks, bound_blocks + SLACK);
        grow(&mut self.edge_blocks, edge_blocks + SLACK);
        self.hits(edge_blocks);
    }

    /// Room for so many blocks and one more, and for the numbers of those that have doubtful edges.
    pub(crate) fn hits(&mut self, blocks: usize) -> (&mut [Hit], &mut [usize]) {
        grow(&mut self.hits, blocks + 1);
        grow(&mut self.doubtful, blocks + 1);
        (&mut self.hits, &mut self.doubtful)
    }
}

/// To at least so many.
fn grow<T: Zeroable + Clone>(places: &mut Vec<T>, len: usize) {
    if places.len() < len {
        places.resize(len, T::zeroed());
    }
}
