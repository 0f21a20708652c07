//! The two loops that take the time, with the newest instructions that the processor has.
//!
//! There is one of each. It is compiled for several instruction sets and does the same in all: whole
//! numbers are exact, and f32 is added and multiplied in the same order, never fused.

use drypoint_bounds::MIN_CLEARANCE;
use glam::Vec3;
use wide::{CmpGt, CmpLt, f32x4, i16x8, i32x4};

use crate::blocks::{EdgeBlock, LANES, MARGIN, View};
use crate::patch_blocks::PatchBlock;

/// Instructions that a kernel may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// What every processor of the kind has: SSE2 on x86-64, NEON on AArch64.
    Portable,
    /// Of x86-64-v3: AVX2, BMI and POPCNT.
    Avx2,
}

impl Instructions {
    /// All that there are, oldest first.
    pub const ALL: [Self; 2] = [Self::Portable, Self::Avx2];

    /// Whether this processor has them.
    pub fn are_here(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        let avx2 = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt");
        #[cfg(not(target_arch = "x86_64"))]
        let avx2 = false;
        match self {
            Self::Portable => true,
            Self::Avx2 => avx2,
        }
    }

    /// The newest that this processor has.
    pub fn newest() -> Self {
        Self::ALL.into_iter().rfind(|set| set.are_here()).unwrap_or(Self::Portable)
    }
}

/// From where patches are looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Eye {
    /// A point, in model units.
    Point([f64; 3]),
    /// A unit vector.
    Direction(Vec3),
}

