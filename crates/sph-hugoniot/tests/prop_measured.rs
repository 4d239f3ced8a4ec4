//! Measured data changed at random: always an answer, never a panic; what is written is read back.

use proptest::prelude::*;
use sph_hugoniot::curve::measured;

const TEXT: &str = "# Boade 1970\nu_p [m/s], u_s [km/s], u_s_error [m/s], source\n120, 0.52, 10, \"shot 3, left\"\n250, 0.95, , shot 7\n";

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_gets_an_answer(text in "\\PC{0,200}") {
        if let Err(faults) = measured::parse(&text) {
            prop_assert!(!faults.is_empty() && faults.iter().all(|f| f.line >= 1 && f.column >= 1));
        }
    }

    #[test]
    fn a_changed_file_gets_an_answer_within_the_text(at in 0..TEXT.len(), length in 0..30usize, new in "[-0-9.,eE\"\\[\\]µ\r\n a-z_/#]{0,8}") {
        let end = (at + length).min(TEXT.len());
        let text = format!("{}{new}{}", &TEXT[..at], &TEXT[end..]);
        match measured::parse(&text) {
            Ok(points) => prop_assert!(points.iter().all(|p| p.shock_velocity > p.particle_velocity)),
            Err(faults) => {
                prop_assert!(!faults.is_empty() && faults.len() <= 30);
                let lines = text.lines().count().max(1);
                prop_assert!(faults.iter().all(|f| f.line <= lines), "{faults:?}");
            }
        }
    }

    #[test]
    fn what_is_written_is_read_back(rows in prop::collection::vec((1.0..900.0_f64, 1.0..3000.0_f64, 0.0..50.0_f64), 1..20)) {
        let mut text = String::from("u_s_error [m/s],u_p [m/s],u_s [m/s]\n");
        for (u_p, more, error) in &rows {
            text += &format!("{error:?},{u_p:?},{:?}\n", u_p + more);
        }
        let points = measured::parse(&text).unwrap();
        prop_assert_eq!(points.len(), rows.len());
        for (point, (u_p, more, error)) in points.iter().zip(&rows) {
            prop_assert_eq!(point.particle_velocity, *u_p);
            prop_assert_eq!(point.shock_velocity, u_p + more);
            prop_assert_eq!(point.shock_velocity_error, *error);
        }
    }
}
