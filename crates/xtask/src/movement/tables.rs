//! The tables and figures of what was measured, beside the literature.

use reports::{Labels, Series, chart};
use statistics::bootstrap::quantile;

use super::literature::{Peer, Power, Published, Quantity, weidmann};
use super::square::Outcome;
use super::{AtDoor, DEPTHS_M, InSquare, Measured, ROBOTS};

/// Width of the classes of density, in robots a square metre, and the fewest samples of one.
const CLASS_PER_M2: f64 = 0.5;
const FEWEST: usize = 20;

/// A table in Markdown.
pub(super) struct Table {
    pub title: &'static str,
    pub rows: String,
}

/// A figure and the name of its file.
pub(super) struct Figure {
    pub name: &'static str,
    pub svg: String,
}

/// Robots in corridors at densities of a class.
struct Class {
    samples: usize,
    per_m2: f64,
    speed_mps: f64,
    /// Share of the robots that stand.
    standing: f64,
    /// The mean of the published speeds in the class.
    published_mps: Option<f64>,
}

/// The tables of crowds.
pub(super) fn crowds(measured: &Measured, published: &[Published]) -> Vec<Table> {
    vec![
        Table { title: "flow", rows: flow(&measured.doors, published) },
        Table { title: "speed", rows: speed(measured, published) },
        Table { title: "corridors", rows: corridors(measured) },
    ]
}

/// Both figures.
pub(super) fn figures(measured: &Measured, published: &[Published]) -> Vec<Figure> {
    let flow = Labels { title: "Flow through a door", x: "width, m", y: "people or robots a second" };
    let speed = Labels { title: "Speed in a corridor", x: "people or robots a square metre", y: "m/s" };
    vec![
        Figure { name: "flow.svg", svg: chart(flow, &flow_series(&measured.doors, published)) },
        Figure { name: "density.svg", svg: chart(speed, &speed_series(measured, published)) },
    ]
}

fn table(header: &str, rows: impl Iterator<Item = String>) -> String {
    let columns = header.matches('|').count() - 1;
    let mut text = format!("{header}\n|{}\n", " --- |".repeat(columns));
    rows.for_each(|row| text.extend([row.as_str(), "\n"]));
    text
}

fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.into_iter().collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.2}"))
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// The flows of the seeds in which nobody gave up.
fn flows(door: &AtDoor) -> impl Iterator<Item = f64> + '_ {
    door.passages.iter().filter(|passage| !passage.jammed).filter_map(|passage| passage.flow_per_s)
}

fn flow(doors: &[AtDoor], published: &[Published]) -> String {
    let (shallow, deep) = doors.split_at(doors.len() / DEPTHS_M.len());
    let ours = |door: &AtDoor| {
        let (low, high) =
            flows(door).fold((f64::INFINITY, 0.0_f64), |(a, b), flow| (a.min(flow), b.max(flow)));
        let jammed = door.passages.iter().filter(|passage| passage.jammed).count();
        let all = door.passages.len();
        let flow =
            mean(flows(door)).map_or("-".to_owned(), |mean| format!("{mean:.2} ({low:.2} to {high:.2})"));
        format!("{flow} | {jammed} of {all}")
    };
    let of_people = |width: f64| {
        let there = published.iter().filter(|one| is_flow_at(one, width));
        let told = there.map(|one| format!("{:.2} ({})", one.y * one.x, one.series));
        let told: Vec<String> = told.collect();
        if told.is_empty() { "-".to_owned() } else { told.join(", ") }
    };
    let row = |(a, b): (&AtDoor, &AtDoor)| {
        let a_metre = or_dash(mean(flows(a)).map(|flow| flow / a.width_m));
        format!("| {} | {} | {} | {a_metre} | {} |", a.width_m, of_people(a.width_m), ours(a), ours(b))
    };
    let header = format!(
        "| width, m | people a second | robots a second, {} m deep | jams \
         | a metre wide | {} m deep | jams |",
        DEPTHS_M[0], DEPTHS_M[1]
    );
    table(&header, shallow.iter().zip(deep).map(row))
}

fn is_flow_at(one: &Published, width_m: f64) -> bool {
    one.quantity == Quantity::SpecificFlow && (one.x - width_m).abs() < 1e-9
}

fn flow_series(doors: &[AtDoor], published: &[Published]) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    for door in doors {
        let name = format!("robots, {} m deep", door.depth_m);
        flows(door).for_each(|flow| add(&mut series, &name, [door.width_m, flow]));
    }
    // People last, so that they are drawn above the robots.
    for one in published.iter().filter(|one| one.quantity == Quantity::SpecificFlow) {
        add(&mut series, &one.series, [one.x, one.y * one.x]);
    }
    series
}

/// Adds a point to the series of this name.
fn add(series: &mut Vec<Series>, name: &str, point: [f64; 2]) {
    match series.iter_mut().find(|one| one.name == name) {
        Some(one) => one.points.push(point),
        None => series.push(Series { name: name.to_owned(), points: vec![point], is_line: false }),
    }
}

fn classes(measured: &Measured, published: &[Published]) -> Vec<Class> {
    let passages = measured.corridors.iter().flat_map(|corridor| &corridor.passages);
    let samples: Vec<_> = passages.flat_map(|passage| &passage.samples).collect();
    let class_of = |per_m2: f64| (per_m2 / CLASS_PER_M2) as usize;
    let last = samples.iter().map(|sample| class_of(sample.per_m2)).max().unwrap_or(0);
    let class = |class: usize| {
        let here = || samples.iter().filter(move |sample| class_of(sample.per_m2) == class);
        let people =
            published.iter().filter(|one| one.quantity == Quantity::Speed && class_of(one.x) == class);
        Some(Class {
            samples: here().count(),
            per_m2: mean(here().map(|sample| sample.per_m2))?,
            speed_mps: mean(here().map(|sample| sample.speed_mps))?,
            standing: mean(here().map(|sample| sample.standing))?,
            published_mps: mean(people.map(|one| one.y)),
        })
    };
    (0..=last).filter_map(class).filter(|class| class.samples >= FEWEST).collect()
}

