//! SIGKILL at random moments: a run that is killed again and again, with states and outcomes damaged in between and another
//! number of threads each time, ends with the bytes of a run that was left alone.
//!
//! `cargo test` kills a few times; `cargo xtask soak` sets `SOAK_KILLS` and `SOAK_SEED`.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use sph_hugoniot::outcome::PointOutcome;
use sph_io::checkpoint;
use sph_riemann::StageTimes;

/// Kills of each case, where the environment does not say otherwise.
const KILLS: u64 = 4;
/// So many kills cannot all come before there is anything to damage.
const MANY: u64 = 20;
/// Where a checkpoint has its version: a file of another one is refused, not damaged.
const VERSION: Range<usize> = 8..12;

fn number(variable: &str, default: u64) -> u64 {
    std::env::var(variable).map_or(default, |text| text.parse().expect("a whole number"))
}

/// Fewer cells than the smoke case has: the test is of restart.
const SHORT: [(&str, &str); 2] =
    [("Cells(4), block_cells: 2", "Cells(2), block_cells: 1"), ("max_fed_cells: 12", "max_fed_cells: 6")];

/// The shipped smoke case, shorter, with something in place of something else.
fn smoke(changes: &[(&str, &str)]) -> String {
    let mut text = sph_hugoniot::template::text("smoke").expect("the template").to_owned();
    for (from, to) in SHORT.iter().chain(changes) {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    text
}

/// Runs of one case: straight through, and killed.
struct Soak {
    folder: tempfile::TempDir,
    random: Pcg64Mcg,
    kills: u64,
    damaged: u64,
    rounds: u64,
}

impl Soak {
    fn new(case: &str, seed: u64) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("case.ron"), case).expect("the case");
        Self { folder, random: Pcg64Mcg::seed_from_u64(seed), kills: 0, damaged: 0, rounds: 0 }
    }

    fn command(&self, out: &Path, threads: u32, keep_every: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
        command.arg("run").arg(self.folder.path().join("case.ron")).arg("--out").arg(out);
        command.args(["--resume", "--quiet", "--keep-every", keep_every, "--threads", &threads.to_string()]);
        command.env_remove("RUST_BACKTRACE").env_remove("RUST_LOG");
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Runs to the end without being disturbed.
    fn finish(&self, out: &Path, threads: u32) {
        let output = self.command(out, threads, "1e6").output().expect("the program runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }

    /// Starts and kills the run after a random time within `span`; false if it had ended before.
    fn kill_once(&mut self, out: &Path, span: Duration) -> bool {
        let keep_every = ["0", "0.02", "0.2"][self.random.random_range(0..3)];
        let threads = self.random.random_range(1..4);
        let wait = span.mul_f64(self.random.random_range(0.0..1.0));
        let mut child = self.command(out, threads, keep_every).spawn().expect("the program starts");
        std::thread::sleep(wait);
        if let Some(status) = child.try_wait().expect("a process") {
            assert_eq!(status.code(), Some(0), "{:?}", child.wait_with_output());
            return false;
        }
        child.kill().expect("SIGKILL");
        child.wait().expect("it ends");
        self.kills += 1;
        true
    }

    /// Cuts the newest state of a point, or changes a byte of it; the one before must then do. So with the outcome of some
    /// points that have ended: they are then run once more.
    fn damage(&mut self, out: &Path) {
        for point in list(&out.join("points")) {
            let outcome = point.join("outcome.ckpt");
            if outcome.exists() && self.random.random_range(0..2) == 0 {
                self.damage_file(&outcome);
            }
            let is_state = |path: &PathBuf| {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                name.starts_with("state-") && name.ends_with(".ckpt")
            };
            let states: Vec<PathBuf> = list(&point).into_iter().filter(is_state).collect();
            let [_, newest] = &states[..] else { continue };
            self.damage_file(newest);
        }
    }

    /// Cuts a file, or changes a byte of it.
    fn damage_file(&mut self, path: &Path) {
        let mut bytes = std::fs::read(path).expect("a state or an outcome");
        // Killed before it saw that a state was cut to nothing: there is nothing to damage any more.
        if bytes.is_empty() {
            return;
        }
        let place = self.random.random_range(0..bytes.len());
        if self.random.random_range(0..2) == 0 || VERSION.contains(&place) {
            bytes.truncate(place);
        } else {
            bytes[place] ^= self.random.random_range(1..256_u32) as u8;
        }
        std::fs::write(path, bytes).expect("a damaged file");
        self.damaged += 1;
    }

    /// Kills the run until it is through; and so again in a new folder, until there were enough kills.
    fn run(&mut self, kills: u64) {
        let straight = self.folder.path().join("straight through");
        let started = Instant::now();
        self.finish(&straight, 1);
        // Most of a short run's time goes into its pictures; most kills, not all, shall fall into what comes before.
        let whole = started.elapsed();
        let early = whole.mul_f64(0.25);
        let expected = contents(&straight);
        assert!(expected.len() >= 10, "{:?}", expected.keys());
        while self.kills < kills {
            let out = self.folder.path().join(format!("killed {}", self.rounds));
            // A run that is killed before it comes far must come to its end all the same.
            for _ in 0..3 {
                let span = if self.random.random_range(0..3) == 0 { whole } else { early };
                if self.kills >= kills || !self.kill_once(&out, span) {
                    break;
                }
                self.damage(&out);
            }
            let threads = self.random.random_range(1..4);
            self.finish(&out, threads);
            assert_same(&expected, &contents(&out));
            std::fs::remove_dir_all(&out).expect("the folder goes");
            self.rounds += 1;
        }
    }
}

/// Entries of a folder in the order of their names; none if it is not there.
fn list(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths
}

/// What a run leaves, without what tells of time: name and content.
fn contents(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![out.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in list(&folder) {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(out).expect("below it").to_string_lossy().into_owned();
            let told_again = ["report.html", "status.json", "hugoniot.json"].contains(&name.as_str());
            let aside = [".lock", ".damaged"].iter().any(|ending| name.ends_with(ending));
            if !(told_again || aside) {
                found.insert(name, timeless(&path));
            }
        }
    }
    found
}

/// A file's bytes; of outcomes and of the table all but the times.
fn timeless(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).expect("a file");
    match path.file_name().and_then(|name| name.to_str()) {
        Some("outcome.ckpt") => {
            let found = checkpoint::read_bytes::<PointOutcome>(&bytes, path).expect("a whole outcome");
            let outcome = PointOutcome { stages: StageTimes::default(), wall_seconds: 0.0, ..found.header };
            format!("{outcome:?}").into_bytes()
        }
        Some("hugoniot.csv") => without_times(&String::from_utf8(bytes).expect("a table")).into_bytes(),
        _ => bytes,
    }
}

/// The table without its remarks and without the columns that tell of time.
fn without_times(table: &str) -> String {
    let mut rows = table.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(','));
    let header: Vec<&str> = rows.next().expect("a header").collect();
    let timed = |name: &str| name.starts_with("wall_time") || name.starts_with("particle_steps_per_second");
    assert_eq!(header.iter().filter(|name| timed(name)).count(), 2, "{header:?}");
    let row = |cells: std::str::Split<'_, char>| {
        cells
            .zip(&header)
            .filter(|(_, name)| !timed(name))
            .map(|(cell, _)| cell)
            .collect::<Vec<_>>()
            .join(",")
    };
    rows.map(row).collect::<Vec<_>>().join("\n")
}

