//! The report of a sweep: the page of its case, or an overview and a page for each of its cases.

use std::path::PathBuf;

use experiments::Failure;
use experiments::comparison::{compare, doubts, own_question};
use experiments::sweep::folder::Folder;
use experiments::sweep::names::{PLOTS, REPORT};
use experiments::sweep::owned::Report;

use crate::case::{CasePage, Compared, write_case};
use crate::overview::write_overview;
use crate::wanted::Wanted;

/// Largest number of cases that get a page, if no case is selected.
const MOST_PAGES: usize = 24;

/// Writes the report of a sweep into its folder; returns its path. A sweep with several cases gets an
/// overview, and a page for each case beside the figures.
///
/// # Errors
/// An unknown policy, the folder cannot be written to, or its journal cannot be read.
pub fn write_report(folder: &mut Folder, mut wanted: Wanted) -> Result<PathBuf, Failure> {
    let is_compared = folder.experiment().policies.len() > 1;
    let compared = |metrics: &[usize]| {
        if is_compared { compare(folder, metrics, wanted.asked.choice()) } else { Ok(Vec::new()) }
    };
    let (asked, exploratory) = (compared(&wanted.asked.metrics)?, compared(&wanted.asked.exploratory)?);
    let own = own_question(folder, &wanted.asked, &asked)?;
    let warnings = own.into_iter().chain(doubts(folder)?).collect();
    let all = Compared { asked, exploratory, warnings };
    let cases = folder.experiment().cases.len();
    let shown = std::mem::take(&mut wanted.shown);
    let mut files = Report::of(folder.path());
    if cases == 1 {
        let (file, links) = (REPORT.to_owned(), format!("{PLOTS}/"));
        let page = CasePage { case: 0, file, links, prefix: String::new(), shown };
        write_case(folder, &wanted, &all, page, &mut files)?;
    } else {
        let chosen: Vec<usize> = wanted.case.map_or((0..cases.min(MOST_PAGES)).collect(), |case| vec![case]);
        let mut shown = Some(shown);
        for case in &chosen {
            let prefix = format!("case-{}-", case + 1);
            let file = format!("{PLOTS}/case-{}.html", case + 1);
            let shown = shown.take().unwrap_or_default();
            let page = CasePage { case: *case, file, links: prefix.clone(), prefix, shown };
            write_case(folder, &wanted, &all, page, &mut files)?;
        }
        write_overview(folder, &wanted, &all, &chosen, &mut files)?;
    }
    files.write()?;
    Ok(folder.path().join(REPORT))
}
