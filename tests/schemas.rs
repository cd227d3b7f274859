//! The JSON Schema of scenario files and the program agree: on shipped files, and on damaged ones.

use std::path::{Path, PathBuf};

use experiments::experiment::sweep_schema;
use jsonschema::Validator;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use ron_tree::{Node, Value as Ron};
use scenario::{Scenario, ScenarioError, scenario_schema};
use serde_json::{Map, Value, json};

use crate::support::root;

/// Damaged scenarios.
const MUTATIONS: u32 = 500;

/// Words of rules for one value: its type, its range, its form. Other rules compare values with one another,
/// and no schema has them.
const OF_ONE_VALUE: [&str; 9] = [
    "must be a number",
    "must be a count from",
    "must be a whole number",
    "must be text",
    "must be true or false",
    "must be a name of",
    "must be a word of",
    "must have at most",
    "unknown field",
];

/// With these begins a distribution.
const WORDS: [&str; 5] = ["Uniform", "Normal", "Clamped", "Truncated", "Choice"];

/// The files of folders of `scenarios/`, in order.
fn files(folders: &[&str]) -> Vec<PathBuf> {
    let folders = folders.iter().map(|folder| root().join("scenarios").join(folder));
    let entries = folders.flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "ron"));
    files.sort();
    files
}

fn shipped() -> Vec<PathBuf> {
    let mut files = files(&["", "tutorial", "gallery"]);
    files.retain(|file| !file.to_string_lossy().ends_with(".sweep.ron"));
    files
}

fn tree(file: &Path) -> Node {
    Node::parse(&std::fs::read_to_string(file).unwrap()).unwrap()
}

/// A text as JSON: structs as objects, lists and tuples as arrays, `Disc(0.5)` as `{"Disc": 0.5}`, and names
/// as the values that they stand for.
fn as_json(node: &Node, names: &[(Node, Node)]) -> Value {
    let inside = |node: &Node| as_json(node, names);
    let fields = |fields: &[(Node, Node)]| {
        let name = |node: &Node| node.as_word().or(node.as_text()).unwrap().to_owned();
        Value::Object(fields.iter().map(|(key, value)| (name(key), inside(value))).collect::<Map<_, _>>())
    };
    let array = |entries: &[Node]| Value::Array(entries.iter().map(inside).collect());
    match &node.value {
        Ron::Text(text) => json!(text),
        Ron::Word(word) => match names.iter().find(|(name, _)| name.as_word() == Some(word)) {
            Some((_, value)) => as_json(value, &[]),
            None if &**word == "None" => Value::Null,
            None => serde_json::from_str(word.trim_start_matches('+')).unwrap_or_else(|_| json!(word)),
        },
        Ron::List(entries) => array(entries),
        Ron::Map(of) => fields(of),
        Ron::Struct(name, of) if name.is_empty() => fields(of),
        Ron::Struct(name, of) => json!({&**name: fields(of)}),
        Ron::Tuple(name, entries) => match (&**name, &entries[..]) {
            ("", []) => json!({}),
            ("", _) => array(entries),
            ("Some", [inner]) => inside(inner),
            (name, [inner]) => json!({name: inside(inner)}),
            (name, _) => json!({name: array(entries)}),
        },
    }
}

