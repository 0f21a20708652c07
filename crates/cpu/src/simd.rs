//! Sixteen numbers at a time, on every processor the best way it can.
//!
//! [`Kernel`]s are written once, for any [`Lanes`], and compiled for each of them. All give the same to
//! the bit: whole numbers are exact, and f32 is added and multiplied in the same order, never fused.
//! `pulp` hands out a token where it finds the instructions of a level, and there is no other way to
//! them: nothing here is `unsafe`.

use bytemuck::Pod;
use drypoint_mesh::EdgeId;
use wide::{CmpGt, CmpLt, f32x4, i16x8, i32x4};

use crate::faces::{LANES, Pairs};

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

/// A loop that is compiled for each kind of [`Lanes`]. `run` and all that it calls must be
/// `#[inline(always)]`, so as to be compiled with their instructions.
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
    /// Mask of |a| < b or |a| = b; b is above 0 and below 2³¹ − 1.
    fn within(self, a: Self::Wholes, b: i32) -> u16;

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
pub(crate) trait Label: Pod {
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

/// Four times four, with 128-bit instructions that the compiler may always use.
#[derive(Clone, Copy, Debug)]
struct Portable;

/// As many labels as most blocks of faces give, or fewer: a branch on how many there are would be guessed
/// wrong too often.
const MOST_CONTOURS: usize = 3;

impl Portable {
    #[inline(always)]
    fn compact<T: Copy>(from: &[T; LANES], mut mask: u16, to: &mut [T; LANES]) {
        let mut push = |place: &mut T| {
            *place = from[mask.trailing_zeros() as usize % LANES];
            mask &= mask.wrapping_sub(1);
            mask
        };
        let (first, more) = to.split_at_mut(MOST_CONTOURS);
        let mut left = 0;
        for place in first {
            left = push(place);
        }
        if left != 0 {
            for place in more {
                if push(place) == 0 {
                    break;
                }
            }
        }
    }
}

impl Lanes for Portable {
    type Reals = [f32x4; 4];
    type Wholes = [i32x4; 4];

    #[inline(always)]
    fn reals(self, numbers: &[f32; LANES]) -> Self::Reals {
        bytemuck::cast(*numbers)
    }

