//! The two loops that take the time: over bounds, and over edges.

use drypoint_bounds::MIN_CLEARANCE;
use drypoint_mesh::Viewpoint;

use crate::bounds::{BoundBlock, Bounds};
use crate::edges::Blocks;
use crate::exact::{Exact, Hit};
use crate::faces::{LANES, View};
use crate::simd::{Kernel, Label, Lanes};

/// Places behind the last that may be written.
pub(crate) const SLACK: usize = LANES;

/// From where bounds are looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    /// A point in model units, or a unit vector.
    xyz: [f64; 3],
    /// The same, rounded.
    rounded: [f32; 3],
    is_point: bool,
    /// Whether nothing was lost: then one subtraction of f32 rounds once, as bounds ask for.
    is_exact: bool,
}

impl Eye {
    #[expect(clippy::cast_possible_truncation, reason = "it is said whether something is lost")]
    pub(crate) fn new(viewpoint: Viewpoint) -> Self {
        let is_point = viewpoint.is_point();
        let xyz = if is_point { viewpoint.xyz() } else { viewpoint.xyz().normalize_or_zero() };
        let rounded = xyz.to_array().map(|number| number as f32);
        let is_exact = rounded.map(f64::from) == xyz.to_array();
        Self { xyz: xyz.to_array(), rounded, is_point, is_exact }
    }

    /// The component along `axis` of the vectors to it from centers.
    #[inline(always)]
    fn from<L: Lanes>(&self, lanes: L, axis: usize, centers: &[f32; LANES]) -> L::Reals {
        if !self.is_point {
            lanes.splat(self.rounded[axis])
        } else if self.is_exact {
            lanes.sub(lanes.splat(self.rounded[axis]), lanes.reals(centers))
        } else {
            lanes.sub_rounded(self.xyz[axis], centers)
        }
    }
}

/// Finds the bounds that may hold a contour edge, and what these hold.
pub(crate) struct Cull<'a, N> {
    /// Numbers of blocks of bounds.
    pub(crate) numbers: N,
    pub(crate) bounds: &'a Bounds,
    pub(crate) eye: Eye,
    /// Gets the numbers of the bounds that survive. Has room for those of all blocks, and [`SLACK`]
    /// more.
    pub(crate) survivors: &'a mut [u32],
    /// Gets the numbers of the blocks that they hold. Has room for all of them, and [`SLACK`] more.
    pub(crate) found: &'a mut [u32],
}

/// How many bounds may hold a contour edge, how many blocks they hold, and how many patches or edges.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Culled {
    pub(crate) survivors: usize,
    pub(crate) blocks: usize,
    pub(crate) count: usize,
}

impl<N: Iterator<Item = u32>> Kernel for Cull<'_, N> {
    type Output = Culled;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Culled {
        let Self { numbers, bounds, eye, survivors, found } = self;
        let mut culled = Culled::default();
        let blocks = &bounds.blocks[..];
        let used = &bounds.used[..blocks.len()];
        for block in numbers {
            let mask = may_hold_contour(lanes, &blocks[block as usize], &eye);
            let mask = mask & used[block as usize];
            let numbers = lanes.counted_from(block << LANES.ilog2());
            lanes.compact_words(&numbers, mask, room(survivors, culled.survivors));
            culled.survivors += mask.count_ones() as usize;
        }
        // To go from survivor to survivor in a loop of its own is never guessed wrong, while how many
        // a block has is.
        let mut end = 0;
        for &survivor in &survivors[..culled.survivors] {
            let held = bounds.held[survivor as usize];
            // Without the block that it shares with the survivor before.
            let (first, blocks) = (held.first.max(end), held.range().end - held.first.max(end));
            end = held.range().end;
            *room(found, culled.blocks) = lanes.counted_from(first);
            if blocks as usize > LANES {
                let places = &mut found[culled.blocks..][..blocks as usize];
                places.iter_mut().zip(first..).for_each(|(place, number)| *place = number);
            }
            culled.blocks += blocks as usize;
            culled.count += held.count as usize;
        }
        culled
    }
}

