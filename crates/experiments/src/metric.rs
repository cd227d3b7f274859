//! Metrics: the quantities measured in a trial. Each metric is declared once, in `DECLARATIONS`. An
//! experiment has a [`Catalogue`] of them, including one for each of its tasks. `trials.csv`, comparisons,
//! stopping rules, reports and calibrations look metrics up there.

mod belief;
mod joins;
mod values;

use std::ops::Deref;

use scenario::{Scenario, Words};
use statistics::comparison::Direction;
use store::Failure;
use usar_sim::metrics::TaskTotals;
use usar_sim::record::TrialRecord;

pub use values::Values;

/// Name of the metric of all tasks together, in the place of a task's name.
pub const TOTAL: &str = "total";

type Value = fn(&TrialRecord) -> Option<f64>;
type TaskValue = fn(&TaskTotals) -> Option<f64>;

/// How a metric is computed.
#[derive(Clone, Copy)]
enum Scope {
    /// From the whole trial.
    Whole(Value),
    /// For all tasks together, and for each task.
    PerTask { total: Value, task: TaskValue },
}

/// A metric, independent of the scenario's tasks.
#[derive(Clone, Copy)]
struct Declaration {
    name: &'static str,
    meaning: &'static str,
    unit: &'static str,
    figure: &'static str,
    is_primary: bool,
    direction: Direction,
    /// For a cost per rescuee, the metric of the cost.
    cost: Option<&'static str>,
    is_censored: bool,
    scope: Scope,
}

const POINTS: &str = "points";
const RATIO: &str = "points per rescuee";

