//! What is measured of a trial. A metric is one entry of [`METRICS`]: tables, comparisons, stopping rules and reports find it there.

use usar_sim::record::TrialRecord;

use crate::failure::Failure;

/// A quantity of a trial.
pub struct Metric {
    /// Name on the command line and in tables that programs read.
    pub name: &'static str,
    /// In words.
    pub title: &'static str,
    /// Unit; empty for a count.
    pub unit: &'static str,
    /// The report's figure of box plots that shows it beside others of the same figure; empty for none.
    pub figure: &'static str,
    /// Whether it is one of the paper's, which are shown unless others are asked for.
    pub is_papers: bool,
    /// Its value; `None` where it is undefined.
    pub value: fn(&TrialRecord) -> Option<f64>,
}

const POINTS: &str = "percent points per rescuee";

/// All metrics.
#[rustfmt::skip]
pub const METRICS: &[Metric] = &[
    papers("rescuees.total", "rescuees total", "", "rescuees", |r| Some(f64::from(r.rescued()))),
    papers("rescuees.hard", "rescuees hard", "", "rescuees", |r| Some(f64::from(r.hard.rescued))),
    papers("rescuees.easy", "rescuees easy", "", "rescuees", |r| Some(f64::from(r.easy.rescued))),
    papers("energy_per_rescuee.total", "energy per rescuee total", POINTS, "energy per rescuee", |r| ratio(r.energy(), r.rescued())),
    papers("energy_per_rescuee.hard", "energy per rescuee hard", POINTS, "energy per rescuee", |r| ratio(r.hard.energy, r.hard.rescued)),
    papers("energy_per_rescuee.easy", "energy per rescuee easy", POINTS, "energy per rescuee", |r| ratio(r.easy.energy, r.easy.rescued)),
    papers("hp_per_rescuee.total", "HP per rescuee total", POINTS, "HP per rescuee", |r| ratio(r.hp(), r.rescued())),
    papers("hp_per_rescuee.hard", "HP per rescuee hard", POINTS, "HP per rescuee", |r| ratio(r.hard.hp, r.hard.rescued)),
    papers("hp_per_rescuee.easy", "HP per rescuee easy", POINTS, "HP per rescuee", |r| ratio(r.easy.hp, r.easy.rescued)),
    papers("rounds", "rounds", "", "", |r| Some(f64::from(r.completed_rounds))),
    other("waiting", "time waited", "s", "waiting and deadlocks", |r| Some(r.waiting_s())),
    other("deadlocks", "deadlocks", "", "waiting and deadlocks", |r| Some(f64::from(r.deadlocks))),
    other("longest_stall", "longest stall", "s", "waiting and deadlocks", |r| Some(r.longest_stall_s())),
    other("conflicts", "conflicts", "", "", |r| Some(f64::from(r.conflicts))),
    other("errands_done", "errands done", "", "", |r| Some(f64::from(r.errands_done))),
    other("time", "time to the end", "s", "", |r| Some(r.time_s)),
    other("secured", "secured", "", "", |r| Some(f64::from(r.hard.secured + r.easy.secured))),
    other("energy.total", "energy spent", "percent points", "", |r| Some(r.energy())),
    other("hp.total", "HP lost", "percent points", "", |r| Some(r.hp())),
    other("turned_back", "times turned back", "", "", |r| Some(f64::from(r.turned_back))),
    other("stranded", "robots stranded", "", "", |r| Some(r.stranded() as f64)),
    other("disabled", "robots disabled", "", "", |r| Some(r.disabled() as f64)),
    other("distance", "distance travelled", "m", "", |r| Some(r.distance_m())),
];

type Value = fn(&TrialRecord) -> Option<f64>;

const fn papers(
    name: &'static str,
    title: &'static str,
    unit: &'static str,
    figure: &'static str,
    value: Value,
) -> Metric {
    Metric { name, title, unit, figure, is_papers: true, value }
}

const fn other(
    name: &'static str,
    title: &'static str,
    unit: &'static str,
    figure: &'static str,
    value: Value,
) -> Metric {
    Metric { name, title, unit, figure, is_papers: false, value }
}

fn ratio(cost: f64, rescuees: u32) -> Option<f64> {
    (rescuees > 0).then(|| cost / f64::from(rescuees))
}

/// The place of a metric in [`METRICS`].
///
/// # Errors
/// An unknown name, with the known ones.
pub fn metric_named(name: &str) -> Result<usize, Failure> {
    METRICS.iter().position(|metric| metric.name == name).ok_or_else(|| {
        let known: Vec<&str> = METRICS.iter().map(|metric| metric.name).collect();
        Failure::input(format!("unknown metric {name:?}; known metrics: {}", known.join(", ")))
    })
}

/// The places of the paper's metrics, or of those that were asked for by name; `all` for all.
///
/// # Errors
/// Those of [`metric_named`].
pub fn chosen(names: &[String]) -> Result<Vec<usize>, Failure> {
    if names.is_empty() {
        return Ok((0..METRICS.len()).filter(|place| METRICS[*place].is_papers).collect());
    }
    if names.iter().any(|name| name == "all") {
        return Ok((0..METRICS.len()).collect());
    }
    let mut places = Vec::new();
    for name in names {
        let place = metric_named(name)?;
        if !places.contains(&place) {
            places.push(place);
        }
    }
    Ok(places)
}

/// The figures of the report in their order, each with the places of its metrics.
#[must_use]
pub fn figures() -> Vec<(&'static str, Vec<usize>)> {
    let mut figures: Vec<(&str, Vec<usize>)> = Vec::new();
    for (place, metric) in METRICS.iter().enumerate().filter(|(_, metric)| !metric.figure.is_empty()) {
        match figures.iter_mut().find(|(name, _)| *name == metric.figure) {
            Some((_, places)) => places.push(place),
            None => figures.push((metric.figure, vec![place])),
        }
    }
    figures
}

/// Values of all metrics of a trial, in the order of [`METRICS`].
#[must_use]
pub fn measure(record: &TrialRecord) -> Vec<Option<f64>> {
    METRICS.iter().map(|metric| (metric.value)(record).filter(|value| value.is_finite())).collect()
}