/// A bit for each bound that may hold a contour edge: as
/// [`DoubleCone::may_hold_contour`](drypoint_bounds::DoubleCone::may_hold_contour) has it, to the bit.
#[inline(always)]
fn may_hold_contour<L: Lanes>(lanes: L, block: &BoundBlock, eye: &Eye) -> u16 {
    let [centers, axes] = [&block.centers, &block.axes];
    let x = eye.from(lanes, 0, &centers[0]);
    let y = eye.from(lanes, 1, &centers[1]);
    let z = eye.from(lanes, 2, &centers[2]);
    let (nx, ny, nz) = (lanes.reals(&axes[0]), lanes.reals(&axes[1]), lanes.reals(&axes[2]));
    let height = dot(lanes, [nx, ny, nz], [x, y, z]);
    let ax = lanes.sub(x, lanes.mul(height, nx));
    let ay = lanes.sub(y, lanes.mul(height, ny));
    let az = lanes.sub(z, lanes.mul(height, nz));
    let w = if eye.is_point { 1.0 } else { 0.0 };
    let apex_distance = lanes.mul(lanes.splat(w), lanes.reals(&block.apex_distances));
    let clearance = lanes.sub(lanes.abs(height), apex_distance);
    let width = lanes.mul(lanes.reals(&block.tans_squared), dot(lanes, [ax, ay, az], [ax, ay, az]));
    let is_culled = lanes.greater(clearance, lanes.splat(MIN_CLEARANCE))
        & lanes.greater(lanes.mul(clearance, clearance), width);
    !is_culled
}

#[inline(always)]
fn dot<L: Lanes>(lanes: L, [ax, ay, az]: [L::Reals; 3], [bx, by, bz]: [L::Reals; 3]) -> L::Reals {
    lanes.add(lanes.add(lanes.mul(ax, bx), lanes.mul(ay, by)), lanes.mul(az, bz))
}

/// Finds the contour edges in blocks of edges.
pub(crate) struct Test<'a, N, B, T> {
    /// Numbers of blocks.
    pub(crate) numbers: N,
    pub(crate) blocks: &'a B,
    /// What is written of each contour edge.
    pub(crate) labels: &'a [[T; LANES]],
    pub(crate) view: View,
    /// Decides where edges are doubtful.
    pub(crate) exact: Exact<'a>,
    /// Gets the blocks that may have contour edges. Has room for all, and one more.
    pub(crate) hits: &'a mut [Hit],
    /// Gets the numbers of those hits that have doubtful edges. Has as much room.
    pub(crate) doubtful: &'a mut [usize],
    /// Gets the labels, in order. Has room for those of all blocks, and [`SLACK`] more.
    pub(crate) contours: &'a mut [T],
}

impl<N, B, T> Kernel for Test<'_, N, B, T>
where
    N: Iterator<Item = u32>,
    B: Blocks,
    T: Label,
{
    /// How many contour edges.
    type Output = usize;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> usize {
        let Self { numbers, blocks, labels, view, exact, hits, doubtful, contours } = self;
        let looked_at = blocks.looked_at();
        let (mut hit, mut doubts) = (0, 0);
        for block in numbers {
            let seen = B::look(looked_at, lanes, block, view);
            // Written in any case, and overwritten by the next if there was nothing: no branch that could be
            // guessed wrong.
            hits[hit] = Hit { block, seen };
            // Few are, so that it is nearly always guessed right.
            if seen.doubtful != 0 {
                doubtful[doubts] = hit;
                doubts += 1;
            }
            hit += usize::from(seen.is_any());
        }
        let hits = &mut hits[..hit];
        if doubts != 0 {
            exact.decide(blocks, hits, &doubtful[..doubts]);
        }
        let labels = &labels[..blocks.len() as usize];
        let mut count = 0;
        for Hit { block, seen } in hits {
            let mask = seen.contours;
            T::compact(lanes, &labels[*block as usize], mask, room(contours, count));
            count += mask.count_ones() as usize;
        }
        count
    }
}

/// The next sixteen places.
#[inline(always)]
fn room<T>(places: &mut [T], count: usize) -> &mut [T; LANES] {
    places[count..].first_chunk_mut().expect("there is always SLACK more")
}
