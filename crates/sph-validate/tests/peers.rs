//! Our exact solutions beside those of others for the same problem.

use sph_materials::eos::MieGruneisen;
use sph_materials::hugoniot::{PistonWaves, piston};
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength};

/// The aluminum of the elastic-plastic piston of ExactPack (`exactpack/solvers/ep_piston`, after Lieberman et al. 2019).
fn aluminum() -> Material {
    Material {
        name: "aluminum".into(),
        reference_density: 2790.0,
        equation_of_state: EquationOfState::MieGruneisen(MieGruneisen {
            bulk_sound_speed: 5330.0,
            hugoniot_slope: 1.34,
            gruneisen_coefficient: 2.0,
        }),
        strength: Strength::PerfectPlastic { shear_modulus: 28.6e9, yield_strength: 0.26e9 },
        failure: Failure::None,
        sound_speed: SoundSpeedModel::Thermodynamic,
    }
}

/// ExactPack's hypoelastic model is ours. Its test prints the density at yield (2.8027106842157106 g/cm³); the other
/// numbers are its equations, solved by bisection at u_p = 100 m/s.
#[test]
fn piston_is_that_of_exactpack() {
    let waves = piston(&aluminum(), 100.0).expect("two waves");
    let PistonWaves::TwoWave { precursor, plastic } = waves else { panic!("{waves:?}") };
    for (name, ours, theirs) in [
        ("density at yield", precursor.behind.density, 2_802.710_684_215_71),
        ("pressure at yield", precursor.behind.pressure, 0.364_661_296_870_489e9),
        ("velocity at yield", precursor.behind.particle_velocity, 29.572_102_231_964_9),
        ("precursor", precursor.wave_speed, 6_520.659_743_698_48),
        ("plastic wave", plastic.wave_speed, 5_505.528_458_708_72),
        ("pressure at the piston", plastic.behind.pressure, 1.445_554_964_078_43e9),
        ("density at the piston", plastic.behind.density, 2_839.226_821_916_05),
    ] {
        assert!((ours / theirs - 1.0).abs() < 1e-9, "{name}: {ours} here, {theirs} there");
    }
}
