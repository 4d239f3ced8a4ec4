//! Figures and field images come out whole, also from odd data.

use sph_io::Color;
use sph_io::field_image::{Cell, ColorMap, Field, FieldImage};
use sph_io::plot::{Annotation, Axis, Figure, LegendPosition, Panel, Series};
use std::path::Path;

/// Width, height and red-green-blue pixels.
fn pixels(path: &Path) -> (usize, usize, Vec<[u8; 3]>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    let pixels = bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, pixels)
}

fn count(pixels: &[[u8; 3]], color: Color) -> usize {
    pixels.iter().filter(|pixel| **pixel == [color.red, color.green, color.blue]).count()
}

fn sample() -> Figure {
    Figure::new("Title", Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]"))
        .with(Series::points("computed", &[1.0, 2.0, 3.0], &[1.0, 4.0, 9.0]).with_error(&[
            0.1,
            0.2,
            f64::NAN,
        ]))
        .with(Series::dashed("fit", &[1.0, 2.0, 3.0], &[1.2, 3.9, 9.1]))
}

#[test]
fn svg_and_png_show_the_same_figure() {
    let folder = tempfile::tempdir().unwrap();
    let (svg, png) = (folder.path().join("a.svg"), folder.path().join("a.png"));
    sample().write_svg(&svg).unwrap();
    sample().write_png(&png).unwrap();
    let text = std::fs::read_to_string(&svg).unwrap();
    for word in [">Title<", ">computed<", ">fit<", ">u<", ">p<", "rotate(-90", "#0072b2", "#d55e00"] {
        assert!(text.contains(word), "{word}");
    }
    let (width, height, pixels) = pixels(&png);
    assert_eq!(width, 1800);
    assert!(text.contains(&format!("height=\"{}\"", height / 2)));
    assert!(count(&pixels, Color::cycle(0)) > 300, "the markers are missing");
    assert!(count(&pixels, Color::cycle(1)) > 300, "the curve is missing");
}

#[test]
fn odd_data_leave_gaps_and_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let odd = [f64::NAN, 0.0, -1.0, f64::INFINITY, 1e-300, 1e300];
    let figure = Figure::stacked("", Axis::log("x"))
        .with_panel(Panel::new(Axis::log("y")).with(Series::line("all odd", &odd, &odd)))
        .with_panel(Panel::new(Axis::new("z")).with(Series::points("", &odd, &odd).with_error(&odd)))
        .with_panel(Panel::new(Axis::new("nothing")))
        .with_annotation(Annotation::Slope { start: (0.0, 0.0), to_x: 1.0, order: -1.0, text: "s".into() })
        .with_annotation(Annotation::Vertical { x: -1.0, text: "none".into() })
        .with_annotation(Annotation::Horizontal { y: 0.5, text: "half".into() });
    figure.write_png(&path).unwrap();
    Figure::stacked("no panel", Axis::new("x")).write_svg(folder.path().join("b.svg")).unwrap();
}

#[test]
fn what_does_not_fit_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    let uneven = sample().with(Series::line("short", &[1.0], &[]));
    let message = uneven.write_svg(&path).unwrap_err().to_string();
    assert!(message.contains("series `short` has 1 x, 0 y"), "{message}");
    let mut backward = sample();
    backward.x = Axis::log("N").with_range(0.0, 10.0);
    assert!(
        backward.write_svg(&path).unwrap_err().to_string().contains("axis `N` has no range from 0 to 10")
    );
    assert!(!path.exists());
}

#[test]
fn a_legend_without_a_free_place_stands_beside_the_panel() {
    let folder = tempfile::tempdir().unwrap();
    let (crowded, outside) = (folder.path().join("a.svg"), folder.path().join("b.svg"));
    let x: Vec<f64> = (0..400).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| (0.7 * x).sin()).collect();
    let figure = Figure::new("", Axis::new("x"), Axis::new("y")).with(Series::line("noise", &x, &y));
    figure.write_svg(&crowded).unwrap();
    figure.with_legend(LegendPosition::Outside).write_svg(&outside).unwrap();
    assert_eq!(std::fs::read(crowded).unwrap(), std::fs::read(outside).unwrap());
}

/// A curve along the top, a slope at the bottom right: the bottom left is free.
#[test]
fn a_legend_hides_no_slope() {
    let folder = tempfile::tempdir().unwrap();
    let (chosen, left) = (folder.path().join("a.svg"), folder.path().join("b.svg"));
    let axes = (Axis::log("N").with_range(10.0, 100.0), Axis::log("error").with_range(0.01, 1.0));
    let slope = Annotation::Slope { start: (50.0, 0.03), to_x: 100.0, order: -1.0, text: "order 1".into() };
    let figure = Figure::new("", axes.0, axes.1)
        .with(Series::line("errors", &[10.0, 30.0, 100.0], &[0.9, 0.8, 0.85]))
        .with_annotation(slope);
    figure.write_svg(&chosen).unwrap();
    figure.with_legend(LegendPosition::BottomLeft).write_svg(&left).unwrap();
    assert_eq!(std::fs::read(chosen).unwrap(), std::fs::read(left).unwrap());
}

#[test]
fn a_legend_too_wide_for_its_side_stands_below_the_axis() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let height = |label: &str| {
        let mut figure = sample().with(Series::line(label, &[1.0, 2.0], &[1.0, 2.0]));
        figure.width = 620.0;
        figure.with_legend(LegendPosition::Outside).write_png(&path).unwrap();
        let (width, height, _) = pixels(&path);
        assert_eq!(width, 1240);
        height
    };
    let (beside, below) = (height("short"), height("a name that leaves the panel hardly any room beside it"));
    assert!(below > beside + 60, "{beside} {below}");
}

#[test]
fn a_field_image_has_the_colors_of_its_values_and_of_the_void() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let image = FieldImage::new("two particles", (0.0, 4.0), (0.0, 1.0))
        .with_particles([0.5, 1.5], [0.5, 0.5], [1.0, 1.0])
        .with_field(Field::new("rho", [0.0, 1.0], ColorMap::Sequential).with_range(0.0, 1.0))
        .with_field(Field::new("v", [-1.0, 1.0], ColorMap::Diverging));
    image.write_png(&path).unwrap();
    let (width, _, all) = pixels(&path);
    assert_eq!(width, 2400);
    let quarter = count(&all, ColorMap::Sequential.color(0.0));
    assert!(quarter > 200_000, "{quarter}");
    let near = |n: usize, factor: f64| (n as f64 / (factor * quarter as f64) - 1.0).abs() < 0.03;
    assert!(near(count(&all, ColorMap::Sequential.color(1.0)), 1.0));
    assert!(near(count(&all, ColorMap::Sequential.void()), 2.0));
    assert!(near(count(&all, ColorMap::Diverging.color(1.0)), 1.0));
    assert!(near(count(&all, ColorMap::Diverging.void()), 2.0));

    let discs = FieldImage { cell: Cell::Disc, ..image };
    discs.write_png(&path).unwrap();
    let n = count(&pixels(&path).2, ColorMap::Sequential.color(0.0));
    assert!((n as f64 / quarter as f64 - std::f64::consts::FRAC_PI_4).abs() < 0.03, "{n} of {quarter}");
}
