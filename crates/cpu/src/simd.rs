//! Sixteen numbers at a time, on every processor the best way it can.
//!
//! [`Kernel`]s are written once, for any [`Lanes`], and compiled for each of them. All give the same to
//! the bit: whole numbers are exact, and f32 is added and multiplied in the same order, never fused.
//! `pulp` hands out a token where it finds the instructions of a level, and there is no other way to
//! them: nothing here is `unsafe`.

mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

use std::fmt;

use bytemuck::Pod;
use drypoint_mesh::EdgeId;

use crate::faces::{LANES, Pairs};
use portable::Portable;

/// Instructions that a kernel may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// What every processor of the kind has: SSE2 on x86-64, NEON on AArch64.
    Portable,
    /// x86-64-v3: AVX2, BMI and what is older.
    Avx2,
    /// x86-64-v4: AVX-512 F, BW, CD, DQ and VL.
    Avx512,
}

impl Instructions {
    /// All that there are, oldest first.
    pub const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// Whether this processor has them.
    pub fn are_here(self) -> bool {
        self.level().is_some()
    }

    /// The newest that this processor has.
    pub fn newest() -> Self {
        Self::ALL.into_iter().rfind(|set| set.are_here()).unwrap_or(Self::Portable)
    }

    pub(crate) fn level(self) -> Option<Level> {
        match self {
            Self::Portable => Some(Level::Portable),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => pulp::x86::V3::try_new().map(Level::Avx2),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => pulp::x86::V4::try_new().map(Level::Avx512),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => None,
        }
    }
}

impl fmt::Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Portable => "portable",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        })
    }
}

/// [`Instructions`] that this processor has.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Level {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
}

impl Level {
    /// The newest that this processor has.
    pub(crate) fn newest() -> Self {
        Instructions::newest().level().unwrap_or(Self::Portable)
    }

    /// Compiled for these instructions.
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Portable => kernel.run(Portable),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(v3) => v3.vectorize(x86::With(v3, kernel)),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(v4) => v4.vectorize(x86::With(v4, kernel)),
        }
    }
}

/// A loop that is compiled for each kind of [`Lanes`]. `run` and all that it calls of
/// [`Lanes`] must be `#[inline(always)]`, so as to be compiled with their instructions.
pub(crate) trait Kernel {
    type Output;
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// What a kernel can do to sixteen numbers. Bit i of a mask is for number i.
pub(crate) trait Lanes: Copy {
    /// Sixteen f32.
    type Reals: Copy;
    /// Sixteen i32.
    type Wholes: Copy;

    fn reals(self, numbers: &[f32; LANES]) -> Self::Reals;
    fn add(self, a: Self::Reals, b: Self::Reals) -> Self::Reals;
    fn sub(self, a: Self::Reals, b: Self::Reals) -> Self::Reals;
    fn mul(self, a: Self::Reals, b: Self::Reals) -> Self::Reals;
    fn abs(self, a: Self::Reals) -> Self::Reals;
    /// Mask of a > b; not where a number is NaN.
    fn greater(self, a: Self::Reals, b: Self::Reals) -> u16;

    /// The sums of the products of both pairs.
    fn dot(self, a: [&Pairs; 2], b: [[i16; 2]; 2]) -> Self::Wholes;
    /// Mask of a < 0.
    fn negative(self, a: Self::Wholes) -> u16;
    /// Mask of |a| < b or |a| = b; b is 0 or more, and below 2³¹ − 1.
    fn within(self, a: Self::Wholes, b: i32) -> u16;
    /// Mask of where one of both is below 0, and the other is not.
    fn differ(self, a: [Self::Wholes; 2]) -> u16;
    /// Mask of where one of both at least is [`Lanes::within`].
    fn any_within(self, a: [Self::Wholes; 2], b: i32) -> u16;

    /// Moves the words that `mask` has to the front of `to`, in order; what is behind them there
    /// may be overwritten.
    fn compact_words(self, from: &[u32; LANES], mask: u16, to: &mut [u32; LANES]);
    /// The same with pairs of words.
    fn compact_pairs(self, from: &[[u32; 2]; LANES], mask: u16, to: &mut [[u32; 2]; LANES]);

    /// This number and the fifteen that follow.
    fn counted_from(self, first: u32) -> [u32; LANES];

    /// The same number sixteen times.
    #[inline(always)]
    fn splat(self, number: f32) -> Self::Reals {
        self.reals(&[number; LANES])
    }

    /// a - b, exactly, then rounded to f32.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "that is what it is for")]
    fn sub_rounded(self, a: f64, b: &[f32; LANES]) -> Self::Reals {
        // A loop, as `map` is not compiled for the instructions of the kernel.
        let mut differences = [0.0; LANES];
        for (difference, &b) in differences.iter_mut().zip(b) {
            *difference = (a - f64::from(b)) as f32;
        }
        self.reals(&differences)
    }
}

/// What is written of an edge.
pub(crate) trait Label: Pod + Send + Sync {
    fn compact<L: Lanes>(lanes: L, from: &[Self; LANES], mask: u16, to: &mut [Self; LANES]);
}

impl Label for EdgeId {
    #[inline(always)]
    fn compact<L: Lanes>(lanes: L, from: &[Self; LANES], mask: u16, to: &mut [Self; LANES]) {
        lanes.compact_words(bytemuck::cast_ref(from), mask, bytemuck::cast_mut(to));
    }
}

impl Label for [u32; 2] {
    #[inline(always)]
    fn compact<L: Lanes>(lanes: L, from: &[Self; LANES], mask: u16, to: &mut [Self; LANES]) {
        lanes.compact_pairs(from, mask, to);
    }
}

/// A mask of at most eight bits, as instructions give it.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "they are the lowest")]
fn bits(mask: i32) -> u16 {
    mask as u16
}

const COUNTED: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
