//! The medium of a case: cell, particles, pores, porosity; what fills the cell is read in `resolve_layout`, `resolve_image`
//! and `resolve_shapes`.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec2;

use super::fault::Span;
use super::field::Field;
use super::medium::{Medium, Packing, Pores};
use super::resolve::{Resolver, span_of};
use super::schema::*;
use super::units::{LengthKind, show, significant};
use crate::microstructure::layout::{Base, Fill, Layout};
use crate::microstructure::placement::Amount;
use crate::microstructure::pore_centers;
use crate::microstructure::shape::Shape;

/// Fewest and most particles along an edge of the cell.
const ALONG_EDGE: (f64, f64) = (4.0, 4000.0);
/// Most particles of a cell: a sample of a few hundred megabytes.
const MAX_PARTICLES: f64 = 5e6;
/// How far spacings are stretched to fit a cell that nobody can choose, that of a picture or of hexagonal pores [-].
const STRETCH: f64 = 0.03;
/// Largest porosity.
const LIMIT: f64 = 20.0;

/// What a medium is read in.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'s> {
    /// Names of the materials; `None` if they could not be read.
    pub materials: Option<&'s [String]>,
    /// Folder of the case file.
    pub folder: &'s Path,
}

impl Resolver<'_> {
    pub(super) fn medium(&self, m: &MediumSchema, group: &Span, around: Surroundings<'_>) -> Option<Medium> {
        let particle_size = self.needed(&m.particle_size, "particle_size", group, 1e-10, 1.0);
        let packing = self.choice(&m.packing, PackingSchema::Square).map(|packing| match packing {
            PackingSchema::Square => Packing::Square,
            PackingSchema::Hexagonal => Packing::Hexagonal,
            PackingSchema::Relaxed => Packing::Relaxed,
        });
        let porosity = self.number(&m.porosity, 1.0, 1.0, LIMIT);
        if matches!((&m.shapes, &m.layers, &m.image), (Field::Absent, Field::Absent, Field::Absent)) {
            m.pores.required("pores", group, self.faults);
        }
        let base = self.base(m, around);
        let cell = self.cell(m, group, base.as_ref());
        let (cell, size) = (cell?, particle_size?);
        let good = self.whole_particles(cell, size, m);
        let layout = Layout { base: base?, painted: Vec::new() };
        // What fills the cell is looked at even if the porosity is wrong: its faults are told too.
        let draft = Draft { m, cell, size, good: good && porosity.is_some(), around };
        draft.finish(self, layout, porosity, packing.unwrap_or(Packing::Square)).filter(|_| packing.is_some())
    }

    /// Length and height of the cell; hexagonal pores and pictures have their own.
    fn cell(&self, m: &MediumSchema, group: &Span, base: Option<&Base>) -> Option<DVec2> {
        if let Some(Base::Image(image)) = base {
            if let Some(span) = m.cell.span() {
                let own = image.cell();
                let message = format!(
                    "the picture gives the cell: {} × {}",
                    show::<LengthKind>(own.x),
                    show::<LengthKind>(own.y)
                );
                self.refuse(span, message, "leave `cell` out; `pixel_size` and `crop` change it");
            }
            return Some(image.cell());
        }
        if matches!(m.image, Field::Absent) {
            m.cell.required("cell", group, self.faults);
        }
        let Field::Good(cell, span) = &m.cell else { return None };
        let hexagonal = matches!(m.pores.get(), Some(PoresSchema::Hexagonal(_)));
        let cell = match *cell {
            CellSchema::Edge(edge) if hexagonal => DVec2::new(edge.si, 3f64.sqrt() * edge.si),
            CellSchema::Edge(edge) => DVec2::splat(edge.si),
            CellSchema::Rectangle(length, height) => DVec2::new(length.si, height.si),
        };
        if cell.cmpge(DVec2::splat(1e-9)).all() && cell.cmple(DVec2::ONE).all() {
            return Some(cell);
        }
        let shown = format!("{} × {}", show::<LengthKind>(cell.x), show::<LengthKind>(cell.y));
        self.refuse(span.clone(), format!("a cell of {shown} is out of range"), "edges from 1 nm to 1 m");
        None
    }

    /// The cell must hold a whole number of particles along each edge: the sample repeats without a seam. False if it
    /// does not.
    fn whole_particles(&self, cell: DVec2, size: f64, m: &MediumSchema) -> bool {
        let span = span_of(&m.particle_size);
        let fitted_height = !matches!(m.cell.get(), Some(CellSchema::Rectangle(..)))
            && matches!(m.pores.get(), Some(PoresSchema::Hexagonal(_)));
        let picture = matches!(m.image, Field::Good(..));
        for (edge, fitted) in [(cell.x, picture), (cell.y, picture || fitted_height)] {
            if !self.fits_edge(edge, size, fitted, &span) {
                return false;
            }
        }
        let count = (cell.x / size).round() * (cell.y / size).round();
        if count > MAX_PARTICLES {
            let message =
                format!("{} gives {} particles a cell", show::<LengthKind>(size), significant(count));
            self.refuse(
                span,
                message,
                &format!("at most {MAX_PARTICLES:e}: coarser particles or a smaller cell"),
            );
            return false;
        }
        let n = (cell.x / size).round();
        let odd = n % 2.0 != 0.0 || (cell.y / size).round() % 2.0 != 0.0;
        if odd && matches!(m.pores.get(), Some(PoresSchema::CenteredSquare(_))) {
            let message = format!("{n} particles along the edge: the two pores of a cell would differ");
            let hint = format!("an even number, such as {}", show::<LengthKind>(cell.x / (n + 1.0)));
            self.refuse(span, message, &hint);
            return false;
        }
        true
    }

    fn fits_edge(&self, edge: f64, size: f64, fitted: bool, span: &Span) -> bool {
        let n = edge / size;
        if !(ALONG_EDGE.0..=ALONG_EDGE.1).contains(&n) {
            let message = format!(
                "{} gives {} particles along the cell's edge of {}",
                show::<LengthKind>(size),
                significant(n.floor()),
                show::<LengthKind>(edge)
            );
            self.refuse(span.clone(), message, &format!("from {} to {}", ALONG_EDGE.0, ALONG_EDGE.1));
            return false;
        }
        let off = (n - n.round()).abs();
        if off > if fitted { STRETCH * n } else { 1e-6 * n } {
            let (size, edge_shown) = (show::<LengthKind>(size), show::<LengthKind>(edge));
            let message = format!("{size} does not divide the cell's edge {edge_shown}");
            let (below, above) = (show::<LengthKind>(edge / n.ceil()), show::<LengthKind>(edge / n.floor()));
            self.refuse(span.clone(), message, &format!("nearest: {below} or {above}"));
            return false;
        }
        true
    }

    /// Radius of pores on a lattice; radius and porosity may each be left out, and must agree when both are given.
    fn lattice_radius(&self, m: &MediumSchema, place: LatticePlace<'_>, porosity: f64) -> Option<f64> {
        let LatticePlace { pores, cell, size, radius: field } = place;
        let count = pores.count() as f64;
        let wanted = (cell.x * cell.y * (1.0 - 1.0 / porosity) / (count * PI)).sqrt();
        let given = self.quantity(field, 0.0, cell.max_element());
        let span = field.span().or(m.porosity.span()).unwrap_or_else(|| span_of(&m.pores));
        if matches!((field, &m.porosity), (Field::Absent, Field::Absent)) {
            self.refuse(
                span_of(&m.pores),
                "neither radius nor porosity is given".into(),
                "radius: \"4.06 um\", or porosity: 1.35",
            );
            return None;
        }
        let radius = if matches!(field, Field::Absent) { wanted } else { given? };
        self.lattice_fits(pores, cell, radius, size, &span)?;
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
        Some(radius)
    }

    /// Circles on a lattice keep a particle's width between them.
    pub(super) fn lattice_fits(
        &self,
        pores: Pores,
        cell: DVec2,
        radius: f64,
        size: f64,
        span: &Span,
    ) -> Option<()> {
        let largest = 0.5 * lattice_spacing(pores, cell) - size;
        if radius <= largest {
            return Some(());
        }
        let message = format!("pores of radius {} touch or overlap", show::<LengthKind>(radius));
        let share = pores.count() as f64 * PI * largest * largest / (cell.x * cell.y);
        let porosity = significant((1e3 / (1.0 - share)).floor() / 1e3);
        let most = show::<LengthKind>(largest);
        let hint = match largest > 0.0 {
            true => {
                format!("at most {most}, half the distance less one particle; porosity at most {porosity}")
            }
            false => "finer particles, or a larger cell".into(),
        };
        self.refuse(span.clone(), message, &hint);
        None
    }
}

