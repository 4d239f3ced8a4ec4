//! How the equations are solved, and the moving window.

use sph_riemann::{FaceClosure, Scheme, Settings, SurfaceTreatment, VolumeConsistency};
use sph_window::InletKind;

use super::case::WindowCase;
use super::field::Field;
use super::resolve::Resolver;
use super::schema::*;
use crate::zone::AutoLength;

impl Resolver<'_> {
    pub(super) fn scheme(&self, s: &SchemeSchema) -> Option<Settings> {
        let usual = Settings::for_scheme(self.choice(&s.scheme, Scheme::default())?);
        let limiter = self.choice(&s.limiter, usual.limiter);
        let kernel = self.choice(&s.kernel, usual.kernel);
        let smoothing = self.number(&s.smoothing, usual.smoothing, 0.45, 1.0);
        let courant = self.number(&s.cfl, usual.courant, 0.001, 1.0);
        let skin = self.number_if_given(&s.skin, 0.0, 2.0);
        let surface = self.surface(&s.surface, usual.surface);
        let volume_consistency = self.volume_consistency(&s.volume_consistency, usual.volume_consistency);
        let face_closure = self.face_closure(&s.face_closure);
        Some(Settings {
            limiter: limiter?,
            kernel: kernel?,
            smoothing: smoothing?,
            courant: courant?,
            skin: skin?,
            surface: surface?,
            volume_consistency: volume_consistency?,
            face_closure: face_closure?,
            ..usual
        })
    }

    fn surface(&self, field: &Field<SurfaceSchema>, usual: SurfaceTreatment) -> Option<SurfaceTreatment> {
        let floor = |f: &FloorSchema| self.number(&f.determinant_floor, 0.01, 0.0, 0.5);
        match field {
            Field::Absent => Some(usual),
            Field::Bad(_) => None,
            Field::Good(SurfaceSchema::None, _) => Some(SurfaceTreatment::None),
            Field::Good(SurfaceSchema::Printed(f), _) => {
                floor(f).map(|determinant_floor| SurfaceTreatment::Printed { determinant_floor })
            }
            Field::Good(SurfaceSchema::Intended(f), _) => {
                floor(f).map(|determinant_floor| SurfaceTreatment::Intended { determinant_floor })
            }
            Field::Good(SurfaceSchema::SpectralCap(c), _) => {
                self.number(&c.cap, 2.5, 1.0, 100.0).map(|cap| SurfaceTreatment::SpectralCap { cap })
            }
        }
    }

    fn volume_consistency(
        &self,
        field: &Field<VolumeConsistencySchema>,
        usual: Option<VolumeConsistency>,
    ) -> Option<Option<VolumeConsistency>> {
        let r = match field {
            Field::Absent => return Some(usual),
            Field::Bad(_) => return None,
            Field::Good(VolumeConsistencySchema::Off, _) => return Some(None),
            Field::Good(VolumeConsistencySchema::On(r), _) => r,
        };
        let usual = VolumeConsistency::default();
        let width = self.number(&r.width, usual.width, 1.5, 4.0);
        let rate = self.number(&r.rate, usual.rate, 0.0, 1.0);
        let tolerance = self.number(&r.tolerance, usual.tolerance, 0.0, 0.1);
        let void_deficit = self.number(&r.void_deficit, usual.void_deficit, 1e-3, 1.0);
        Some(Some(VolumeConsistency {
            width: width?,
            rate: rate?,
            tolerance: tolerance?,
            void_deficit: void_deficit?,
            ..usual
        }))
    }

    fn face_closure(&self, field: &Field<FaceClosureSchema>) -> Option<Option<FaceClosure>> {
        match field {
            Field::Absent => Some(None),
            Field::Bad(_) => None,
            Field::Good(FaceClosureSchema::Off, _) => Some(None),
            Field::Good(FaceClosureSchema::On(closure), _) => {
                let sweeps = self.count(&closure.sweeps, u64::from(FaceClosure::default().sweeps), 2, 1000);
                sweeps.map(|sweeps| Some(FaceClosure { sweeps: sweeps as u32 }))
            }
        }
    }

    pub(super) fn window(
        &self,
        w: &WindowSchema,
        automatic: impl Fn(f64) -> AutoLength,
    ) -> Option<WindowCase> {
        let cells = match &w.length {
            Field::Bad(_) => None,
            Field::Absent | Field::Good(LengthSchema::Auto, _) => Some(None),
            Field::Good(LengthSchema::Cells(n), _) => self.count(n, 12, 1, 100_000).map(Some),
        };
        let region_width = self.number(&w.region_width, 4.0, 2.0, 40.0);
        let inlet = match &w.inlet {
            Field::Bad(_) => None,
            Field::Absent | Field::Good(InletSchema::FixedVelocity, _) => Some(InletKind::FixedVelocity),
            Field::Good(InletSchema::ImpedanceMatched(wave), _) => {
                let wave_speed = self.quantity(&wave.wave_speed, 1.0, 1e5);
                let good = !matches!(wave.wave_speed, Field::Bad(_));
                good.then_some(InletKind::ImpedanceMatched { wave_speed })
            }
        };
        let front_place = self.number(&w.front_place, 0.5, 0.2, 0.8)?;
        Some(WindowCase {
            cells: cells?,
            automatic: automatic(front_place),
            region_width: region_width?,
            inlet: inlet?,
            front_place,
        })
    }
}