fn assert_same(expected: &BTreeMap<String, Vec<u8>>, found: &BTreeMap<String, Vec<u8>>) {
    let names = |map: &BTreeMap<String, Vec<u8>>| map.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(expected), names(found));
    for (name, bytes) in expected {
        assert!(bytes == &found[name], "{name} is not what it is in a run that was left alone");
    }
}

fn soak(name: &str, case: &str, seed: u64) {
    let (kills, seed) = (number("SOAK_KILLS", KILLS), number("SOAK_SEED", seed));
    let mut soak = Soak::new(case, seed);
    soak.run(kills);
    assert!(kills < MANY || soak.damaged > 0, "{name}: {kills} kills, and no file was damaged");
    println!(
        "{name}: {} kills and {} damaged files in {} runs, seed {seed}: same bytes",
        soak.kills, soak.damaged, soak.rounds
    );
}

/// With moments for ParaView, which must be the same files too, and voids that remember.
#[test]
fn tracking() {
    let case = smoke(&[
        (
            "Library(name: \"porous-copper\")",
            "Library(name: \"porous-copper\", tensile_failure: VoidGrowth())",
        ),
        ("directory: \"results/smoke\"", "snapshots: Every(cells: 2)"),
    ]);
    soak("tracking", &case, 1);
}

/// The bisection keeps a second state, the one that its trials start from, and its log.
#[test]
fn bisection() {
    let search = "search: Bisection(samples: 2, rounds: 1, tolerance: \"60 m/s\"), points: [\"300 m/s\"],";
    let shipped = sph_hugoniot::template::text("smoke").expect("the template");
    let mut case = shipped.replace("points: [\"200 m/s\", \"300 m/s\"],", search);
    SHORT.iter().for_each(|(from, to)| case = case.replace(from, to));
    assert!(case.contains("Bisection") && case.contains("max_fed_cells: 6"));
    soak("bisection", &case, 2);
}

/// Two solids, pores at random places in a rectangular cell, faces closed.
#[test]
fn media() {
    let aluminum = "MieGruneisen(name: \"aluminum\", density: \"2785 kg/m3\", bulk_sound_speed: \"5328 m/s\", hugoniot_slope: \
                    1.338, gruneisen_coefficient: 2.0, shear_modulus: \"28.6 GPa\", yield_strength: \"0.26 GPa\")";
    let materials = format!("materials: [Library(name: \"porous-copper\"), {aluminum}]");
    let medium = "cell: (\"24 um\", \"20 um\"), inclusions: [(of: Material(\"aluminum\"), \
                  places: Random(radius: Constant(\"4 um\"), gap: \"4 um\", seed: 1), share: 0.1)]";
    let case = smoke(&[
        ("material: Library(name: \"porous-copper\")", &materials),
        ("cell: \"20 um\"", medium),
        ("CenteredSquare()", "Random(radius: Constant(\"4 um\"), gap: \"4 um\", seed: 2)"),
        ("porosity: 1.35", "porosity: 1.15"),
        ("window:", "scheme: (face_closure: On()), window:"),
    ]);
    soak("media", &case, 3);
}
