//! All clusters of a part of space, packed so that a new one is compared with them at a glance.

use std::marker::PhantomData;

use crate::cluster::{Outline, most_gain};
use crate::extent::Extent;
use crate::greedy::GreedyModel;
use crate::lanes::{LANES, Lanes, Number};

/// The live clusters, densely packed in no particular order.
pub(crate) struct Screen<E> {
    blocks: Vec<Outline<Lanes>>,
    /// Number of the cluster in each place.
    numbers: Vec<u32>,
    /// Place of each cluster, by number; stale for those that are gone.
    places: Vec<u32>,
    extent: PhantomData<E>,
}

impl<E: Extent> Screen<E> {
    pub(crate) fn new() -> Self {
        Self { blocks: Vec::new(), numbers: Vec::new(), places: Vec::new(), extent: PhantomData }
    }

    pub(crate) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// Number of the cluster in a place.
    pub(crate) fn number(&self, place: usize) -> u32 {
        self.numbers[place]
    }

    /// Adds a cluster under the next number, and returns that.
    pub(crate) fn insert(&mut self, outline: &Outline<f64>) -> u32 {
        let place = self.numbers.len();
        if place.is_multiple_of(LANES) {
            self.blocks.push(outline.map(Lanes::of));
        }
        self.set(place, outline);
        let number = index(self.places.len());
        self.numbers.push(number);
        self.places.push(index(place));
        number
    }

    /// Removes a cluster; the last one takes its place.
    pub(crate) fn remove(&mut self, number: u32) {
        let place = self.places[number as usize] as usize;
        let last = self.numbers.len() - 1;
        self.set(place, &self.get(last));
        self.places[self.numbers[last] as usize] = index(place);
        self.numbers.swap_remove(place);
        self.blocks.truncate(last.div_ceil(LANES));
    }

    /// Replaces `most` by the most that fusing each cluster with this live one may gain, by place;
    /// at least the exact gain, rounding included.
    pub(crate) fn most_gains(&self, number: u32, model: &GreedyModel, most: &mut Vec<f64>) {
        let own = self.get(self.places[number as usize] as usize).map(Lanes::of);
        most.clear();
        for block in &self.blocks {
            most.extend_from_slice(&most_gain::<E>(&own, block, model).0);
        }
        most.truncate(self.numbers.len());
    }

    fn get(&self, place: usize) -> Outline<f64> {
        self.blocks[place / LANES].map(|row| row.0[place % LANES])
    }

    fn set(&mut self, place: usize, outline: &Outline<f64>) {
        let block = &mut self.blocks[place / LANES];
        block.set_each(outline, |row, value| row.0[place % LANES] = value);
    }
}

/// A count of clusters, of which there are fewer than two for each of at most 2³¹ edges.
fn index(count: usize) -> u32 {
    u32::try_from(count).expect("a mesh has fewer than 2^31 edges in one part of space")
}
