//! Asking for memory ahead of its use.

/// Bytes of a cache line.
const LINE: usize = 64;

/// Asks for the lines that would hold `count` values from number `first` on, so that they are in the second cache when
/// they are read or written. (The first cache is too small for what lies some hundred particles ahead.)
///
/// The numbers may lie beyond the end of `values`: whatever stands there in memory is then asked for, or nothing. Elsewhere
/// than on x86-64 nothing is done.
#[inline(always)]
pub fn prefetch<T>(values: &[T], first: usize, count: usize) {
    #[cfg(target_arch = "x86_64")]
    for offset in (0..count * size_of::<T>()).step_by(LINE) {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        let at = values.as_ptr().wrapping_add(first).cast::<i8>().wrapping_add(offset);
        // SAFETY: a prefetch changes nothing that a program can see and never faults, whatever the address; SSE, which has
        // it, is part of x86-64. The address is computed without a claim that it lies inside the slice.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(at) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (values, first, count, LINE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_place_is_out_of_bounds() {
        let values = vec![1.0_f64; 100];
        for first in [0, 99, 100, 10_000_000, usize::MAX / 8] {
            prefetch(&values, first, 100);
        }
        prefetch::<f64>(&[], 0, 1);
        assert!(values.iter().all(|&v| v == 1.0), "nothing that a program can see has changed");
    }
}
