//! Makes `docs/scenarios-reference.md`, `docs/limits.md`, `docs/events.md` and `docs/columns.md`, and the
//! schemas of scenario and sweep files in `docs/schemas`.

use std::process::ExitCode;

use xtask::docs::place;
use xtask::{limits, reference, reference_pages};

pub fn run() -> ExitCode {
    let mut files = vec![(reference::path(), reference::page()), (limits::path(), limits::page())];
    files.extend(reference_pages::pages());
    files.extend(
        reference::schemas()
            .map(|(name, schema)| (place(&format!("docs/schemas/{name}.schema.json")), schema)),
    );
    for (path, text) in files {
        std::fs::write(&path, text).expect("the file can be written");
        println!("written: {}", path.display());
    }
    ExitCode::SUCCESS
}
