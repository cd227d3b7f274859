//! The trust of all pairs of a team, as a table, as JSON and as a picture.

use pictures::Picture;
use reports::distrust_map;
use serde_json::json;
use tables::{Format, shown_as};
use teaming::MadeMeasure;

use super::team::Team;
use crate::prelude::*;
use ron_tree::visible;

/// The most robots whose matrix is shown in a terminal; of more, each robot's extremes are.
const MOST_SHOWN: usize = 16;

/// Dots per inch of the picture as PNG: two pixels for each pixel of a screen.
const DPI: f64 = 192.0;

/// The distrust of each robot towards each other, by a trust measure.
pub(super) struct Matrix<'t> {
    team: &'t Team,
    measure: MadeMeasure,
    /// The ids of the robots as the file has them.
    names: Vec<String>,
    /// A row for each robot that trusts. Infinite for no trust at all.
    distrust: Vec<Vec<f64>>,
    /// The weight of each need as the measure used it; empty for a measure without weights.
    weights: Vec<f64>,
}

impl<'t> Matrix<'t> {
    /// Measures all pairs by the registry's measure.
    pub(super) fn of(team: &'t Team, registry: &Registry) -> Result<Self, Failure> {
        let measure =
            registry.a_measure().ok_or_else(|| Failure::input("this program has no trust measure"))?;
        let robots = team.robots();
        let trust = measure.it.of_team(&team.question).map_err(|error| team.failure(&error))?;
        let towards = |from: u32, to: u32| match trust.towards(&[from], &[to]) {
            Ok(distrust) if distrust.is_nan() => {
                Err(Failure::run(format!("{}: the distrust of {from} towards {to} is NaN", measure.label)))
            }
            found => found.map_err(|error| team.failure(&error)),
        };
        let row = |from: &u32| robots.iter().map(|to| towards(*from, *to)).collect();
        let distrust = robots.iter().map(row).collect::<Result<Vec<Vec<f64>>, Failure>>()?;
        let weights = trust.weights().to_vec();
        drop(trust);
        let names = robots.iter().map(|robot| team.name(*robot)).collect();
        Ok(Self { team, measure, names, distrust, weights })
    }

    /// The matrix as a picture.
    pub(super) fn drawn(&self) -> Picture {
        let names: Vec<String> = self.names.iter().map(|name| drawn_name(name)).collect();
        let is_infinite = self.distrust.iter().flatten().any(|value| value.is_infinite());
        let darkest = if is_infinite { "; darkest: infinite" } else { "" };
        let (name, unit) = (&self.measure.name, self.measure.it.unit());
        let title = format!("{name} in thousandths of {unit}, lower is more trust{darkest}");
        Picture::of_svg(distrust_map(&title, &names, &self.distrust), DPI)
    }

    pub(super) fn told(&self) -> Result<Report, Failure> {
        let (label, unit) = (&self.measure.label, self.measure.it.unit());
        let mut out = Report::from(format!("{label} in {unit}: lower is more trust"));
        if shown_as() == Format::Table && self.names.len() > MOST_SHOWN {
            out.show("distrust", self.extremes());
            out.say("all pairs: --format csv, --json, or --out matrix.svg");
        } else {
            out.show("distrust", self.table(shown));
        }
        out.say(format!("needs: {}", self.team.needs()));
        if shown_as() == Format::Json {
            out.show("trust", self.table(|distrust| valued(self.measure.it.trust(distrust), "")));
            let needs = self.team.question.needs.iter().zip(&self.weights);
            let needs: Vec<_> =
                needs.map(|(need, used)| json!({"need": need.name, "weight": used})).collect();
            out.rows("needs", &needs)?;
        }
        Ok(out)
    }

    /// All pairs, a row for each robot that trusts.
    fn table(&self, cell: impl Fn(f64) -> Entry) -> Table {
        let rows = self.names.iter().zip(&self.distrust);
        let row = |(name, row): (&String, &Vec<f64>)| labelled(name, row.iter().copied().map(&cell));
        Table::of(labelled("from \\ to", self.names.iter().map(right)), rows.map(row))
    }

    /// Of each robot, the other robots that it trusts most and least.
    fn extremes(&self) -> Table {
        let row = |(i, row): (usize, &Vec<f64>)| {
            let others = || (0..row.len()).filter(|other| *other != i);
            let most = others().min_by(|a, b| row[*a].total_cmp(&row[*b])).unwrap_or(i);
            let least = others().max_by(|a, b| row[*a].total_cmp(&row[*b])).unwrap_or(i);
            let cells = [most, least].map(|other| [Entry::from(&self.names[other]), shown(row[other])]);
            labelled(&self.names[i], cells.into_iter().flatten())
        };
        Table::of(["robot", "trusts most", "", "trusts least", ""], self.distrust.iter().enumerate().map(row))
    }
}

/// An id as it stands in the picture: of long ones the beginning.
fn drawn_name(name: &str) -> String {
    const MOST: usize = 24;
    let name = visible(name);
    if name.chars().count() <= MOST {
        return name.into_owned();
    }
    name.chars().take(MOST - 1).chain(['\u{2026}']).collect()
}

/// A value as an entry: in full for programs.
fn shown(distrust: f64) -> Entry {
    let text = if distrust.is_infinite() {
        "infinite".to_owned()
    } else if shown_as().is_for_programs() {
        distrust.to_string()
    } else {
        format!("{distrust:.6}")
    };
    valued(distrust, text)
}
