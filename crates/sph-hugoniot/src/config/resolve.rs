//! Schema → case: required fields, defaults, ranges, and what fields must hold together. All faults are noted.

use super::case::*;
use super::fault::{Fault, Faults, Span};
use super::field::Field;
use super::schema::*;
use super::units::{Count, Kind, LengthKind, Number, Quantity, show, significant};

/// Most particles that a window may hold: about 100 GB, beyond any machine that this program is made for.
pub const MAX_PARTICLES: f64 = 1e8;

/// Least and greatest u_p that is accepted [m/s].
pub const PARTICLE_VELOCITIES: (f64, f64) = (1.0, 3000.0);

/// Turns what was written into a case; `None` when a fault was noted, here or before.
pub fn resolve(schema: &CaseSchema, whole: &Span, faults: &Faults) -> Option<Case> {
    let r = Resolver { faults };
    let name = schema.name.required("name", whole, faults).cloned();
    let material = schema
        .material
        .required("material", whole, faults)
        .and_then(|m| r.material(m, &span_of(&schema.material)));
    let medium =
        schema.medium.required("medium", whole, faults).and_then(|m| r.medium(m, &span_of(&schema.medium)));
    let points =
        schema.points.required("points", whole, faults).and_then(|p| r.points(p, &span_of(&schema.points)));
    let data = r.data(&schema.data);
    let scheme = r.group(&schema.scheme, |s| r.scheme(s));
    let window = r.group(&schema.window, |w| r.window(w));
    let stop = r.group(&schema.stop, |s| r.stop(s));
    let output = r.group(&schema.output, |o| r.output(o, name.as_deref()));
    let (points, refinement) = points.unzip();
    if let (Some(medium), Some(window), Some(points)) = (&medium, &window, &points) {
        r.window_fits(schema, medium, window, points);
    }
    if let (Some(window), Some(points), Some(stop)) = (&window, &points, &stop) {
        r.points_can_settle(schema, window, points, stop);
    }
    let case = Case {
        name: name?,
        material: material?,
        medium: medium?,
        scheme: scheme?,
        window: window?,
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

/// Checks of single fields and groups.
pub(super) struct Resolver<'f> {
    pub(super) faults: &'f Faults,
}

impl Resolver<'_> {
    pub(super) fn refuse(&self, span: Span, message: String, hint: &str) {
        self.faults.push(Fault::new(span, message).hint(hint));
    }

    /// A group that may be absent: then all its fields have their defaults.
    fn group<S: Default, T>(&self, field: &Field<S>, read: impl Fn(&S) -> Option<T>) -> Option<T> {
        match field {
            Field::Absent => read(&S::default()),
            Field::Bad(_) => None,
            Field::Good(group, _) => read(group),
        }
    }

    /// A quantity within [low, high], SI.
    pub(super) fn quantity<K: Kind>(&self, field: &Field<Quantity<K>>, low: f64, high: f64) -> Option<f64> {
        let Field::Good(value, span) = field else { return None };
        if (low..=high).contains(&value.si) {
            return Some(value.si);
        }
        let message = format!("{} is out of range", show::<K>(value.si));
        self.refuse(span.clone(), message, &format!("from {} to {}", show::<K>(low), show::<K>(high)));
        None
    }

    /// A required quantity within [low, high], SI.
    pub(super) fn needed<K: Kind>(
        &self,
        field: &Field<Quantity<K>>,
        name: &str,
        group: &Span,
        low: f64,
        high: f64,
    ) -> Option<f64> {
        field.required(name, group, self.faults);
        self.quantity(field, low, high)
    }

    /// A plain number within [low, high], or the default.
    pub(super) fn number(&self, field: &Field<Number>, default: f64, low: f64, high: f64) -> Option<f64> {
        let Field::Good(Number(value), span) = field else {
            return matches!(field, Field::Absent).then_some(default);
        };
        if (low..=high).contains(value) {
            return Some(*value);
        }
        let hint = format!(
            "from {} to {}; {} if left out",
            significant(low),
            significant(high),
            significant(default)
        );
        self.refuse(span.clone(), format!("{} is out of range", significant(*value)), &hint);
        None
    }

    /// A whole number within [low, high], or the default.
    pub(super) fn count(&self, field: &Field<Count>, default: u64, low: u64, high: u64) -> Option<usize> {
        let Field::Good(Count(value), span) = field else {
            return matches!(field, Field::Absent).then_some(default as usize);
        };
        if (low..=high).contains(value) {
            return Some(*value as usize);
        }
        self.refuse(span.clone(), format!("{value} is out of range"), &format!("from {low} to {high}"));
        None
    }

    pub(super) fn choice<T: Copy>(&self, field: &Field<T>, default: T) -> Option<T> {
        match field {
            Field::Absent => Some(default),
            Field::Bad(_) => None,
            Field::Good(value, _) => Some(*value),
        }
    }

    fn medium(&self, m: &MediumSchema, group: &Span) -> Option<Medium> {
        let cell = self.needed(&m.cell, "cell", group, 1e-9, 1.0);
        let particle_size = self.needed(&m.particle_size, "particle_size", group, 1e-10, 1.0);
        let packing = match self.choice(&m.packing, PackingSchema::Square)? {
            PackingSchema::Square => Packing::Square,
            PackingSchema::Hexagonal => Packing::Hexagonal,
        };
        let porosity = self.number(&m.porosity, 1.0, 1.0, 20.0);
        m.pores.required("pores", group, self.faults);
        if let (Some(cell), Some(size)) = (cell, particle_size) {
            self.whole_particles(cell, size, m);
        }
        let (pores, radius) = self.pores(m, cell?, porosity?, particle_size?)?;
        let porosity = if matches!(m.porosity, Field::Absent) {
            geometric_porosity(pores, radius, cell?)
        } else {
            porosity?
        };
        Some(Medium { cell: cell?, pores, radius, porosity, particle_size: particle_size?, packing })
    }

    /// The cell must hold a whole number of particles along each edge: the sample repeats without a seam.
    fn whole_particles(&self, cell: f64, size: f64, m: &MediumSchema) {
        let n = cell / size;
        let (few, many) = (4.0, 4000.0);
        let span = span_of(&m.particle_size);
        if !(few..=many).contains(&n) {
            let message = format!(
                "{} gives {} particles along the cell's edge",
                show::<LengthKind>(size),
                significant(n)
            );
            return self.refuse(span, message, &format!("from {few} to {many}"));
        }
        if (n - n.round()).abs() > 1e-6 * n {
            let message = format!(
                "{} does not divide the cell's edge {}",
                show::<LengthKind>(size),
                show::<LengthKind>(cell)
            );
            let hint = format!(
                "nearest: {} or {}",
                show::<LengthKind>(cell / n.ceil()),
                show::<LengthKind>(cell / n.floor())
            );
            return self.refuse(span, message, &hint);
        }
        if n.round() % 2.0 != 0.0 && matches!(m.pores.get(), Some(PoresSchema::CenteredSquare(_))) {
            let message =
                format!("{} particles along the edge: the two pores of a cell would differ", n.round());
            self.refuse(
                span,
                message,
                &format!("an even number, such as {}", show::<LengthKind>(cell / (n.round() + 1.0))),
            );
        }
    }

    /// Lattice and radius; radius and porosity may each be left out, and must agree when both are given.
    fn pores(&self, m: &MediumSchema, cell: f64, porosity: f64, size: f64) -> Option<(Pores, f64)> {
        let (pores, pore) = match m.pores.get()? {
            PoresSchema::None => {
                if porosity > 1.0 {
                    self.refuse(
                        span_of(&m.porosity),
                        format!("{porosity} is asked for without pores"),
                        "leave it out, or add pores",
                    );
                }
                return Some((Pores::None, 0.0));
            }
            PoresSchema::Square(pore) => (Pores::Square, pore),
            PoresSchema::CenteredSquare(pore) => (Pores::CenteredSquare, pore),
        };
        let wanted =
            (cell * cell * (1.0 - 1.0 / porosity) / (pores.count() as f64 * std::f64::consts::PI)).sqrt();
        let given = self.quantity(&pore.radius, 0.0, cell);
        let span = pore.radius.span().or(m.porosity.span()).unwrap_or_else(|| span_of(&m.pores));
        if matches!(pore.radius, Field::Absent) && matches!(m.porosity, Field::Absent) {
            self.refuse(
                span_of(&m.pores),
                "neither radius nor porosity is given".into(),
                "radius: \"4.06 um\", or porosity: 1.35",
            );
            return None;
        }
        let radius = if matches!(pore.radius, Field::Absent) { wanted } else { given? };
        let largest = 0.5 * pores.spacing() * cell - size;
        if radius > largest {
            let message = format!("pores of radius {} touch or overlap", show::<LengthKind>(radius));
            self.refuse(
                span,
                message,
                &format!("at most {}: half the distance less one particle", show::<LengthKind>(largest)),
            );
            return None;
        }
        if matches!(m.porosity, Field::Good(..)) && (radius - wanted).abs() > 0.03 * wanted + 0.5 * size {
            let found = geometric_porosity(pores, radius, cell);
            let message = format!(
                "radius {} gives porosity {}, not {porosity}",
                show::<LengthKind>(radius),
                significant(found)
            );
            self.refuse(
                span,
                message,
                &format!("leave one out, or use radius {}", show::<LengthKind>(wanted)),
            );
            return None;
        }
        Some((pores, radius))
    }

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
            Field::Good(path, _) => Some(path.clone()),
        };
        let bins_per_cell = self.count(&o.bins_per_cell, 10, 1, 1000);
        let images = self.choice(&o.images, true);
        Some(Output { directory: directory?, bins_per_cell: bins_per_cell?, images: images? })
    }

    /// The longest window fits into memory and leaves room between its regions.
    fn window_fits(&self, schema: &CaseSchema, medium: &Medium, window: &WindowCase, points: &[f64]) {
        let longest = points.iter().map(|&u| window.cells_at(u)).max().unwrap_or(0);
        let along = medium.cell / medium.particle_size;
        let particles = longest as f64 * along * along;
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

/// Porosity of a cell with circular pores.
fn geometric_porosity(pores: Pores, radius: f64, cell: f64) -> f64 {
    1.0 / (1.0 - pores.count() as f64 * std::f64::consts::PI * radius * radius / (cell * cell))
}
