//! `hugoniot check`: what a case file resolves to, before anything is run.

use std::fmt::Write;
use std::path::Path;
use std::path::PathBuf;

use serde::Serialize;

use sph_materials::Material;

use crate::config::Case;
use crate::config::case::Pores;
use crate::config::units::{LengthKind, PressureKind, VelocityKind, show, significant};
use crate::estimate::{self, PointEstimate};
use crate::microstructure::layout::{Base, Fill};
use crate::microstructure::measure::{self, Features};
use crate::microstructure::relax::Uniformity;
use crate::microstructure::{self, Sample, picture};

/// A resolved case with what its run will need.
#[derive(Debug, Serialize)]
pub struct Check {
    /// The case in SI.
    pub case: Case,
    /// Porosity that whole particles reach [-].
    pub porosity_reached: f64,
    /// Density ρ00 of the medium [kg/m³].
    pub bulk_density: f64,
    /// Particles in a cell.
    pub particles_per_cell: usize,
    /// Particles of each material in a cell.
    pub particles_by_material: Vec<(String, usize)>,
    /// What the sample resolves, in particle sizes.
    pub features: Features,
    /// How well a relaxed packing fills space.
    pub uniformity: Option<Uniformity>,
    /// What to be warned of.
    pub warnings: Vec<String>,
    /// The picture of the sample, if it was drawn.
    pub picture: Option<PathBuf>,
    /// Of the farthest point removed: distance from its pore's center on a lattice, else from the voids' boundary [m];
    /// `None` without voids.
    pub cut_radius: Option<f64>,
    /// What each point will need.
    pub points: Vec<PointEstimate>,
    /// Cores that the estimate is for.
    pub threads: usize,
    /// Expected time of all points [s].
    pub expected_seconds: f64,
    /// Expected memory [bytes].
    pub expected_bytes: f64,
    /// Expected size of the folder of results, moments for ParaView at their limit [bytes].
    pub expected_disk_bytes: f64,
}

impl Check {
    /// Resolves the case further: sample, particles, memory, time on `threads` cores.
    pub fn new(case: Case, threads: usize) -> Self {
        let sample: Sample = microstructure::sample(&case);
        let points: Vec<_> = case.points.iter().map(|&u| estimate::point(&case, &sample, u)).collect();
        let names: Vec<String> = case.materials().into_iter().map(|m| m.name).collect();
        let features = measure::features(&case.medium);
        let (expected_seconds, expected_bytes) = estimate::total(&points, threads);
        let expected_disk_bytes = estimate::disk(&points, threads);
        Self {
            porosity_reached: sample.porosity,
            bulk_density: sample.bulk_density(),
            particles_per_cell: sample.particles.len(),
            particles_by_material: names.into_iter().zip(sample.counts.iter().copied()).collect(),
            warnings: measure::warnings(&case.medium, &sample, &features),
            features,
            uniformity: sample.uniformity,
            picture: None,
            cut_radius: sample.cut.0.is_finite().then_some(sample.cut.0),
            points,
            threads,
            expected_seconds,
            expected_bytes,
            expected_disk_bytes,
            case,
        }
    }

    /// Draws the sample into a PNG file and names it; a picture that cannot be written is a warning.
    pub fn draw(&mut self, path: &Path) {
        let written = path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(|e| e.to_string());
        let sample = microstructure::sample(&self.case);
        let written =
            written.and_then(|()| picture::write(&self.case, &sample, path).map_err(|e| e.to_string()));
        match written {
            Ok(()) => self.picture = Some(path.to_path_buf()),
            Err(reason) => self.warnings.push(format!("no picture of the sample: {reason}")),
        }
    }

    /// The text for people.
    pub fn to_text(&self) -> String {
        let (mut out, medium, scheme) = (String::new(), &self.case.medium, &self.case.scheme);
        let mut line = |name: &str, text: String| _ = writeln!(out, "{name:<20} {text}");
        line("case", self.case.name.clone());
        line("material", self.material_text());
        line("medium", self.medium_text());
        let (wanted, reached) = (significant(medium.porosity), significant(self.porosity_reached));
        line(
            "porosity",
            format!(
                "{reached} reached, {wanted} asked for; bulk density {} kg/m3",
                significant(self.bulk_density)
            ),
        );
        line("particles", self.particles_text());
        line("voids", self.features_text());
        if let Some(u) = self.uniformity {
            line("relaxed", relaxed_text(&u));
        }
        let volume = if scheme.volume_consistency.is_some() { "on" } else { "off" };
        line(
            "scheme",
            format!(
                "{:?}, {:?}, θ = {}, CFL {}",
                scheme.scheme, scheme.limiter, scheme.smoothing, scheme.courant
            ),
        );
        line("surfaces, volume", format!("{:?}, volume consistency {volume}", scheme.surface));
        line("results", self.case.output.directory.clone());
        out.push('\n');
        out.push_str(&self.points_text());
        if let Some(refinement) = &self.case.refinement {
            let (n, percent) = (refinement.max_points, significant(100.0 * refinement.tolerance));
            _ = writeln!(
                out,
                "more points where the curve bends, to {percent} % of u_s or {n} points; not in the estimates"
            );
        }
        let time = duration(self.expected_seconds);
        let megabytes = |bytes: f64| significant((bytes / 1e5).round() / 10.0);
        if let Some(path) = &self.picture {
            _ = writeln!(out, "\npicture of the sample: {}", path.display());
        }
        for warning in &self.warnings {
            _ = writeln!(out, "warning: {warning}");
        }
        let on_disk: f64 = self.points.iter().map(|p| p.snapshot_bytes).sum();
        if on_disk > 0.0 {
            _ = writeln!(out, "moments for ParaView: {} MB on disk at the most", megabytes(on_disk));
        }
        let (memory, disk) = (megabytes(self.expected_bytes), megabytes(self.expected_disk_bytes));
        let threads = self.threads;
        _ = writeln!(
            out,
            "\nabout {time} on {threads} core(s), {memory} MB of memory, {disk} MB on disk; estimates"
        );
        out
    }

