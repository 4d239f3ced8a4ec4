//! What can be chosen of the scheme.

use serde::{Deserialize, Serialize};
use sph_core::kernel::KernelFamily;

use crate::limiter::Limiter;
use crate::record::Prepared;

/// The named schemes. They share one step; see [`crate::simulation`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Scheme {
    /// Contact SPH: piecewise constant sides, no kernel correction, explicit Euler. The paper's baseline.
    Csph,
    /// TKC-MUSCL-SPH as printed: corrected kernel, reconstruction with the printed limiter, explicit Euler. Stable only
    /// up to a Courant number of about 0.1.
    TkcMuscl,
    /// Corrected kernel, reconstruction from values advanced by half a step (MUSCL-Hancock), upwind-biased limiter:
    /// second order.
    #[default]
    TkcHancock,
}

impl Scheme {
    /// Every scheme, in the order of declaration.
    pub const ALL: [Self; 3] = [Self::Csph, Self::TkcMuscl, Self::TkcHancock];

    /// True if gradients are needed before the contact.
    pub fn reconstructs(self) -> bool {
        self != Self::Csph
    }

    /// The records that its first pair loop reads.
    pub(crate) fn prepared(self) -> Prepared {
        if self.reconstructs() { Prepared::State } else { Prepared::ConstantSides }
    }

    /// True if sides are advanced by half a step before the contact.
    pub fn is_time_centered(self) -> bool {
        self == Self::TkcHancock
    }
}

/// What stands in the place of L⁻¹ near free surfaces, where L loses its neighbors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SurfaceTreatment {
    /// The rule as printed: I in place of L⁻¹ where the least eigenvalue of **L⁻¹** is below 0.75, and within a smoothing
    /// length of such particles. Flags almost nothing, since those eigenvalues rise at a surface.
    Printed {
        /// I as well where det L is below this [-]; 0.01-0.1, at most 0.5.
        determinant_floor: f64,
    },
    /// The rule as its source has it: least eigenvalue of **L** below 0.75.
    Intended {
        /// I as well where det L is below this [-]; 0.01-0.1, at most 0.5.
        determinant_floor: f64,
    },
    /// L⁻¹ everywhere.
    None,
    /// K = Σ min(1/λ, cap) n⊗n over the eigenpairs of L, everywhere; velocity gradient exact in rotation, adjoint
    /// traction, half step of the velocity centered on the true acceleration. No rule. This project's.
    SpectralCap {
        /// Largest eigenvalue of K [-]; 2.5.
        cap: f64,
    },
}

impl Default for SurfaceTreatment {
    fn default() -> Self {
        Self::SpectralCap { cap: 2.5 }
    }
}

/// How the density is kept at the density of the packing where pores have shut; see [`crate::volume`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VolumeConsistency {
    /// Smoothing length of the volume sum in particle sizes, h_S / D [-].
    pub width: f64,
    /// Rate κ of the relaxation in units of c/h [-].
    pub rate: f64,
    /// |ΔS| below which nothing is done [-].
    pub tolerance: f64,
    /// Deficit δ of the volume sum beyond which a particle lines a void and is left alone [-].
    pub void_deficit: f64,
    /// Volume sum of a packing that fills space.
    #[serde(default)]
    pub reference: PackingReference,
}

/// What the volume sum of a particle is held against.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PackingReference {
    /// The sum of a perfect lattice.
    #[default]
    Lattice,
    /// The particle's own sum when it was first measured: for disordered packings, whose sums scatter. Only for bodies
    /// without voids at the start.
    Start,
}

impl Default for VolumeConsistency {
    fn default() -> Self {
        Self {
            width: 2.0,
            rate: 0.05,
            tolerance: 0.001,
            void_deficit: 0.1,
            reference: PackingReference::Lattice,
        }
    }
}

/// How the faces between particles are closed on disordered clouds; see [`crate::pass`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FaceClosure {
    /// Jacobi sweeps in a step.
    pub sweeps: u32,
}

impl Default for FaceClosure {
    fn default() -> Self {
        Self { sweeps: 10 }
    }
}

/// All settings of the scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The scheme.
    pub scheme: Scheme,
    /// The limiter; not used by [`Scheme::Csph`].
    pub limiter: Limiter,
    /// The smoothing kernel.
    pub kernel: KernelFamily,
    /// θ in h_ij = θ (D_i + D_j) [-]; 0.5-0.7.
    pub smoothing: f64,
    /// Courant number C [-].
    pub courant: f64,
    /// What is done at free surfaces; not used by [`Scheme::Csph`].
    pub surface: SurfaceTreatment,
    /// Skin of the neighbor lists, in particle sizes [-]; `None`: chosen from θ, see [`Settings::skin_width`].
    #[serde(default)]
    pub skin: Option<f64>,
    /// Keeps the density at that of the packing, or not.
    pub volume_consistency: Option<VolumeConsistency>,
    /// Closes the faces between particles, or not: for disordered clouds; on lattices it only costs.
    #[serde(default)]
    pub face_closure: Option<FaceClosure>,
}

impl Settings {
    /// Sensible settings for a scheme: θ = 0.5, the Courant number that the scheme bears in pore collapse, and for the
    /// printed scheme everything as printed.
    pub fn for_scheme(scheme: Scheme) -> Self {
        let (limiter, courant, surface) = match scheme {
            Scheme::Csph => (Limiter::VanLeer, 0.4, SurfaceTreatment::None),
            Scheme::TkcMuscl => {
                (Limiter::MinmodPrinted, 0.1, SurfaceTreatment::Printed { determinant_floor: 0.01 })
            }
            Scheme::TkcHancock => (Limiter::VanLeer, 0.4, SurfaceTreatment::default()),
        };
        Self {
            scheme,
            limiter,
            kernel: KernelFamily::WendlandC2,
            smoothing: 0.5,
            courant,
            surface,
            skin: None,
            volume_consistency: Some(VolumeConsistency::default()),
            face_closure: None,
        }
    }