/// All metrics.
#[rustfmt::skip]
const DECLARATIONS: &[Declaration] = &[
    per_task("rescuees", "", |r| Some(f64::from(r.rescued())), |t| Some(f64::from(t.rescued)))
        .primary().in_figure("rescuees").higher().means("Rescuees delivered home or to a rest place."),
    per_task("energy_per_rescuee", RATIO, |r| ratio(r.energy(), r.rescued()), |t| ratio(t.energy, t.rescued))
        .primary().of_sums("energy").in_figure("energy per rescuee").lower()
        .means("Energy spent, divided by the rescuees delivered; empty where nobody was rescued. The total \
            includes what robots spent outside groups."),
    per_task("hp_per_rescuee", RATIO, |r| ratio(r.hp(), r.rescued()), |t| ratio(t.hp, t.rescued))
        .primary().of_sums("hp").in_figure("HP per rescuee").lower()
        .means("HP lost, divided by the rescuees delivered; empty where nobody was rescued. The total \
            includes what robots lost outside groups."),
    whole("rounds", "", |r| Some(f64::from(r.completed_rounds))).primary().higher()
        .means("Rounds that ended: everybody was home again for whom the team waits."),
    whole("waiting", "s", |r| Some(r.waiting_s())).in_figure("waiting and deadlocks").lower()
        .means("Time in which robots stood because of other robots, summed over all robots."),
    whole("deadlocks", "", |r| Some(f64::from(r.counts.deadlocks))).in_figure("waiting and deadlocks").lower()
        .means("Conflict sets in which nobody moved for as long as the rule of right of way allows."),
    whole("longest_stall", "s", |r| Some(r.longest_stall_s())).in_figure("waiting and deadlocks").lower()
        .means("The longest time in which one robot with a goal came no nearer to it, over all robots."),
    whole("stalled", "", |r| Some(f64::from(r.stalled))).lower()
        .means("Robots that stood at the end: they could act, had something to do, and had come no nearer to \
            it for `mission.cut_off_s`, or were cut off."),
    whole("conflicts", "", |r| Some(f64::from(r.counts.conflicts)))
        .means("Conflict sets that began: robots whose wishes would have brought them too near to one \
            another."),
    whole("rotations", "", |r| Some(f64::from(r.counts.rotations)))
        .means("Times the head of a conflict set lost its turn to the next."),
    whole("retreats", "", |r| Some(f64::from(r.counts.retreats)))
        .means("Times a robot made room for another."),
    whole("back_offs", "", |r| Some(f64::from(r.counts.back_offs)))
        .means("Times a conflict set backed off sideways."),
    whole("unreachable", "", |r| Some(f64::from(r.counts.unreachable))).lower()
        .means("Times a robot gave up on a rescuee or a place because no way leads there."),
    whole("errands_done", "", |r| Some(f64::from(r.counts.errands_done))).higher()
        .means("Places of errands that were reached."),
    whole("time", "s", |r| Some(r.time_s)).means("Simulated time when the trial was over."),
    per_task("secured", "", |r| Some(f64::from(r.secured())), |t| Some(f64::from(t.secured))).higher()
        .means("Rescuees that were taken on board."),
    per_task("energy", POINTS, |r| Some(r.energy()), |t| Some(t.energy))
        .means("Energy spent by all robots; of a task, by its groups."),
    whole("energy.ungrouped", POINTS, |r| Some(r.ungrouped_energy))
        .means("Energy spent by robots that were in no group: on their way to rest, and during rounds that \
            went on without them."),
    per_task("hp", POINTS, |r| Some(r.hp()), |t| Some(t.hp))
        .means("HP lost by all robots; of a task, by its groups."),
    whole("hp.ungrouped", POINTS, |r| Some(r.ungrouped_hp)).means("HP lost by robots that were in no group."),
    whole("turned_back", "", |r| Some(f64::from(r.counts.turned_back)))
        .means("Times a robot left for its rest place."),
    whole("stranded", "", |r| Some(r.stranded() as f64)).lower().means("Robots that ended with no energy."),
    whole("disabled", "", |r| Some(r.disabled() as f64)).lower().means("Robots that ended with no HP."),
    whole("distance", "m", |r| Some(r.distance_m())).means("Way travelled, summed over all robots."),
    whole("time_to_last", "s", |r| r.delivered_s.last().copied())
        .means("Time of the last delivery; empty where nobody was rescued."),
    whole("time_to_half", "s", |r| r.time_to_share_s(0.5)).censored().lower()
        .means("Time by which half of all people had been delivered; empty where they never were. Then it is \
            censored: there is no mean over the trials."),
    whole("time_to_90", "s", |r| r.time_to_share_s(0.9)).censored().lower()
        .means("The same of nine tenths of all people."),
];

/// The metrics of trials in which the base goes by reports.
#[rustfmt::skip]
const OF_REPORTS: &[Declaration] = &[
    whole("reports_heard", "", belief::reports_heard).means("Reports of levels that the base heard."),
    whole("liars", "", belief::liars).means("Robots that told a lie, sooner or later."),
    whole("level_mae", "%", belief::level_mae).lower()
        .means("How far energy and health as they were believed are from the truth, on average over members \
            and decisions: by the estimator of the policy, or else as said last."),
    whole("level_crps", "%", belief::level_crps).lower()
        .means("The continuous ranked probability score of the same levels, with their standard deviations."),
    whole("tau_b", "", belief::rank_agreement).higher()
        .means("Kendall's rank correlation (tau-b) of believed and true levels of the members, on average \
            over levels and decisions."),
    whole("trust_auc", "", belief::trust_auc).higher()
        .means("How often an honest robot has more trust than a liar, ties by half; empty without an \
            estimator, liars or honest robots."),
    whole("doubles", "", |r| Some(f64::from(r.finds.doubles))).lower()
        .means("Times a robot came for a rescuee that another had taken or was loading."),
    whole("ghosts_visited", "", |r| Some(f64::from(r.finds.ghosts_visited))).lower()
        .means("Times a robot came for a rescuee where nobody ever was."),
    whole("trust_brier", "", belief::trust_brier).lower().means("The Brier score of trust as the probability \
        that a robot is honest; empty without an estimator."),
    whole("trust_log", "nats", belief::trust_log).lower().means("The logarithmic score of the same."),
    whole("trust_ece", "", belief::trust_ece).lower()
        .means("The expected calibration error of the same, in ten bins."),
    whole("rounds_to_detect", "", belief::rounds_to_detect).lower()
        .means("Rounds from the first in which a robot lies until its trust falls below 0.5, on average over \
            liars. One that is never detected counts with all of these: the mean is censored there."),
    whole("false_exclusions", "", belief::false_exclusions).lower()
        .means("How often an honest robot was left at home by a policy with an estimator."),
];

