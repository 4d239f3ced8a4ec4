//! The texts of the repository.

use std::path::Path;

use anyhow::Context;

/// Folders that are built, not written.
const BUILT: [&str; 3] = ["target", "results", "book"];
/// Hidden folders that belong to the project.
const HIDDEN: [&str; 2] = [".ci", ".cargo"];
/// Endings of texts.
const TEXTS: [&str; 7] = ["rs", "md", "toml", "ron", "json", "sh", "yml"];

/// A file that people write.
#[derive(Clone, Debug)]
pub struct Text {
    /// Path relative to the root, with `/` between its parts.
    pub path: String,
    /// What it says.
    pub content: String,
}

impl Text {
    /// True for a Rust source.
    pub fn is_rust(&self) -> bool {
        self.path.ends_with(".rs")
    }
}

/// All texts below `root`, in the order of their paths.
pub fn texts(root: &Path) -> anyhow::Result<Vec<Text>> {
    let mut texts = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).with_context(|| format!("{}", folder.display()))?;
        for entry in entries {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_symlink() {
                continue; // What it leads to is read where it stands.
            }
            if path.is_dir() {
                if !BUILT.contains(&name.as_str())
                    && (!name.starts_with('.') || HIDDEN.contains(&name.as_str()))
                {
                    folders.push(path);
                }
            } else if is_text(&path, &name) {
                let content =
                    std::fs::read_to_string(&path).with_context(|| format!("{}", path.display()))?;
                texts.push(Text { path: relative(root, &path), content });
            }
        }
    }
    texts.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(texts)
}

fn is_text(path: &Path, name: &str) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    TEXTS.contains(&ending.as_ref()) || name == "run" || name.starts_with("LICENSE")
}

fn relative(root: &Path, path: &Path) -> String {
    let inside = path.strip_prefix(root).unwrap_or(path);
    inside.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}
