//! Lattices of particles that fill the cell, and the centers of pores on lattices.

use glam::DVec2;

use crate::config::case::{Medium, Packing, Pores};

/// Lattice points of a full cell; half a spacing off its edges.
///
/// The hexagonal lattice is fitted to the cell: rows along x, the spacing a of equal area D² = a² √3/2, a whole number
/// of particles in a row and an even number of rows. A relaxed packing starts from the square lattice.
pub(super) fn points(medium: &Medium) -> Vec<DVec2> {
    let (in_row, rows, shift) = match medium.packing {
        Packing::Square | Packing::Relaxed => (
            (medium.cell / medium.particle_size).round(),
            (medium.height / medium.particle_size).round(),
            0.0,
        ),
        Packing::Hexagonal => {
            let spacing = medium.particle_size * (2.0 / 3f64.sqrt()).sqrt();
            let rows = 2.0 * (medium.height / (spacing * 3f64.sqrt())).round().max(1.0);
            ((medium.cell / spacing).round().max(1.0), rows, 0.5)
        }
    };
    let (dx, dy) = (medium.cell / in_row, medium.height / rows);
    let mut points = Vec::with_capacity((in_row * rows) as usize);
    for row in 0..rows as usize {
        let offset = if row % 2 == 0 { 0.5 - 0.5 * shift } else { 0.5 + 0.5 * shift };
        for k in 0..in_row as usize {
            points.push(DVec2::new((k as f64 + offset) * dx, (row as f64 + 0.5) * dy));
        }
    }
    points
}

/// Centers of the pores of one cell, for pores on a lattice: midway between particles when their number allows.
pub(crate) fn pore_centers(pores: Pores, cell: DVec2) -> Vec<DVec2> {
    let at = |f: f64| f * cell;
    match pores {
        Pores::None | Pores::Placed => vec![],
        Pores::Square => vec![at(0.5)],
        Pores::CenteredSquare | Pores::Hexagonal => vec![at(0.25), at(0.75)],
    }
}

/// Distance to the nearest center, periodic images included.
pub(super) fn distance_to_center(point: DVec2, centers: &[DVec2], cell: DVec2) -> f64 {
    let nearest_image = |d: f64, period: f64| d - period * (d / period).round();
    let distance =
        |c: &DVec2| nearest_image(point.x - c.x, cell.x).hypot(nearest_image(point.y - c.y, cell.y));
    centers.iter().map(distance).fold(f64::INFINITY, f64::min)
}