    /// Width of the skin of the neighbor lists in particle sizes [-]: that of the settings, or one that costs least. Pairs of
    /// the skin are looked at in every step, while the wider it is, the longer lists live; so lists reach just not to the next
    /// ring of a square or cubic lattice. At least 0.2, at most 0.4.
    pub fn skin_width(&self, dimensions: usize) -> f64 {
        const NARROWEST: f64 = 0.2;
        const WIDEST: f64 = 0.4;
        /// What rings come nearer when the lattice is pressed a little.
        const SPARE: f64 = 0.05;
        self.skin.unwrap_or_else(|| {
            let reach = self.kernel.support() * 2.0 * self.smoothing;
            let beyond = (reach + NARROWEST).powi(2).floor() as u32 + 1;
            let next = (beyond..).find(|n| is_sum_of_squares(*n, dimensions));
            next.map_or(WIDEST, |n| (f64::from(n).sqrt() - SPARE - reach).clamp(NARROWEST, WIDEST))
        })
    }

    /// Names every setting that is outside its range.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut check = |holds: bool, what: String| {
            if !holds {
                faults.push(what);
            }
        };
        let within = |x: f64, low: f64, high: f64| x.is_finite() && x >= low && x <= high;
        check(
            within(self.smoothing, 0.3, 2.0),
            format!("smoothing = {} is outside 0.3 to 2", self.smoothing),
        );
        check(within(self.courant, 1e-6, 1.0), format!("courant = {} is outside 1e-6 to 1", self.courant));
        if let Some(skin) = self.skin {
            check(within(skin, 0.0, 2.0), format!("skin = {skin} particle sizes is outside 0 to 2"));
        }
        match self.surface {
            SurfaceTreatment::Printed { determinant_floor }
            | SurfaceTreatment::Intended { determinant_floor } => check(
                within(determinant_floor, 0.0, 0.5),
                format!("determinant_floor = {determinant_floor} of the surface rule is outside 0 to 0.5"),
            ),
            SurfaceTreatment::SpectralCap { cap } => {
                check(
                    within(cap, 1.0, 100.0),
                    format!("cap = {cap} of the spectral cap is outside 1 to 100"),
                );
            }
            SurfaceTreatment::None => {}
        }
        if let Some(v) = self.volume_consistency {
            check(
                within(v.width, 1.0, 4.0),
                format!("width = {} of the volume sum is outside 1 to 4", v.width),
            );
            check(within(v.rate, 0.0, 1.0), format!("rate = {} of the relaxation is outside 0 to 1", v.rate));
            check(within(v.tolerance, 0.0, 0.1), format!("tolerance = {} is outside 0 to 0.1", v.tolerance));
            check(
                within(v.void_deficit, 1e-3, 1.0),
                format!("void_deficit = {} is outside 0.001 to 1", v.void_deficit),
            );
        }
        if let Some(FaceClosure { sweeps }) = self.face_closure {
            check(
                (1..=1000).contains(&sweeps),
                format!("{sweeps} sweeps of the closure are outside 1 to 1000"),
            );
            check(self.scheme.reconstructs(), "closed faces need a scheme with corrected kernel".into());
        }
        faults
    }
}

/// Whether a number is the sum of `count` squares: the square of a ring's radius in a square or cubic lattice.
fn is_sum_of_squares(number: u32, count: usize) -> bool {
    let mut bases = (0..=number).take_while(|base| base * base <= number);
    if count == 1 {
        return bases.any(|base| base * base == number);
    }
    bases.any(|base| is_sum_of_squares(number - base * base, count - 1))
}

impl Default for Settings {
    fn default() -> Self {
        Self::for_scheme(Scheme::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_of_the_determinant_that_is_none_is_a_fault() {
        let surfaces = [
            |determinant_floor| SurfaceTreatment::Printed { determinant_floor },
            |determinant_floor| SurfaceTreatment::Intended { determinant_floor },
        ];
        for surface in surfaces {
            let faults = |floor| Settings { surface: surface(floor), ..Settings::default() }.faults();
            for floor in [0.0, 0.01, 0.1, 0.5] {
                assert_eq!(faults(floor), Vec::<String>::new(), "{floor}");
            }
            for floor in [f64::NAN, f64::INFINITY, -0.01, 0.51] {
                let found = faults(floor);
                assert!(found.len() == 1 && found[0].contains("determinant_floor"), "{floor}: {found:?}");
            }
        }
        for scheme in Scheme::ALL {
            assert_eq!(Settings::for_scheme(scheme).faults(), Vec::<String>::new(), "{scheme:?}");
        }
    }

    #[test]
    fn the_skin_ends_before_the_next_ring_of_the_lattice() {
        let width = |smoothing: f64, skin| Settings { smoothing, skin, ..Settings::default() }.skin_width(2);
        // Rings at 2, √5, √8, 3, √10 D; lists reach to 4 θ D and the skin.
        assert_eq!(width(0.5, None), 0.2, "√5 - 2 = 0.236");
        assert_eq!(width(0.55, None), 0.4, "√8 - 2.2 = 0.628");
        assert!((width(0.6, None) - (8.0_f64.sqrt() - 2.45)).abs() < 1e-12);
        assert_eq!(width(0.6, Some(0.7)), 0.7, "asked for");
        assert_eq!(
            Settings { smoothing: 0.56, ..Settings::default() }.skin_width(3),
            0.2,
            "√6 - 2.24 = 0.21"
        );
    }
}
