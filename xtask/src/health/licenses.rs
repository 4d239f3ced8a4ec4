//! Licenses of the dependencies: every one can be met beside `MIT OR Apache-2.0`.

use anyhow::Context;
use serde_json::Value;
use spdx::{Expression, ParseMode};

use super::Finding;
use crate::process;

/// Licenses that ask for no more than their notice to be kept.
const PERMISSIVE: [&str; 10] = [
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

pub(super) fn check() -> anyhow::Result<Finding> {
    let metadata = process::metadata(&[])?;
    let packages = metadata["packages"].as_array().context("metadata has no packages")?;
    let faults: Vec<String> = packages.iter().filter_map(fault).collect();
    let said = format!("licenses of {} packages against {}", packages.len(), PERMISSIVE.join(", "));
    Ok(Finding::of("licenses", said, faults))
}

/// What is wrong with the license of a package.
fn fault(package: &Value) -> Option<String> {
    let name = package["name"].as_str().unwrap_or_default();
    let Some(text) = package["license"].as_str() else {
        return Some(format!("{name} names no license"));
    };
    match can_be_met(text) {
        Ok(true) => None,
        Ok(false) => Some(format!("{name} asks for {text}")),
        Err(error) => Some(format!("{name}: {text:?} cannot be read: {error}")),
    }
}

/// True if the licenses listed above suffice. Old manifests write `MIT/Apache-2.0` for OR.
fn can_be_met(text: &str) -> Result<bool, String> {
    let expression =
        Expression::parse_mode(text, ParseMode::LAX).map_err(|error| error.reason.to_string())?;
    let permissive = |id: &str| PERMISSIVE.contains(&id);
    Ok(expression
        .evaluate(|requirement| requirement.license.id().is_some_and(|license| permissive(license.name))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn either_side_of_an_or_suffices_and_both_of_an_and_are_needed() {
        for good in
            ["MIT", "MIT/Apache-2.0", "MIT OR LGPL-2.1-or-later", "(MIT OR Apache-2.0) AND Unicode-3.0"]
        {
            assert_eq!(can_be_met(good), Ok(true), "{good}");
        }
        for bad in ["GPL-3.0-only", "MIT AND GPL-3.0-only", "LGPL-2.1-or-later"] {
            assert_eq!(can_be_met(bad), Ok(false), "{bad}");
        }
        assert!(can_be_met("as you like").is_err());
    }
}
