//! Names of what is run: schemes, tiers, and one run of a suite.

use std::fmt;

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sph_riemann::{Scheme, Settings};

/// A scheme of the solver, by its name in commands and files.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum, Serialize, Deserialize, JsonSchema,
)]
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

    /// Courant number [-] of the scheme's published figures: CSPH 0.3, TKC-MUSCL-SPH 0.1, TKC-Hancock 0.4.
    pub fn courant(self) -> f64 {
        match self {
            Self::Csph => 0.3,
            Self::TkcMuscl => 0.1,
            Self::TkcHancock => 0.4,
        }
    }

    /// Price of a particle-step, that of the corrected schemes being 1.
    pub fn price(self) -> f64 {
        match self {
            Self::Csph => 0.5,
            Self::TkcMuscl | Self::TkcHancock => 1.0,
        }
    }

    /// The solver's settings: its defaults for the scheme, with the published Courant number and, for the published
    /// schemes, without the volume consistency that they do not know.
    pub fn settings(self) -> Settings {
        let mut settings = Settings::for_scheme(self.scheme());
        settings.courant = self.courant();
        if self != Self::TkcHancock {
            settings.volume_consistency = None;
        }
        settings
    }
}

/// How much is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Tier {
    /// Coarse resolutions: under three minutes on two cores, all suites together.
    #[default]
    Quick,
    /// Every resolution of the tables: under an hour on two cores.
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

/// One run: a variant of a suite's problem with one scheme at one resolution.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct Case {
    /// Name of the suite.
    pub suite: String,
    /// Variant of the problem (a material, a velocity, an angle); empty where a suite has one only.
    pub variant: String,
    /// The scheme.
    pub scheme: SchemeName,
    /// Resolution; what it counts is said by [`About::resolution`](crate::suites::About::resolution).
    pub n: u32,
}

impl Case {
    /// The only problem of a suite.
    pub fn new(suite: &str, scheme: SchemeName, n: u32) -> Self {
        Self { suite: suite.to_owned(), variant: String::new(), scheme, n }
    }

    /// The same run of a variant of the problem.
    #[must_use]
    pub fn of_variant(mut self, variant: &str) -> Self {
        variant.clone_into(&mut self.variant);
        self
    }

    /// All `schemes` at all `resolutions`, of the only problem of a suite.
    pub fn grid(suite: &str, schemes: &[SchemeName], resolutions: &[u32]) -> Vec<Self> {
        let of_scheme = |&scheme| resolutions.iter().map(move |&n| Self::new(suite, scheme, n));
        schemes.iter().flat_map(of_scheme).collect()
    }

    /// All `schemes` at all `resolutions`, of one variant of a suite's problem.
    pub fn grid_of(suite: &str, variant: &str, schemes: &[SchemeName], resolutions: &[u32]) -> Vec<Self> {
        let grid = Self::grid(suite, schemes, resolutions).into_iter();
        grid.map(|case| case.of_variant(variant)).collect()
    }

    /// Whether two runs differ in resolution only: their errors make an order of convergence.
    pub fn is_kin_of(&self, other: &Self) -> bool {
        (&self.suite, &self.variant, self.scheme) == (&other.suite, &other.variant, other.scheme)
    }

    /// Name for files, without an extension: `riemann-tkc-hancock-100`.
    pub fn stem(&self) -> String {
        let variant = if self.variant.is_empty() { String::new() } else { format!("-{}", self.variant) };
        format!("{}{variant}-{}-{}", self.suite, self.scheme, self.n)
    }
}

impl fmt::Display for SchemeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let variant = if self.variant.is_empty() { String::new() } else { format!(" {}", self.variant) };
        write!(f, "{}{variant} {} n = {}", self.suite, self.scheme, self.n)
    }
}
