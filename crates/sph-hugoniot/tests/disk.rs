//! A full disk and a folder that must not be written to: a clear error, nothing lost, and the same bits after `--resume`.
//!
//! The disks are small file systems in memory, mounted in a name space of the test's own; where the system allows no
//! such name space the tests say so and end.

#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::Command;

/// What a script in a name space of its own gave: exit code, standard output, standard error.
struct Said {
    code: Option<i32>,
    out: String,
    error: String,
}

/// Runs a shell script that may mount file systems; `None` where that is not allowed.
fn with_mounts(script: &str, folder: &Path) -> Option<Said> {
    let unshare = ["--user", "--map-root-user", "--mount"];
    let allowed = Command::new("unshare")
        .args(unshare)
        .args(["mount", "-t", "tmpfs", "tmpfs"])
        .arg(folder)
        .output()
        .is_ok_and(|output| output.status.success());
    if !allowed {
        eprintln!("not tested: this system mounts nothing for an ordinary user");
        return None;
    }
    let output = Command::new("unshare")
        .args(unshare)
        .args(["sh", "-c", script])
        .current_dir(folder)
        .env("HUGONIOT", env!("CARGO_BIN_EXE_hugoniot"))
        .env("CASE", Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/smoke.ron"))
        .env_remove("RUST_BACKTRACE")
        .output()
        .expect("a shell");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Some(Said { code: output.status.code(), out: text(&output.stdout), error: text(&output.stderr) })
}

#[test]
fn a_full_disk_ends_the_run_with_a_word_and_costs_nothing_that_was_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    // 120 kB hold one state of a point and no second.
    let script = r#"
        mkdir small && mount -t tmpfs -o size=120k tmpfs small
        "$HUGONIOT" run "$CASE" --threads 1 --quiet --keep-every 0.2 --out small/run
        echo "code $?"
        ls small/run/points/*/*.ckpt
        mount -o remount,size=16m small
        "$HUGONIOT" run "$CASE" --threads 1 --quiet --resume --out small/run
        echo "code $?"
        "$HUGONIOT" run "$CASE" --threads 1 --quiet --out straight
        strip() { grep -v '^#' "$1/hugoniot.csv" | cut -d, -f1-12; }
        strip small/run > a; strip straight > b
        cmp a b && cmp small/run/points/up_0200/profile.csv straight/points/up_0200/profile.csv && echo "the same bits"
    "#;
    let Some(said) = with_mounts(script, folder.path()) else { return };
    assert!(said.error.contains("No space left on device"), "{}", said.error);
    assert!(said.error.contains("--resume"), "how to go on: {}", said.error);
    assert_eq!(said.error.matches("No space left").count(), 1, "said once: {}", said.error);
    assert!(said.out.starts_with("code 1\n"), "{}", said.out);
    assert!(said.out.contains("state-"), "a state was kept: {}", said.out);
    assert!(said.out.contains("code 0\nthe same bits\n"), "{}\n{}", said.out, said.error);
    assert_eq!(said.code, Some(0));
}

#[test]
fn a_folder_that_must_not_be_written_to_is_named_and_left_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = r#"
        mkdir fixed && mount -t tmpfs tmpfs fixed && mkdir fixed/run && mount -o remount,ro fixed
        "$HUGONIOT" run "$CASE" --threads 1 --quiet --out fixed/run
        echo "code $?"
        "$HUGONIOT" run "$CASE" --threads 1 --quiet --out "fixed/new folder"
        echo "code $?"
    "#;
    let Some(said) = with_mounts(script, folder.path()) else { return };
    assert_eq!(said.out, "code 1\ncode 1\n", "{}", said.error);
    assert!(said.error.contains("fixed/run") && said.error.contains("fixed/new folder"), "{}", said.error);
    assert_eq!(said.error.matches("Read-only file system").count(), 2, "{}", said.error);
}
