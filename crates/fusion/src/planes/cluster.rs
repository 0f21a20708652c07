//! A patch in the making, in f32, and the bound of a union.

use std::ops::Range;

use glam::Vec3;
use smallvec::{SmallVec, smallvec};
use wide::{CmpGt, f32x4};

use super::cap::Cap;
use super::model::Model;
use super::sums::Sums;
use super::table::{Item, Plane, Table};

/// Planes in one block.
const LANES: usize = 4;

/// A cap is wide enough if nothing sticks out farther than this share of its chord's square.
const CAP_TOLERANCE: f32 = 2e-3;

/// The widest cap that is worth a bound: 80°.
const MAX_CHORD_SQUARED: f32 = 1.65;

/// Numbers of edges or planes.
pub(crate) type Numbers = SmallVec<[u32; 8]>;

/// Four planes, a coordinate each.
pub(crate) type Block = [f32x4; 4];

/// Some planes; the last block repeats its last one.
type Blocks = SmallVec<[Block; 2]>;

/// What bounds a set of planes, and what the set costs for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    pub(crate) cap: Cap,
    /// Half-way between the apexes.
    pub(crate) center: Vec3,
    /// Distance from there to each.
    pub(crate) apex_distance: f32,
    /// Probability H to survive.
    pub(crate) acceptance: f32,
    /// Expected cost E.
    pub(crate) cost: f32,
}

impl Bound {
    /// Of the two planes of an edge.
    pub(crate) fn of_item(table: &Table, item: &Item, model: &Model) -> Self {
        let [a, b] = item.planes.map(|plane| table.plane(plane).normal);
        let cap = Cap::of_two(a, b).unwrap_or(Cap::of(a).reaching(4.0));
        let acceptance = if cap.chord_squared > MAX_CHORD_SQUARED {
            1.0
        } else {
            Model::least_acceptance(cap.chord_squared)
        };
        let cap = cap.reaching(cap.chord_squared.min(MAX_CHORD_SQUARED));
        Self {
            cap,
            center: item.midpoint,
            apex_distance: 0.0,
            acceptance,
            cost: model.patch(acceptance, 1.0),
        }
    }
}

/// Edges, their planes and their bound.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    /// Numbers of its edges, unsorted.
    pub(crate) items: Numbers,
    /// Numbers of its planes, sorted.
    planes: Numbers,
    /// The same planes; the last block repeats its last one.
    blocks: Blocks,
    sums: Sums,
    pub(crate) bound: Bound,
}

/// Some clusters, each in a box: and not in place, as they are moved from cell to cell.
pub(crate) type Clusters = Vec<Box<Cluster>>;

impl Cluster {
    pub(crate) fn of_item(table: &Table, number: u32, model: &Model) -> Self {
        let item = table.item(number);
        let sums = Sums::of_edge(item.planes.map(|plane| table.plane(plane)), item.midpoint);
        let [low, high] = item.planes;
        let planes: Numbers = smallvec![low.min(high), low.max(high)];
        let blocks = blocks(table, &planes);
        let bound = Bound::of_item(table, item, model);
        Self { items: smallvec![number], planes, blocks, sums, bound }
    }

    /// From scratch; at least one edge.
    pub(crate) fn of_items(table: &Table, items: Numbers, model: &Model) -> Self {
        if let [item] = items[..] {
            return Self::of_item(table, item, model);
        }
        let (planes, blocks, sums) = measured(table, &items);
        let cap = Cap::of(table.plane(planes[0]).normal);
        let bound = bound(Some(cap), [&blocks, &[]], &sums, model);
        Self { items, planes, blocks, sums, bound }
    }

