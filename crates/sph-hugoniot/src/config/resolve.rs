//! Schema → case: required fields, defaults, ranges, and what fields must hold together. All faults are noted.

use std::path::Path;

use sph_case::units::significant;
use sph_case::{Checker, Faults, Field, Span};

use super::case::*;
use super::resolve_medium::Surroundings;
use super::schema::*;
use crate::zone::AutoLength;

/// The newest format of case files, and so far the only one. A change after which an old file would be read differently
/// raises it; [`resolve()`] then translates the older formats, or refuses them with what to write instead. Further fields
/// that may be left out change nothing of what old files mean, and raise no number.
pub const CASE_FORMAT: u64 = 1;

/// Most particles that a window may hold: about 100 GB, beyond any machine that this program is made for.
pub const MAX_PARTICLES: f64 = 1e8;

/// Least and greatest u_p that is accepted [m/s].
pub const PARTICLE_VELOCITIES: (f64, f64) = (1.0, 3000.0);

/// Turns what was written into a case; `None` when a fault was noted, here or before.
///
/// Files that the case names are looked for in `folder`.
pub fn resolve(schema: &CaseSchema, whole: &Span, folder: &Path, faults: &Faults) -> Option<Case> {
    let r = Resolver(Checker { faults });
    let format = r.format(&schema.format, CASE_FORMAT);
    let name = schema.name.required("name", whole, faults).cloned();
    let materials = r.materials(schema, whole);
    let names: Option<Vec<String>> =
        materials.as_ref().map(|list| list.iter().map(|m| m.name.clone()).collect());
    let surroundings = Surroundings { materials: names.as_deref(), folder };
    let medium = schema
        .medium
        .required("medium", whole, faults)
        .and_then(|m| r.medium(m, &span_of(&schema.medium), surroundings));
    let points =
        schema.points.required("points", whole, faults).and_then(|p| r.points(p, &span_of(&schema.points)));
    let data = r.data(&schema.data, folder);
    let scheme = r.group(&schema.scheme, |s| r.scheme(s));
    let parts = medium.as_ref().zip(materials.as_deref().and_then(<[_]>::first));
    let automatic = |place: f64| {
        parts.map_or(AutoLength::UNKNOWN, |(medium, material)| AutoLength::new(medium, material, place))
    };
    let window = r.group(&schema.window, |w| r.window(w, automatic));
    let search = r.search(&schema.search);
    let stop = r.group(&schema.stop, |s| r.stop(s));
    let output = r.group(&schema.output, |o| r.output(o, name.as_deref()));
    let (points, refinement) = points.unzip();
    if let (Some(medium), Some(window), Some(points)) = (&medium, &window, &points) {
        r.window_fits(schema, medium, window, points);
    }
    if let (Some(window), Some(points), Some(stop)) = (&window, &points, &stop) {
        r.points_can_settle(schema, window, points, stop);
    }
    if let (Some(materials), Some(medium), Some(points)) = (materials.as_deref(), &medium, &points) {
        r.fronts_separate(&schema.points, materials, medium.porosity, points);
    }
    let mut materials = materials?.into_iter();
    format?;
    let case = Case {
        name: name?,
        material: materials.next()?,
        further_materials: materials.collect(),
        medium: medium?,
        scheme: scheme?,
        window: window?,
        search: search?,
        points: points?,
        refinement: refinement?,
        stop: stop?,
        data: data?,
        output: output?,
    };
    faults.is_empty().then_some(case)
}

pub(super) fn span_of<T>(field: &Field<T>) -> Span {
    field.span().unwrap_or(0..0)
}

/// Checks of the groups; those of single fields are the [`Checker`]'s.
pub(super) struct Resolver<'f>(pub(super) Checker<'f>);

impl<'f> std::ops::Deref for Resolver<'f> {
    type Target = Checker<'f>;

    fn deref(&self) -> &Checker<'f> {
        &self.0
    }
}

