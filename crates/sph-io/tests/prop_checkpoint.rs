//! Checkpoints come back bit for bit, and no damage passes unnoticed.

use proptest::prelude::*;
use serde::{Deserialize, Serialize};
use sph_io::IoError;
use sph_io::checkpoint::{self, Checkpoint, CheckpointStore, ColumnData, FORMAT_VERSION};
use std::fs;
use std::path::Path;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Header {
    step: u64,
    time: f64,
    case: String,
}

fn header(step: u64) -> Header {
    Header { step, time: 1.5e-7, case: "porous copper".into() }
}

fn write_sample(path: &Path) {
    let density: Vec<f64> = (0..40).map(|k| 8930.0 + f64::from(k)).collect();
    let columns = [
        ("density", ColumnData::F64(&density)),
        ("id", ColumnData::U64(&[7, u64::MAX, 0])),
        ("material", ColumnData::U32(&[1, 2, 3, 4])),
        ("flags", ColumnData::U8(b"abc")),
        ("none", ColumnData::F64(&[])),
    ];
    checkpoint::write(path, &header(3), &columns).unwrap();
}

fn read(path: &Path) -> Result<Checkpoint<Header>, IoError> {
    checkpoint::read(path)
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn odd_numbers_keep_their_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    let odd = [f64::from_bits(0x7ff8_0000_dead_beef), f64::from_bits(0xfff0_0000_0000_0001), -0.0, 5e-324];
    checkpoint::write(&path, &header(1), &[("odd", ColumnData::F64(&odd))]).unwrap();
    let mut back = read(&path).unwrap();
    assert_eq!(back.header, header(1));
    assert_eq!(bits(&back.take_f64("odd").unwrap()), bits(&odd));
    assert_eq!(back.column_names().count(), 0);
}

#[test]
fn every_kind_comes_back_and_a_wrong_wish_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    write_sample(&path);
    let mut back = read(&path).unwrap();
    assert_eq!(back.column_names().collect::<Vec<_>>(), ["density", "id", "material", "flags", "none"]);
    assert_eq!(back.take_u64("id").unwrap(), [7, u64::MAX, 0]);
    assert_eq!(back.take_u32("material").unwrap(), [1, 2, 3, 4]);
    assert_eq!(back.take_u8("flags").unwrap(), b"abc");
    assert!(back.take_f64("none").unwrap().is_empty());
    let absent = back.take_f64("pressure").unwrap_err().to_string();
    assert!(absent.contains("there is no column `pressure`"), "{absent}");
    let kind = back.take_u32("density").unwrap_err().to_string();
    assert!(kind.contains("`density` holds f64, and u32 is wanted"), "{kind}");
}

#[test]
fn a_file_cut_at_any_length_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    write_sample(&path);
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        assert!(matches!(read(&path), Err(IoError::Damaged { .. })), "cut at {length} of {}", whole.len());
    }
    fs::write(&path, [&whole[..], b"x"].concat()).unwrap();
    assert!(read(&path).unwrap_err().to_string().contains("13 bytes follow the last column"));
}

#[test]
fn the_damaged_column_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    let noise: Vec<u64> = (0..500u64).map(|k| k.wrapping_mul(0x9e37_79b9_7f4a_7c15)).collect();
    let columns = [("first", ColumnData::U64(&noise)), ("second", ColumnData::U64(&noise))];
    checkpoint::write(&path, &header(1), &columns).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let within_second = bytes.len() - 1000;
    bytes[within_second] ^= 1;
    fs::write(&path, bytes).unwrap();
    let message = read(&path).unwrap_err().to_string();
    assert!(message.contains("a.ckpt: damaged") && message.contains("column `second`"), "{message}");
}