/// Metrics of trials in which robots decide.
#[rustfmt::skip]
const OF_JOINS: &[Declaration] = &[
    whole("agreement", "", joins::agreement).higher()
        .means("The share of pairs of robots that saw each robot in the same group, on average."),
    whole("sizes_missed", "", joins::sizes_missed).lower()
        .means("Robots above the number that the base would have sent to their task, on average."),
    whole("belief_age", "s", joins::belief_age).lower()
        .means("How old what robots had last heard of each other was when they decided, on average."),
    whole("never_heard", "", joins::never_heard).lower()
        .means("The share of other robots of which a robot had never heard when it decided, on average."),
    whole("time_to_agree", "s", joins::time_to_agree).lower()
        .means("Time until all robots had decided, on average over decisions with agreement on all groups."),
    whole("decided_late", "", joins::decided_late).lower()
        .means("The share of robots that had not decided when the time of a negotiation was over."),
    whole("messages", "", joins::messages).means("Messages over the medium, for each hearer one."),
    whole("messages_lost", "", joins::messages_lost).means("Those that were not heard until the end."),
];

const fn whole(name: &'static str, unit: &'static str, value: Value) -> Declaration {
    Declaration {
        name,
        meaning: "",
        unit,
        figure: "",
        is_primary: false,
        direction: Direction::Neither,
        cost: None,
        is_censored: false,
        scope: Scope::Whole(value),
    }
}

const fn per_task(name: &'static str, unit: &'static str, total: Value, task: TaskValue) -> Declaration {
    Declaration { scope: Scope::PerTask { total, task }, ..whole(name, unit, total) }
}

impl Declaration {
    const fn primary(self) -> Self {
        Self { is_primary: true, ..self }
    }

    const fn means(self, meaning: &'static str) -> Self {
        Self { meaning, ..self }
    }

    const fn of_sums(self, cost: &'static str) -> Self {
        Self { cost: Some(cost), ..self }
    }

    const fn censored(self) -> Self {
        Self { is_censored: true, ..self }
    }

    const fn higher(self) -> Self {
        Self { direction: Direction::Higher, ..self }
    }

    const fn lower(self) -> Self {
        Self { direction: Direction::Lower, ..self }
    }

    const fn in_figure(self, figure: &'static str) -> Self {
        Self { figure, ..self }
    }

    /// The metrics of this declaration: one of all tasks together and one of each task, or one of the whole
    /// trial.
    fn metrics(self, tasks: &[String], words: &Words) -> Vec<Metric> {
        match self.scope {
            Scope::Whole(value) => vec![self.metric(None, Source::Trial(value), words)],
            Scope::PerTask { total, task } => {
                let each = tasks.iter().map(|name| self.metric(Some(name), Source::Task(task), words));
                std::iter::once(self.metric(Some(TOTAL), Source::Trial(total), words)).chain(each).collect()
            }
        }
    }

    fn metric(self, part: Option<&str>, source: Source, words: &Words) -> Metric {
        let Self { name, meaning, unit, figure, is_primary, direction, cost, is_censored, .. } = self;
        let named = |name: &str| part.map_or(name.to_owned(), |part| format!("{name}.{part}"));
        Metric {
            name: named(&words.metric(name)),
            standard: named(name),
            meaning,
            unit,
            unit_in_words: words.text(unit),
            figure: words.text(figure),
            is_primary,
            direction,
            declared: name,
            cost,
            is_censored,
            part: part.unwrap_or_default().to_owned(),
            source,
        }
    }
}

