//! The figure of a study of sensitivity: a panel for each outcome, a row for each parameter.

use experiments::Failure;
use experiments::explore::{Index, Row};
use kuva::plot::ForestPlot;
use statistics::sensitivity::Known;

use crate::drawing::{Drawing, Panel, Sketch, forest_plot, interval_panel, range};

const OF_SHOWN: &str = "#0072B2";
const OF_OTHERS: &str = "#999999";

/// The indices of a study.
///
/// # Errors
/// None: tables are written to memory.
pub(crate) fn sensitivity(rows: &[Row]) -> Result<Sketch, Failure> {
    let mut panels = Vec::new();
    let mut outcomes: Vec<String> = rows.iter().map(|row| row.outcome.name()).collect();
    outcomes.dedup();
    for outcome in &outcomes {
        panels.extend(panel(outcome, rows.iter().filter(|row| row.outcome.name() == *outcome)));
    }
    let most = rows.len() / outcomes.len().max(1);
    let height = 110.0 + 34.0 * most as f64;
    Ok(Sketch {
        name: "indices".to_owned(),
        title: "What matters".to_owned(),
        caption: String::new(),
        drawing: Drawing::new(panels, 2, [520.0, height]),
        csv: csv(rows)?,
    })
}

fn panel<'a>(outcome: &str, rows: impl Iterator<Item = &'a Row>) -> Option<Panel> {
    let mut plot = forest_plot();
    let (mut ends, mut label) = (vec![0.0], "");
    for row in rows {
        let shown = if row.is_shown() && !row.is_chance() { OF_SHOWN } else { OF_OTHERS };
        let mut add = |name: String, Known { value, interval }: Known, colour: &str| {
            let [low, high] = interval.unwrap_or([value; 2]);
            plot = std::mem::replace(&mut plot, ForestPlot::new())
                .with_colored_row(name, value, low, high, colour);
            ends.extend([low, high]);
        };
        match row.index {
            Index::Effects { effects, .. } => {
                label = "mean size of the effect over the whole range (mu*)";
                add(row.parameter.clone(), effects.size, shown);
            }
            Index::Shares(shares) => {
                label = "share of the variance";
                add(format!("{}, alone", row.parameter), shares.first, shown);
                add(format!("{}, in all", row.parameter), shares.total, OF_OTHERS);
            }
            Index::Chance { first } => add(row.parameter.clone(), first, shown),
        }
    }
    if ends.len() < 2 {
        return None;
    }
    Some(interval_panel(plot, outcome, label, range(ends)))
}

const HEADER: &str = "who,metric,parameter,blocks,is_shown,mu_star,mu_star_low,mu_star_high,mu,mu_low,\
    mu_high,sigma,sigma_low,sigma_high,beyond_low,beyond_high";

const HEADER_OF_SHARES: &str =
    "who,metric,parameter,blocks,is_shown,first,first_low,first_high,total,total_low,total_high";

/// The table of the indices.
fn csv(rows: &[Row]) -> Result<String, Failure> {
    let is_of_effects = rows.iter().any(|row| matches!(row.index, Index::Effects { .. }));
    let header = if is_of_effects { HEADER } else { HEADER_OF_SHARES };
    let cells = |row: &Row| {
        let mut cells = vec![
            row.outcome.who.clone(),
            row.outcome.what.clone(),
            row.parameter.clone(),
            row.blocks.to_string(),
            row.is_shown().to_string(),
        ];
        let ends = |interval: Option<[f64; 2]>| {
            [0, 1].map(|end| interval.map_or(String::new(), |interval| interval[end].to_string()))
        };
        let mut add = |Known { value, interval }: Known| {
            cells.push(value.to_string());
            cells.extend(ends(interval));
        };
        match row.index {
            Index::Effects { effects, beyond } => {
                [effects.size, effects.mean, effects.spread].into_iter().for_each(&mut add);
                cells.extend(ends(beyond.and_then(|beyond| beyond.interval)));
            }
            Index::Shares(shares) => {
                [shares.first, shares.total].into_iter().for_each(&mut add);
            }
            Index::Chance { first } => add(first),
        }
        cells.resize(header.split(',').count(), String::new());
        cells
    };
    Ok(tables::csv(header.split(','), rows.iter().map(cells))?)
}
