//! Names of what is run: suites, schemes, tiers, and one run of a suite.

use std::fmt;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use sph_riemann::{Limiter, Scheme};

/// A problem with a known answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SuiteName {
    /// Elastic-plastic Riemann problem.
    Riemann,
    /// Longitudinal sound wave.
    SoundWave,
    /// Verney's cylindrical shell.
    Verny,
}

impl SuiteName {
    /// All suites, in the order of the report.
    pub const ALL: [Self; 3] = [Self::Riemann, Self::SoundWave, Self::Verny];

    /// Name in commands, files and folders.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Riemann => "riemann",
            Self::SoundWave => "sound-wave",
            Self::Verny => "verny",
        }
    }

    /// Title in reports.
    pub fn title(self) -> &'static str {
        match self {
            Self::Riemann => "Elastic-plastic Riemann problem",
            Self::SoundWave => "Longitudinal sound wave",
            Self::Verny => "Verney's cylindrical shell",
        }
    }

    /// What `n` counts in this suite.
    pub fn resolution_name(self) -> &'static str {
        match self {
            Self::Riemann | Self::SoundWave => "particles along x",
            Self::Verny => "rings of particles (D0 = 20 mm / n)",
        }
    }
}

/// A scheme of the solver, by its name in commands and files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all(serialize = "kebab-case"))]
pub enum SchemeName {
    /// No reconstruction, no kernel correction: the baseline.
    Csph,
    /// As printed: corrected kernels, limited reconstruction, explicit Euler.
    TkcMuscl,
    /// MUSCL-Hancock, the default of the program.
    TkcHancock,
}

impl SchemeName {
    /// All schemes, in the order of the report.
    pub const ALL: [Self; 3] = [Self::Csph, Self::TkcMuscl, Self::TkcHancock];

    /// Name in commands and files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Csph => "csph",
            Self::TkcMuscl => "tkc-muscl",
            Self::TkcHancock => "tkc-hancock",
        }
    }

    /// Name in reports.
    pub fn title(self) -> &'static str {
        match self {
            Self::Csph => "CSPH",
            Self::TkcMuscl => "TKC-MUSCL-SPH",
            Self::TkcHancock => "TKC-Hancock",
        }
    }

    /// The solver's scheme.
    pub fn scheme(self) -> Scheme {
        match self {
            Self::Csph => Scheme::Csph,
            Self::TkcMuscl => Scheme::TkcMuscl,
            Self::TkcHancock => Scheme::TkcHancock,
        }
    }
}

/// How much is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tier {
    /// Coarse resolutions: under two minutes on two cores.
    #[default]
    Quick,
    /// Every resolution of the tables.
    Full,
}

impl Tier {
    /// Name in commands and files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Full => "full",
        }
    }
}

/// One run: a suite with one scheme at one resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Case {
    /// The problem.
    pub suite: SuiteName,
    /// The scheme.
    pub scheme: SchemeName,
    /// Resolution, see [`SuiteName::resolution_name`].
    pub n: u32,
}

impl Case {
    /// Courant number of the run.
    ///
    /// CSPH, TKC-MUSCL-SPH and the shell: what the published figures of the scheme were measured with. TKC-Hancock in
    /// the two plane problems: 0.5, where the published figures have 0.4; what 0.4 gives is in their READMEs.
    pub fn courant(self) -> f64 {
        match (self.scheme, self.suite) {
            (SchemeName::Csph, _) => 0.3,
            (SchemeName::TkcMuscl, _) => 0.1,
            (SchemeName::TkcHancock, SuiteName::Verny) => 0.4,
            (SchemeName::TkcHancock, SuiteName::Riemann | SuiteName::SoundWave) => 0.5,
        }
    }

    /// Limiter of the run, where it is not the scheme's default: the published figures of TKC-Hancock in the two plane
    /// problems were measured with the monotonized central one.
    pub fn limiter(self) -> Option<Limiter> {
        let is_plane = matches!(self.suite, SuiteName::Riemann | SuiteName::SoundWave);
        (self.scheme == SchemeName::TkcHancock && is_plane).then_some(Limiter::MonotonizedCentral)
    }
}

impl fmt::Display for SuiteName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl fmt::Display for SchemeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} n = {}", self.suite, self.scheme, self.n)
    }
}