    /// A patch as the one item `number` of a group, which counts as one edge; `items` are its edges,
    /// at least one.
    pub(crate) fn of_patch(table: &Table, number: u32, items: Range<u32>, model: &Model) -> Self {
        let items: Numbers = items.collect();
        let (planes, blocks, sums) = measured(table, &items);
        let sums = sums.over(sums.edges());
        let cap = Cap::of(table.plane(planes[0]).normal);
        let bound = bound(Some(cap), [&blocks, &[]], &sums, model);
        Self { items: smallvec![number], planes, blocks, sums, bound }
    }

    /// [`Model::place`] of its planes.
    pub(crate) fn place(&self, model: &Model) -> [f32; 4] {
        model.place(self.bound.cap.axis, self.bound.center)
    }

    pub(crate) fn edges(&self) -> f32 {
        self.sums.edges()
    }

    /// The bound of two clusters' planes, and what both together cost. Where they cannot cost less
    /// than `most`, any number that is not less.
    pub(crate) fn union(&self, other: &Self, table: &Table, model: &Model, most: f32) -> Bound {
        if !self.may_be_fused(other, table, model) {
            return Bound { cost: f32::INFINITY, ..self.bound };
        }
        let (wide, narrow) = if self.bound.cap.chord_squared >= other.bound.cap.chord_squared {
            (self, other)
        } else {
            (other, self)
        };
        let mut cap = Some(wide.bound.cap);
        for _ in 0..2 {
            for &normal in narrow.bound.cap.support() {
                cap = cap.and_then(|cap| take_in(cap, normal));
            }
        }
        let edges = self.sums.edges() + other.sums.edges();
        // No union has a narrower cap.
        let chord_squared = cap.map_or(4.0, |cap| cap.chord_squared);
        let least = model.patch(Model::least_acceptance(chord_squared), edges);
        if least >= most {
            return Bound { cost: f32::INFINITY, ..self.bound };
        }
        let sums = self.sums.plus(&other.sums);
        bound(cap, [&wide.blocks, &narrow.blocks], &sums, model)
    }

    /// Sets of edges that may do better elsewhere: all that lie beside one plane of the rim, and
    /// each on its own; and whether the bound may shrink without them.
    pub(crate) fn units(&self, table: &Table) -> Vec<(Numbers, bool)> {
        let mut units: Vec<(Numbers, bool)> = Vec::new();
        let mut sole = Numbers::new();
        for &plane in &self.planes {
            if self.is_on_rim(table.plane(plane)) {
                let beside = |&&item: &&u32| table.item(item).planes.contains(&plane);
                let unit: Numbers = self.items.iter().filter(beside).copied().collect();
                if let [item] = unit[..] {
                    sole.push(item);
                } else {
                    units.push((unit, true));
                }
            }
        }
        units.extend(self.items.iter().map(|item| (smallvec![*item], sole.contains(item))));
        units
    }

    /// Whether the bound may shrink without this plane.
    fn is_on_rim(&self, plane: Plane) -> bool {
        let Bound { cap, center, apex_distance, .. } = &self.bound;
        let chord_squared = plane.normal.distance_squared(cap.axis);
        let height = (plane.offset - plane.normal.dot(*center)) / (1.0 - 0.5 * chord_squared);
        chord_squared > 0.98 * cap.chord_squared || height.abs() > 0.98 * apex_distance
    }

