//! Makes `docs/scenarios-reference.md` of the types' comments, and the schemas of scenario and sweep files in
//! `docs/schemas`.

use std::process::ExitCode;

use xtask::reference;

pub fn run() -> ExitCode {
    std::fs::write(reference::path(), reference::page()).expect("the page can be written");
    println!("written: {}", reference::path().display());
    for (name, schema) in reference::schemas() {
        let path = reference::path().with_file_name("schemas").join(format!("{name}.schema.json"));
        std::fs::write(&path, schema).expect("the schema can be written");
        println!("written: {}", path.display());
    }
    ExitCode::SUCCESS
}
