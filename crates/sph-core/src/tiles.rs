//! Columns that tiles of particles write in parallel.
//!
//! A step updates a dozen columns at once, tile by tile. Rayon splits one slice, or a few, into chunks; here as many
//! columns as a dimension has are split at the same places, without an allocation.

use std::marker::PhantomData;

use crate::neighbors::TILE;

/// A column, to be taken apart into tiles.
#[derive(Clone, Copy, Debug)]
pub struct TiledColumn<'a, T> {
    start: *mut T,
    length: usize,
    column: PhantomData<&'a mut [T]>,
}

// SAFETY: a `TiledColumn` stands for an exclusive borrow of the column; parts of it reach threads only through
// `tile`, whose caller promises that no part is out twice.
unsafe impl<T: Send> Send for TiledColumn<'_, T> {}
// SAFETY: as above.
unsafe impl<T: Send> Sync for TiledColumn<'_, T> {}

impl<'a, T> TiledColumn<'a, T> {
    /// Borrows a column.
    pub fn new(column: &'a mut [T]) -> Self {
        Self { start: column.as_mut_ptr(), length: column.len(), column: PhantomData }
    }

    /// The part of the column that belongs to a tile.
    ///
    /// # Safety
    /// While a tile's part is in use, no other part of the same tile may be taken from this column or from a copy of
    /// this value. Passes keep to it by taking every tile once, inside the closure of a parallel iterator over tiles.
    #[inline]
    pub unsafe fn tile(self, tile: usize) -> &'a mut [T] {
        let first = (tile * TILE).min(self.length);
        let end = ((tile + 1) * TILE).min(self.length);
        // SAFETY: the range is inside the column, ranges of different tiles do not overlap, and the caller promises that
        // this tile's is not out twice.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(first), end - first) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn tiles_cover_a_column_once() {
        let mut column = vec![0usize; 2 * TILE + 3];
        let tiled = TiledColumn::new(&mut column);
        (0..3).into_par_iter().for_each(|t| {
            // SAFETY: each tile is taken once.
            let part = unsafe { tiled.tile(t) };
            part.iter_mut().enumerate().for_each(|(i, x)| *x += t * TILE + i);
        });
        assert!(column.iter().enumerate().all(|(i, &x)| i == x));
    }
}