fn faults(schema: &Validator, root: &Node) -> Vec<String> {
    let names = root.get("values").map(|values| values.fields().to_vec()).unwrap_or_default();
    let json = as_json(root, &names);
    schema.iter_errors(&json).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

fn validator() -> Validator {
    jsonschema::validator_for(&scenario_schema()).unwrap()
}

#[test]
fn every_shipped_sweep_passes_the_schema() {
    let schema = jsonschema::validator_for(&sweep_schema()).unwrap();
    let files = files(&["", "tutorial", "gallery", "sweeps"]);
    let sweeps = files.iter().filter(|file| tree(file).get("arena_m").or(tree(file).get("base")).is_none());
    let sweeps: Vec<&PathBuf> = sweeps.collect();
    assert!(sweeps.len() > 5, "{sweeps:?}");
    for file in sweeps {
        assert_eq!(faults(&schema, &tree(file)), Vec::<String>::new(), "{}", file.display());
    }
}

#[test]
fn every_shipped_scenario_passes_the_schema() {
    let schema = validator();
    for file in shipped() {
        assert_eq!(faults(&schema, &tree(&file)), Vec::<String>::new(), "{}", file.display());
    }
}

/// Puts something wrong, or something else, into a field. Returns what, and whether it stands in a
/// distribution: what a distribution may draw, no schema knows.
fn damage(root: &mut Node, draws: &mut ChaCha8Rng) -> (String, bool) {
    let leaves: Vec<String> = root.leaves().into_iter().map(|(path, _)| path).collect();
    let path = &leaves[draws.random_range(0..leaves.len() as u32) as usize];
    let choice = draws.random_range(0..9_u32);
    let above = path.rfind('.').map_or("", |end| &path[..end]);
    if choice == 8 {
        let node = if above.is_empty() { root } else { root.get_mut(above).unwrap() };
        if let Ron::Struct(_, fields) = &mut node.value {
            fields.push((Node::word("surplus"), Node::word("1")));
        }
        return (format!("{above}: a surplus field"), false);
    }
    let node = root.get_mut(path).unwrap();
    let is_text = node.as_text().is_some();
    let number = node.as_word().and_then(|word| word.parse::<f64>().ok());
    let new = match (choice, number) {
        (0, Some(number)) => Node::word(format!("{}", -1.0 - number.abs())),
        (1, Some(number)) => Node::word(format!("{}", number * 1e3)),
        (2, Some(_)) => Node::word("1e12"),
        (3, Some(number)) => Node::word(format!("{}", number * 1.001)),
        (4, Some(_)) => Node::word("inf"),
        (0, None) => Ron::Text("x".repeat(65).into()).into(),
        (1, None) => Ron::Text("Of two words".into()).into(),
        (2 | 3, None) if !is_text => Node::word("Nothing"),
        (2..=4, None) => Node::word("-3.5"),
        (5, _) => Node::word("true"),
        (6, _) => Ron::Text("text".into()).into(),
        (_, _) => Ron::List(vec![Node::word("1"), Node::word("2"), Node::word("3")]).into(),
    };
    let says = format!("{path}: {node} becomes {new}");
    node.value = new.value;
    let ends = path.char_indices().filter(|(_, letter)| "[.".contains(*letter)).map(|(at, _)| at);
    let mut above = ends.filter_map(|end| root.get(&path[..end]));
    let is_drawn = above.any(|node| matches!(&node.value, Ron::Tuple(name, _) if WORDS.contains(&&**name)));
    (says, is_drawn)
}

#[test]
fn the_schema_and_the_program_agree_on_damaged_scenarios() {
    let (schema, files) = (validator(), shipped());
    let (mut refused, mut both) = (0, 0);
    for number in 0..MUTATIONS {
        let mut draws = ChaCha8Rng::seed_from_u64(u64::from(number));
        let file = &files[draws.random_range(0..files.len() as u32) as usize];
        let mut root = tree(file);
        let (damage, is_drawn) = damage(&mut root, &mut draws);
        let says = format!("{}: {damage}", file.display());
        let (faults, problems) = (faults(&schema, &root), problems(&root, file));
        assert!(faults.is_empty() || !problems.is_empty(), "only the schema refuses {says}: {faults:?}");
        let of_one = problems.iter().any(|rule| OF_ONE_VALUE.iter().any(|words| rule.starts_with(words)));
        let is_missed = of_one && !is_drawn && faults.is_empty();
        assert!(!is_missed, "only the program refuses {says}: {problems:?}");
        refused += u32::from(!problems.is_empty());
        both += u32::from(!faults.is_empty());
    }
    assert!(refused > 300 && both > 250, "{refused} refused, {both} of them by the schema");
}

/// The rules that the program says a scenario breaks.
fn problems(root: &Node, file: &Path) -> Vec<String> {
    match Scenario::parse(&root.to_string(), file) {
        Ok(_) => Vec::new(),
        Err(ScenarioError::Invalid(problems)) => problems.list.into_iter().map(|one| one.rule).collect(),
        Err(error) => vec![error.to_string()],
    }
}