fn speed(measured: &Measured, published: &[Published]) -> String {
    let row = |class: Class| {
        format!(
            "| {:.2} | {} | {:.2} | {} | {:.2} | {} |",
            class.per_m2,
            class.samples,
            class.speed_mps,
            percent(class.standing),
            weidmann(class.per_m2),
            or_dash(class.published_mps)
        )
    };
    table(
        "| robots a m² | samples | m/s | of these stand | Weidmann, m/s | people in corridors, m/s |",
        classes(measured, published).into_iter().map(row),
    )
}

fn speed_series(measured: &Measured, published: &[Published]) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    for one in published.iter().filter(|one| one.quantity == Quantity::Speed) {
        add(&mut series, &one.series, [one.x, one.y]);
    }
    for class in classes(measured, published) {
        add(&mut series, "robots", [class.per_m2, class.speed_mps]);
    }
    let points = (2..=54).map(|tenth| [f64::from(tenth) / 10.0, weidmann(f64::from(tenth) / 10.0)]).collect();
    series.push(Series { name: "Weidmann 1993".to_owned(), points, is_line: true });
    series
}

fn corridors(measured: &Measured) -> String {
    let row = |corridor: &super::InCorridor| {
        let samples = || corridor.passages.iter().flat_map(|passage| &passage.samples);
        let through: usize = corridor.passages.iter().map(|passage| passage.through).sum();
        let jammed = corridor.passages.iter().filter(|passage| passage.jammed).count();
        format!(
            "| {} | {} | {} | {} | {} | {through} of {} | {jammed} of {} |",
            corridor.ends_m[0],
            corridor.ends_m[1],
            or_dash(mean(samples().map(|sample| sample.per_m2))),
            or_dash(mean(samples().map(|sample| sample.speed_mps))),
            mean(samples().map(|sample| sample.standing)).map_or("-".to_owned(), percent),
            ROBOTS as usize * corridor.passages.len(),
            corridor.passages.len(),
        )
    };
    table(
        "| entrance, m | exit, m | robots a m² | m/s | of these stand | half way | jams |",
        measured.corridors.iter().map(row),
    )
}

/// The cases of the square, beside those of other methods: a column for each.
pub(super) fn square(squares: &[InSquare], peers: &[Peer]) -> Table {
    let mut methods: Vec<&str> = peers.iter().map(|peer| peer.method.as_str()).collect();
    methods.dedup();
    let row = |square: &InSquare| {
        let of = |method: &&str| {
            let peer = peers.iter().find(|peer| peer.agents == square.agents && peer.method == **method);
            peer.map_or("-".to_owned(), told)
        };
        let others: Vec<String> = methods.iter().map(of).collect();
        format!("| {} | {} | {} |", square.agents, told(&ours(square)), others.join(" | "))
    };
    let header = format!("| agents | default rule | {} |", methods.join(" | "));
    Table { title: "square", rows: table(&header, squares.iter().map(row)) }
}

/// The cases of the default rule, as those of any method.
fn ours(square: &InSquare) -> Peer {
    let count =
        |is: fn(&Outcome) -> bool| square.outcomes.iter().filter(|outcome| is(outcome)).count() as u32;
    let good = || square.outcomes.iter().filter(|outcome| !outcome.collided && !outcome.stuck);
    let mut extra: Vec<f64> = good().map(|outcome| outcome.extra_s).collect();
    extra.sort_by(f64::total_cmp);
    let at = |share| if extra.is_empty() { f64::NAN } else { quantile(&extra, share) };
    Peer {
        method: String::new(),
        agents: square.agents,
        cases: square.outcomes.len() as u32,
        touched: count(|outcome| outcome.collided),
        stuck: count(|outcome| outcome.stuck),
        extra_s: mean(extra.iter().copied()).unwrap_or(f64::NAN),
        p75_s: at(0.75),
        p90_s: at(0.9),
        alone_s: mean(good().map(|outcome| outcome.extra_alone_s)).unwrap_or(f64::NAN),
    }
}

fn told(peer: &Peer) -> String {
    let share = |count: u32| percent(f64::from(count) / f64::from(peer.cases));
    format!(
        "{:.2} ({:.2}, {:.2}); alone {:.2}; {} touch, {} stuck",
        peer.extra_s,
        peer.p75_s,
        peer.p90_s,
        peer.alone_s,
        share(peer.touched),
        share(peer.stuck)
    )
}

/// Measured powers as costs.
pub(super) fn energy(powers: &[Power]) -> Table {
    let row = |power: &Power| {
        let standing = powers.iter().find(|one| one.robot == power.robot && one.speed_mps == 0.0);
        let per_metre = standing.and_then(|standing| power.per_metre(standing));
        format!(
            "| {} | {} | {} | {} | {:.5} | {} | {:.1} |",
            power.robot,
            power.state,
            power.watts,
            power.battery_wh,
            power.per_second(),
            per_metre.map_or("-".to_owned(), |percent| format!("{percent:.5}")),
            power.battery_wh / power.watts
        )
    };
    let header = "| robot | | W | battery, Wh | as `per_second` alone | driving as `per_metre` | lasts, h |";
    Table { title: "energy", rows: table(header, powers.iter().map(row)) }
}
