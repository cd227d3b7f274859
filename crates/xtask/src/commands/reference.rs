//! Makes `docs/scenarios-reference.md`, `docs/events.md` and `docs/columns.md`, and the schemas of scenario
//! and sweep files in `docs/schemas`.

use std::process::ExitCode;

use xtask::{reference, reference_pages};

pub fn run() -> ExitCode {
    std::fs::write(reference::path(), reference::page()).expect("the page can be written");
    println!("written: {}", reference::path().display());
    for (path, page) in reference_pages::pages() {
        std::fs::write(&path, page).expect("the page can be written");
        println!("written: {}", path.display());
    }
    for (name, schema) in reference::schemas() {
        let path = reference::path().with_file_name("schemas").join(format!("{name}.schema.json"));
        std::fs::write(&path, schema).expect("the schema can be written");
        println!("written: {}", path.display());
    }
    ExitCode::SUCCESS
}
