//! Cell lists, kd-tree and brute force find the same pairs, in any box, with unequal sizes.

mod common;

use common::{box_of, random};
use proptest::prelude::*;
use rand::RngExt;
use sph_core::lanes::{InstructionSet, LANES};
use sph_core::neighbors::{NeighborLists, Reach, TILE, brute_force, kd_tree};
use sph_core::{Components, Dim2, Dim3, Dimension, Domain, Vector};

/// Random points in a box with random periodic axes, and sizes over a wide range.
struct Scene<D: Dimension> {
    position: D::AxisColumns,
    size: Vec<f64>,
    domain: Domain<D>,
}

impl<D: Dimension> Scene<D> {
    /// `periodic` has one bit for each axis. `shortest` is the least edge of the box; the least size is 0.02.
    fn new(count: usize, periodic: u8, shortest: f64, seed: u64) -> Self {
        let mut random = random(seed);
        let edges: [f64; 3] = std::array::from_fn(|_| random.random_range(shortest..1.5 * shortest));
        let domain = box_of(|a| edges[a], |a| periodic >> a & 1 == 1);
        let position =
            Components::from_fn(|a| (0..count).map(|_| random.random_range(0.0..edges[a])).collect());
        let size = (0..count).map(|_| random.random_range(0.02..0.1)).collect();
        Self { position, size, domain }
    }

    fn point(&self, i: usize) -> D::Vector {
        D::vector(|a| self.position[a][i])
    }

    fn moved(&self, amplitude: f64, seed: u64) -> D::AxisColumns {
        let mut random = random(seed);
        Components::from_fn(|a| {
            let shift = |x: &f64| x + random.random_range(-amplitude..=amplitude);
            self.position[a].iter().map(shift).collect()
        })
    }
}

/// Pairs of the lists by owner, sorted; each image of a neighbor counts.
fn listed_pairs<D: Dimension>(lists: &NeighborLists<D>) -> Vec<(u32, u32)> {
    let of = |i: usize| lists.neighbors(i).map(move |j| (i as u32, lists.owner(j as usize) as u32));
    let mut pairs: Vec<(u32, u32)> = (0..lists.n_particles()).flat_map(of).collect();
    pairs.sort_unstable();
    pairs
}

/// Pairs with every image, by plain loops over the turns along each axis; (i, i) stands for images of i itself.
fn image_pairs<D: Dimension>(scene: &Scene<D>, cut: impl Fn(f64, f64) -> f64) -> Vec<(u32, u32)> {
    let turns = |a: usize| if a < D::COUNT && scene.domain.periodic[a] { -3..=3 } else { 0..=0 };
    let mut shifts = Vec::new();
    for x in turns(0) {
        for y in turns(1) {
            shifts.extend(turns(2).map(|z| [x, y, z]));
        }
    }
    let mut pairs = Vec::new();
    for i in 0..scene.size.len() {
        for j in 0..scene.size.len() {
            for shift in shifts.iter().filter(|s| i != j || **s != [0; 3]) {
                let image =
                    |a: usize| if shift[a] == 0 { 0.0 } else { shift[a] as f64 * scene.domain.period(a) };
                let offset = scene.point(j) - scene.point(i) + D::vector(image);
                if offset.length() < cut(scene.size[i], scene.size[j]) {
                    pairs.push((i as u32, j as u32));
                }
            }
        }
    }
    pairs
}

/// Pairs of the parts that list each pair once, by particles, the lesser one first; checks the places in the buffers too.
fn pairs_listed_once<D: Dimension>(lists: &NeighborLists<D>) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    for (t, tile) in lists.tiles().iter().enumerate() {
        for block in 0..tile.n_blocks() {
            let (slots, targets) = tile.pairs(block);
            for (slot, target) in slots.iter().zip(targets) {
                for (l, (&j, &place)) in slot.iter().zip(target).enumerate() {
                    let i = t * TILE + block * LANES + l;
                    let owner = lists.owner(j as usize);
                    let there = match (place as usize).checked_sub(tile.n_own()) {
                        Some(foreign) => tile.foreign()[foreign] as usize,
                        None => t * TILE + place as usize,
                    };
                    assert_eq!(there, owner);
                    if j as usize != i {
                        pairs.push((i.min(owner) as u32, i.max(owner) as u32));
                    }
                }
            }
        }
        for incoming in tile.incoming() {
            let source = lists.tiles()[incoming.tile as usize].foreign();
            let of_tile = &source[incoming.first as usize..incoming.end as usize];
            assert!(of_tile.iter().all(|&o| o as usize / TILE == t) && !of_tile.is_empty());
        }
    }
    let incoming: usize =
        lists.tiles().iter().flat_map(|t| t.incoming()).map(|i| (i.end - i.first) as usize).sum();
    assert_eq!(incoming, lists.tiles().iter().map(|t| t.foreign().len()).sum::<usize>());
    pairs.sort_unstable();
    pairs
}