#[test]
fn another_version_and_another_header_are_told_apart_from_damage() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    write_sample(&path);
    let other: Result<Checkpoint<(u8, u8)>, _> = checkpoint::read(&path);
    assert!(matches!(other, Err(IoError::Mismatch { .. })));
    let mut bytes = fs::read(&path).unwrap();
    bytes[8] += 1;
    fs::write(&path, bytes).unwrap();
    assert!(matches!(read(&path), Err(IoError::Version { found, .. }) if found == FORMAT_VERSION + 1));
    assert!(matches!(read(&folder.path().join("absent")), Err(IoError::File { .. })));
}

#[test]
fn names_must_differ() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    let columns = [("a", ColumnData::U8(b"1")), ("a", ColumnData::U8(b"2"))];
    assert!(matches!(checkpoint::write(&path, &header(1), &columns), Err(IoError::Invalid { .. })));
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_store_keeps_two_and_falls_back_on_the_older() {
    let folder = tempfile::tempdir().unwrap();
    let store = CheckpointStore::new(folder.path(), "point-100");
    fs::write(folder.path().join("point-100-notes.txt"), "not a checkpoint").unwrap();
    assert!(store.load::<Header>().unwrap().is_none());
    let mut newest = std::path::PathBuf::new();
    for step in 1..=4 {
        newest = store.save(&header(step), &[("a", ColumnData::F64(&[step as f64]))]).unwrap();
    }
    let kept = ["point-100-0000000003.ckpt", "point-100-0000000004.ckpt", "point-100-notes.txt"];
    assert_eq!(names(folder.path()), kept);
    assert_eq!(store.load::<Header>().unwrap().unwrap().checkpoint.header.step, 4);

    let mut bytes = fs::read(&newest).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    fs::write(&newest, bytes).unwrap();
    let loaded = store.load::<Header>().unwrap().unwrap();
    assert_eq!(loaded.checkpoint.header.step, 3);
    assert_eq!(loaded.skipped.len(), 1);
    assert_eq!(loaded.skipped[0].path(), newest);

    // The damaged one no longer counts: the next save leaves the good one standing.
    store.save(&header(5), &[]).unwrap();
    let listed = names(folder.path());
    assert!(listed.contains(&"point-100-0000000003.ckpt".to_owned()), "{listed:?}");
    assert!(listed.contains(&"point-100-0000000004.ckpt.damaged".to_owned()), "{listed:?}");
}

#[test]
fn a_store_with_only_damaged_files_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let store = CheckpointStore::new(folder.path(), "a");
    fs::write(folder.path().join("a-0000000001.ckpt"), "rubbish").unwrap();
    assert!(matches!(store.load::<Header>(), Err(IoError::Damaged { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    #[test]
    fn any_bits_come_back(reals in prop::collection::vec(any::<u64>(), 0..200), small in any::<Vec<u8>>()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ckpt");
        let values: Vec<f64> = reals.iter().map(|&word| f64::from_bits(word)).collect();
        let columns = [("reals", ColumnData::F64(&values)), ("small", ColumnData::U8(&small))];
        checkpoint::write(&path, &header(9), &columns).unwrap();
        let mut back = read(&path).unwrap();
        prop_assert_eq!(bits(&back.take_f64("reals").unwrap()), reals);
        prop_assert_eq!(back.take_u8("small").unwrap(), small);
    }

    #[test]
    fn any_changed_byte_is_noticed(place in any::<prop::sample::Index>(), change in 1u8..) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ckpt");
        write_sample(&path);
        let mut bytes = fs::read(&path).unwrap();
        let place = place.index(bytes.len());
        bytes[place] ^= change;
        fs::write(&path, bytes).unwrap();
        prop_assert!(read(&path).is_err());
    }

    #[test]
    fn rubbish_behind_a_true_beginning_is_an_error(rubbish in any::<Vec<u8>>()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ckpt");
        let beginning = [b"sph-ckpt".as_slice(), &FORMAT_VERSION.to_le_bytes(), &rubbish].concat();
        fs::write(&path, beginning).unwrap();
        prop_assert!(read(&path).is_err());
    }
}