    #[inline(always)]
    fn add(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
        [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
    }

    #[inline(always)]
    fn sub(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
    }

    #[inline(always)]
    fn mul(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
        [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
    }

    #[inline(always)]
    fn abs(self, a: Self::Reals) -> Self::Reals {
        a.map(f32x4::abs)
    }

    #[inline(always)]
    fn greater(self, a: Self::Reals, b: Self::Reals) -> u16 {
        let part = |i: usize| bits(a[i].cmp_gt(b[i]).move_mask());
        part(0) | part(1) << 4 | part(2) << 8 | part(3) << 12
    }

    #[inline(always)]
    fn dot(self, a: [&Pairs; 2], b: [[i16; 2]; 2]) -> Self::Wholes {
        let [first, second] = a.map(|pairs| bytemuck::cast::<Pairs, [i16x8; 4]>(*pairs));
        let [x, y] = b.map(|[x, y]| i16x8::from([x, y, x, y, x, y, x, y]));
        std::array::from_fn(|i| first[i].dot(x) + second[i].dot(y))
    }

    #[inline(always)]
    fn negative(self, a: Self::Wholes) -> u16 {
        let part = |i: usize| bits(a[i].move_mask());
        part(0) | part(1) << 4 | part(2) << 8 | part(3) << 12
    }

    #[inline(always)]
    fn within(self, a: Self::Wholes, b: i32) -> u16 {
        let (above, below) = (i32x4::splat(-b - 1), i32x4::splat(b + 1));
        let is_within = a.map(|a| a.cmp_gt(above) & a.cmp_lt(below));
        self.negative(is_within)
    }

    #[inline(always)]
    fn compact_words(self, from: &[u32; LANES], mask: u16, to: &mut [u32; LANES]) {
        Self::compact(from, mask, to);
    }

    #[inline(always)]
    fn compact_pairs(self, from: &[[u32; 2]; LANES], mask: u16, to: &mut [[u32; 2]; LANES]) {
        Self::compact(from, mask, to);
    }

    #[inline(always)]
    fn counted_from(self, first: u32) -> [u32; LANES] {
        let mut numbers = COUNTED;
        for number in &mut numbers {
            *number += first;
        }
        numbers
    }
}

const COUNTED: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{__m128i, __m256, __m256i, __m512, __m512i, _CMP_GT_OQ};

    use pulp::x86::{V3, V4};
    use pulp::{NullaryFnOnce, cast};

    use super::{COUNTED, Kernel, LANES, Lanes, Pairs, bits};

    /// A kernel, and what it is compiled for.
    pub(super) struct With<L, K>(pub(super) L, pub(super) K);

    impl<L: Lanes, K: Kernel> NullaryFnOnce for With<L, K> {
        type Output = K::Output;

        #[inline(always)]
        fn call(self) -> K::Output {
            self.1.run(self.0)
        }
    }

    /// Both pairs of bytes as a word, as `_mm256_set1_epi32` has it.
    #[inline(always)]
    fn word(pair: [i16; 2]) -> i32 {
        bytemuck::cast(pair)
    }

    /// For each mask of eight bits, the numbers of those that it has.
    const EIGHT: [[u8; 8]; 256] = {
        let mut table = [[0; 8]; 256];
        let mut mask = 0;
        while mask < 256 {
            let (mut lane, mut count) = (0, 0);
            while lane < 8 {
                if mask >> lane & 1 == 1 {
                    table[mask][count] = lane;
                    count += 1;
                }
                lane += 1;
            }
            mask += 1;
        }
        table
    };

    /// For each mask of four bits, the words of the pairs that it has.
    const FOUR_PAIRS: [[u8; 8]; 16] = {
        let mut table = [[0; 8]; 16];
        let mut mask = 0;
        while mask < 16 {
            let mut place = 0;
            while place < 4 {
                let pair = EIGHT[mask][place];
                table[mask][2 * place] = 2 * pair;
                table[mask][2 * place + 1] = 2 * pair + 1;
                place += 1;
            }
            mask += 1;
        }
        table
    };

    /// Of eight words, those with these numbers.
    #[inline(always)]
    fn chosen(v3: V3, words: [u32; 8], numbers: [u8; 8]) -> [u32; 8] {
        let numbers: __m128i = cast([numbers, [0; 8]]);
        let numbers = v3.avx2._mm256_cvtepu8_epi32(numbers);
        cast(v3.avx2._mm256_permutevar8x32_epi32(cast(words), numbers))
    }

    /// Twice eight.
    impl Lanes for V3 {
        type Reals = [__m256; 2];
        type Wholes = [__m256i; 2];

        #[inline(always)]
        fn reals(self, numbers: &[f32; LANES]) -> Self::Reals {
            cast(*numbers)
        }

        #[inline(always)]
        fn add(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
            [self.avx._mm256_add_ps(a[0], b[0]), self.avx._mm256_add_ps(a[1], b[1])]
        }

        #[inline(always)]
        fn sub(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
            [self.avx._mm256_sub_ps(a[0], b[0]), self.avx._mm256_sub_ps(a[1], b[1])]
        }

        #[inline(always)]
        fn mul(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
            [self.avx._mm256_mul_ps(a[0], b[0]), self.avx._mm256_mul_ps(a[1], b[1])]
        }

        #[inline(always)]
        fn abs(self, a: Self::Reals) -> Self::Reals {
            let sign = self.avx._mm256_set1_ps(-0.0);
            a.map(|a| self.avx._mm256_andnot_ps(sign, a))
        }

        #[inline(always)]
        fn greater(self, a: Self::Reals, b: Self::Reals) -> u16 {
            let part = |i: usize| {
                let is_greater = self.avx._mm256_cmp_ps::<_CMP_GT_OQ>(a[i], b[i]);
                bits(self.avx._mm256_movemask_ps(is_greater))
            };
            part(0) | part(1) << 8
        }

        #[inline(always)]
        fn dot(self, a: [&Pairs; 2], b: [[i16; 2]; 2]) -> Self::Wholes {
            let [first, second] = a.map(|pairs| cast::<Pairs, [__m256i; 2]>(*pairs));
            let [x, y] = b.map(|pair| self.avx._mm256_set1_epi32(word(pair)));
            let part = |i: usize| {
                let first = self.avx2._mm256_madd_epi16(first[i], x);
                self.avx2._mm256_add_epi32(first, self.avx2._mm256_madd_epi16(second[i], y))
            };
            [part(0), part(1)]
        }

        #[inline(always)]
        fn negative(self, a: Self::Wholes) -> u16 {
            let part = |i: usize| {
                let a = self.avx._mm256_castsi256_ps(a[i]);
                bits(self.avx._mm256_movemask_ps(a))
            };
            part(0) | part(1) << 8
        }

        #[inline(always)]
        fn within(self, a: Self::Wholes, b: i32) -> u16 {
            let b = self.avx._mm256_set1_epi32(b);
            // b − |a| is negative where |a| is more.
            let left = a.map(|a| self.avx2._mm256_sub_epi32(b, self.avx2._mm256_abs_epi32(a)));
            !self.negative(left)
        }

        #[inline(always)]
        fn compact_words(self, from: &[u32; LANES], mask: u16, to: &mut [u32; LANES]) {
            let [low, high]: [[u32; 8]; 2] = cast(*from);
            let [first, second] = mask.to_le_bytes();
            to[..8].copy_from_slice(&chosen(self, low, EIGHT[first as usize]));
            let count = first.count_ones() as usize % LANES;
            to[count..count + 8].copy_from_slice(&chosen(self, high, EIGHT[second as usize]));
        }

        #[inline(always)]
        fn compact_pairs(self, from: &[[u32; 2]; LANES], mask: u16, to: &mut [[u32; 2]; LANES]) {
            let fours: [[u32; 8]; 4] = cast(*from);
            let mut count = 0;
            for (part, four) in fours.into_iter().enumerate() {
                let mask = (mask >> (4 * part)) as usize % 16;
                let chosen: [[u32; 2]; 4] = cast(chosen(self, four, FOUR_PAIRS[mask]));
                to[count..count + 4].copy_from_slice(&chosen);
                count += mask.count_ones() as usize;
            }
        }

        #[inline(always)]
        fn counted_from(self, first: u32) -> [u32; LANES] {
            let [low, high]: [__m256i; 2] = cast(COUNTED);
            let first = self.avx._mm256_set1_epi32(first.cast_signed());
            cast([self.avx2._mm256_add_epi32(first, low), self.avx2._mm256_add_epi32(first, high)])
        }
    }

    impl Lanes for V4 {
        type Reals = __m512;
        type Wholes = __m512i;

        #[inline(always)]
        fn reals(self, numbers: &[f32; LANES]) -> Self::Reals {
            cast(*numbers)
        }

        #[inline(always)]
        fn add(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
            self.avx512f._mm512_add_ps(a, b)
        }

        #[inline(always)]
        fn sub(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
            self.avx512f._mm512_sub_ps(a, b)
        }

        #[inline(always)]
        fn mul(self, a: Self::Reals, b: Self::Reals) -> Self::Reals {
            self.avx512f._mm512_mul_ps(a, b)
        }

        #[inline(always)]
        fn abs(self, a: Self::Reals) -> Self::Reals {
            self.avx512f._mm512_abs_ps(a)
        }

        #[inline(always)]
        fn greater(self, a: Self::Reals, b: Self::Reals) -> u16 {
            self.avx512f._mm512_cmp_ps_mask::<_CMP_GT_OQ>(a, b)
        }

        #[inline(always)]
        fn dot(self, a: [&Pairs; 2], b: [[i16; 2]; 2]) -> Self::Wholes {
            let [first, second]: [__m512i; 2] = a.map(|pairs| cast(*pairs));
            let [x, y] = b.map(|pair| self.avx512f._mm512_set1_epi32(word(pair)));
            let first = self.avx512bw._mm512_madd_epi16(first, x);
            self.avx512f._mm512_add_epi32(first, self.avx512bw._mm512_madd_epi16(second, y))
        }

        #[inline(always)]
        fn negative(self, a: Self::Wholes) -> u16 {
            self.avx512dq._mm512_movepi32_mask(a)
        }

        #[inline(always)]
        fn within(self, a: Self::Wholes, b: i32) -> u16 {
            let b = self.avx512f._mm512_set1_epi32(b);
            self.avx512f._mm512_cmple_epu32_mask(self.avx512f._mm512_abs_epi32(a), b)
        }

        #[inline(always)]
        fn compact_words(self, from: &[u32; LANES], mask: u16, to: &mut [u32; LANES]) {
            *to = cast(self.avx512f._mm512_maskz_compress_epi32(mask, cast(*from)));
        }

        #[inline(always)]
        fn compact_pairs(self, from: &[[u32; 2]; LANES], mask: u16, to: &mut [[u32; 2]; LANES]) {
            let [low, high]: [__m512i; 2] = cast(*from);
            let [first, second] = mask.to_le_bytes();
            let chosen = |mask: u8, eight: __m512i| -> [[u32; 2]; 8] {
                cast(self.avx512f._mm512_maskz_compress_epi64(mask, eight))
            };
            to[..8].copy_from_slice(&chosen(first, low));
            let count = first.count_ones() as usize % LANES;
            to[count..count + 8].copy_from_slice(&chosen(second, high));
        }

        #[inline(always)]
        fn counted_from(self, first: u32) -> [u32; LANES] {
            let first = self.avx512f._mm512_set1_epi32(first.cast_signed());
            cast(self.avx512f._mm512_add_epi32(first, cast(COUNTED)))
        }
    }
}
