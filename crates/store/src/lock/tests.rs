//! Tests of stale locks, and that only one process at a time holds a folder.

use super::*;

fn of(host: &str, job: Option<&str>, restarts: u32) -> Holder {
    let (host, job) = (host.to_owned(), job.map(str::to_owned));
    Holder { host, job, restarts, process: u32::MAX, since: "2026-01-01T00:00:00Z".to_owned() }
}

fn is_stale(holder: Option<Holder>, this: &Holder, is_free: Option<bool>, silence_s: u64) -> bool {
    let found = Found { holder, is_free, silence: Duration::from_secs(silence_s) };
    found.stale(this).is_some()
}

#[test]
fn the_rule_for_stale_locks() {
    let this = of("a", Some("7_1"), 1);
    let there = |host, job, restarts| Some(of(host, job, restarts));
    for (holder, (is_free, silence_s), expected) in [
        (there("a", None, 0), (Some(true), 0), true), // of this host, killed
        (there("a", None, 0), (Some(false), 9_999), false), // of this host, at work or stopped
        (there("a", None, 0), (None, 0), true),       // no flock: there is no such process
        (there("b", None, 0), (Some(true), 299), false), // of another host, whose flock is not seen here
        (there("b", None, 0), (Some(true), 301), true), // silent
        (there("b", Some("7_1"), 0), (None, 1), true), // this job, before it was requeued
        (there("b", Some("7_1"), 1), (None, 1), false), // this job, now: two processes of one task
        (there("b", Some("7_2"), 0), (None, 1), false), // another task
        (None, (Some(true), 5), false),               // it is just being written
        (None, (Some(true), 11), true),               // left by a process that was killed
    ] {
        assert_eq!(
            is_stale(holder.clone(), &this, is_free, silence_s),
            expected,
            "{holder:?} {is_free:?} {silence_s}"
        );
    }
}

#[test]
fn one_process_at_a_time_has_a_folder_and_leaves_no_lock() {
    let folder = tempfile::tempdir().unwrap();
    let mut said = Vec::new();
    let lock = Lock::of_folder(folder.path(), &mut |note| said.push(note)).unwrap();
    lock.check().unwrap();
    let other = Lock::of_folder(folder.path(), &mut |note| said.push(note)).unwrap_err().to_string();
    let expected = format!("process {} on {}", std::process::id(), machine::name());
    assert!(other.contains(&expected), "{other}");
    assert_eq!(holder(folder.path()).unwrap().unwrap().process, std::process::id());
    drop(lock);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert!(said.is_empty());
}

#[test]
fn a_process_whose_lock_was_taken_over_does_not_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let lock = Lock::of_folder(folder.path(), &mut |_| {}).unwrap();
    let path = folder.path().join(LOCK);
    let thief = serde_json::to_string(&of("elsewhere", None, 0)).unwrap();
    std::fs::remove_file(&path).unwrap();
    std::fs::write(&path, &thief).unwrap();
    assert!(!lock.held.beat());
    assert!(lock.check().unwrap_err().to_string().contains("was taken over by another process"));
    drop(lock);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), thief, "it is not ours to remove");
}

#[test]
fn the_lock_of_another_host_holds_until_it_is_silent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(LOCK);
    let text = serde_json::to_string(&of("elsewhere", Some("42_3"), 0)).unwrap();
    std::fs::write(&path, text).unwrap();
    let refused = Lock::of_folder(folder.path(), &mut |_| {}).unwrap_err().to_string();
    assert!(refused.contains("on elsewhere, job 42_3, since 2026-01-01T00:00:00Z"), "{refused}");
    let old = SystemTime::now() - STALE - Duration::from_mins(1);
    File::options().write(true).open(&path).unwrap().set_modified(old).unwrap();
    let mut said = Vec::new();
    let lock = Lock::of_folder(folder.path(), &mut |note| said.push(note)).unwrap();
    assert!(said[0].contains("is taken over: it was silent for five minutes"), "{said:?}");
    lock.check().unwrap();
}
