//! Who may depend on whom.

use serde_json::Value;

use super::Fault;
use crate::files::Text;

/// Each package of the workspace with the packages of the workspace that it may depend on, from the ground up. The
/// same holds for what its tests and examples use.
const MAY_USE: [(&str, &[&str]); 9] = [
    ("sph-case", &[]),
    ("sph-core", &[]),
    ("sph-materials", &[]),
    ("sph-io", &[]),
    ("sph-riemann", &["sph-core", "sph-materials"]),
    ("sph-window", &["sph-core", "sph-materials", "sph-riemann"]),
    ("sph-hugoniot", &["sph-core", "sph-materials", "sph-riemann", "sph-window", "sph-io", "sph-case"]),
    ("sph-validate", &["sph-core", "sph-materials", "sph-riemann", "sph-window", "sph-io", "sph-case"]),
    // It starts programs; it links no numerics.
    ("xtask", &[]),
];

/// Holds the manifests, as `cargo metadata` gives them, against the list.
pub fn check(metadata: &Value) -> anyhow::Result<Vec<Fault>> {
    let packages =
        metadata["packages"].as_array().ok_or_else(|| anyhow::anyhow!("metadata has no packages"))?;
    let names: Vec<&str> = packages.iter().filter_map(|package| package["name"].as_str()).collect();
    let mut faults = Vec::new();
    for package in packages {
        let name = package["name"].as_str().unwrap_or_default();
        let Some((_, allowed)) = MAY_USE.iter().find(|(known, _)| *known == name) else {
            let hint = "hint: MAY_USE in xtask/src/tidy/dependencies.rs, and the map in ARCHITECTURE.md";
            faults.push(fault(name, format!("the package has no place in the house; {hint}")));
            continue;
        };
        let dependencies = package["dependencies"].as_array().map(Vec::as_slice).unwrap_or_default();
        let used = dependencies.iter().filter_map(|dependency| dependency["name"].as_str());
        for sibling in used.filter(|used| names.contains(used) && !allowed.contains(used)) {
            let may = if allowed.is_empty() { "no sibling".to_owned() } else { allowed.join(", ") };
            faults.push(fault(name, format!("depends on {sibling}; it may use {may}")));
        }
    }
    Ok(faults)
}

fn fault(package: &str, message: String) -> Fault {
    let path = if package == "xtask" {
        "xtask/Cargo.toml".to_owned()
    } else {
        format!("crates/{package}/Cargo.toml")
    };
    Fault { path, line: 0, message }
}

/// Every package takes the lints of the workspace.
pub fn check_lints(texts: &[Text]) -> Vec<Fault> {
    // Fuzz targets are a workspace of their own.
    let of_workspace = |path: &str| path.ends_with("/Cargo.toml") && !path.contains("/fuzz/");
    let manifests = texts.iter().filter(|text| of_workspace(&text.path));
    let careless = manifests.filter(|text| !text.content.contains("[lints]\nworkspace = true"));
    careless
        .map(|text| Fault {
            path: text.path.clone(),
            line: 0,
            message: "without the lints of the workspace; hint: [lints] workspace = true".into(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packages(list: &[(&str, &[&str])]) -> Value {
        let package = |(name, uses): &(&str, &[&str])| {
            let uses: Vec<Value> = uses.iter().map(|name| serde_json::json!({ "name": name })).collect();
            serde_json::json!({ "name": name, "dependencies": uses })
        };
        serde_json::json!({ "packages": list.iter().map(package).collect::<Vec<_>>() })
    }

    #[test]
    fn the_house_as_it_should_be_has_no_faults() {
        let good = packages(&[
            ("sph-core", &["glam"]),
            ("sph-materials", &["serde"]),
            ("sph-riemann", &["sph-core", "sph-materials"]),
        ]);
        assert_eq!(check(&good).unwrap(), []);
    }

    #[test]
    fn a_wrong_direction_and_a_stranger_are_told_together() {
        let bad = packages(&[
            ("sph-core", &["sph-materials"]),
            ("sph-materials", &[]),
            ("sph-new", &["sph-core"]),
            ("xtask", &["sph-core"]),
        ]);
        let faults: Vec<String> = check(&bad).unwrap().iter().map(ToString::to_string).collect();
        assert_eq!(faults.len(), 3, "{faults:?}");
        assert_eq!(faults[0], "crates/sph-core/Cargo.toml: depends on sph-materials; it may use no sibling");
        assert!(faults[1].starts_with("crates/sph-new/Cargo.toml: the package has no place"));
        assert!(faults[2].starts_with("xtask/Cargo.toml: depends on sph-core"));
    }

    #[test]
    fn a_manifest_without_lints_is_told() {
        let manifest =
            |content: &str| Text { path: "crates/sph-x/Cargo.toml".into(), content: content.into() };
        assert_eq!(check_lints(&[manifest("[package]\n\n[lints]\nworkspace = true\n")]), []);
        assert_eq!(check_lints(&[manifest("[package]\n")]).len(), 1);
    }
}
