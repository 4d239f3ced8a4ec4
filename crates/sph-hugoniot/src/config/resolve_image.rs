//! The picture of a case: which gray is which material, what of it counts, and whether it fits to itself.

use super::fault::Span;
use super::field::Field;
use super::resolve::{Resolver, span_of};
use super::resolve_medium::Surroundings;
use super::schema::*;
use super::units::{LengthKind, show};
use crate::microstructure::image::{Edges, GrayImage, ImageLayout};
use crate::microstructure::layout::Fill;

impl Resolver<'_> {
    /// Reads the picture, cuts it and deals its grays out.
    pub(super) fn image(
        &self,
        image: &ImageSchema,
        group: &Span,
        around: Surroundings<'_>,
    ) -> Option<ImageLayout> {
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
}