fn ratio(cost: f64, rescuees: u32) -> Option<f64> {
    (rescuees > 0).then(|| cost / f64::from(rescuees))
}

/// The names of a scenario's tasks, in the order of their table.
pub fn task_names(scenario: &Scenario) -> Vec<String> {
    scenario.tasks.iter().map(|task| task.name.clone()).collect()
}

/// Where a value comes from.
#[derive(Debug, Clone, Copy)]
enum Source {
    /// The trial.
    Trial(Value),
    /// The task that the metric names.
    Task(TaskValue),
}

/// A quantity of a trial.
#[derive(Debug, Clone)]
pub struct Metric {
    /// Name, the same on the command line, in tables, sentences and figures.
    pub name: String,
    /// Meaning, in a sentence or two.
    pub meaning: &'static str,
    /// Unit; empty for a count.
    pub unit: &'static str,
    /// The unit in the words of the scenario.
    pub unit_in_words: String,
    /// The report's figure of box plots that shows it beside others of the same figure; empty for none.
    pub figure: String,
    /// Whether it is shown by default.
    pub is_primary: bool,
    /// Which direction is better.
    pub direction: Direction,
    declared: &'static str,
    /// Its name in the standard words.
    standard: String,
    cost: Option<&'static str>,
    /// Whether a trial without a value has one that is larger than all that can be seen.
    pub is_censored: bool,
    part: String,
    source: Source,
}

impl Metric {
    /// The name of its column in `trials.csv`, in the standard words whatever those of the scenario; it ends
    /// with the unit of a time or a length.
    pub fn column(&self) -> String {
        let column = self.standard.replace('.', "_");
        let unit = match self.unit {
            "s" => "_s",
            "m" => "_m",
            _ => "",
        };
        if column.ends_with(unit) { column } else { column + unit }
    }

    /// The name of its column without the task, for a table that has the task in a column of its own.
    pub fn declared_column(&self) -> String {
        let whole = self.column();
        let part = format!("_{}", self.part);
        if self.part.is_empty() { whole } else { whole.replacen(&part, "", 1) }
    }

    /// Whether a name without a task means the metrics of its declaration, in either words.
    fn is_declared_as(&self, name: &str) -> bool {
        self.declared == name
            || self.name.strip_suffix(&self.part).is_some_and(|stem| stem.strip_suffix('.') == Some(name))
    }

    /// Its name with its unit, if it has one.
    pub fn name_with_unit(&self) -> String {
        if self.unit.is_empty() {
            self.name.clone()
        } else {
            format!("{} ({})", self.name, self.unit_in_words)
        }
    }

    /// Its value; `None` where it is undefined.
    pub fn value(&self, record: &TrialRecord) -> Option<f64> {
        let value = match self.source {
            Source::Trial(value) => value(record),
            Source::Task(value) => value(record.task(&self.part)?),
        };
        value.filter(|value| value.is_finite())
    }

    /// The task of the metric, or [`TOTAL`]; empty for a metric without tasks.
    pub fn part(&self) -> &str {
        &self.part
    }

    /// Whether it is the metric of all tasks together.
    pub fn is_total(&self) -> bool {
        self.part == TOTAL
    }
}

/// The metrics of an experiment, in the order of tables.
#[derive(Debug, Clone)]
pub struct Catalogue {
    metrics: Vec<Metric>,
}

/// A catalogue is read as the list of its metrics.
impl Deref for Catalogue {
    type Target = [Metric];

    fn deref(&self) -> &[Metric] {
        &self.metrics
    }
}

impl Catalogue {
    /// All metrics of a scenario: of its tasks, in its words; those of reports where the base goes by
    /// reports, or robots see rescuees with errors; those of joins where robots decide.
    pub fn of(scenario: &Scenario) -> Self {
        Self::of_cases(scenario, &[scenario])
    }