fn searches_agree<D: Dimension>(scene: &Scene<D>, factor: f64, skin: f64) -> Result<(), TestCaseError> {
    let cut = |a: f64, b: f64| factor * (a + b) + skin;
    let plain = brute_force::pairs(&scene.position, &scene.size, &scene.domain, cut);
    let tree = kd_tree::pairs(&scene.position, &scene.size, &scene.domain, cut).unwrap();
    prop_assert_eq!(&tree, &plain);
    let reach = Reach { factor, skin };
    let lists = NeighborLists::<D>::build(&scene.position, &scene.size, &scene.domain, reach);
    for instructions in InstructionSet::available() {
        let mut with = NeighborLists::<D>::default();
        with.rebuild_with(instructions, &scene.position, &scene.size, &scene.domain, reach);
        let block = |lists: &NeighborLists<D>, b: usize| lists.block(b).to_vec();
        let differs = (0..lists.n_padded() / LANES).find(|&b| block(&lists, b) != block(&with, b));
        prop_assert_eq!(differs, None, "a block with {:?}", instructions);
    }
    let mut listed = listed_pairs(&lists);
    prop_assert_eq!(&listed, &image_pairs(scene, cut));
    let mut twice: Vec<(u32, u32)> = pairs_listed_once(&lists).iter().flat_map(|&p| [p, p]).collect();
    let mut unordered: Vec<(u32, u32)> = listed.iter().map(|&(i, j)| (i.min(j), i.max(j))).collect();
    unordered.sort_unstable();
    twice.sort_unstable();
    prop_assert_eq!(&twice, &unordered);
    listed.dedup();
    listed.retain(|&(i, j)| i != j);
    prop_assert_eq!(&listed, &plain);
    Ok(())
}

/// As long as the lists say that they are good, no pair is missing; they say so while no pair can have used the skin up.
fn lists_that_are_good_miss_no_pair<D: Dimension>(
    scene: &Scene<D>,
    skin: f64,
    amplitude: f64,
    seed: u64,
) -> Result<(), TestCaseError> {
    let mut lists =
        NeighborLists::<D>::build(&scene.position, &scene.size, &scene.domain, Reach { factor: 1.0, skin });
    let now = scene.moved(amplitude, seed);
    if lists.outlived(&now) {
        let farthest_apart = 2.0 * amplitude * (D::COUNT as f64).sqrt();
        prop_assert!(farthest_apart > skin, "given up too early");
        return Ok(());
    }
    let listed = listed_pairs(&lists);
    for pair in brute_force::pairs(&now, &scene.size, &scene.domain, |a, b| a + b) {
        prop_assert!(listed.binary_search(&pair).is_ok(), "{:?} is missing", pair);
    }
    Ok(())
}

/// The displacement grows step by step until the lists say that they are outlived; up to then no pair is missing.
fn lists_hold_as_a_flow_goes_on<D: Dimension>(
    scene: &Scene<D>,
    skin: f64,
    amplitude: f64,
    waves: u32,
    closing: f64,
) -> Result<(), TestCaseError> {
    let reach = Reach { factor: 1.0, skin };
    let mut lists = NeighborLists::<D>::build(&scene.position, &scene.size, &scene.domain, reach);
    let listed = listed_pairs(&lists);
    let middle = 0.5 * scene.domain.upper[0];
    for step in 1..=20 {
        let share = step as f64 / 20.0;
        let now = Components::from_fn(|a| {
            let moved = |x: f64| {
                let phase = f64::from(waves) * std::f64::consts::TAU * x / scene.domain.upper[a];
                let stream = if a == 0 && x < middle { closing } else { 0.0 };
                x + share * (amplitude * phase.sin() + stream)
            };
            scene.position[a].iter().map(|&x| moved(x)).collect()
        });
        if lists.outlived(&now) {
            break;
        }
        for pair in brute_force::pairs(&now, &scene.size, &scene.domain, |a, b| a + b) {
            prop_assert!(listed.binary_search(&pair).is_ok(), "{:?} is missing in step {}", pair, step);
        }
    }
    Ok(())
}