/// Circles on a lattice.
struct LatticePlace<'m> {
    pores: Pores,
    cell: DVec2,
    size: f64,
    radius: &'m Field<super::units::Length>,
}

/// Least distance between the centers of pores on a lattice [m].
fn lattice_spacing(pores: Pores, cell: DVec2) -> f64 {
    match pores {
        Pores::CenteredSquare | Pores::Hexagonal => cell.min_element().min(0.5 * cell.length()),
        Pores::None | Pores::Square | Pores::Placed => cell.min_element(),
    }
}

/// Porosity of a cell with circular pores.
fn geometric_porosity(pores: Pores, radius: f64, cell: DVec2) -> f64 {
    1.0 / (1.0 - pores.count() as f64 * PI * radius * radius / (cell.x * cell.y))
}

/// A medium whose cell and particles are known.
pub(super) struct Draft<'m> {
    pub m: &'m MediumSchema,
    pub cell: DVec2,
    pub size: f64,
    /// False if particles do not fit the cell: nothing large is then tried.
    pub good: bool,
    pub around: Surroundings<'m>,
}

impl Draft<'_> {
    /// Paints all that the case asks for, settles radius and porosity.
    fn finish(
        &self,
        r: &Resolver<'_>,
        mut layout: Layout,
        porosity: Option<f64>,
        packing: Packing,
    ) -> Option<Medium> {
        let m = self.m;
        self.paint_layers(r, &mut layout);
        let mut standing = self.paint_inclusions(r, &mut layout);
        standing.extend(self.paint_shapes(r, &mut layout));
        let has_voids = layout.has(Fill::Void);
        let (pores, lattice) = match m.pores.get() {
            None | Some(PoresSchema::None) => (Pores::None, None),
            Some(PoresSchema::Square(pore)) => (Pores::Square, Some(pore)),
            Some(PoresSchema::CenteredSquare(pore)) => (Pores::CenteredSquare, Some(pore)),
            Some(PoresSchema::Hexagonal(pore)) => (Pores::Hexagonal, Some(pore)),
            Some(PoresSchema::Random(random)) => {
                return self.random_pores(r, random, layout, &standing, porosity, packing);
            }
        };
        let porosity = porosity?;
        let mut radius = 0.0;
        if let Some(pore) = lattice {
            let place = LatticePlace { pores, cell: self.cell, size: self.size, radius: &pore.radius };
            radius = if has_voids {
                pore.radius.required("radius", &span_of(&m.pores), r.faults);
                let given = r.quantity(&pore.radius, 0.0, self.cell.max_element())?;
                r.lattice_fits(pores, self.cell, given, self.size, &span_of(&pore.radius))?;
                given
            } else {
                r.lattice_radius(m, place, porosity)?
            };
        }
        for center in pore_centers(pores, self.cell) {
            layout.paint(Shape::Circle { center, radius }, Fill::Void);
        }
        let porosity = match (has_voids, lattice) {
            (true, _) => self.porosity_of(r, &layout, porosity)?,
            (false, Some(_)) if matches!(m.porosity, Field::Absent) => {
                geometric_porosity(pores, radius, self.cell)
            }
            (false, Some(_)) => porosity,
            (false, None) => self.solid(r, porosity),
        };
        Some(self.medium(layout, pores, radius, porosity, packing))
    }

    fn medium(&self, layout: Layout, pores: Pores, radius: f64, porosity: f64, packing: Packing) -> Medium {
        let (cell, height) = (self.cell.x, self.cell.y);
        Medium { cell, height, pores, radius, porosity, particle_size: self.size, packing, layout }
    }

    fn solid(&self, r: &Resolver<'_>, porosity: f64) -> f64 {
        if porosity > 1.0 {
            let message = format!("{porosity} is asked for without pores");
            r.refuse(span_of(&self.m.porosity), message, "leave it out, or add pores");
        }
        1.0
    }

    /// Pores at random: their number by `count`, or by the porosity.
    fn random_pores(
        &self,
        r: &Resolver<'_>,
        random: &RandomSchema,
        mut layout: Layout,
        standing: &[Shape],
        porosity: Option<f64>,
        packing: Packing,
    ) -> Option<Medium> {
        let span = span_of(&self.m.pores);
        let has_voids = layout.has(Fill::Void);
        let there = if has_voids && self.good { layout.share(Fill::Void, self.cell) } else { 0.0 };
        let share = porosity.map_or(0.0, |porosity| 1.0 - 1.0 / porosity);
        let wanted = Amount::Share((share - there).max(0.0));
        let by_porosity = matches!(random.count, Field::Absent) && !is_listed(random);
        if by_porosity && matches!(self.m.porosity, Field::Absent) {
            r.refuse(
                span,
                "neither the porosity nor the number of pores is given".into(),
                "porosity: 1.35 beside `pores`, or `count: 12` within",
            );
            return None;
        }
        if by_porosity && share > 0.0 && share <= there {
            let (there, share) = (100.0 * there, 100.0 * share);
            let message = format!(
                "the other voids take {there:.1} % of the cell already, the porosity asks for {share:.1} % in all"
            );
            r.refuse(span, message, "fewer or smaller voids, a higher porosity, or no `pores`");
            return None;
        }
        let shapes = self.place_at_random(r, random, by_porosity.then_some(wanted), standing, &span)?;
        shapes.into_iter().for_each(|shape| layout.paint(shape, Fill::Void));
        let exact = by_porosity && !has_voids;
        let porosity = porosity?;
        let porosity = if exact { porosity } else { self.porosity_of(r, &layout, porosity)? };
        Some(self.medium(layout, Pores::Placed, 0.0, porosity, packing))
    }

    /// Where the voids are written: the porosity, or what makes them.
    fn voids_span(&self) -> Span {
        let m = self.m;
        let spans = [m.porosity.span(), m.pores.span(), m.image.span(), m.shapes.span(), m.layers.span()];
        spans.into_iter().flatten().next().unwrap_or_else(|| span_of(&m.particle_size))
    }

    /// Porosity of a layout; one that is given must be near it: no boundary moves by more than a particle or two pixels.
    fn porosity_of(&self, r: &Resolver<'_>, layout: &Layout, porosity: f64) -> Option<f64> {
        if !self.good {
            return None;
        }
        let share = layout.share(Fill::Void, self.cell);
        let found = 1.0 / (1.0 - share);
        let span = self.voids_span();
        if !(1.0..=LIMIT).contains(&found) {
            let message = format!("voids take {} % of the cell", significant((share * 1e4).round() / 100.0));
            let hint = match &layout.base {
                Base::Image(_) => {
                    format!("porosity up to {LIMIT}: other gray levels for the void, see `levels`")
                }
                Base::Uniform(_) => format!("porosity up to {LIMIT}: smaller voids"),
            };
            r.refuse(span, message, &hint);
            return None;
        }
        if matches!(self.m.porosity, Field::Absent) {
            return Some(found);
        }
        let pixel = if let Base::Image(image) = &layout.base { 2.0 * image.pixel_size } else { 0.0 };
        let (offset, most) = (layout.offset_for(1.0 - 1.0 / porosity, self.cell), self.size.max(pixel));
        if offset.abs() <= most {
            return Some(porosity);
        }
        let way = match offset.is_finite() {
            true => format!("their boundaries would have to move by {}", show::<LengthKind>(offset)),
            false => "no void is there to grow".into(),
        };
        r.refuse(
            span,
            format!(
                "the voids give porosity {}, not {porosity}: {way}",
                significant((found * 1e4).round() / 1e4)
            ),
            &format!(
                "leave porosity out, or change the voids; at most {} is made up for",
                show::<LengthKind>(most)
            ),
        );
        None
    }
}

/// True if the sizes are listed: then they are as many as the list has.
pub(super) fn is_listed(random: &RandomSchema) -> bool {
    matches!(random.radius.get(), Some(SizesSchema::Listed(_)))
}
