//! Tests of the catalogue.

use scenario::Words;

use super::Catalogue;

fn catalogue(tasks: &[&str]) -> Catalogue {
    Catalogue::with(&tasks.iter().map(|task| (*task).to_owned()).collect::<Vec<_>>(), &Words::default())
}

#[test]
fn a_metric_that_is_told_by_task_has_a_total_and_one_for_each_task() {
    let metrics = catalogue(&["north", "south", "tunnel"]);
    let names = |declared: &str| {
        let places = metrics.declared(declared).into_iter();
        places.map(|place| metrics[place].name.as_str()).collect::<Vec<_>>()
    };
    assert_eq!(names("rescuees"), ["rescuees.total", "rescuees.north", "rescuees.south", "rescuees.tunnel"]);
    assert_eq!(names("energy"), ["energy.total", "energy.north", "energy.south", "energy.tunnel"]);
    assert_eq!(names("rounds"), ["rounds"]);
    let parts: Vec<&str> = metrics.declared("hp").into_iter().map(|place| metrics[place].part()).collect();
    assert_eq!(parts, ["total", "north", "south", "tunnel"]);
}

#[test]
fn a_column_has_the_unit_of_times_and_lengths() {
    let metrics = catalogue(&["north"]);
    let column = |name: &str| metrics[metrics.named(name).unwrap()].column();
    assert_eq!(column("time"), "time_s");
    assert_eq!(column("longest_stall"), "longest_stall_s");
    assert_eq!(column("distance"), "distance_m");
    assert_eq!(column("rescuees.north"), "rescuees_north");
    assert_eq!(column("energy.ungrouped"), "energy_ungrouped");
    let mut columns: Vec<String> = metrics.iter().map(super::Metric::column).collect();
    columns.sort();
    columns.dedup();
    assert_eq!(columns.len(), metrics.len(), "each has its own");
}

#[test]
fn primary_metrics_are_shown_unless_others_are_asked_for() {
    let metrics = catalogue(&["north"]);
    let names = |asked: &[&str]| {
        let asked: Vec<String> = asked.iter().map(|name| (*name).to_owned()).collect();
        let places = metrics.chosen(&asked).map_err(|error| error.to_string())?;
        Ok::<_, String>(places.into_iter().map(|place| metrics[place].name.as_str()).collect::<Vec<_>>())
    };
    let primary = [
        "rescuees.total",
        "rescuees.north",
        "energy_per_rescuee.total",
        "energy_per_rescuee.north",
        "hp_per_rescuee.total",
        "hp_per_rescuee.north",
        "rounds",
    ];
    assert_eq!(names(&[]).unwrap(), primary);
    assert_eq!(names(&["secured", "waiting", "waiting"]).unwrap(), ["secured.total", "waiting"]);
    assert_eq!(names(&["all"]).unwrap().len(), metrics.len());
    assert!(names(&["luck"]).unwrap_err().contains("unknown metric \"luck\"; known metrics: rescuees.total"));
}
