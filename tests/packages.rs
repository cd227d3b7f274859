//! What makes the crates usable by strangers: ranges of versions where these hurt nobody, and what a registry
//! and a reader need to know.

use std::collections::BTreeSet;

use crate::support::root;

/// Dependencies that decide bits: any other version may change every number.
const EXACT: [&str; 5] = ["cmaes", "libm", "nalgebra", "parry2d", "rapier2d"];

/// Crates that are no libraries for others.
const OURS: [&str; 1] = ["xtask"];

fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn only_what_decides_bits_has_an_exact_version() {
    let workspace = text("Cargo.toml");
    let (_, dependencies) = workspace.split_once("[workspace.dependencies]").unwrap();
    let (dependencies, _) = dependencies.split_once("\n[").unwrap();
    let exact = dependencies.lines().filter(|line| line.contains("\"="));
    let exact: BTreeSet<&str> = exact.filter_map(|line| line.split(" = ").next()).collect();
    assert_eq!(exact, BTreeSet::from(EXACT));
    let page = text("docs/dependencies.md");
    for name in EXACT {
        assert!(page.contains(name), "docs/dependencies.md does not tell of {name}");
    }
}

#[test]
fn every_library_says_what_it_is() {
    for folder in std::fs::read_dir(root().join("crates")).unwrap() {
        let name = folder.unwrap().file_name().into_string().unwrap();
        assert!(!root().join(format!("crates/{name}/examples")).exists(), "{name}: tests are no examples");
        if OURS.contains(&name.as_str()) {
            continue;
        }
        let manifest = text(&format!("crates/{name}/Cargo.toml"));
        for field in ["description = ", "readme = ", "keywords = [", "categories = [", "license.workspace"] {
            assert!(manifest.contains(&format!("\n{field}")), "crates/{name}/Cargo.toml lacks {field}");
        }
        let keywords = manifest.split("\nkeywords = [").nth(1).unwrap().split(']').next().unwrap();
        assert!(keywords.split(',').count() <= 5, "{name}: a registry takes five keywords");
        assert!(text(&format!("crates/{name}/README.md")).starts_with(&format!("# {name}\n")));
    }
}

/// Names and versions of the packages of a lock file.
fn locked(path: &str) -> BTreeSet<[String; 2]> {
    let text = text(path);
    let packages = text.split("[[package]]").skip(1);
    let value = |package: &str, field: &str| {
        let line = package.lines().find_map(|line| line.strip_prefix(field)?.strip_prefix(" = "));
        line.unwrap_or_default().trim_matches('"').to_owned()
    };
    packages.map(|package| ["name", "version"].map(|field| value(package, field))).collect()
}

/// The page of the laboratory is built from the versions of the command: other ones would have other bits.
#[test]
fn the_page_has_the_versions_of_the_command() {
    let page = locked("lab/Cargo.lock");
    assert!(page.iter().any(|[name, _]| name == "rapier2d"));
    let others: Vec<_> = page.difference(&locked("Cargo.lock")).map(|[name, _]| name.clone()).collect();
    assert_eq!(others, ["usar-lab"]);
}

#[test]
fn only_the_door_of_the_page_is_unsafe() {
    for file in std::fs::read_dir(root().join("lab/src")).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        let is_unsafe = text(&format!("lab/src/{name}")).contains("unsafe(");
        assert_eq!(is_unsafe, name == "door.rs", "{name}");
    }
    assert!(text("lab/Cargo.toml").contains("unsafe_code = \"deny\""));
}

/// A sweep, its comparison and its report need no renderer and no format of other programs, and the first
/// build has none.
#[test]
fn the_first_build_leaves_out_what_the_first_result_does_not_need() {
    let tree = [
        "tree",
        "--locked",
        "--offline",
        "--package=usar",
        "--edges=normal",
        "--prefix=none",
        "--format={p}",
    ];
    let cargo = std::env::var("CARGO").unwrap_or("cargo".to_owned());
    let tree = std::process::Command::new(cargo).args(tree).current_dir(root()).output().unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8(tree.stdout).unwrap();
    let names: BTreeSet<&str> = tree.lines().filter_map(|line| line.split(' ').next()).collect();
    assert!(names.contains("usar-sim") && names.len() < 200, "{}", names.len());
    for name in ["usvg", "resvg", "svg2pdf", "gif", "parquet", "mcap", "foxglove"] {
        assert!(!names.contains(name), "{name}");
    }
}
