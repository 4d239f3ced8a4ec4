//! The bytes of a case file become text, or a fault with its place.

use std::path::PathBuf;

use sph_case::text_of;

/// A file with these bytes, and its folder, which goes when dropped.
fn file(bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.ron");
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

#[test]
fn the_mark_at_the_beginning_is_no_part_of_the_text() {
    let (_folder, path) = file("\u{feff}(a: 1)".as_bytes());
    assert_eq!(text_of(&path).unwrap(), "(a: 1)");
    let (_folder, path) = file(b"(a: 1)");
    assert_eq!(text_of(&path).unwrap(), "(a: 1)");
}

#[test]
fn what_is_no_text_is_told_with_its_place() {
    // "µ" of Latin-1 in the second line.
    let (_folder, path) = file(b"(\n  cell: \"20 \xb5m\",\n)");
    let told = text_of(&path).unwrap_err().to_string();
    for part in ["byte 0xb5 means nothing here", "case.ron:2:13", "save it as UTF-8"] {
        assert!(told.contains(part), "{part}\n{told}");
    }
    let utf16: Vec<u8> = "\u{feff}(a: 1)".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let (_folder, path) = file(&utf16);
    let told = text_of(&path).unwrap_err().to_string();
    assert!(told.contains("case.ron:1:1") && told.contains("this looks like UTF-16"), "{told}");
}

#[test]
fn only_so_much_is_read() {
    let (_folder, path) = file(&vec![b' '; 1 << 20]);
    assert_eq!(text_of(&path).unwrap().len(), 1 << 20);
    let (_folder, path) = file(&vec![b' '; (1 << 20) + 1]);
    assert!(text_of(&path).unwrap_err().to_string().contains("more than 1048576 bytes"));
}

/// A device has no length and no end.
#[cfg(unix)]
#[test]
fn a_device_without_an_end_is_refused() {
    assert!(text_of("/dev/zero".as_ref()).unwrap_err().to_string().contains("more than 1048576 bytes"));
}