macro_rules! dispatch {
    ($(#[$doc:meta])* $name:ident, $avx2:ident, $anywhere:ident$(<$t:ident>)?, ($($argument:ident: $type:ty),*) -> $result:ty) => {
        $(#[$doc])*
        pub(crate) fn $name$(<$t: Copy>)?(instructions: Instructions, $($argument: $type),*) -> $result {
            #[cfg(target_arch = "x86_64")]
            #[expect(unsafe_code, reason = "to use instructions that not every processor has")]
            match instructions {
                Instructions::Portable => {}
                // SAFETY: an `Extractor`, the only caller, has none that are not here: `new` takes the
                // newest that are, `with` asks.
                Instructions::Avx2 => return unsafe { $avx2($($argument),*) },
            }
            #[cfg(not(target_arch = "x86_64"))]
            let _: Instructions = instructions;
            $anywhere($($argument),*)
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2,bmi1,bmi2,popcnt")]
        fn $avx2$(<$t: Copy>)?($($argument: $type),*) -> $result {
            $anywhere($($argument),*)
        }
    };
}

dispatch! {
    /// Writes to `found` the numbers of the edge blocks of all patches in `patches` that may hold a
    /// contour edge. It has room for all blocks, and [`SLACK`] more.
    cull, cull_avx2, cull_anywhere,
    (patches: &[PatchBlock], eye: Eye, found: &mut [u32]) -> Culled
}

/// How many patches may hold a contour edge, and how many blocks and edges they have.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Culled {
    pub(crate) survivors: usize,
    pub(crate) blocks: usize,
    pub(crate) edges: usize,
}

/// Places behind the last that may be written.
pub(crate) const SLACK: usize = 8;

/// As many contour edges as most blocks of edges have.
const MOST_CONTOURS: usize = 3;

#[inline(always)]
fn cull_anywhere(patches: &[PatchBlock], eye: Eye, found: &mut [u32]) -> Culled {
    let mut culled = Culled::default();
    for block in patches {
        let mut survivors = may_hold_contour(block, eye);
        culled.survivors += survivors.count_ones() as usize;
        while survivors != 0 {
            let lane = survivors.trailing_zeros() as usize % LANES;
            let [first, blocks] = block.blocks[lane];
            culled.edges += block.edges[lane] as usize;
            push_blocks(first, blocks as usize, found, &mut culled.blocks);
            survivors &= survivors - 1;
        }
    }
    culled
}

/// Puts `blocks` numbers from `first` on behind the first `count`; without a branch for as many as
/// most patches have.
#[inline(always)]
fn push_blocks(first: u32, blocks: usize, found: &mut [u32], count: &mut usize) {
    for (place, number) in found[*count..*count + SLACK].iter_mut().zip(first..) {
        *place = number;
    }
    if blocks > SLACK {
        for (place, number) in found[*count..*count + blocks].iter_mut().zip(first..) {
            *place = number;
        }
    }
    *count += blocks;
}

/// A bit for each patch that may hold a contour edge: as
/// [`DoubleCone::may_hold_contour`](drypoint_bounds::DoubleCone::may_hold_contour) has it, to the bit.
#[inline(always)]
fn may_hold_contour(block: &PatchBlock, eye: Eye) -> u32 {
    let (mut to_eye, w) = ([[0.0; LANES]; 3], if matches!(eye, Eye::Point(_)) { 1.0 } else { 0.0 });
    for (axis, to_eye) in to_eye.iter_mut().enumerate() {
        match eye {
            #[expect(clippy::cast_possible_truncation, reason = "rounded once, as bounds ask for")]
            Eye::Point(eye) => {
                for (to_eye, &center) in to_eye.iter_mut().zip(&block.centers[axis]) {
                    *to_eye = (eye[axis] - f64::from(center)) as f32;
                }
            }
            Eye::Direction(direction) => *to_eye = [direction[axis]; LANES],
        }
    }
    let mut survivors = 0;
    for half in [4, 0] {
        let four = |lanes: &[f32; LANES]| {
            f32x4::from([lanes[half], lanes[half + 1], lanes[half + 2], lanes[half + 3]])
        };
        let [x, y, z] = to_eye.each_ref().map(four);
        let [nx, ny, nz] = block.axes.each_ref().map(four);
        let height = nx * x + ny * y + nz * z;
        let (ax, ay, az) = (x - height * nx, y - height * ny, z - height * nz);
        let clearance = height.abs() - f32x4::splat(w) * four(&block.apex_distances);
        let across_squared = ax * ax + ay * ay + az * az;
        let is_culled = clearance.cmp_gt(f32x4::splat(MIN_CLEARANCE))
            & (clearance * clearance).cmp_gt(four(&block.tans_squared) * across_squared);
        survivors = survivors << 4 | !is_culled.move_mask().cast_unsigned() & 0xf;
    }
    survivors & block.used
}

/// What a block's edges are, a bit each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Contour edges, if they are not doubtful.
    pub(crate) contours: u32,
    /// Edges beside a face that the exact predicate must see.
    pub(crate) doubtful: u32,
}

dispatch! {
    /// Writes to `contours` the labels of the contour edges in the edge blocks whose `numbers` are
    /// given, in that order, and tells how many there are. Doubtful ones are decided by `ask`, which is
    /// given the number of a block and what was seen, and gives the bits of the contour edges.
    /// `contours` has room for all, and [`SLACK`] more.
    test, test_avx2, test_anywhere<T>,
    (numbers: &[u32], edges: Labelled<'_, T>, view: View, ask: &dyn Fn(u32, Seen) -> u32, contours: &mut [T]) -> usize
}

/// Edges, and what is written of those that are contour edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Labelled<'a, T> {
    pub(crate) blocks: &'a [EdgeBlock],
    pub(crate) labels: &'a [[T; LANES]],
}

#[inline(always)]
fn test_anywhere<T: Copy>(
    numbers: &[u32],
    edges: Labelled<'_, T>,
    view: View,
    ask: &dyn Fn(u32, Seen) -> u32,
    contours: &mut [T],
) -> usize {
    let mut count = 0;
    for &number in numbers {
        let seen = look(&edges.blocks[number as usize], view);
        let mut left = if seen.doubtful == 0 { seen.contours } else { ask(number, seen) };
        let labels = &edges.labels[number as usize];
        let places = &mut contours[count..count + SLACK];
        count += left.count_ones() as usize;
        // Without a branch for as many as most blocks have: to guess how many there are, and be wrong,
        // takes longer.
        for place in &mut places[..MOST_CONTOURS] {
            *place = labels[left.trailing_zeros() as usize % LANES];
            left &= left.wrapping_sub(1);
        }
        if left != 0 {
            for place in &mut places[MOST_CONTOURS..] {
                *place = labels[left.trailing_zeros() as usize % LANES];
                left &= left.wrapping_sub(1);
            }
        }
    }
    count
}

/// See [`crate::blocks`].
#[inline(always)]
pub(crate) fn look(block: &EdgeBlock, view: View) -> Seen {
    let mut seen = Seen { contours: 0, doubtful: 0 };
    for half in [1, 0] {
        let [left, right] = [&block.left, &block.right].map(|side| heights(side[half], view));
        let is_low = |height: i32x4| {
            // |height|, or 1 less.
            let size: i32x4 = height ^ (height >> 31);
            size.cmp_lt(i32x4::splat(MARGIN))
        };
        let push = |bits: u32, lanes: i32x4| bits << 4 | lanes.move_mask().cast_unsigned();
        seen.contours = push(seen.contours, left ^ right);
        seen.doubtful = push(seen.doubtful, is_low(left) | is_low(right));
    }
    seen
}

/// How far the viewpoint is above each plane.
#[inline(always)]
fn heights([xy, zd]: [i16x8; 2], view: View) -> i32x4 {
    xy.dot(view[0]) + zd.dot(view[1])
}