    /// What is left of it without some of its edges, but not all.
    pub(crate) fn without(&self, table: &Table, unit: &Self, model: &Model) -> Self {
        let is_left = |item: &u32| !unit.items.contains(item);
        let items: Numbers = self.items.iter().copied().filter(is_left).collect();
        let sums = self.sums.minus(&unit.sums);
        let mut given_up = unit.planes.clone();
        for &item in &items {
            let planes = table.item(item).planes;
            given_up.retain(|plane| !planes.contains(plane));
        }
        if !given_up.iter().any(|&plane| self.is_on_rim(table.plane(plane))) {
            let planes: Numbers =
                self.planes.iter().copied().filter(|plane| !given_up.contains(plane)).collect();
            let blocks =
                if given_up.is_empty() { self.blocks.clone() } else { blocks(table, &planes) };
            let cost = model.patch(self.bound.acceptance, sums.edges());
            return Self { items, planes, blocks, sums, bound: Bound { cost, ..self.bound } };
        }
        let planes: Numbers =
            self.planes.iter().copied().filter(|plane| !given_up.contains(plane)).collect();
        let blocks = blocks(table, &planes);
        let is_kept =
            |normal: &&Vec3| !given_up.iter().any(|&plane| table.plane(plane).normal == **normal);
        let mut support = self.bound.cap.support().iter().filter(is_kept);
        let first = support.next().copied().unwrap_or(table.plane(planes[0]).normal);
        let cap = support.try_fold(Cap::of(first), |cap, &normal| take_in(cap, normal));
        let bound = bound(cap, [&blocks, &[]], &sums, model);
        Self { items, planes, blocks, sums, bound }
    }

    /// Whether a patch may hold so many edges and vertices.
    fn may_be_fused(&self, other: &Self, table: &Table, model: &Model) -> bool {
        let edges = self.items.len() + other.items.len();
        if !model.cost.admits(edges, 0) || model.cost.admits(edges, 2 * edges) {
            return model.cost.admits(edges, 0);
        }
        let items = self.items.iter().chain(&other.items);
        let mut ends: Numbers = items.flat_map(|&item| table.item(item).ends).collect();
        ends.sort_unstable();
        ends.dedup();
        model.cost.admits(edges, ends.len())
    }

    /// Takes in another, with the bound that [`Cluster::union`] found.
    pub(crate) fn absorb(&mut self, table: &Table, other: &Self, bound: Bound) {
        self.items.extend_from_slice(&other.items);
        self.planes = merged(&self.planes, &other.planes);
        fill_blocks(&mut self.blocks, table, &self.planes);
        self.sums = self.sums.plus(&other.sums);
        self.bound = bound;
    }
}

/// Numbers of the planes of some edges, sorted, these planes, and sums over the edges.
fn measured(table: &Table, items: &[u32]) -> (Numbers, Blocks, Sums) {
    let mut planes: Numbers = items.iter().flat_map(|&number| table.item(number).planes).collect();
    planes.sort_unstable();
    planes.dedup();
    let mut sums = Sums::default();
    for &number in items {
        let item = table.item(number);
        sums = sums.plus(&Sums::of_edge(item.planes.map(|p| table.plane(p)), item.midpoint));
    }
    let blocks = blocks(table, &planes);
    (planes, blocks, sums)
}

fn take_in(cap: Cap, normal: Vec3) -> Option<Cap> {
    if normal.distance_squared(cap.axis) <= cap.chord_squared * (1.0 + CAP_TOLERANCE) {
        Some(cap)
    } else {
        // Rounding must not make it smaller.
        cap.taking_in(normal).filter(|wider| wider.chord_squared <= MAX_CHORD_SQUARED)
    }
}

/// Union of two sorted lists without duplicates.
fn merged(a: &[u32], b: &[u32]) -> Numbers {
    let mut union = Numbers::with_capacity(a.len() + b.len());
    let (mut i, mut j) = (0, 0);
    while i < a.len() && j < b.len() {
        let (x, y) = (a[i], b[j]);
        union.push(x.min(y));
        i += usize::from(x <= y);
        j += usize::from(y <= x);
    }
    union.extend_from_slice(&a[i..]);
    union.extend_from_slice(&b[j..]);
    union
}

fn blocks(table: &Table, planes: &[u32]) -> Blocks {
    let mut blocks = Blocks::new();
    fill_blocks(&mut blocks, table, planes);
    blocks
}

fn fill_blocks(blocks: &mut Blocks, table: &Table, planes: &[u32]) {
    blocks.clear();
    blocks.reserve(planes.len().div_ceil(LANES));
    for numbers in planes.chunks(LANES) {
        let last = numbers.len() - 1;
        let rows: [[f32; 4]; LANES] =
            std::array::from_fn(|lane| table.plane(numbers[lane.min(last)]).to_array());
        let column = |field: usize| f32x4::from(std::array::from_fn(|lane| rows[lane][field]));
        blocks.push(std::array::from_fn(column));
    }
}

