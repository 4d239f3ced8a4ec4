//! Concentric rings of particles: a packing that follows round surfaces.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::dimension::Dim2;
use crate::error::CoreError;
use crate::geometry::Packing;
use crate::geometry::lattice::positive;

/// Turn of each ring against the one inside it, in spacings of the ring: the golden section, so that rings of equal
/// numbers never line up.
const PHASE_SHIFT: f64 = 0.618_033_988_749_894_9;

/// Rings of particles of size `size` D0 [m] between two radii [m] around `center` [m].
///
/// Ring k has radius R0 + (k + ½) D0 and round(2π r/D0) particles that share its area 2π r D0 equally. D0 is adjusted
/// so that a whole number of rings fits; the packing's size is the one that was asked for.
///
/// # Errors
/// If a length is not positive (the inner radius may be zero).
pub fn concentric_rings(
    center: DVec2,
    inner_radius: f64,
    outer_radius: f64,
    size: f64,
) -> Result<Packing<Dim2>, CoreError> {
    positive("the particle size", size)?;
    positive("the thickness of the rings", outer_radius - inner_radius)?;
    positive("the outer radius", outer_radius)?;
    if inner_radius < 0.0 {
        return Err(CoreError::NotPositive { what: "the inner radius", value: inner_radius });
    }
    let n_rings = ((outer_radius - inner_radius) / size).round().max(1.0) as usize;
    let thickness = (outer_radius - inner_radius) / n_rings as f64;
    let mut packing = Packing::empty(size);
    for k in 0..n_rings {
        let radius = inner_radius + (k as f64 + 0.5) * thickness;
        let count = (TAU * radius / size).round().max(1.0);
        for n in 0..count as usize {
            let angle = TAU * (n as f64 + (k as f64 * PHASE_SHIFT).fract()) / count;
            packing.push(center + DVec2::from_angle(angle) * radius, TAU * radius * thickness / count);
        }
    }
    Ok(packing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn rings_fill_the_annulus_exactly_and_evenly() {
        let center = DVec2::new(0.3, -0.2);
        let packing = concentric_rings(center, 0.08, 0.1, 0.002).unwrap();
        assert!((packing.total_volume() / (PI * (0.01 - 0.0064)) - 1.0).abs() < 1e-13);
        assert!(packing.volume.iter().all(|v| (v / 4e-6 - 1.0).abs() < 2e-3));
        let expected: f64 = (0..10).map(|k| (TAU * (0.081 + 0.002 * k as f64) / 0.002).round()).sum();
        assert_eq!(packing.len(), expected as usize);
        let rings: Vec<f64> = packing.points().map(|p| ((p - center).length() - 0.081) / 0.002).collect();
        assert!(rings.iter().all(|ring| (ring - ring.round()).abs() < 1e-10));
        let mean = packing.points().fold(DVec2::ZERO, |sum, p| sum + p) / packing.len() as f64;
        assert!((mean - center).length() < 1e-15, "each ring is balanced");
    }

    #[test]
    fn a_disc_has_no_hole() {
        let packing = concentric_rings(DVec2::ZERO, 0.0, 1.0, 0.1).unwrap();
        assert!((packing.total_volume() - PI).abs() < 1e-12);
        assert!(packing.points().any(|p| p.length() < 0.051));
    }

    #[test]
    fn lengths_that_make_no_rings_are_refused() {
        for (inner, outer, size) in
            [(0.2, 0.1, 0.01), (-0.1, 0.1, 0.01), (0.1, 0.2, -1.0), (f64::NAN, 1.0, 0.1)]
        {
            assert!(concentric_rings(DVec2::ZERO, inner, outer, size).is_err());
        }
    }
}
