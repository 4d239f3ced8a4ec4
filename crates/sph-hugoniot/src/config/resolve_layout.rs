//! What fills the cell of a case: base or picture, layers, inclusions, shapes, and what is placed at random.

use glam::DVec2;

use super::fault::{Span, name_hint};
use super::field::Field;
use super::medium::Pores;
use super::resolve::{Resolver, span_of};
use super::resolve_medium::{Draft, Surroundings, is_listed};
use super::schema::*;
use super::units::{LengthKind, show, significant};
use crate::microstructure::image::{Edges, GrayImage, ImageLayout};
use crate::microstructure::layout::{Base, Fill, Layout};
use crate::microstructure::placement::{self, Amount, Refusal, Request, Sizes};
use crate::microstructure::pore_centers;
use crate::microstructure::shape::Shape;

/// Most shapes, layers or corners of a list.
const MOST: usize = 2000;

impl Resolver<'_> {
    /// What is there before anything is painted.
    pub(super) fn base(&self, m: &MediumSchema, around: Surroundings<'_>) -> Option<Base> {
        match &m.image {
            Field::Bad(_) => None,
            Field::Absent => self.fill(&m.base, Fill::Material(0), around).map(Base::Uniform),
            Field::Good(image, span) => {
                if let Some(base) = m.base.span() {
                    self.refuse(
                        base,
                        "a base is given beside a picture".into(),
                        "leave it out: the picture fills the cell",
                    );
                }
                self.image(image, span, around).map(Base::Image)
            }
        }
    }

    /// A filling by the material's name.
    fn fill(&self, field: &Field<FillSchema>, default: Fill, around: Surroundings<'_>) -> Option<Fill> {
        let (fill, span) = match field {
            Field::Absent => return Some(default),
            Field::Bad(_) => return None,
            Field::Good(fill, span) => (fill, span),
        };
        let FillSchema::Material(name) = fill else { return Some(Fill::Void) };
        let names = around.materials?;
        if let Some(index) = names.iter().position(|known| known == name) {
            return Some(Fill::Material(index as u16));
        }
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        let message = format!("no material of this case is called {name:?}");
        self.refuse(span.clone(), message, &format!("{}; list them in `materials`", name_hint(name, &known)));
        None
    }

    fn image(&self, image: &ImageSchema, group: &Span, around: Surroundings<'_>) -> Option<ImageLayout> {
        let pixel_size = self.needed(&image.pixel_size, "pixel_size", group, 1e-10, 1e-2);
        let ranges = self.levels(image, group, around);
        let edges = match self.choice(&image.edges, EdgesSchema::Mirror)? {
            EdgesSchema::Mirror => Edges::Mirror,
            EdgesSchema::Periodic => Edges::Periodic,
        };
        let name = image.file.required("file", group, self.faults)?;
        let picture = match GrayImage::read(&around.folder.join(name)) {
            Ok(picture) => picture,
            Err(message) => {
                let hint =
                    "a PNG file, its path relative to the case file; crop or shrink one that is too large";
                self.refuse(span_of(&image.file), message, hint);
                return None;
            }
        };
        let picture = self.crop(&image.crop, picture)?;
        let (pixel_size, ranges) = (pixel_size?, ranges?);
        if edges == Edges::Periodic {
            self.seams_fit(
                &picture,
                &ranges,
                pixel_size,
                &image.edges.span().unwrap_or_else(|| group.clone()),
            )?;
        }
        Some(ImageLayout::new(name.clone(), &picture, ranges, pixel_size, edges))
    }

    /// Ranges of gray levels: they rise, and the last reaches white.
    fn levels(
        &self,
        image: &ImageSchema,
        group: &Span,
        around: Surroundings<'_>,
    ) -> Option<Vec<(f64, Fill)>> {
        let list = image.levels.required("levels", group, self.faults)?;
        let span = span_of(&image.levels);
        let read = |field: &Field<LevelSchema>| {
            let level = field.get()?;
            let of = level.of.required("of", &span_of(field), self.faults).map(|_| ());
            let up_to = self.count(&level.up_to, 255, 0, 255);
            let fill = of.and_then(|()| self.fill(&level.of, Fill::Void, around));
            up_to.zip(fill)
        };
        // All are read before any is left out, so that the faults of all are told.
        let read: Vec<Option<(usize, Fill)>> = list.iter().map(read).collect();
        let mut ranges: Vec<(f64, Fill)> = Vec::new();
        for (field, read) in list.iter().zip(read) {
            let (level, (up_to, fill)) = (field.get()?, read?);
            if ranges.last().is_some_and(|last| last.0 >= up_to as f64) {
                let message = format!("{up_to} is not above the level before");
                self.refuse(span_of(&level.up_to), message, "list levels from black (0) to white (255)");
                return None;
            }
            ranges.push((up_to as f64, fill));
        }
        if ranges.last().is_none_or(|last| last.0 < 255.0) {
            self.refuse(
                span,
                "the levels do not reach 255, white".into(),
                "leave `up_to` of the last one out",
            );
            return None;
        }
        Some(ranges)
    }

    fn crop(&self, field: &Field<CropSchema>, picture: GrayImage) -> Option<GrayImage> {
        let (crop, span) = match field {
            Field::Absent => return Some(picture),
            Field::Bad(_) => return None,
            Field::Good(crop, span) => (crop, span),
        };
        let most = 1 << 24;
        let left = self.count(&crop.left, 0, 0, most)?;
        let top = self.count(&crop.top, 0, 0, most)?;
        let width = self.count(&crop.width, picture.width.saturating_sub(left) as u64, 1, most)?;
        let height = self.count(&crop.height, picture.height.saturating_sub(top) as u64, 1, most)?;
        let part = picture.crop(left, top, width, height);
        if part.is_none() {
            let message = format!(
                "columns {left} to {} and rows {top} to {} are not all in the picture",
                left + width,
                top + height
            );
            self.refuse(
                span.clone(),
                message,
                &format!("it has {} × {} pixels", picture.width, picture.height),
            );
        }
        part
    }

    /// A picture that is taken as periodic must fit to itself.
    fn seams_fit(&self, picture: &GrayImage, ranges: &[(f64, Fill)], pixel: f64, span: &Span) -> Option<()> {
        let mut good = true;
        for (vertical, edges, lines, rows) in
            [(true, "left and right", "columns", "rows"), (false, "upper and lower", "rows", "columns")]
        {
            let seam = picture.seam(ranges, vertical);
            if seam.is_periodic() {
                continue;
            }
            good = false;
            let (first, last) = seam.span.unwrap_or((0, 0));
            let at = |k: usize| show::<LengthKind>(k as f64 * pixel);
            let message = format!(
                "the picture is not periodic: its {edges} edges differ in {:.0} % of the {rows}, between {rows} {first} \
                 and {last} ({} and {}); neighboring {lines} inside differ in at most {:.0} %",
                100.0 * seam.share,
                at(first),
                at(last),
                100.0 * seam.usual
            );
            self.refuse(
                span.clone(),
                message,
                "`edges: Mirror` makes any picture periodic; or `crop` to whole periods",
            );
        }
        good.then_some(())
    }

    fn place(&self, field: &Field<PointSchema>, name: &str, group: &Span) -> Option<DVec2> {
        let PointSchema(x, y) = field.required(name, group, self.faults)?;
        Some(DVec2::new(x.si, y.si))
    }
}