impl Resolver<'_> {
    fn stop(&self, s: &StopSchema) -> Option<Stop> {
        let startup_cells = match &s.startup_cells {
            Field::Bad(_) => None,
            Field::Absent | Field::Good(StartupSchema::Auto, _) => Some(None),
            Field::Good(StartupSchema::Cells(n), _) => self.count(n, 12, 1, 100_000).map(Some),
        };
        let block_cells = self.count(&s.block_cells, 4, 1, 10_000);
        let blocks = self.count(&s.blocks, 2, 2, 100);
        let tolerance = self.number(&s.tolerance, 0.005, 1e-5, 0.5);
        let max_fed_cells = self.count(&s.max_fed_cells, 60, 3, 1_000_000);
        Some(Stop {
            startup_cells: startup_cells?,
            block_cells: block_cells?,
            blocks: blocks?,
            tolerance: tolerance?,
            max_fed_cells: max_fed_cells?,
        })
    }

    fn output(&self, o: &OutputSchema, name: Option<&str>) -> Option<Output> {
        let automatic =
            || format!("results/{}", name.unwrap_or("case").replace(|c: char| !c.is_alphanumeric(), "-"));
        let directory = match &o.directory {
            Field::Absent => Some(automatic()),
            Field::Bad(_) => None,
            Field::Good(path, span) if path.is_empty() => {
                self.refuse(
                    span.clone(),
                    "the folder has no name".into(),
                    "such as \"results/porous-copper\"",
                );
                None
            }
            Field::Good(path, span) if path.contains('\0') => {
                self.refuse(
                    span.clone(),
                    "no folder can have this name: it holds the character zero".into(),
                    "such as \"results/porous-copper\"",
                );
                None
            }
            Field::Good(path, _) => Some(path.clone()),
        };
        let bins_per_cell = self.count(&o.bins_per_cell, 10, 1, 1000);
        let images = self.choice(&o.images, true);
        let snapshots = self.snapshots(&o.snapshots);
        Some(Output {
            directory: directory?,
            bins_per_cell: bins_per_cell?,
            images: images?,
            snapshots: snapshots?,
        })
    }

    fn snapshots(&self, s: &Field<SnapshotsSchema>) -> Option<Option<Snapshots>> {
        match s {
            Field::Bad(_) => None,
            Field::Absent | Field::Good(SnapshotsSchema::Off, _) => Some(None),
            Field::Good(SnapshotsSchema::Every(every), _) => {
                let cells = self.number(&every.cells, 0.5, 1e-3, 1e6);
                let limit = self.number(&every.limit_mb, 500.0, 1e-3, 1e9);
                Some(Some(Snapshots { every_cells: cells?, limit_bytes: 1e6 * limit? }))
            }
        }
    }

    /// The longest window fits into memory and leaves room between its regions.
    fn window_fits(&self, schema: &CaseSchema, medium: &Medium, window: &WindowCase, points: &[f64]) {
        let longest = points.iter().map(|&u| window.cells_at(u)).max().unwrap_or(0);
        let (along, across) = (medium.cell / medium.particle_size, medium.height / medium.particle_size);
        let particles = longest as f64 * along * across;
        let length = schema.window.get().and_then(|w| w.length.span());
        let span = length.unwrap_or_else(|| span_of(&schema.medium));
        if particles > MAX_PARTICLES {
            let message = format!("the window would hold {} particles", significant(particles));
            let hint =
                format!("at most {MAX_PARTICLES:e}: coarser particles, a smaller cell or a shorter window");
            return self.refuse(span, message, &hint);
        }
        let regions = 3.0 * window.region_width * medium.particle_size;
        if longest as f64 * medium.cell < regions + 3.0 * medium.cell {
            let message =
                format!("a window of {longest} cells leaves less than three cells between its regions");
            let least = (regions / medium.cell + 3.0).ceil();
            self.refuse(span, message, &format!("at least {least} cells"));
        }
    }

    /// The cells fed at most suffice for start-up and the blocks that must agree.
    fn points_can_settle(&self, schema: &CaseSchema, window: &WindowCase, points: &[f64], stop: &Stop) {
        let needed = points.iter().map(|&u| stop.least_fed_cells(window.cells_at(u))).max().unwrap_or(0);
        if stop.max_fed_cells < needed {
            let most = schema.stop.get().and_then(|s| s.max_fed_cells.span());
            let span = most.unwrap_or_else(|| span_of(&schema.stop));
            let message = format!("{} cells end before a point can settle", stop.max_fed_cells);
            self.refuse(
                span,
                message,
                &format!("at least {needed}: start-up and the blocks that must agree"),
            );
        }
    }
}