/// What one look at all planes tells.
struct Scan {
    /// Square of the chord from the axis to the normal farthest from it.
    chord_squared: f32,
    farthest: Vec3,
    /// How far along the axis from the center the highest plane meets it.
    front: f32,
    /// And the lowest.
    back: f32,
}

fn scan(parts: [&[Block]; 2], axis: Vec3, center: Vec3) -> Scan {
    let splat = |v: Vec3| v.to_array().map(f32x4::splat);
    let ([ax, ay, az], [cx, cy, cz]) = (splat(axis), splat(center));
    let mut chords = f32x4::splat(-1.0);
    let (mut front, mut back) = (f32x4::splat(f32::MIN), f32x4::splat(f32::MAX));
    let mut farthest = [f32x4::ZERO; 3];
    for [x, y, z, d] in parts.into_iter().flatten() {
        let (dx, dy, dz) = (*x - ax, *y - ay, *z - az);
        let chord = dx * dx + dy * dy + dz * dz;
        let height = (*d - *x * cx - *y * cy - *z * cz) / (f32x4::ONE - chord * f32x4::splat(0.5));
        front = front.fast_max(height);
        back = back.fast_min(height);
        let is_farther = chord.cmp_gt(chords);
        chords = chords.fast_max(chord);
        farthest = [
            is_farther.blend(*x, farthest[0]),
            is_farther.blend(*y, farthest[1]),
            is_farther.blend(*z, farthest[2]),
        ];
    }
    let [x, y, z] = farthest.map(f32x4::to_array);
    let chords = chords.to_array();
    let lane =
        (1..LANES).fold(0, |best, lane| if chords[lane] > chords[best] { lane } else { best });
    Scan {
        chord_squared: chords[lane],
        farthest: Vec3::new(x[lane], y[lane], z[lane]),
        front: front.to_array().into_iter().fold(f32::MIN, f32::max),
        back: back.to_array().into_iter().fold(f32::MAX, f32::min),
    }
}

/// Widens `cap` until it holds all planes, and finds the apexes. Without a cap, or with one of more
/// than 80°, it always survives.
fn bound(cap: Option<Cap>, parts: [&[Block]; 2], sums: &Sums, model: &Model) -> Bound {
    let center = sums.center();
    let mut widened = cap;
    let mut last = None;
    for _ in 0..8 {
        let Some(cap) = widened else { break };
        let scan = scan(parts, cap.axis, center);
        if scan.chord_squared > MAX_CHORD_SQUARED && cap.chord_squared > 1.2 {
            break;
        }
        let is_held = scan.chord_squared <= cap.chord_squared * (1.0 + CAP_TOLERANCE) + 1e-12;
        let farthest = scan.farthest;
        last = Some((cap, scan));
        if is_held {
            break;
        }
        widened = take_in(cap, farthest);
    }
    let Some((cap, scan)) = last.filter(|(_, scan)| scan.chord_squared <= MAX_CHORD_SQUARED) else {
        let cap = cap.unwrap_or(Cap::of(Vec3::Z));
        let cap = cap.reaching(MAX_CHORD_SQUARED);
        let cost = model.patch(1.0, sums.edges());
        return Bound { cap, center, apex_distance: 0.0, acceptance: 1.0, cost };
    };
    let cap = cap.reaching(scan.chord_squared);
    let apex_distance = 0.5 * (scan.front - scan.back);
    let acceptance = model.acceptance(cap.chord_squared, apex_distance);
    Bound {
        cap,
        center: center + 0.5 * (scan.front + scan.back) * cap.axis,
        apex_distance,
        acceptance,
        cost: model.patch(acceptance, sums.edges()),
    }
}
