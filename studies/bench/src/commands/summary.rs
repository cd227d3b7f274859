//! The gaps of methods, as a table.

use std::time::Duration;

use statistics::Moments;
use statistics::bootstrap::quantile;

use usar::prelude::*;

/// Makespans whose ratio differs by less from 1 are equal.
const TIE: f64 = 1e-9;

/// A problem by all methods.
pub(super) struct Solved {
    pub(super) problem: String,
    pub(super) optimum: Option<f64>,
    pub(super) methods: Vec<Method>,
}

/// What a method makes of a problem.
pub(super) struct Method {
    pub(super) label: String,
    pub(super) makespan: f64,
    /// Decisions that were asked for; 0 for a method that plans.
    pub(super) decisions: u32,
    /// The time that they took.
    pub(super) time: Duration,
}

impl Solved {
    /// How much longer a schedule takes than the shortest one that is known, in percent of that.
    fn gap(&self, method: &Method) -> f64 {
        let found = self.methods.iter().map(|method| method.makespan).fold(f64::INFINITY, f64::min);
        let least = self.optimum.unwrap_or(found);
        let gap = if least > 0.0 { method.makespan / least - 1.0 } else { 0.0 };
        if gap < TIE { 0.0 } else { 100.0 * gap }
    }
}

/// A method over all problems.
struct Row {
    method: String,
    /// Gaps in percent.
    mean: Option<f64>,
    median: f64,
    percentile_95: f64,
    worst: f64,
    /// Of the problems that were solved exactly, the share with no gap, in percent.
    optimal: Option<f64>,
    /// Absent for a method that is not asked.
    ms_per_decision: Option<f64>,
}

impl Row {
    fn of(solved: &[Solved], at: usize) -> Self {
        let methods = || solved.iter().map(|solved| (solved, &solved.methods[at]));
        let mut gaps: Vec<f64> = methods().map(|(solved, method)| solved.gap(method)).collect();
        gaps.sort_by(f64::total_cmp);
        let exact: Vec<f64> =
            methods().filter(|(of, _)| of.optimum.is_some()).map(|(of, method)| of.gap(method)).collect();
        let hits = exact.iter().filter(|gap| **gap == 0.0).count();
        let decisions: u32 = methods().map(|(_, method)| method.decisions).sum();
        let time: Duration = methods().map(|(_, method)| method.time).sum();
        Self {
            method: solved[0].methods[at].label.clone(),
            mean: Moments::of(&gaps).mean,
            median: quantile(&gaps, 0.5),
            percentile_95: quantile(&gaps, 0.95),
            worst: quantile(&gaps, 1.0),
            optimal: (!exact.is_empty()).then(|| 100.0 * hits as f64 / exact.len() as f64),
            ms_per_decision: (decisions > 0).then(|| 1e3 * time.as_secs_f64() / f64::from(decisions)),
        }
    }
}

/// The table.
pub(super) fn told(solved: &[Solved]) -> Report {
    let exact = solved.iter().filter(|solved| solved.optimum.is_some()).count();
    let rows: Vec<Row> = (0..solved[0].methods.len()).map(|at| Row::of(solved, at)).collect();
    let count = counted(solved.len(), "problem");
    let first = format!("{count}, {exact} of them solved exactly; gap to the least makespan in percent");
    let header = ["method", "mean", "median", "95th percentile", "worst", "optimal (%)", "ms a decision"];
    let row = |row: &Row| {
        let gaps = [row.mean, Some(row.median), Some(row.percentile_95), Some(row.worst), row.optimal];
        let gaps = gaps.map(|gap| right_or_dash(gap, |gap| format!("{gap:.1}")));
        let time = right_or_dash(row.ms_per_decision, |time| format!("{time:.4}"));
        labelled(&row.method, gaps.into_iter().chain([time]))
    };
    let mut out = Report::from(first);
    out.show("methods", Table::of(header, rows.iter().map(row)));
    out
}

/// All makespans as CSV: a row for each problem and method.
pub(super) fn csv(solved: &[Solved]) -> Result<String, Failure> {
    let of_method = |solved: &Solved, method: &Method| {
        let optimum = solved.optimum.map_or(String::new(), |optimum| optimum.to_string());
        let [makespan, gap] = [method.makespan, solved.gap(method)].map(|value| value.to_string());
        vec![solved.problem.clone(), optimum, method.label.clone(), makespan, gap]
    };
    let rows = solved.iter().flat_map(|one| one.methods.iter().map(move |method| of_method(one, method)));
    Ok(tables::csv(["problem", "optimum", "method", "makespan", "gap_percent"], rows)?)
}
