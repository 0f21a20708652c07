//! AVX2 and AVX-512, through the tokens of `pulp`.

use std::arch::x86_64::{__m128i, __m256, __m256i, __m512, __m512i, _CMP_GT_OQ};

use pulp::x86::{V3, V4};
use pulp::{NullaryFnOnce, cast};

use super::{COUNTED, Kernel, Lanes, bits};
use crate::faces::{LANES, Pairs};

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
    fn differ(self, [a, b]: [Self::Wholes; 2]) -> u16 {
        self.negative([
            self.avx2._mm256_xor_si256(a[0], b[0]),
            self.avx2._mm256_xor_si256(a[1], b[1]),
        ])
    }

    #[inline(always)]
    fn any_within(self, a: [Self::Wholes; 2], b: i32) -> u16 {
        let least = |i: usize| {
            let (first, second) =
                (self.avx2._mm256_abs_epi32(a[0][i]), self.avx2._mm256_abs_epi32(a[1][i]));
            self.avx2._mm256_min_epu32(first, second)
        };
        self.within([least(0), least(1)], b)
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
    fn differ(self, [a, b]: [Self::Wholes; 2]) -> u16 {
        self.negative(self.avx512f._mm512_xor_si512(a, b))
    }

    #[inline(always)]
    fn any_within(self, a: [Self::Wholes; 2], b: i32) -> u16 {
        let [first, second] = a.map(|a| self.avx512f._mm512_abs_epi32(a));
        let b = self.avx512f._mm512_set1_epi32(b);
        self.avx512f._mm512_cmple_epu32_mask(self.avx512f._mm512_min_epu32(first, second), b)
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