    /// The same for a sweep over a scenario with these cases.
    pub(crate) fn of_cases(base: &Scenario, cases: &[&Scenario]) -> Self {
        let mut all = Self::with(&task_names(base), &base.words);
        let mut more = |them: &[Declaration]| {
            all.metrics.extend(them.iter().flat_map(|of| of.metrics(&[], &base.words)));
        };
        if cases.iter().any(|case| case.goes_by_reports() || case.has_sight_errors()) {
            more(OF_REPORTS);
        }
        if cases.iter().any(|case| !case.mission.decides.is_base()) {
            more(OF_JOINS);
        }
        all
    }

    /// All metrics but those of reports, for tasks of these names, in these words.
    pub(crate) fn with(tasks: &[String], words: &Words) -> Self {
        let of = |declaration: &Declaration| declaration.metrics(tasks, words);
        Self { metrics: DECLARATIONS.iter().flat_map(of).collect() }
    }

    /// The place of a metric. The name of a metric with tasks means the total.
    ///
    /// # Errors
    /// An unknown name, with the known ones.
    pub fn named(&self, name: &str) -> Result<usize, Failure> {
        let is_named = |metric: &Metric| {
            metric.name == name
                || metric.standard == name
                || (metric.is_total() && metric.is_declared_as(name))
        };
        self.iter().position(is_named).ok_or_else(|| {
            let known: Vec<&str> = self.iter().map(|metric| metric.name.as_str()).collect();
            let names = known.iter().copied().chain(self.iter().map(|metric| metric.declared));
            let meant = ron_tree::nearest(name, names)
                .map_or(String::new(), |meant| format!("; did you mean {meant}?"));
            Failure::input(format!("unknown metric {name:?}; known metrics: {}{meant}", known.join(", ")))
        })
    }

    /// The places of the cost and of the rescuees whose ratio the metric is; `None` for other metrics.
    pub fn sums(&self, place: usize) -> Option<[usize; 2]> {
        let Metric { cost, part, .. } = &self[place];
        let of = |declared: &str| {
            self.iter().position(|metric| metric.declared == declared && metric.part == *part)
        };
        Some([of((*cost)?)?, of("rescuees")?])
    }

    /// The metrics declared under one name: the total, then one for each task; or the only one.
    pub fn declared(&self, name: &str) -> Vec<usize> {
        (0..self.len()).filter(|place| self[*place].declared == name).collect()
    }

    /// The places of the metrics with these names. Without names, the primary metrics; with `all`, all
    /// metrics.
    ///
    /// # Errors
    /// Those of [`Catalogue::named`].
    pub fn chosen(&self, names: &[String]) -> Result<Vec<usize>, Failure> {
        if names.is_empty() {
            return Ok((0..self.len()).filter(|place| self[*place].is_primary).collect());
        }
        if names.iter().any(|name| name == "all") {
            return Ok((0..self.len()).collect());
        }
        let mut places = Vec::new();
        for name in names {
            let place = self.named(name)?;
            if !places.contains(&place) {
                places.push(place);
            }
        }
        Ok(places)
    }

    /// The figures of the report in their order, each with the places of its metrics.
    pub fn figures(&self) -> Vec<(&str, Vec<usize>)> {
        let mut figures: Vec<(&str, Vec<usize>)> = Vec::new();
        for (place, metric) in self.iter().enumerate().filter(|(_, metric)| !metric.figure.is_empty()) {
            match figures.iter_mut().find(|(name, _)| *name == metric.figure) {
                Some((_, places)) => places.push(place),
                None => figures.push((&metric.figure, vec![place])),
            }
        }
        figures
    }

    /// The values of all metrics of a trial, in their order.
    pub fn measure(&self, record: &TrialRecord) -> Vec<Option<f64>> {
        self.iter().map(|metric| metric.value(record)).collect()
    }
}

#[cfg(test)]
mod tests;
