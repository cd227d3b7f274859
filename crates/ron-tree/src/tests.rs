//! Tests of trees as a whole: paths, reading, writing, setting.

use serde::{Deserialize, Serialize};

use crate::{Node, Problem, Value, value_of};

fn tree(text: &str) -> Node {
    Node::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

const TEXT: &str = r##"// a comment with name: 1
(
    name: "a (tricky, \" one)", /* other: [ /* nested */ */
    raw: r#"x: (" "#,
    list: [
        (at: (1.0, 2.0), shape: Disc(0.5)),
        Named(at: (1.0,
            3.0), extra: Some((mass: 2.0))),
    ],
    last: -1e3,
    map: {"a.b": [1, 2]},
)
"##;

#[test]
fn fields_are_found_where_they_stand() {
    let root = tree(TEXT);
    for (path, line, value) in [
        ("name", 3, r#""a (tricky, \" one)""#),
        ("raw", 4, r##"r#"x: (" "#"##),
        ("list[0].at", 6, "(1.0, 2.0)"),
        ("list[0].at[1]", 6, "2.0"),
        ("list[0].shape", 6, "Disc(0.5)"),
        ("list[1].at[1]", 8, "3.0"),
        ("list[1].extra.mass", 8, "2.0"),
        ("last", 10, "-1e3"),
        ("map.\"a.b\"[1]", 11, "2"),
    ] {
        assert_eq!(root.line(path), Some(line), "{path}");
        assert_eq!(&TEXT[root.get(path).unwrap().bytes()], value, "{path}");
    }
    for (path, line) in
        [("list[1].rotation", Some(7)), ("map.\"a.b\"[7].deep", Some(11)), ("absent.deep", None), ("", None)]
    {
        assert_eq!(root.line(path), line, "{path}");
    }
    assert_eq!(root.names(), ["name", "raw", "list", "last", "map"]);
    assert_eq!(root.get("list[1]").unwrap().names(), ["at", "extra"]);
    let leaves: Vec<String> = root.leaves().into_iter().map(|(path, _)| path).collect();
    assert_eq!(leaves[..5], ["name", "raw", "list[0].at[0]", "list[0].at[1]", "list[0].shape[0]"]);
    assert_eq!(leaves[7..], ["list[1].extra.mass", "last", "map.\"a.b\"[0]", "map.\"a.b\"[1]"]);
}

const NAMED: &str = r#"(
    tasks: [
        (name: "steep", grid: (4, 5), steps: [
            (cost: 1, name: "go"),
            (cost: 2, name: "lift"),
        ]),
        Some((grid: (6, 7), name: "flat")),
        Task(name: "steep", grid: (8, 9)),
        (name: "a.b", grid: (0, 0)),
        (name: Some("roof"), grid: (1, 1)), (name: "grid[0]"),
        (name: ""), (name: "q\"q"), (name: 3), 1,
    ],
    site: (name: "hall", size: 3),
    pair: ((name: "left", x: 1), (name: "right", x: 2)),
)"#;

#[test]
fn entries_are_found_by_their_names() {
    let root = tree(NAMED);
    for (path, canonical, line, value) in [
        ("tasks.steep.grid[0]", "tasks[0].grid[0]", 3, "4"),
        ("tasks.flat.grid[1]", "tasks[1].grid[1]", 7, "7"),
        ("tasks.steep.steps.lift.cost", "tasks[0].steps[1].cost", 5, "2"),
        ("tasks[0].steps.go.cost", "tasks[0].steps[0].cost", 4, "1"),
        ("tasks[2].grid[0]", "tasks[2].grid[0]", 8, "8"),
        ("tasks.roof.grid[1]", "tasks[4].grid[1]", 10, "1"),
        ("pair.right.x", "pair[1].x", 14, "2"),
    ] {
        assert_eq!(root.canonical(path), canonical);
        assert_eq!(root.line(path), Some(line), "{path}");
        assert_eq!(root.get(path).unwrap().to_string(), value, "{path}");
    }
    assert_eq!(root.line("tasks.steep.steps.lift.weight"), Some(5));
    for absent in [
        "tasks.a.b",
        "tasks.",
        "tasks.q\"q",
        "tasks.3",
        "tasks.grid[0]",
        "site.hall",
        "steep",
        "tasks..steep",
        ".tasks",
        "tasks.steep.",
        "tasks[steep]",
        "tasks.steep.go",
        "tasks[10]",
    ] {
        assert!(root.get(absent).is_none(), "{absent}");
    }
    let list = tree(r#"[(name: "a", x: 1), (name: "b", x: 2)]"#);
    assert_eq!(list.canonical("b.x"), "[1].x");
    assert_eq!(root.canonical("tasks.flat.size.x"), "tasks[1].size.x");
}

#[test]
fn what_is_there_instead_is_told() {
    let root = tree(
        r#"(
        tasks: [(name: "steep", grid: (1, 2), steps: [(name: "go")]), (name: "flat"), (name: "steep")],
        debris: [1, 2], one: [1], none: [], speed: 3,
    )"#,
    );
    for (path, says) in [
        ("tasks.medium", "tasks has steep, flat (or [0] to [2])"),
        ("tasks.stepe.grid[0]", "did you mean steep? tasks has steep, flat (or [0] to [2])"),
        ("tasks[3]", "tasks has steep, flat (or [0] to [2])"),
        ("tasks.steep.steps.fly", "tasks.steep.steps has go (or [0])"),
        ("tasks.steep.size", "tasks.steep has name, grid, steps"),
        ("tasks.steep.grid[2]", "tasks.steep.grid has 2 entries, from [0] on"),
        ("debris.large", "debris has 2 entries, from [0] on"),
        ("one[1]", "one has 1 entry, [0]"),
        ("none.any", "none has no entries"),
        ("speed.x", "the file has tasks, debris, one, none, speed"),
        ("sped", "did you mean speed? the file has tasks, debris, one, none, speed"),
    ] {
        assert_eq!(root.unknown(path, "the file").to_string(), format!("{path} is no field; {says}"));
    }
    assert_eq!(tree("3").unknown("a", "the number").to_string(), "a is no field; the number has no fields");
    let entries: Vec<String> = (0..22).map(|i| format!("(name: \"n{i}\")")).collect();
    let hint = tree(&format!("[{}]", entries.join(", "))).unknown("x", "the list").hint;
    assert!(hint.starts_with("the list has n0, n1, n2, "), "{hint}");
    assert!(hint.ends_with(", n19 and 2 more (or [0] to [21])"), "{hint}");
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Mission {
    duration_s: f64,
    arena_m: [f64; 2],
    order: Order,
    levels: Option<Levels>,
    tasks: Vec<Task>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Levels {
    energy: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Order {
    Near,
    Ring(f64, f64),
    Held(Rule),
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Rule {
    margin_m: f64,
    steps: u32,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Task {
    name: String,
    grid: [u32; 2],
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_last: bool,
}

fn mission() -> Mission {
    let task = |name: &str, grid| Task { name: name.to_owned(), grid, is_last: false };
    Mission {
        duration_s: 60.0,
        arena_m: [20.0, 0.1],
        order: Order::Near,
        levels: None,
        tasks: vec![task("steep", [3, 4]), task("flat", [1, 1]), task("a \"b\"\n", [7, 8])],
    }
}

fn with(value: &Mission, path: &str, new: &str) -> Result<Mission, Box<Problem>> {
    let mut tree = Node::of(value)?;
    tree.set(path, value_of(path, new)?, "a mission")?;
    tree.read_as()
}

#[test]
fn one_field_is_set_and_no_other() {
    let mut found = mission();
    for (path, new) in [
        ("duration_s", " 90 "),
        ("arena_m[1]", "30"),
        ("order", "Ring(3, 1)"),
        ("levels", "(energy: 50)"),
        ("levels.energy", "55"),
        ("tasks[1].grid[1]", "2"),
        ("tasks.steep.grid[0]", "9"),
        ("tasks.flat.is_last", "true"),
        ("tasks.flat.name", "\"light\""),
    ] {
        found = with(&found, path, new).unwrap();
    }
    let mut expected = mission();
    expected.duration_s = 90.0;
    expected.arena_m[1] = 30.0;
    expected.order = Order::Ring(3.0, 1.0);
    expected.levels = Some(Levels { energy: 55.0 });
    expected.tasks[0].grid[0] = 9;
    expected.tasks[1] = Task { name: "light".to_owned(), grid: [1, 2], is_last: true };
    assert_eq!(found, expected);
}

#[test]
fn what_cannot_be_set_is_named() {
    for (path, new, says) in [
        ("duration", "1", "duration is no field; did you mean duration_s? There are duration_s, arena_m, or"),
        ("arena_m[2]", "1", "arena_m[2] is no field; arena_m has 2 entries, from [0] on"),
        ("tasks.medium", "1", "tasks.medium is no field; tasks has steep, flat (or [0] to [2])"),
        ("tasks.steep.price", "1", "tasks[0].price is no field; there are name, grid, is_last"),
        ("duration_s", "\"long\"", "duration_s must be a number, found \"long\""),
        ("tasks.steep.is_last", "3", "tasks[0].is_last must be true or false, found 3"),
        ("order", "Far", "order must be one of Near, Ring, Held, found Far"),
    ] {
        let error = with(&mission(), path, new).unwrap_err().to_string();
        assert!(error.starts_with(says), "{path}: {error}");
    }
    for new in ["1, dt_s: 1", "1) //", "1 /* ", "", "(1", "a: 1", "1 // one"] {
        let error = with(&mission(), "duration_s", new).unwrap_err().to_string();
        assert!(error.starts_with("duration_s must be one value in RON"), "{new}: {error}");
    }
}

#[test]
fn a_value_is_read_as_it_was_written() {
    let mut mission = mission();
    mission.levels = Some(Levels { energy: 1e-7 });
    for order in [Order::Near, Order::Ring(1.0, -0.5), Order::Held(Rule { margin_m: 0.25, steps: 9 })] {
        mission.order = order;
        let tree = Node::of(&mission).unwrap();
        for text in [tree.to_string(), tree.pretty()] {
            assert_eq!(self::tree(&text), tree, "{text}");
            assert_eq!(self::tree(&text).read_as::<Mission>().unwrap(), mission);
        }
    }
    let whole = "(duration_s: 60.0, arena_m: (20.0, 0.1), order: Near, levels: None, tasks: [(name: \
        \"steep\", grid: (3, 4))])";
    mission.tasks.truncate(1);
    (mission.order, mission.levels) = (Order::Near, None);
    assert_eq!(Node::of(&mission).unwrap().to_string(), whole);
}

#[test]
fn a_variant_with_a_struct_has_its_fields_in_its_own_brackets_or_none() {
    let rule = |margin_m, steps| Order::Held(Rule { margin_m, steps });
    for (text, order) in [
        ("Held", rule(0.0, 0)),
        ("Held()", rule(0.0, 0)),
        ("Held ( steps : 3 )", rule(0.0, 3)),
        ("Held((margin_m: 0.5))", rule(0.5, 0)),
    ] {
        assert_eq!(tree(text).read_as::<Order>().unwrap(), order, "{text}");
    }
    let refused = |text: &str| tree(text).read_as::<Order>().unwrap_err().to_string();
    assert_eq!(
        refused("Held(margin: 0.3)"),
        "margin is no field; did you mean margin_m? There are margin_m, steps"
    );
    assert_eq!(refused("Near(1)"), "the file must be Near without brackets, found Near(1)");
    assert_eq!(refused("Near()"), "the file must be Near without brackets, found Near()");
    assert_eq!(refused("Ring(1)"), "the file must have 2 entries, found Ring(1)");
}

#[test]
fn a_node_can_be_a_part_of_a_type() {
    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Axis {
        values: Vec<Node>,
    }
    let text = r#"(values: [1.50, "a", Disc(r: 2), {"k": [None]}])"#;
    let axis: Axis = tree(text).read_as().unwrap();
    assert_eq!(axis.values[0], Node::word("1.50"));
    assert_eq!(axis.values[1].value, Value::Text("a".into()));
    assert_eq!(Node::of(&axis).unwrap(), tree(text));
    assert_eq!(Node::of(&axis).unwrap().to_string(), text);
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "only reading is tested")]
struct Row {
    count: u32,
    kind: Option<Kind>,
    #[serde(default)]
    place: [f64; 2],
    #[serde(default)]
    name: String,
    #[serde(default)]
    list: Vec<bool>,
    #[serde(default)]
    by_name: std::collections::BTreeMap<String, i8>,
}

#[derive(Debug, Deserialize)]
#[expect(dead_code, reason = "only reading is tested")]
enum Kind {
    Ground,
    Disc(f64),
    Box(f64, f64),
}

#[test]
fn each_value_that_does_not_fit_is_told_in_words_of_the_file() {
    for (text, told) in [
        ("(count: 3.5)", "count must be a whole number, found 3.5"),
        ("(count: -3)", "count must be a whole number of at least 0, found -3"),
        ("(count: 99999999999)", "count must be a smaller whole number, found 99999999999"),
        ("(count: six)", "count must be a whole number, found six"),
        ("(count: (1))", "count must be a whole number, found (1)"),
        (
            "(coutn: 3, count: 1)",
            "coutn is no field; did you mean count? There are count, kind, place, name, list, by_name",
        ),
        ("(colour: 3, count: 1)", "colour is no field; there are count, kind, place, name, list, by_name"),
        ("(place: (1, 2))", "count must be given"),
        (
            "(count: 1, kind: Disk(2))",
            "kind must be one of Ground, Disc, Box, found Disk; did you mean Disc?",
        ),
        ("(count: 1, kind: \"Ground\")", "kind must be a name without quotes, found \"Ground\""),
        ("(count: 1, kind: Disc(0x10))", "kind[0] must be a decimal number, found 0x10"),
        ("(count: 1, kind: Disc(a))", "kind[0] must be a number, found a"),
        ("(count: 1, kind: Disc)", "kind must have 1 entry, found Disc"),
        ("(count: 1, kind: Box(1, (2)))", "kind[1] must be a number, found (2)"),
        ("(count: 1, place: (1))", "place must have 2 entries, found (1)"),
        ("(count: 1, place: (1, 2, 3))", "place must have 2 entries, found (1, 2, 3)"),
        ("(count: 1, place: 3)", "place must be in round brackets: (...), found 3"),
        ("(count: 1, place: [3, 4])", "place must be in round brackets: (...), found [3, 4]"),
        ("(count: 1, name: x)", "name must be a text in double quotes, found x"),
        ("(count: 1, list: 1)", "list must be a list in square brackets: [...], found 1"),
        ("(count: 1, list: [1])", "list[0] must be true or false, found 1"),
        (
            "(count: 1, by_name: (a: 1))",
            "by_name must be a map in curly brackets: {\"name\": ...}, found (a: 1)",
        ),
        ("(count: 1, by_name: {\"a\": 200})", "by_name.\"a\" must be a smaller whole number, found 200"),
        ("[1]", "the file must be in round brackets: (...), found [1]"),
        ("Line(count: 1)", "the file must be in round brackets: (...), found Line(count: 1)"),
    ] {
        let (value, problems) = tree(text).read_all::<Row>();
        let told: Vec<&str> = told.split('|').collect();
        assert!(value.is_none() || !problems.is_empty());
        assert_eq!(problems.iter().map(ToString::to_string).collect::<Vec<_>>(), told, "{text}");
    }
}

#[test]
fn all_values_that_do_not_fit_are_told_with_their_lines() {
    let text = "(\n count: 1.5,\n place: (1,\n x),\n name: 3, nmae: \"a\",\n list: [true, 1, 2],\n)";
    let (value, problems) = tree(text).read_all::<Row>();
    assert!(value.is_none());
    let told: Vec<(String, usize)> =
        problems.into_iter().map(|problem| (problem.field, problem.line.unwrap())).collect();
    let told: Vec<(&str, usize)> = told.iter().map(|(field, line)| (field.as_str(), *line)).collect();
    assert_eq!(told, [("count", 2), ("place[1]", 4), ("name", 5), ("nmae", 5), ("list[1]", 6)]);
    let (value, problems) = tree("(count: 1, place: (1, x), name: 3)").read_all::<Row>();
    assert_eq!((value.unwrap().place, problems.len()), ([0.0, 0.0], 2));
}
