//! What a reader of a comparison must know of its trials.

use store::Failure;

use crate::rounds::odd_sizes;
use crate::sweep::folder::Folder;

/// What a reader must know of the trials, in a sentence each: policies whose groups have other sizes than
/// the question says, and why trials have no numbers.
///
/// # Errors
/// The journal cannot be read.
pub fn doubts(folder: &mut Folder) -> Result<Vec<String>, Failure> {
    let mut doubts: Vec<String> = odd_sizes(folder)?.iter().map(ToString::to_string).collect();
    for (policy, spec) in folder.experiment().policies.iter().enumerate() {
        let trials = || folder.results().iter().filter(|((_, of, _), _)| *of == policy);
        let failures: Vec<&str> = trials().filter_map(|(_, trial)| trial.failure.as_deref()).collect();
        let (count, of) = (failures.len(), trials().count());
        doubts.extend(failures.first().map(|first| {
            format!("{}: {count} of {of} trials have no numbers; the first: {first}", spec.label)
        }));
    }
    Ok(doubts)
}
