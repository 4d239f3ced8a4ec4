//! The particles at one moment for ParaView.

use std::path::Path;

use sph_core::Dim2;
use sph_io::IoError;
use sph_io::snapshot::Snapshot;
use sph_window::Window;

/// Columns of a moment, in the components that ParaView knows.
#[derive(Clone, Debug, Default)]
pub struct Moment {
    time: f64,
    points: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    stress: Vec<[f64; 6]>,
    scalars: Vec<(&'static str, Vec<f64>)>,
    integers: Vec<(&'static str, Vec<i64>)>,
}

impl Moment {
    /// The particles that `keep` names by their index.
    pub fn of(window: &Window<Dim2>, keep: impl Fn(usize) -> bool) -> Self {
        let simulation = window.simulation();
        let p = simulation.particles();
        let kept: Vec<usize> = (0..p.len()).filter(|&i| keep(i)).collect();
        let numbers = |value: &dyn Fn(usize) -> f64| kept.iter().map(|&i| value(i)).collect::<Vec<f64>>();
        let whole = |value: &dyn Fn(usize) -> i64| kept.iter().map(|&i| value(i)).collect::<Vec<i64>>();
        let inlet = window.inlet_velocity();
        let stress = |i: usize| {
            let [xx, yy, zz, xy] = simulation.stress(i);
            [xx, yy, zz, xy, 0.0, 0.0]
        };
        Self {
            time: window.time(),
            points: kept.iter().map(|&i| [p.position[0][i], p.position[1][i], 0.0]).collect(),
            velocity: kept.iter().map(|&i| [p.velocity[0][i] + inlet, p.velocity[1][i], 0.0]).collect(),
            stress: kept.iter().map(|&i| stress(i)).collect(),
            scalars: vec![
                ("density [kg/m3]", numbers(&|i| p.density[i])),
                ("pressure [Pa]", numbers(&|i| simulation.pressure(i))),
                ("specific internal energy [J/kg]", numbers(&|i| p.specific_internal_energy[i])),
                ("plastic strain", numbers(&|i| p.plastic_strain[i])),
                ("packing excess", numbers(&|i| p.packing_excess[i])),
                ("size [m]", numbers(&|i| (p.mass[i] / p.density[i]).sqrt())),
            ],
            integers: vec![
                ("id", whole(&|i| p.id[i] as i64)),
                ("material", whole(&|i| i64::from(p.material[i]))),
                ("constraint", whole(&|i| p.constraint[i] as i64)),
                ("failed", whole(&|i| i64::from(p.failed[i]))),
            ],
        }
    }

    /// The moment as a snapshot to be written.
    pub fn snapshot(&self) -> Snapshot<'_> {
        let mut snapshot = Snapshot::new(self.time, &self.points)
            .with_vector("velocity [m/s]", &self.velocity)
            .with_symmetric_tensor("stress [Pa]", &self.stress);
        for (name, values) in &self.scalars {
            snapshot = snapshot.with_scalar(*name, values);
        }
        for (name, values) in &self.integers {
            snapshot = snapshot.with_integer(*name, values);
        }
        snapshot
    }

    /// Writes the moment as `.vtp`.
    ///
    /// # Errors
    /// From the system.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        self.snapshot().write_vtp(path)
    }
}