    fn material_text(&self) -> String {
        let text = |m: Material| {
            let speed = m.longitudinal_sound_speed(m.reference_density, 0.0);
            let (shear, c_l) =
                (show::<PressureKind>(m.strength.shear_modulus()), show::<VelocityKind>(speed));
            format!("{}, {} kg/m3, G = {shear}, c_l = {c_l}", m.name, significant(m.reference_density))
        };
        self.case.materials().into_iter().map(text).collect::<Vec<_>>().join("\n                     ")
    }

    fn medium_text(&self) -> String {
        let medium = &self.case.medium;
        let cell =
            format!("cell {} × {}", show::<LengthKind>(medium.cell), show::<LengthKind>(medium.height));
        let picture = match &medium.layout.base {
            Base::Image(image) => {
                format!(", {} ({} × {} pixels)", image.file, image.pixels.0, image.pixels.1)
            }
            Base::Uniform(_) => String::new(),
        };
        let pores = match medium.pores {
            Pores::None => String::new(),
            Pores::Placed => ", pores at random".into(),
            lattice => format!(", pores {lattice:?}, radius {}", show::<LengthKind>(medium.radius)),
        };
        let painted = medium.layout.painted.iter().filter(|p| p.fill != Fill::Void).count();
        let inclusions =
            if painted > 0 { format!(", {painted} inclusions or layers") } else { String::new() };
        cell + &picture + &pores + &inclusions
    }

    fn particles_text(&self) -> String {
        let medium = &self.case.medium;
        let size = show::<LengthKind>(medium.particle_size);
        let head = format!("D = {size}, {:?} packing, {} a cell", medium.packing, self.particles_per_cell);
        if self.particles_by_material.len() < 2 {
            return head;
        }
        let parts = self.particles_by_material.iter().map(|(name, count)| format!("{count} {name}"));
        format!("{head}: {}", parts.collect::<Vec<_>>().join(", "))
    }

    fn features_text(&self) -> String {
        let width = |w: Option<f64>| w.map_or("none".to_string(), |w| format!("{w:.1} D"));
        let f = &self.features;
        if f.pores == 0 {
            return "none".into();
        }
        let (gap, pore) = (width(f.smallest_gap), width(f.smallest_pore));
        format!("{} pores a cell; smallest gap between them {gap}, smallest pore {pore}", f.pores)
    }

    fn points_text(&self) -> String {
        let mut out = String::from(
            "u_p, m/s  u_s about  window, cells  particles  cells fed, least      steps      time\n",
        );
        for p in &self.points {
            _ = writeln!(
                out,
                "{:>8}  {:>9.0}  {:>13}  {:>9}  {:>16}  {:>9.0}  {:>8}",
                significant(p.particle_velocity),
                p.shock_velocity,
                p.window_cells,
                p.particles,
                p.fed_cells,
                p.steps,
                duration(p.seconds)
            );
        }
        out
    }
}

fn relaxed_text(u: &Uniformity) -> String {
    format!(
        "volume sums within {:.2} % of their mean, {:.2} % before; surface within {:.2} D of the boundary, {:.2} D before",
        100.0 * u.relaxed,
        100.0 * u.jittered,
        u.surface.1,
        u.surface.0
    )
}

/// A duration as people say it.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 48.0 * 3600.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config;

    #[test]
    fn the_shipped_case_tells_what_it_is() {
        let case =
            config::parse(include_str!("../templates/porous-copper.ron"), "porous-copper.ron").unwrap();
        let check = Check::new(case, 2);
        let text = check.to_text();
        for part in ["1.35135 reached, 1.35 asked for", "296 a cell", "TkcHancock", "u_s about"] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
        assert!(check.expected_seconds < 600.0, "the shipped case is to end within ten minutes");
        assert!(serde_json::to_value(&check).unwrap()["points"].as_array().unwrap().len() == 8);
    }

    #[test]
    fn durations_read_well() {
        assert_eq!(duration(0.25), "0.2 s");
        assert_eq!(duration(90.0), "90 s");
        assert_eq!(duration(600.0), "10 min");
        assert_eq!(duration(9000.0), "2.5 h");
    }
}
