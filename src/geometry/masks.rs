//! Sixteen answers as the bits of a number.

use super::batch::{InstructionSet, LANES};

/// A bit for each lane that is not zero: of lanes that are 0 or 1. Compilers make a long way of this loop, which
/// both instruction sets have an instruction for.
#[inline(always)]
pub(crate) fn bits(set: InstructionSet, lanes: &[u32; LANES]) -> u32 {
    match set {
        // SAFETY: whoever runs on such a set has asked whether it is there.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => unsafe { x86_64::bits_avx2(lanes) },
        // SAFETY: the same.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => unsafe { x86_64::bits_avx512(lanes) },
        _ => lanes.iter().enumerate().fold(0, |bits, (i, lane)| bits | lane << i),
    }
}

#[cfg(target_arch = "x86_64")]
mod x86_64 {
    use super::LANES;
    use std::arch::x86_64::*;

    #[inline]
    #[target_feature(enable = "avx2")]
    pub fn bits_avx2(lanes: &[u32; LANES]) -> u32 {
        let half = |first: usize| {
            // SAFETY: eight of sixteen lanes.
            let eight = unsafe { _mm256_loadu_si256(lanes.as_ptr().add(first).cast()) };
            _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(eight, _mm256_setzero_si256()))) as u32
        };
        half(0) | half(8) << 8
    }

    #[inline]
    #[target_feature(enable = "avx512f")]
    pub fn bits_avx512(lanes: &[u32; LANES]) -> u32 {
        // SAFETY: sixteen lanes.
        let sixteen = unsafe { _mm512_loadu_si512(lanes.as_ptr().cast()) };
        u32::from(_mm512_test_epi32_mask(sixteen, sixteen))
    }
}

/// The places of the bits that are set. Not a call for each: a closure that is not inlined is compiled for the instructions that
/// every machine has.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bits(pub u32);

impl Iterator for Bits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let place = self.0.trailing_zeros() as usize;
        let is_there = self.0 != 0;
        self.0 &= self.0.wrapping_sub(1);
        is_there.then_some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_gives_the_same_bits() {
        for number in (0..1 << LANES).step_by(7) {
            let lanes = std::array::from_fn(|i| number >> i & 1);
            let sets = [InstructionSet::Portable, InstructionSet::Avx2, InstructionSet::Avx512];
            for set in sets.into_iter().filter(|set| set.is_available()) {
                assert_eq!(bits(set, &lanes), number, "{set:?}");
            }
            assert_eq!(Bits(number).fold(0, |found, i| found | 1 << i), number);
        }
    }
}
