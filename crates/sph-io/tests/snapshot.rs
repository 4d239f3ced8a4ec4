//! Reads snapshots back with a parser that shares nothing with the writer.

use flate2::read::ZlibDecoder;
use sph_io::snapshot::{Precision, Snapshot, SnapshotSeries};
use std::io::Read;

/// The lines of the head, and the blob behind the underscore.
fn parts(file: &[u8]) -> (String, &[u8]) {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let start = file.windows(mark.len()).position(|window| window == mark).unwrap();
    (String::from_utf8(file[..start].to_vec()).unwrap(), &file[start + mark.len()..])
}

fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
    let start = line.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    line[start..].split('"').next().unwrap()
}

fn line_of<'a>(head: &'a str, array: &str) -> &'a str {
    head.lines().find(|line| line.contains(&format!("Name=\"{array}\""))).unwrap()
}

/// The bytes of an array, put together from its blocks.
fn bytes_of(head: &str, blob: &[u8], array: &str) -> Vec<u8> {
    let offset: usize = attribute(line_of(head, array), "offset").parse().unwrap();
    let number = |k: usize| u64::from_le_bytes(blob[offset + 8 * k..][..8].try_into().unwrap()) as usize;
    let (n_blocks, block_size, last) = (number(0), number(1), number(2));
    let mut at = offset + 8 * (3 + n_blocks);
    let mut out = Vec::new();
    for block in 0..n_blocks {
        let before = out.len();
        ZlibDecoder::new(&blob[at..at + number(3 + block)]).read_to_end(&mut out).unwrap();
        let expected = if block + 1 == n_blocks && last > 0 { last } else { block_size };
        assert_eq!(out.len() - before, expected);
        at += number(3 + block);
    }
    out
}

fn doubles(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap())).collect()
}

#[test]
fn every_value_comes_back() {
    // Large enough for several blocks, one of them partial.
    let n = 50_001;
    let points: Vec<[f64; 3]> = (0..n).map(|k| [f64::from(k) * 0.37, 1.0 / f64::from(k + 1), 0.0]).collect();
    let rho: Vec<f64> = (0..n).map(|k| 8930.0 + f64::from(k).sin()).collect();
    let stress: Vec<[f64; 6]> = rho.iter().map(|&r| [r, -r, 0.5 * r, 1.0, f64::NAN, -0.0]).collect();
    let ids: Vec<i64> = (0..i64::from(n)).rev().collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtp");
    Snapshot::new(1.25e-7, &points)
        .with_scalar("density", &rho)
        .with_vector("velocity", &points)
        .with_symmetric_tensor("stress", &stress)
        .with_integer("id", &ids)
        .with_precision(Precision::Double)
        .write_vtp(&path)
        .unwrap();
    let file = std::fs::read(&path).unwrap();
    let (head, blob) = parts(&file);
    assert!(head.contains("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">1.25e-7<"));
    assert!(head.contains(&format!("NumberOfPoints=\"{n}\" NumberOfVerts=\"{n}\"")));
    assert_eq!(doubles(&bytes_of(&head, blob, "density")), rho);
    assert_eq!(doubles(&bytes_of(&head, blob, "Points")), points.as_flattened());
    assert_eq!(doubles(&bytes_of(&head, blob, "velocity")), points.as_flattened());
    let tensor = doubles(&bytes_of(&head, blob, "stress"));
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&tensor), bits(stress.as_flattened()));
    assert_eq!(attribute(line_of(&head, "stress"), "ComponentName3"), "XY");
    let integers = |array: &str| -> Vec<i64> {
        let bytes = bytes_of(&head, blob, array);
        bytes.chunks_exact(8).map(|chunk| i64::from_le_bytes(chunk.try_into().unwrap())).collect()
    };
    assert_eq!(integers("id"), ids);
    assert_eq!(integers("connectivity"), (0..i64::from(n)).collect::<Vec<_>>());
    assert_eq!(integers("offsets"), (1..=i64::from(n)).collect::<Vec<_>>());
}

#[test]
fn single_precision_takes_four_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtp");
    Snapshot::new(0.0, &[[1.5, 2.5, 0.0]]).with_scalar("a < \"b\"", &[0.1]).write_vtp(&path).unwrap();
    let file = std::fs::read(&path).unwrap();
    let (head, blob) = parts(&file);
    let name = "a &lt; &quot;b&quot;";
    assert_eq!(attribute(line_of(&head, name), "type"), "Float32");
    assert_eq!(bytes_of(&head, blob, name), 0.1f32.to_le_bytes());
}

#[test]
fn arrays_must_fit_the_points() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.vtp");
    let points = [[0.0; 3]; 2];
    let short = Snapshot::new(0.0, &points).with_scalar("rho", &[1.0]);
    assert!(short.write_vtp(&path).unwrap_err().to_string().contains("`rho` has 1 values for 2 particles"));
    let twice = Snapshot::new(0.0, &points).with_scalar("a", &[1.0; 2]).with_integer("a", &[1; 2]);
    assert!(twice.write_vtp(&path).unwrap_err().to_string().contains("two arrays are named `a`"));
    assert!(!path.exists());
}

#[test]
fn a_series_lists_its_snapshots() {
    let folder = tempfile::tempdir().unwrap();
    let mut series = SnapshotSeries::new(folder.path(), "window");
    for k in 0..3 {
        series.add(&Snapshot::new(f64::from(k) * 1e-9, &[[0.0; 3]])).unwrap();
    }
    let list = std::fs::read_to_string(series.path()).unwrap();
    assert!(list.contains("timestep=\"2e-9\" part=\"0\" file=\"window_000002.vtp\""), "{list}");
    assert!(folder.path().join("window_000002.vtp").exists());
    assert_eq!(series.len(), 3);
}
