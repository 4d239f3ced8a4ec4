//! The samples of cases that were published with results keep every bit.

use sph_hugoniot::{config, microstructure};

const CASE: &str = r#"Case(
    name: "bits",
    material: Library(name: "porous-copper"),
    medium: (cell: "20 um", pores: PORES(), porosity: 1.35, particle_size: "SIZE", packing: PACKING),
    points: ["100 m/s"],
)"#;

/// FNV-1a over the bits of all numbers of a sample.
fn hash(case: &config::Case) -> u64 {
    let sample = microstructure::sample(case);
    let numbers = sample.particles.iter().flat_map(|p| {
        [p.position.x, p.position.y, p.mass, p.size, p.density, p.id as f64, f64::from(p.material)]
    });
    let bytes =
        numbers.chain([sample.cell, sample.density, sample.porosity]).flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Taken from the program as it was when the figures of the guide were computed.
#[test]
fn samples_keep_their_bits() {
    let shipped = include_str!("../../../cases/porous-copper.ron");
    assert_eq!(hash(&config::parse(shipped, "porous-copper.ron").unwrap()), 0xb222_efc4_5b95_1148);
    for (pores, size, packing, expected) in [
        ("CenteredSquare", "1 um", "Square", 0xb222_efc4_5b95_1148),
        ("CenteredSquare", "2 um", "Square", 0x292e_eb80_2045_e8e0),
        ("CenteredSquare", "0.5 um", "Square", 0x2cd1_7ca1_17d3_1898),
    ] {
        let text = CASE.replace("PORES", pores).replace("SIZE", size).replace("PACKING", packing);
        assert_eq!(hash(&config::parse(&text, "bits.ron").unwrap()), expected, "{pores} {size} {packing}");
    }
}
