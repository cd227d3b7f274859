//! NAME: a policy of usar. It answers a question with groups: for each task, the ids of its robots.
//!
//! `cargo test` asks it the questions of questions.jsonl.

use std::io::{BufRead, Write, stdin, stdout};

use serde_json::{Value, json};

/// Per role, the robots with more energy take the harder tasks; ties go to the lower id.
fn decide(question: &Value, _options: &Value) -> Vec<Vec<u64>> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let level = list(&question["levels"]).iter().position(|level| level["name"] == "energy");
    let tasks = list(&question["tasks"]);
    let mut hardest_first: Vec<usize> = (0..tasks.len()).collect();
    hardest_first.sort_by_key(|task| std::cmp::Reverse(tasks[*task]["difficulty"].as_u64()));
    let mut groups = vec![Vec::new(); tasks.len()];
    for (role, quota) in list(&question["quotas"]).iter().enumerate() {
        let mut robots = list(&question["members"]);
        robots.retain(|robot| robot["role"] == role);
        let energy = |robot: &Value| level.and_then(|level| robot["levels"][level].as_f64()).unwrap_or(0.0);
        let id = |robot: &Value| robot["id"].as_u64().unwrap_or_default();
        robots.sort_by(|a, b| energy(b).total_cmp(&energy(a)).then(id(a).cmp(&id(b))));
        let mut ids = robots.iter().map(id);
        for &task in &hardest_first {
            let size = quota["members"][task].as_u64().unwrap_or(0);
            groups[task].extend(ids.by_ref().take(size as usize));
        }
    }
    groups
}

fn main() -> std::io::Result<()> {
    let mut options = Value::Null;
    for line in stdin().lock().lines() {
        let message: Value = serde_json::from_str(&line?)?;
        let reply = match message["type"].as_str() {
            Some("hello") => {
                options = message["options"].clone();
                json!({
                    "type": "hello", "protocol": 1, "schema_version": 3,
                    "name": "NAME", "version": env!("CARGO_PKG_VERSION"), "deterministic": true,
                })
            }
            Some("question") => {
                let groups = decide(&message["question"], &options);
                let decision = json!({"assignment": {"groups": groups}});
                json!({"type": "decision", "id": message["id"], "decision": decision})
            }
            _ => break,
        };
        let mut out = stdout().lock(); // all other prints: eprintln!
        writeln!(out, "{reply}")?;
        out.flush()?;
    }
    Ok(())
}

#[test]
fn each_robot_is_in_one_group() {
    for line in include_str!("../questions.jsonl").lines() {
        let question: Value = serde_json::from_str(line).unwrap();
        let groups = decide(&question, &Value::Null);
        assert_eq!(groups.len(), question["tasks"].as_array().unwrap().len());
        let mut grouped = groups.concat();
        grouped.sort_unstable();
        let members = question["members"].as_array().unwrap();
        assert_eq!(grouped, members.iter().map(|robot| robot["id"].as_u64().unwrap()).collect::<Vec<_>>());
    }
}
