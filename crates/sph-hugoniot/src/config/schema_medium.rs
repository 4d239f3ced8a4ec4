//! The medium as it is written in a case file.

use std::fmt;

use serde::Deserialize;
use serde::de::{self, Deserializer, SeqAccess, Visitor};

use super::field::Field;
use super::units::{Count, Length, Number};

/// Cell, pores, inclusions, layers, shapes, image, and particles.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MediumSchema {
    /// The periodic cell.
    pub cell: Field<CellSchema>,
    /// What is there where nothing else is.
    pub base: Field<FillSchema>,
    /// A picture in the place of the base.
    pub image: Field<ImageSchema>,
    /// Layers across the way of the wave.
    pub layers: Field<Vec<Field<LayerSchema>>>,
    /// Sets of inclusions of other materials.
    pub inclusions: Field<Vec<Field<InclusionsSchema>>>,
    /// Shapes, later ones over earlier ones.
    pub shapes: Field<Vec<Field<ShapeSchema>>>,
    /// Where the pores are.
    pub pores: Field<PoresSchema>,
    /// Porosity m = ρ0/ρ00 to reach.
    pub porosity: Field<Number>,
    /// Particle size D.
    pub particle_size: Field<Length>,
    /// How particles are packed.
    pub packing: Field<PackingSchema>,
}

/// The periodic cell: one length for a square, or length along x and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellSchema {
    /// Edge.
    Edge(Length),
    /// Length along x and height.
    Rectangle(Length, Length),
}

impl<'de> Deserialize<'de> for CellSchema {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(CellVisitor)
    }
}

struct CellVisitor;

impl<'de> Visitor<'de> for CellVisitor {
    type Value = CellSchema;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an edge such as \"20 um\", or length along x and height such as (\"60 um\", \"40 um\")")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<CellSchema, E> {
        Length::parse(text).map(CellSchema::Edge).map_err(E::custom)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<CellSchema, A::Error> {
        let PointSchema(length, height) = point(&mut items)?;
        Ok(CellSchema::Rectangle(length, height))
    }
}

/// A place, or two lengths along x and y: `("3 um", "4 um")`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSchema(pub Length, pub Length);

impl<'de> Deserialize<'de> for PointSchema {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PointVisitor)
    }
}

struct PointVisitor;

impl<'de> Visitor<'de> for PointVisitor {
    type Value = PointSchema;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("two lengths such as (\"3 um\", \"4 um\")")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<PointSchema, A::Error> {
        point(&mut items)
    }
}

fn point<'de, A: SeqAccess<'de>>(items: &mut A) -> Result<PointSchema, A::Error> {
    let missing = || de::Error::custom("two lengths are wanted here; hint: such as (\"3 um\", \"4 um\")");
    let x = items.next_element()?.ok_or_else(missing)?;
    let y = items.next_element()?.ok_or_else(missing)?;
    match items.next_element::<de::IgnoredAny>()? {
        None => Ok(PointSchema(x, y)),
        Some(_) => Err(missing()),
    }
}

/// What fills a part of the cell.
#[derive(Clone, Debug, Deserialize)]
pub enum FillSchema {
    /// Nothing.
    Void,
    /// A material of the case, by its name.
    Material(String),
}

/// Where the pores are.
#[derive(Debug, Deserialize)]
pub enum PoresSchema {
    /// No pores.
    None,
    /// One pore a cell.
    Square(PoreSchema),
    /// Two pores a cell: one more in the middle of four.
    CenteredSquare(PoreSchema),
    /// A hexagonal lattice.
    Hexagonal(PoreSchema),
    /// At random.
    Random(Box<RandomSchema>),
}

/// A circular pore.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PoreSchema {
    /// Radius r.
    pub radius: Field<Length>,
}

/// Circles or ellipses at random.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RandomSchema {
    /// Radii, or for ellipses radii of circles of the same area.
    pub radius: Field<SizesSchema>,
    /// How many; for pores also by the porosity, for inclusions by their share.
    pub count: Field<Count>,
    /// Ratio of the short axis to the long one.
    pub aspect: Field<Number>,
    /// Angle of the long axis against x in degrees.
    pub angle: Field<AngleSchema>,
    /// Least width of the gaps.
    pub gap: Field<Length>,
    /// Seed.
    pub seed: Field<Count>,
}

