//! How far a long piece of work has come: a bar on a terminal, time-stamped lines elsewhere, both on standard error.
//!
//! The time left is that of the pace since the first report, so a run that resumes in the middle is not taken for a
//! fast one. `NO_COLOR` is honored (<https://no-color.org>).
//!
//! ```
//! use sph_io::progress::{Mode, Progress};
//! let mut progress = Progress::new(24.0, "u_p = 100 m/s", Mode::Quiet);
//! progress.update(6.5, "u_s = 431 m/s");
//! progress.finish("u_s = 425 ± 4 m/s");
//! ```

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write, stderr};
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};

/// Least time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);
/// Steps of the bar.
const RESOLUTION: u64 = 10_000;

/// Whether bars are colored: by `NO_COLOR`, or as [`set_color`] says.
static COLOR: AtomicU8 = AtomicU8::new(0);
const ALWAYS: u8 = 1;
const NEVER: u8 = 2;

/// Says whether bars are colored from now on, whatever `NO_COLOR` says.
pub fn set_color(is_on: bool) {
    COLOR.store(if is_on { ALWAYS } else { NEVER }, Ordering::Relaxed);
}

/// Where progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// A bar if standard error is a terminal, otherwise plain lines.
    #[default]
    Auto,
    /// Nowhere.
    Quiet,
    /// Plain lines, on a terminal too.
    Plain,
}

/// The progress of one piece of work.
pub struct Progress {
    label: String,
    total: f64,
    clock: Clock,
    display: Display,
}

enum Display {
    Bar(ProgressBar),
    Lines { out: Box<dyn Write + Send>, last: Option<Instant> },
    Nothing,
}

/// The pace since the first report.
#[derive(Debug, Clone, Copy)]
struct Clock {
    start: Instant,
    /// Amount done at the first report, and when that was.
    first: Option<(f64, Instant)>,
    done: f64,
}

impl Progress {
    /// Begins work of the amount `total` (steps, cells, seconds: whatever [`update`](Self::update) counts).
    pub fn new(total: f64, label: impl Into<String>, mode: Mode) -> Self {
        let label = label.into();
        let display = match mode {
            Mode::Quiet => Display::Nothing,
            Mode::Auto if stderr().is_terminal() => Display::Bar(bar(&label)),
            Mode::Auto | Mode::Plain => Display::Lines { out: Box::new(stderr()), last: None },
        };
        Self::with_display(total, label, display)
    }

    /// Begins work that is reported as plain lines to `out`.
    pub fn to_writer(total: f64, label: impl Into<String>, out: impl Write + Send + 'static) -> Self {
        Self::with_display(total, label.into(), Display::Lines { out: Box::new(out), last: None })
    }

    fn with_display(total: f64, label: String, display: Display) -> Self {
        let clock = Clock { start: Instant::now(), first: None, done: 0.0 };
        Self { label, total, clock, display }
    }

    /// Reports the amount done so far. Cheap, so it may be called at each step: lines are shown every few seconds, a
    /// bar is drawn some times a second.
    pub fn update(&mut self, done: f64, message: &str) {
        let now = Instant::now();
        self.clock.report(done, now);
        let is_due = match &self.display {
            Display::Lines { last, .. } => last.is_none_or(|last| now - last >= LINE_INTERVAL),
            _ => false,
        };
        if let Display::Bar(bar) = &self.display {
            bar.set_position((self.fraction() * RESOLUTION as f64) as u64);
            bar.set_message(self.with_time_left(message));
        } else if is_due {
            let percent = 100.0 * self.fraction();
            self.write_line(&format!("{percent:3.0} %  {}", self.with_time_left(message)));
        }
    }

    /// The time left at the pace so far; `None` before the second report.
    #[must_use]
    pub fn eta(&self) -> Option<Duration> {
        self.clock.time_left(self.total, Instant::now())
    }