/// Two bodies fly towards each other, each without strain: lists end before they touch, and not long before.
#[test]
fn lists_of_bodies_apart_end_before_they_meet() {
    let (edge, gap, skin) = (16, 12.3, 0.2);
    let body = |at: f64| (0..edge * edge).map(move |k| [at + (k / edge) as f64, (k % edge) as f64]);
    let points: Vec<[f64; 2]> = body(0.0).chain(body(f64::from(edge) - 1.0 + gap)).collect();
    let position: [Vec<f64>; 2] = std::array::from_fn(|a| points.iter().map(|p| p[a]).collect());
    let domain = Domain::<Dim2>::open();
    let reach = Reach { factor: 1.0, skin };
    let mut lists = NeighborLists::<Dim2>::build(&position, &vec![1.0; points.len()], &domain, reach);
    let mut flown = 0.0;
    let outlived = |lists: &mut NeighborLists<Dim2>, flown: f64| {
        let mut now = position.clone();
        now[0].iter_mut().take((edge * edge) as usize).for_each(|x| *x += flown);
        lists.outlived(&now)
    };
    while !outlived(&mut lists, flown) {
        flown += 0.05;
        assert!(flown < gap - 2.0, "particles see each other, and the lists know nothing of it");
    }
    assert!(flown > 10.0 * skin, "ended after {flown} of {}", gap - 2.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn searches_agree_in_the_plane(
        seed: u64, count in 0_usize..250, periodic in 0_u8..4, factor in 0.5..1.6, skin in 0.0..0.03
    ) {
        searches_agree(&Scene::<Dim2>::new(count, periodic, 1.0, seed), factor, skin)?;
    }

    #[test]
    fn searches_agree_in_space(
        seed: u64, count in 0_usize..120, periodic in 0_u8..8, factor in 0.5..1.6, skin in 0.0..0.03
    ) {
        searches_agree(&Scene::<Dim3>::new(count, periodic, 0.7, seed), factor, skin)?;
    }

    /// Periods down to less than the reach: particles see several images of each other and of themselves.
    #[test]
    fn searches_agree_in_narrow_boxes(
        seed: u64, count in 1_usize..30, periodic in 1_u8..4, shortest in 0.15..0.4
    ) {
        searches_agree(&Scene::<Dim2>::new(count, periodic, shortest, seed), 1.5, 0.01)?;
    }

    /// Enough particles for many tiles, whose sums go to each other.
    #[test]
    fn searches_agree_over_many_tiles(seed: u64, count in 300_usize..700, periodic in 0_u8..4) {
        searches_agree(&Scene::<Dim2>::new(count, periodic, 3.0, seed), 0.7, 0.02)?;
    }

    #[test]
    fn good_lists_miss_no_pair(
        seed: u64, count in 1_usize..200, periodic in 0_u8..4, skin in 0.0..0.1, share in 0.0..0.7
    ) {
        let scene = Scene::<Dim2>::new(count, periodic, 1.0, seed);
        lists_that_are_good_miss_no_pair(&scene, skin, share * skin, seed)?;
    }

    /// Flows that bring distant particles together: waves of any length, and a stream of their own for each half of the box.
    #[test]
    fn good_lists_miss_no_pair_in_a_flow(
        seed: u64, count in 1_usize..500, periodic in 0_u8..4, skin in 0.0..0.1,
        amplitude in 0.0..0.5, waves in 0_u32..9, closing in 0.0..1.5
    ) {
        let scene = Scene::<Dim2>::new(count, periodic, 2.0, seed);
        lists_hold_as_a_flow_goes_on(&scene, skin, amplitude, waves, closing)?;
    }

    #[test]
    fn good_lists_miss_no_pair_in_a_flow_in_space(
        seed: u64, count in 1_usize..300, periodic in 0_u8..8, skin in 0.0..0.1,
        amplitude in 0.0..0.5, waves in 0_u32..5, closing in 0.0..1.0
    ) {
        let scene = Scene::<Dim3>::new(count, periodic, 1.0, seed);
        lists_hold_as_a_flow_goes_on(&scene, skin, amplitude, waves, closing)?;
    }

    /// The tree's nearest point is the nearest, for targets outside the box too.
    #[test]
    fn the_nearest_point_is_the_nearest(
        seed: u64, count in 1_usize..100, periodic in 0_u8..8, x in -2.0..2.0, y in -2.0..2.0, z in -2.0..2.0
    ) {
        let scene = Scene::<Dim3>::new(count, periodic, 0.7, seed);
        let target = glam::DVec3::new(x, y, z);
        let tree = kd_tree::KdTree::new(&scene.position, &scene.domain).unwrap();
        let distance = |i: usize| scene.domain.distance(target, scene.point(i));
        let least = (0..count).map(distance).fold(f64::INFINITY, f64::min);
        let (_, found) = tree.nearest(target).unwrap();
        prop_assert!((found - least).abs() < 1e-14);
    }
}
