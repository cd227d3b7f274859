//! Programs that say what robots do in their turns.

use std::sync::Arc;

use teaming::protocol::{Act, Choice, Say, Told, Turn};
use teaming::{Asked, Question, Session};

use crate::support::{registry_until, small};

/// A program by protocol 2; its function `act` is to come.
const PROGRAM: &str = r#"
import json, sys
kept = {}
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        answer = {"type": "hello", "protocol": 2, "schema_version": 3, "name": "talks"}
    elif message["type"] == "turns":
        answer = {"type": "acts", "id": message["id"], "acts": [act(turn) for turn in message["turns"]]}
    else:
        break
    print(json.dumps(answer), flush=True)
"#;

/// A session of a program with this body of `act`, and its folder.
fn talks(body: &str, more: &str) -> (tempfile::TempDir, Box<dyn Session>) {
    let folder = tempfile::tempdir().unwrap();
    let program = format!("def act(turn):\n{body}\n{PROGRAM}");
    let path = folder.path().join("talks.py");
    std::fs::write(&path, program).unwrap();
    let text = format!("ENG by EXEC(command: [\"python3\", \"{}\"]{more})", path.display());
    let session = registry_until(&Arc::default()).parse(&text).unwrap().open().unwrap();
    (folder, session)
}

/// A turn of each robot of a question, which was told something by robot 0.
fn turns(question: &Question) -> Vec<Turn> {
    let turn = |robot: u32| Turn {
        robot,
        since_s: 0.5,
        told: vec![Told { from: 0, what: serde_json::json!({"x": 0.1}), age_s: 0.2 }],
        state: serde_json::json!([robot]),
        rule: None,
        question: Question { asker: Some(robot), ..question.clone() },
        late: None,
    };
    question.members.iter().map(|member| turn(member.id)).collect()
}

fn acts(session: &mut dyn Session, turns: &[Turn]) -> Result<Vec<Act>, String> {
    session.act(turns, &Asked::of(&small())).map_err(|error| error.to_string())
}

const PURE: &str = r"
    says = [{'what': turn['told'][0]['what']}, {'to': 0, 'what': turn['robot']}]
    state = turn['state'] + [turn['since_s']]
    return {'says': says, 'state': state, 'wake_in_s': 0.25, 'joins': turn['robot'] % 2}";

#[test]
fn a_program_says_what_each_robot_does_whoever_else_it_is_told_of() {
    let turns = turns(&small());
    let (_folder, mut together) = talks(PURE, "");
    let (_other, mut apart) = talks(PURE, ", isolate: true");
    let all = acts(&mut *together, &turns).unwrap();
    let says = vec![
        Say { to: None, what: serde_json::json!({"x": 0.1}) },
        Say { to: Some(0), what: serde_json::json!(1) },
    ];
    let second = Act {
        says,
        wake_in_s: Some(0.25),
        joins: Some(Choice::Group(teaming::TaskId(1))),
        state: serde_json::json!([1, 0.5]),
        ..Act::default()
    };
    assert_eq!(all[1], second);
    assert_eq!(all, acts(&mut *apart, &turns).unwrap());
    let mut shuffled = turns.clone();
    shuffled.reverse();
    let mut other = acts(&mut *together, &shuffled).unwrap();
    other.reverse();
    assert_eq!(all, other);
}

/// What a program keeps of one robot and tells another is found out by a process for each.
#[test]
fn a_program_that_shares_memory_acts_otherwise_with_a_process_for_each_robot() {
    let shares = "    kept[turn['robot']] = 1\n    return {'state': len(kept)}";
    let turns = turns(&small());
    let (_folder, mut together) = talks(shares, "");
    let (_other, mut apart) = talks(shares, ", isolate: true");
    assert_ne!(acts(&mut *together, &turns), acts(&mut *apart, &turns));
}

#[test]
fn a_robot_gets_the_groups_of_the_rule_that_it_asks() {
    let asks = r"
    if turn['rule']:
        return {'joins': turn['rule'], 'state': turn['state']}
    return {'asks': True, 'says': [{'what': 'hm'}], 'state': turn['state']}";
    let (_folder, mut session) = talks(asks, "");
    let (question, turns) = (small(), turns(&small()));
    let expected = policies::standard().parse("ENG").unwrap().decide(&question).unwrap().assignment;
    for act in acts(&mut *session, &turns).unwrap() {
        assert_eq!(act.joins, Some(Choice::Groups(expected.clone())));
        assert_eq!(act.says.len(), 1, "what it said before it asked");
    }
    let (_folder, mut session) = talks("    return {'asks': True}", "");
    let error = acts(&mut *session, &turns).unwrap_err();
    assert_eq!(error, "a robot asked its rule again and again in one turn");
}

#[test]
fn acts_that_cannot_be_read_are_told() {
    let turns = turns(&small());
    for (body, expected) in [
        (
            "    return {'joins': 'home'}",
            "acts[0]: joins must be the number of a task, {\"groups\": [..]} or \"stays\"",
        ),
        ("    return {'say': 1}", "acts[0]: unknown field `say`, expected one of `says`"),
        ("    return 1 / 0", "it exited with status 1"),
    ] {
        let (_folder, mut session) = talks(body, "");
        let error = acts(&mut *session, &turns).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let refused = |text: &str| registry_until(&Arc::default()).parse(text).unwrap_err().to_string();
    let isolate = refused("EXEC(command: [\"x\"], isolate: true)");
    assert!(isolate.contains("isolate: must be false for a policy"), "{isolate}");
}
