//! The same bits whatever the registers.

use super::*;

/// Exercises every operation and keeps the bits.
struct Exercise<'a>(&'a [Line], &'a mut Vec<u64>);

impl LaneKernel for Exercise<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let a = L::load(&[1.0, -2.5, 3.0e200, f64::NAN, 0.0, -0.0, 1e-310, 7.0]);
        let b = L::load(&[0.3, 2.5, 1.0e-200, 1.0, -0.0, 0.0, 3.0, f64::NAN]);
        // SAFETY: the records 0..8 of two lines each exist.
        let records = unsafe { L::load_records(self.0, 2, 1, &[7, 0, 3, 3, 1, 2, 6, 5]) };
        let one = L::one();
        let all = [a + b, a - b, a * b, a / b, -a, a.mul_add(b, one), a.abs().sqrt()];
        let picks = [a.max(b), b.max(a), a.min(b), b.min(a), a.select_less(b, a, b)];
        let back = L::transpose(records);
        let mut sums = [Line([1.5; LANES]); 4];
        // SAFETY: the second lines of two records of two lines exist.
        unsafe { L::add_to_records::<true>(records, &mut sums, 2, 1, &[0, 1, 0, 0, 1, 0, 1, 0]) };
        let sums = sums.map(|line| L::load(&line.0));
        let any = [
            L::splat(a.any_less(b) as u8 as f64),
            L::splat(one.any_less(one) as u8 as f64),
            L::splat(b.less_mask(a) as f64),
        ];
        for lanes in all.iter().chain(&picks).chain(&records).chain(&back).chain(&any).chain(&sums) {
            // A NaN's sign and payload are nobody's concern.
            self.1.extend(lanes.to_array().map(|x| if x.is_nan() { 1 } else { x.to_bits() }));
        }
    }
}

/// What parts leave behind: numbers at the places of their lanes, and records that they add to.
#[derive(Default)]
struct Left {
    places: [[f64; LANES]; 10],
    records: [Line; LANES],
    sums: [Line; 4],
}

/// All lanes at once, and one part after the other.
struct Parts<'a>(&'a [Line], &'a mut [Left; 2]);

#[inline(always)]
fn exercise<P: Part>(lines: &[Line], left: &mut Left) {
    let a = P::load(&[1.0, -2.5, 3.0e200, f64::NAN, 0.0, -0.0, 1e-310, 7.0]);
    let b = P::load(&[0.3, 2.5, 1.0e-200, 1.0, -0.0, 0.0, 3.0, 9.0]);
    // SAFETY: the records 0..8 of two lines each exist.
    let records = unsafe { P::load_records(lines, 2, 1, &[7, 0, 3, 3, 1, 2, 6, 5]) };
    let column = P::gather(&[5.0, 6.0, 7.0], &[0, 1, 2, 1, 0, 0, 2, 2]);
    for (k, lanes) in [a * b, a.select_less(b, a, column)].iter().chain(&records).enumerate() {
        lanes.store(&mut left.places[k]);
    }
    for l in P::FIRST..P::FIRST + P::COUNT {
        assert_eq!(a.less_mask(b) >> l & 1 == 1, [1, 6, 7].contains(&l), "{l}");
        assert_eq!(b.to_array()[l], [0.3, 2.5, 1.0e-200, 1.0, -0.0, 0.0, 3.0, 9.0][l]);
    }
    P::store_records(records, &mut left.records, 1, 0);
    // SAFETY: the second lines of two records of two lines exist.
    unsafe { P::add_to_records::<true>(records, &mut left.sums, 2, 1, &[0, 1, 0, 0, 1, 0, 1, 0]) };
}

impl LaneKernel for Parts<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let [whole, parts] = self.1;
        exercise::<L>(self.0, whole);
        exercise::<L::First>(self.0, parts);
        if L::HALVES {
            exercise::<L::Second>(self.0, parts);
        }
    }
}

#[test]
fn two_halves_do_what_all_lanes_do() {
    let lines: Vec<Line> = (0..16).map(|i| Line(std::array::from_fn(|k| (100 * i + k) as f64))).collect();
    for set in InstructionSet::available() {
        let mut left = [Left::default(), Left::default()];
        dispatch_with(set, Parts(&lines, &mut left));
        let [whole, parts] = left;
        let bits = |left: &Left| left.places.map(|row| row.map(|x| if x.is_nan() { 1 } else { x.to_bits() }));
        assert_eq!(bits(&whole), bits(&parts), "{set:?}");
        // Record 7 begins with 1500: it is the first of those that the lanes name.
        assert_eq!(whole.records[0].0[0], 1500.0);
        assert_eq!((whole.records, whole.sums), (parts.records, parts.sums), "{set:?}");
    }
}

#[test]
fn every_set_of_instructions_gives_the_same_bits() {
    let lines: Vec<Line> = (0..16).map(|i| Line(std::array::from_fn(|k| (100 * i + k) as f64))).collect();
    let results: Vec<Vec<u64>> = InstructionSet::available()
        .into_iter()
        .map(|set| {
            let mut bits = Vec::new();
            dispatch_with(set, Exercise(&lines, &mut bits));
            bits
        })
        .collect();
    assert_eq!(results[0].len(), 35 * LANES);
    // Element k of record r, line 1, is 100 (2 r + 1) + k.
    assert_eq!(f64::from_bits(results[0][12 * LANES + 8 * 2]), 1502.0);
    assert_eq!(f64::from_bits(results[0][20 * LANES + 2]), 1502.0, "transposed back");
    assert_eq!(&results[0][28 * LANES..][..9], [[1.0_f64.to_bits(); 8].as_slice(), &[0]].concat());
    assert_eq!(f64::from_bits(results[0][30 * LANES]), 0b0000_0101 as f64, "where b < a");
    let sums = |k: usize| f64::from_bits(results[0][(31 + 1) * LANES + k]);
    // Lanes 0, 2, 3, 5, 7 hold the records 7, 3, 3, 2, 5; number 0 is summed, number 7 is the largest.
    assert_eq!(sums(0), 1.5 + 100.0 * (15.0 + 7.0 + 7.0 + 5.0 + 11.0));
    assert_eq!(sums(7), 1507.0);
    for result in &results[1..] {
        assert_eq!(result, &results[0]);
    }
}

/// Packs the same numbers with every mask.
struct Packing<'a>(&'a mut Vec<Vec<u32>>);

impl LaneKernel for Packing<'_> {
    fn run<L: Lanes>(self) {
        let numbers = [10, 11, 12, 13, 14, 15, 16, 17];
        let packed = |mask: u8| L::pack(&numbers, mask)[..mask.count_ones() as usize].to_vec();
        self.0.extend((0..=u8::MAX).map(packed));
    }
}

#[test]
fn what_a_mask_picks_is_packed_in_order() {
    for set in InstructionSet::available() {
        let mut packed = Vec::new();
        dispatch_with(set, Packing(&mut packed));
        for (mask, packed) in packed.iter().enumerate() {
            let expected: Vec<u32> = (0..8).filter(|l| mask >> l & 1 == 1).map(|l| 10 + l).collect();
            assert_eq!(packed, &expected, "{set:?}, mask {mask:#b}");
        }
    }
}