impl Draft<'_> {
    /// Layers one after another from x = 0; they must fill the cell.
    pub(super) fn paint_layers(&self, r: &Resolver<'_>, layout: &mut Layout) {
        let Field::Good(list, span) = &self.m.layers else { return };
        let mut from = 0.0;
        for field in list.iter().take(MOST) {
            let Some(layer) = field.get() else { return };
            let thickness = r.needed(&layer.thickness, "thickness", &span_of(field), self.size, self.cell.x);
            layer.of.required("of", &span_of(field), r.faults);
            let fill = r.fill(&layer.of, Fill::Void, self.around);
            let (Some(thickness), Some(fill)) = (thickness, fill) else { return };
            layout.paint(Shape::Layer { from, to: from + thickness }, fill);
            from += thickness;
        }
        if (from - self.cell.x).abs() > 1e-6 * self.cell.x {
            let (sum, cell) = (show::<LengthKind>(from), show::<LengthKind>(self.cell.x));
            let message = format!("the layers are {sum} thick together, the cell {cell} long");
            r.refuse(span.clone(), message, "they must fill the cell along x");
        }
    }

    /// Inclusions of all sets; returns them.
    pub(super) fn paint_inclusions(&self, r: &Resolver<'_>, layout: &mut Layout) -> Vec<Shape> {
        let mut standing: Vec<Shape> = Vec::new();
        let Field::Good(list, _) = &self.m.inclusions else { return standing };
        for field in list.iter().take(MOST) {
            let Some(set) = field.get() else { continue };
            let group = span_of(field);
            set.of.required("of", &group, r.faults);
            let fill = r.fill(&set.of, Fill::Void, self.around);
            let shapes = self.inclusions(r, set, &standing, &group);
            let (Some(fill), Some(shapes)) = (fill, shapes) else { continue };
            shapes.iter().for_each(|shape| layout.paint(shape.clone(), fill));
            standing.extend(shapes);
        }
        standing
    }

    fn inclusions(
        &self,
        r: &Resolver<'_>,
        set: &InclusionsSchema,
        standing: &[Shape],
        group: &Span,
    ) -> Option<Vec<Shape>> {
        let share = r.number(&set.share, 0.0, 1e-4, 0.9)?;
        let places = set.places.required("places", group, r.faults)?;
        let span = span_of(&set.places);
        let by_share = !matches!(set.share, Field::Absent);
        let (pores, pore) = match places {
            PoresSchema::None => return Some(Vec::new()),
            PoresSchema::Square(pore) => (Pores::Square, pore),
            PoresSchema::CenteredSquare(pore) => (Pores::CenteredSquare, pore),
            PoresSchema::Hexagonal(pore) => (Pores::Hexagonal, pore),
            PoresSchema::Random(random) => {
                let by_share = by_share && matches!(random.count, Field::Absent) && !is_listed(random);
                return self.place_at_random(
                    r,
                    random,
                    by_share.then_some(Amount::Share(share)),
                    standing,
                    &span,
                );
            }
        };
        let wanted =
            (self.cell.x * self.cell.y * share / (pores.count() as f64 * std::f64::consts::PI)).sqrt();
        let radius = match by_share {
            true => wanted,
            false => r.needed(&pore.radius, "radius", &span, self.size, self.cell.max_element())?,
        };
        r.lattice_fits(pores, self.cell, radius, self.size, &span)?;
        Some(
            pore_centers(pores, self.cell)
                .into_iter()
                .map(|center| Shape::Circle { center, radius })
                .collect(),
        )
    }

    /// Circles or ellipses at random, clear of what stands.
    pub(super) fn place_at_random(
        &self,
        r: &Resolver<'_>,
        random: &RandomSchema,
        amount: Option<Amount>,
        standing: &[Shape],
        span: &Span,
    ) -> Option<Vec<Shape>> {
        let sizes = self.sizes(r, random, span);
        let count = r.count(&random.count, 0, 1, placement::MOST as u64);
        let aspect = r.number(&random.aspect, 1.0, 0.1, 1.0);
        let gap = r.needed(&random.gap, "gap", span, 0.0, self.cell.max_element());
        let seed = r.count(&random.seed, 1, 0, u64::MAX);
        let angle = match &random.angle {
            Field::Bad(_) => None,
            Field::Absent | Field::Good(AngleSchema::Random, _) => Some(None),
            Field::Good(AngleSchema::Degrees(degrees), _) => {
                r.number(degrees, 0.0, -360.0, 360.0).map(|degrees| Some(degrees.to_radians()))
            }
        };
        let (sizes, gap, angle) = (sizes?, gap?, angle?);
        if gap < self.size {
            let message = format!("a gap of {} is narrower than a particle", show::<LengthKind>(gap));
            let least = show::<LengthKind>(self.size);
            r.refuse(
                span_of(&random.gap),
                message,
                &format!("at least D = {least}; four of them to resolve it"),
            );
            return None;
        }
        let amount = match (amount, is_listed(random)) {
            (_, true) => Amount::Count(0),
            (Some(amount), false) => amount,
            (None, false) => {
                random.count.required("count", span, r.faults)?;
                Amount::Count(count?)
            }
        };
        let request = Request { sizes, amount, aspect: aspect?, angle, gap, seed: seed? as u64 };
        if !self.good {
            return None;
        }
        placement::place(&request, self.cell, standing)
            .map_err(|refusal| self.refuse_placement(r, refusal, &request, span))
            .ok()
    }

    fn refuse_placement(&self, r: &Resolver<'_>, refusal: Refusal, request: &Request, span: &Span) {
        let middle = show::<LengthKind>(request.sizes.middle());
        let percent = |share: f64| significant((share * 1e3).round() / 10.0);
        let (message, hint) = match refusal {
            Refusal::TooMany(count) => (
                format!("{} circles of radius {middle} would be needed", significant(count)),
                format!("at most {}: larger ones, a smaller cell, or less of them", placement::MOST),
            ),
            Refusal::TooLarge(share) => (
                format!(
                    "one of radius {middle} takes {} % of the cell: no whole number of them meets what is asked for",
                    percent(share)
                ),
                "smaller ones or a larger cell; or `count` in place of the porosity".into(),
            ),
            Refusal::TooLong(length) => (
                format!(
                    "the largest is {} long with its gap and does not fit into the cell",
                    show::<LengthKind>(length)
                ),
                "smaller ones or a larger cell".into(),
            ),
            Refusal::Full { placed, wanted, share } => (
                format!(
                    "only {placed} of {wanted} found a place: the cell is full at {} % of its area",
                    percent(share)
                ),
                "a narrower gap, a lower porosity or share, or a larger cell".into(),
            ),
        };
        r.refuse(span.clone(), message, &hint);
    }

    fn sizes(&self, r: &Resolver<'_>, random: &RandomSchema, span: &Span) -> Option<Sizes> {
        let sizes = random.radius.required("radius", span, r.faults)?;
        let group = span_of(&random.radius);
        let most = 0.5 * self.cell.min_element();
        match sizes {
            SizesSchema::Constant(radius) => {
                r.needed(radius, "radius", &group, 0.5 * self.size, most).map(Sizes::Constant)
            }
            SizesSchema::Normal(normal) => {
                let mean = r.needed(&normal.mean, "mean", &group, 0.5 * self.size, most);
                let deviation =
                    r.needed(&normal.deviation, "deviation", &group, 0.0, 0.5 * mean.unwrap_or(most));
                Some(Sizes::Normal { mean: mean?, deviation: deviation? })
            }
            SizesSchema::LogNormal(log) => {
                let median = r.needed(&log.median, "median", &group, 0.5 * self.size, most);
                log.deviation.required("deviation", &group, r.faults);
                let deviation = r.number(&log.deviation, 0.3, 0.0, 1.0);
                Some(Sizes::LogNormal { median: median?, deviation: deviation? })
            }
            SizesSchema::Listed(list) => {
                let list = list.get()?;
                let radii: Vec<f64> =
                    list.iter().filter_map(|field| r.quantity(field, 0.5 * self.size, most)).collect();
                if list.is_empty() || list.len() > placement::MOST {
                    let message = format!("{} radii are listed", list.len());
                    r.refuse(group, message, &format!("from 1 to {}", placement::MOST));
                    return None;
                }
                (radii.len() == list.len()).then_some(Sizes::Listed(radii))
            }
        }
    }

    /// Shapes in their order; returns those of voids.
    pub(super) fn paint_shapes(&self, r: &Resolver<'_>, layout: &mut Layout) -> Vec<Shape> {
        let Field::Good(list, span) = &self.m.shapes else { return Vec::new() };
        if list.len() > MOST {
            r.refuse(span.clone(), format!("{} shapes are listed", list.len()), &format!("at most {MOST}"));
            return Vec::new();
        }
        let mut standing = Vec::new();
        for field in list {
            let Some(schema) = field.get() else { continue };
            let span = span_of(field);
            let read = self.shape(r, schema, &span);
            if let Some((shape, fill)) = read.filter(|(shape, _)| self.is_in_cell(r, shape, &span)) {
                standing.push(shape.clone());
                layout.paint(shape, fill);
            }
        }
        standing
    }

    fn shape(&self, r: &Resolver<'_>, schema: &ShapeSchema, span: &Span) -> Option<(Shape, Fill)> {
        let fill = |of: &Field<FillSchema>| r.fill(of, Fill::Void, self.around);
        let most = self.cell.max_element();
        match schema {
            ShapeSchema::Circle(c) => {
                let center = r.place(&c.center, "center", span);
                let radius = r.needed(&c.radius, "radius", span, 0.25 * self.size, most);
                Some((Shape::Circle { center: center?, radius: radius? }, fill(&c.of)?))
            }
            ShapeSchema::Ellipse(e) => {
                let center = r.place(&e.center, "center", span);
                let axes = r.place(&e.semi_axes, "semi_axes", span);
                let angle = r.number(&e.angle, 0.0, -360.0, 360.0)?.to_radians();
                let axes = self.positive(r, axes?, &e.semi_axes, "half axes")?;
                Some((Shape::ellipse(center?, axes, angle), fill(&e.of)?))
            }
            ShapeSchema::Rectangle(b) => {
                let (lower, upper) = (r.place(&b.lower, "lower", span), r.place(&b.upper, "upper", span));
                let (lower, upper) = (lower?, upper?);
                self.positive(r, upper - lower, &b.upper, "edges")?;
                Some((Shape::Rectangle { lower, upper }, fill(&b.of)?))
            }
            ShapeSchema::Polygon(p) => {
                let list = p.corners.required("corners", span, r.faults)?;
                let corners: Vec<DVec2> =
                    list.iter().filter_map(|f| f.get()).map(|c| DVec2::new(c.0.si, c.1.si)).collect();
                let shape = self.polygon(r, corners, &span_of(&p.corners))?;
                Some((shape, fill(&p.of)?))
            }
        }
    }

    fn positive<T>(&self, r: &Resolver<'_>, lengths: DVec2, field: &Field<T>, what: &str) -> Option<DVec2> {
        if lengths.min_element() >= 0.25 * self.size {
            return Some(lengths);
        }
        let (x, y) = (show::<LengthKind>(lengths.x), show::<LengthKind>(lengths.y));
        let least = show::<LengthKind>(0.25 * self.size);
        r.refuse(span_of(field), format!("its {what} are {x} and {y}"), &format!("at least D/4 = {least}"));
        None
    }

    /// A polygon has an area, and its edges do not cross.
    fn polygon(&self, r: &Resolver<'_>, corners: Vec<DVec2>, span: &Span) -> Option<Shape> {
        if !(3..=MOST).contains(&corners.len()) {
            r.refuse(
                span.clone(),
                format!("a polygon of {} corners", corners.len()),
                &format!("from 3 to {MOST}"),
            );
            return None;
        }
        let n = corners.len();
        let edge = |k: usize| (corners[k], corners[(k + 1) % n]);
        for a in 0..n {
            for b in a + 2..n {
                if (b + 1) % n != a && cross(edge(a), edge(b)) {
                    let message = format!("the edges from corner {} and from corner {} cross", a + 1, b + 1);
                    r.refuse(
                        span.clone(),
                        message,
                        "list corners in the order in which the outline meets them",
                    );
                    return None;
                }
            }
        }
        let shape = Shape::Polygon { corners };
        if shape.area(0.0) < 0.05 * self.size * self.size {
            r.refuse(
                span.clone(),
                "the polygon has next to no area".into(),
                "corners in order, two lengths each",
            );
            return None;
        }
        Some(shape)
    }

    /// A shape begins in the cell and is no longer than it; what hangs over a side comes in at the other.
    fn is_in_cell(&self, r: &Resolver<'_>, shape: &Shape, span: &Span) -> bool {
        let (middle, half) = shape.bounds();
        let (lower, upper) = (middle - half, middle + half);
        let size = |v: DVec2| format!("{} × {}", show::<LengthKind>(v.x), show::<LengthKind>(v.y));
        let slack = 1e-9 * self.cell;
        if (2.0 * half).cmpgt(self.cell + slack).any() {
            let message = format!("it is {} large, the cell {}", size(2.0 * half), size(self.cell));
            r.refuse(span.clone(), message, "a shape no larger than the cell");
            return false;
        }
        if upper.cmple(DVec2::ZERO).any() || lower.cmpge(self.cell).any() {
            let at = |v: DVec2| format!("({}, {})", show::<LengthKind>(v.x), show::<LengthKind>(v.y));
            let message = format!("it reaches from {} to {}, outside of the cell", at(lower), at(upper));
            r.refuse(span.clone(), message, &format!("the cell reaches from (0, 0) to {}", at(self.cell)));
            return false;
        }
        true
    }
}

/// True if two edges cross.
fn cross((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    let side = |p: DVec2, q: DVec2, x: DVec2| (q - p).perp_dot(x - p).signum();
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}
