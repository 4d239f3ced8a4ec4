//! What fills the cell of a case: base, layers, inclusions, and what is placed at random. Pictures are read in
//! `resolve_image`, shapes in `resolve_shapes`.

use super::fault::{Span, name_hint};
use super::field::Field;
use super::medium::Pores;
use super::resolve::{Resolver, span_of};
use super::resolve_medium::{Draft, Surroundings, is_listed};
use super::schema::*;
use super::units::{LengthKind, show, significant};
use crate::microstructure::layout::{Base, Fill, Layout};
use crate::microstructure::placement::{self, Amount, Refusal, Request, Sizes};
use crate::microstructure::pore_centers;
use crate::microstructure::shape::Shape;

/// Most shapes, layers or corners of a list.
pub(super) const MOST: usize = 2000;

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
    pub(super) fn fill(
        &self,
        field: &Field<FillSchema>,
        default: Fill,
        around: Surroundings<'_>,
    ) -> Option<Fill> {
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
}

impl Draft<'_> {
    /// Layers one after another from x = 0; they must fill the cell.
    pub(super) fn paint_layers(&self, r: &Resolver<'_>, layout: &mut Layout) {
        let Field::Good(list, span) = &self.m.layers else { return };
        if list.len() > MOST {
            r.refuse(span.clone(), format!("{} layers are listed", list.len()), &format!("at most {MOST}"));
            return;
        }
        let mut from = 0.0;
        for field in list {
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
        let Field::Good(list, span) = &self.m.inclusions else { return standing };
        if list.len() > MOST {
            let message = format!("{} sets of inclusions are listed", list.len());
            r.refuse(span.clone(), message, &format!("at most {MOST}"));
            return standing;
        }
        for field in list {
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
}
