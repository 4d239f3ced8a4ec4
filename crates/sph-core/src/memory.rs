//! Memory in large pages.
//!
//! Pair loops read records that lie some hundred kilobytes apart, more of them than a processor remembers where their pages
//! of 4 KiB are. Linux backs memory with pages of 2 MiB where a program asks for it (unless the setting
//! `/sys/kernel/mm/transparent_hugepage/enabled` is `never`); elsewhere nothing is asked. Only speed depends on it.

use std::mem::MaybeUninit;

/// Makes `values` as long as asked for, with `filling` in what is new. Where the memory it has is too small it gets other, in
/// large pages if the system grants them, and all is `filling`: for scratch whose contents need not be kept.
pub fn resize_scratch<T: Clone>(values: &mut Vec<T>, length: usize, filling: T) {
    if values.capacity() < length {
        // First gives back what it had; then an eighth more than is wanted, so that small growth needs nothing new.
        *values = Vec::new();
        values.reserve_exact(length + length / 8);
        prefer_large_pages(values.spare_capacity_mut());
    }
    values.resize(length, filling);
}

/// Asks for large pages for memory that nothing has been written to.
#[cfg(all(target_os = "linux", not(miri)))]
fn prefer_large_pages<T>(memory: &mut [MaybeUninit<T>]) {
    /// Sizes of pages are divisors of it.
    const WHOLE: usize = 64 << 10;
    let range = memory.as_mut_ptr_range();
    let first = (range.start as usize).next_multiple_of(WHOLE);
    let end = range.end as usize / WHOLE * WHOLE;
    if end <= first {
        return;
    }
    let start = range.start.cast::<u8>().wrapping_add(first - range.start as usize);
    // SAFETY: the range lies inside `memory`, which is borrowed exclusively; this advice changes neither what is mapped nor
    // what a program can read there, and where the system does not want to follow it, its refusal is of no concern.
    unsafe { libc::madvise(start.cast(), end - first, libc::MADV_HUGEPAGE) };
}

#[cfg(not(all(target_os = "linux", not(miri))))]
fn prefer_large_pages<T>(_memory: &mut [MaybeUninit<T>]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_new_is_filled_and_what_fits_stays() {
        let mut values: Vec<u64> = Vec::new();
        for length in [0, 3, 100_000, 1_000_000] {
            resize_scratch(&mut values, length, 7);
            assert_eq!(values.len(), length);
            assert!(values.iter().all(|&v| v == 7));
        }
        let (place, capacity) = (values.as_ptr(), values.capacity());
        values[5] = 1;
        resize_scratch(&mut values, 10, 7);
        resize_scratch(&mut values, capacity, 8);
        assert_eq!((values.as_ptr(), values[5], values[9], values[10]), (place, 1, 7, 8));
    }
}