    /// Time since the beginning.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.clock.start.elapsed()
    }

    /// Shows a line, such as a warning, without tearing the bar.
    pub fn note(&mut self, line: &str) {
        match &self.display {
            Display::Bar(bar) => bar.println(line),
            Display::Lines { .. } => self.write_line(line),
            Display::Nothing => {}
        }
    }

    /// Ends the work with a last line that stays.
    pub fn finish(mut self, message: &str) {
        let took = duration(self.elapsed());
        if let Display::Bar(bar) = &self.display {
            // In this order: a bar that is finished prints no more.
            bar.println(format!("{}  {message}  ({took})", self.label));
            bar.finish_and_clear();
        } else {
            self.write_line(&format!("{message}  ({took})"));
        }
    }

    fn fraction(&self) -> f64 {
        let fraction = self.clock.done / self.total;
        if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 }
    }

    fn with_time_left(&self, message: &str) -> String {
        match self.eta() {
            Some(left) => format!("{message}  {} left", duration(left)),
            None => message.to_owned(),
        }
    }

    /// Writes a line; that nobody can read it is no reason to stop the work.
    fn write_line(&mut self, line: &str) {
        let stamp = stamp(self.elapsed());
        if let Display::Lines { out, last } = &mut self.display {
            let _ = writeln!(out, "[{stamp}] {}  {line}", self.label);
            *last = Some(Instant::now());
        }
    }
}

impl Clock {
    fn report(&mut self, done: f64, now: Instant) {
        if done.is_finite() {
            self.first.get_or_insert((done, now));
            self.done = done;
        }
    }

    fn time_left(&self, total: f64, now: Instant) -> Option<Duration> {
        let (first_done, first_time) = self.first?;
        let seconds = (now - first_time).as_secs_f64() * (total - self.done) / (self.done - first_done);
        (self.done > first_done).then(|| Duration::try_from_secs_f64(seconds.max(0.0)).ok())?
    }
}

fn bar(label: &str) -> ProgressBar {
    let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let is_colored = match COLOR.load(Ordering::Relaxed) {
        ALWAYS => true,
        NEVER => false,
        _ => !unwanted,
    };
    let color = if is_colored { ".cyan/dim" } else { "" };
    let template = format!("{{prefix}} [{{bar:30{color}}}] {{percent:>3}} %  {{msg}}");
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::with_draw_target(Some(RESOLUTION), ProgressDrawTarget::stderr_with_hz(4));
    bar.set_style(style.progress_chars("━━─"));
    bar.set_prefix(label.to_owned());
    bar
}

/// Hours, minutes and seconds since the beginning.
fn stamp(elapsed: Duration) -> String {
    let seconds = elapsed.as_secs();
    format!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

/// A duration as one says it.
fn duration(duration: Duration) -> String {
    match duration.as_secs() {
        0..60 => format!("{:.0} s", duration.as_secs_f64().floor()),
        seconds @ 60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        seconds => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    #[derive(Clone, Default)]
    struct Shared(Arc<Mutex<Vec<u8>>>);

    impl Write for Shared {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn lines_are_rare_stamped_and_end_with_the_result() {
        let out = Shared::default();
        let mut progress = Progress::to_writer(10.0, "u_p = 100 m/s", out.clone());
        for step in 0..1000 {
            progress.update(f64::from(step) * 0.01, "running");
        }
        progress.note("a warning");
        progress.finish("u_s = 425 m/s");
        let text = String::from_utf8(out.0.lock().unwrap().clone()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3, "{text}");
        assert_eq!(lines[0], "[00:00:00] u_p = 100 m/s    0 %  running");
        assert!(lines[1].ends_with("a warning"), "{text}");
        assert!(lines[2].ends_with("u_p = 100 m/s  u_s = 425 m/s  (0 s)"), "{text}");
    }

    #[test]
    fn time_left_is_that_of_the_pace_since_the_first_report() {
        let start = Instant::now();
        let mut clock = Clock { start, first: None, done: 0.0 };
        assert_eq!(clock.time_left(100.0, start), None);
        clock.report(50.0, start);
        assert_eq!(clock.time_left(100.0, start + Duration::from_secs(1)), None);
        clock.report(60.0, start + Duration::from_secs(10));
        let left = clock.time_left(100.0, start + Duration::from_secs(10)).unwrap();
        assert_eq!(left, Duration::from_secs(40));
    }

    #[test]
    fn odd_amounts_do_no_harm() {
        let mut progress = Progress::new(f64::NAN, "empty", Mode::Quiet);
        progress.update(f64::NAN, "");
        progress.update(5.0, "");
        assert_eq!(progress.eta(), None);
        assert_eq!(progress.fraction(), 0.0);
        progress.finish("");
    }

    #[test]
    fn durations_read_well() {
        let cases = [(0.4, "0 s"), (59.9, "59 s"), (185.0, "3 min 05 s"), (7320.0, "2 h 02 min")];
        for (seconds, words) in cases {
            assert_eq!(duration(Duration::from_secs_f64(seconds)), words);
        }
    }
}
