//! The messages of panics that threads catch.

use std::cell::RefCell;
use std::panic::PanicHookInfo;

thread_local! {
    /// Where this thread panicked last.
    static PLACE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Notes where a panic was, for [`panic_message`]. A program makes it its panic hook, so that a panic prints
/// nothing.
pub fn note_panic(panic: &PanicHookInfo<'_>) {
    let place = panic.location().map(|place| format!("{}:{}", from_sources(place.file()), place.line()));
    PLACE.set(place);
}

/// The path of a source file, shortened for a library to begin with the library's name.
fn from_sources(path: &str) -> &str {
    let Some((_, rest)) = path.split_once("registry/src/") else { return path };
    rest.split_once('/').map_or(rest, |(_, rest)| rest)
}

/// The message of a panic that this thread caught, with file and line if [`note_panic`] is the
/// panic hook.
pub fn panic_message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a defect without a message");
    let place = PLACE.take().map_or(String::new(), |place| format!(" ({place})"));
    format!("{text}{place}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_of_libraries_are_named_without_the_machines_folders() {
        let path = "/home/x/.cargo/registry/src/registry-1/parry2d-0.31.1/src/lib.rs";
        assert_eq!(from_sources(path), "parry2d-0.31.1/src/lib.rs");
        assert_eq!(from_sources("crates/usar/src/lib.rs"), "crates/usar/src/lib.rs");
    }
}
