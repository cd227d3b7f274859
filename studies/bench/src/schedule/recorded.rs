//! A schedule that others have recorded, played again.

use super::Schedule;
use crate::problem::Problem;
use crate::read::read;

/// The instance `env_0` of HeteroMRTA's test set (`RALTestSet/env_0/config.json`), to nine digits. For each
/// task: its place, the skills that it requires, and how long it takes.
const TASKS: &str = "\
    0.512758723 0.929104221 01001 3.513260353
    0.066082497 0.841317280 10010 4.719007135
    0.066690009 0.344309979 10101 0.634085511
    0.430298732 0.966062081 11010 4.323891477
    0.562231842 0.258864593 10101 0.297320758
    0.241675714 0.888118321 01110 1.903852542
    0.225869428 0.124554706 11101 2.148870306
    0.288330757 0.586123065 10010 2.444247734
    0.554090502 0.809710776 11110 4.882311610
    0.560475952 0.288421214 00100 3.878455941
    0.412896343 0.818120971 00110 1.544286814
    0.626506462 0.959077643 11100 1.349183928
    0.369404411 0.552611511 11000 4.315601021
    0.593924202 0.848291208 10100 4.406535864
    0.145473538 0.406510337 01111 2.553532528
    0.909958962 0.043066889 10001 1.721478655
    0.822706280 0.415384037 11111 4.974586741
    0.829803985 0.009954561 00101 1.579717727
    0.365046158 0.078630037 11001 0.913561895
    0.652614576 0.273849099 10101 4.400490607";

/// Three robots begin at each of these places. Those of the first have the first skill alone, and so on.
const DEPOTS: &str = "\
    0.479987924 0.232372920
    0.801880579 0.923530160
    0.266130272 0.538934408
    0.442752829 0.931017316
    0.040510711 0.732006196";

/// The schedule that is recorded beside it (`results.yaml`, of the planner CTAS): the tasks of each robot,
/// from 1, and when each task starts.
const ROUTES: [&[usize]; 14] = [
    &[13, 8, 2, 4],
    &[12, 17, 14, 9],
    &[5, 20, 19, 7, 16, 3],
    &[12, 6, 4],
    &[17, 9],
    &[13, 19, 7, 15, 1],
    &[5, 20, 7, 15, 3],
    &[12, 17, 18, 10],
    &[11, 6, 14, 9],
    &[11, 8, 15],
    &[6, 2, 4],
    &[17, 9],
    &[5, 20, 19, 7, 15, 1],
    &[17, 18, 16, 3],
];
const STARTS: [f64; 20] = [
    21.423_791, 11.739_265, 25.070_144, 18.383_206, 3.521_562, 7.012_416, 12.061_666, 7.602_990, 20.052_488,
    18.464_660, 1.577_065, 3.706_641, 2.848_755, 15.368_681, 15.676_504, 17.655_165, 7.945_881, 14.947_926,
    10.415_314, 4.276_965,
];
const MAKESPAN: f64 = 27.845_170;

/// The instance as a `config.json`.
fn config() -> String {
    let place = |x: &str, y: &str| format!(r#"{{"x": {x}, "y": {y}}}"#);
    let skills = |has: &str| {
        let skills = has.chars().enumerate().map(|(skill, has)| format!(r#""{skill}": {has}"#));
        format!("{{{}}}", skills.collect::<Vec<String>>().join(", "))
    };
    let task = |(at, line): (usize, &str)| {
        let [x, y, has, duration] = line.split_whitespace().collect::<Vec<&str>>().try_into().unwrap();
        let [pos, skillset] = [place(x, y), skills(has)];
        format!(r#""{at}": {{"pos": {pos}, "skillset": {skillset}, "duration": {duration}}}"#)
    };
    let robot = |at: usize| {
        let (x, y) = DEPOTS.lines().nth(at / 3).unwrap().trim().split_once(' ').unwrap();
        let has: String = (0..5).map(|skill| if skill == at / 3 { '1' } else { '0' }).collect();
        format!(r#""{at}": {{"pose": {}, "skillset": {}}}"#, place(x, y), skills(&has))
    };
    let tasks = TASKS.lines().enumerate().map(task).collect::<Vec<String>>().join(", ");
    let robots = (0..15).map(robot).collect::<Vec<String>>().join(", ");
    let setup = r#"{"robots": 15, "tasks": 20, "num_skills": 5}"#;
    format!(r#"{{"setup": {setup}, "tasks": {{{tasks}}}, "robots": {{{robots}}}}}"#)
}

/// Each robot goes to its next task as soon as it is free.
fn played(problem: &Problem) -> Schedule<'_> {
    let mut schedule = Schedule::new(problem);
    let mut left = ROUTES.map(<[usize]>::iter);
    loop {
        let before = left.clone();
        for (robot, route) in left.iter_mut().enumerate() {
            if let (false, Some(task)) = (schedule.is_bound[robot], route.as_slice().first()) {
                route.next();
                schedule.commit(robot, task - 1, 0.0);
            }
        }
        if left.iter().zip(before).all(|(left, before)| left.len() == before.len()) {
            return schedule;
        }
    }
}

#[test]
fn the_recorded_schedule_has_the_recorded_times() {
    let problem = read("env_0", &config()).unwrap_or_else(|error| panic!("{error}"));
    let schedule = played(&problem);
    for (task, recorded) in STARTS.iter().enumerate() {
        let later = recorded - (schedule.ends[task].unwrap() - problem.tasks[task].duration);
        // Nobody waits for task 3, and its recorded start is 1.2 later than need be.
        let expected = if task == 2 { 1.216_197 } else { 0.0 };
        assert!((later - expected).abs() < 1e-5, "task {}: {later} after the own start", task + 1);
    }
    assert!((schedule.makespan() - MAKESPAN).abs() < 1e-5, "{}", schedule.makespan());
}