/// Direction of ellipses.
#[derive(Debug, Deserialize)]
pub enum AngleSchema {
    /// Any.
    Random,
    /// This one, in degrees against x.
    Degrees(Field<Number>),
}

/// How sizes are spread.
#[derive(Debug, Deserialize)]
pub enum SizesSchema {
    /// All alike.
    Constant(Field<Length>),
    /// Normal.
    Normal(NormalSchema),
    /// Log-normal.
    LogNormal(LogNormalSchema),
    /// These.
    Listed(Field<Vec<Field<Length>>>),
}

/// A normal distribution.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NormalSchema {
    /// Mean.
    pub mean: Field<Length>,
    /// Standard deviation.
    pub deviation: Field<Length>,
}

/// A log-normal distribution.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LogNormalSchema {
    /// Median.
    pub median: Field<Length>,
    /// Standard deviation of the logarithm.
    pub deviation: Field<Number>,
}

/// Inclusions of another material.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InclusionsSchema {
    /// What they are of.
    pub of: Field<FillSchema>,
    /// Where they are.
    pub places: Field<PoresSchema>,
    /// Part of the cell's area that they take.
    pub share: Field<Number>,
}

/// A layer.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LayerSchema {
    /// Thickness along x.
    pub thickness: Field<Length>,
    /// What it is of.
    pub of: Field<FillSchema>,
}

/// A shape.
#[derive(Debug, Deserialize)]
pub enum ShapeSchema {
    /// A disc.
    Circle(CircleSchema),
    /// An ellipse.
    Ellipse(EllipseSchema),
    /// A rectangle along the axes.
    Rectangle(RectangleSchema),
    /// A polygon.
    Polygon(PolygonSchema),
}

/// A disc.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CircleSchema {
    /// Center.
    pub center: Field<PointSchema>,
    /// Radius.
    pub radius: Field<Length>,
    /// What it is of; void if left out.
    pub of: Field<FillSchema>,
}

/// An ellipse.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EllipseSchema {
    /// Center.
    pub center: Field<PointSchema>,
    /// Half of the length along its own axes.
    pub semi_axes: Field<PointSchema>,
    /// Angle of the first axis against x in degrees.
    pub angle: Field<Number>,
    /// What it is of; void if left out.
    pub of: Field<FillSchema>,
}

/// A rectangle along the axes.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RectangleSchema {
    /// Lower left corner.
    pub lower: Field<PointSchema>,
    /// Upper right corner.
    pub upper: Field<PointSchema>,
    /// What it is of; void if left out.
    pub of: Field<FillSchema>,
}

/// A polygon.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PolygonSchema {
    /// Corners in order.
    pub corners: Field<Vec<Field<PointSchema>>>,
    /// What it is of; void if left out.
    pub of: Field<FillSchema>,
}

/// A picture.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ImageSchema {
    /// PNG file, relative to the case file.
    pub file: Field<String>,
    /// Edge of a pixel.
    pub pixel_size: Field<Length>,
    /// What gray levels mean, from black to white.
    pub levels: Field<Vec<Field<LevelSchema>>>,
    /// What is at its edges.
    pub edges: Field<EdgesSchema>,
    /// The part of the picture that is used.
    pub crop: Field<CropSchema>,
}

/// A range of gray levels.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelSchema {
    /// Highest level of the range, 0 (black) to 255 (white).
    pub up_to: Field<Count>,
    /// What it is of.
    pub of: Field<FillSchema>,
}

/// What is at the edges of a picture.
#[derive(Clone, Copy, Debug, Deserialize)]
pub enum EdgesSchema {
    /// Its mirror images.
    Mirror,
    /// The picture again; it must fit to itself.
    Periodic,
}

/// A part of a picture, in pixels from its upper left.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CropSchema {
    /// First column.
    pub left: Field<Count>,
    /// First row from above.
    pub top: Field<Count>,
    /// Columns.
    pub width: Field<Count>,
    /// Rows.
    pub height: Field<Count>,
}

/// How particles are packed.
#[derive(Clone, Copy, Debug, Deserialize)]
pub enum PackingSchema {
    /// On a square lattice.
    Square,
    /// On a hexagonal lattice.
    Hexagonal,
    /// Following the boundaries.
    Relaxed,
}
