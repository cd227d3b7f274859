//! The account in sentences.

use experiments::comparison::digits;
use experiments::why::{Directed, Exchange, OtherChoice};
use rne_core::RelativeNeedsEntropy;
use teaming::decision::{Ranking, RneAccount};
use teaming::{Account as PolicyAccount, LevelId, Member, Question};
use usar_sim::record::Join;
use usar_sim::robot::{ENERGY, HP};

use super::overheard::{Negotiation, TurnTaken};
use super::robot::{RobotStory, in_words};
use super::{Account, OracleSays};
use crate::arguments::Trial;
use crate::commands::fork::ids;
use crate::prelude::*;

/// A score that exceeds the next best by a smaller share than this is called close.
const CLOSE: f64 = 0.05;
/// Scores whose ratio differs from 1 by less than this are equal: they were summed in another order.
const ROUNDING: f64 = 1e-9;
/// So many characters of what a robot said are shown.
const LONGEST: usize = 60;

pub(super) fn text(account: &Account, asked: &Trial) -> Report {
    let Account { question, decision, .. } = account;
    let mut out = Report::from(format!(
        "{}, seed {}: round {} began at {:.1} s, and {}.",
        account.scenario,
        account.seed,
        account.round,
        account.time_s,
        who_decided(account)
    ));
    out.extend(question.task_ids().map(|task| {
        format!("  {}: robots {}", question.tasks[task.index()].name, ids(decision.assignment.of(task)))
    }));
    out.say("");
    if let Some(table) = said_and_true(account) {
        out.show("account", table);
        out.say("");
    }
    match &decision.account {
        PolicyAccount::Rne(of_rne) => rne(&mut out, question, of_rne),
        PolicyAccount::Ranking(ranking) => ranked(&mut out, question, ranking),
        PolicyAccount::Protocol(sent) => out.say(format!(
            "The robots would have agreed after {} exchanges, with {} messages of {} bytes in all.",
            sent.rounds, sent.messages, sent.bytes
        )),
        PolicyAccount::Text(text) => out.say(format!("{} says: {text}", account.policy)),
        _ => out.say(format!("{} gives no account of its decision.", account.policy)),
    }
    if let Some(pair) = account.directed.first() {
        needs(&mut out, account, pair);
    }
    others(&mut out, question, &account.others);
    oracle(&mut out, account, asked);
    if let Some(story) = &account.robot {
        robot(&mut out, story, account, asked);
        let own = account.joins.iter().find(|join| join.robot == story.robot);
        own.into_iter().for_each(|own| join(&mut out, own, question));
        if let Some(negotiation) = &account.negotiation {
            negotiated(&mut out, negotiation, account.team);
        }
    }
    out
}

/// Who decided, and how far robots agreed.
fn who_decided(account: &Account) -> String {
    let Account { joins, policy, .. } = account;
    if joins.is_empty() {
        return format!("{policy} decided");
    }
    let pairs = joins.iter().enumerate().flat_map(|(i, a)| joins[i + 1..].iter().map(move |b| (a, b)));
    let compared: Vec<bool> = pairs.filter_map(|(a, b)| a.agrees_with(b)).collect();
    let (same, all) = (compared.iter().filter(|same| **same).count(), compared.len());
    if all == 0 {
        return format!("each robot decided by {policy}, and named only its own task");
    }
    format!("each robot decided by {policy}: {same} of {all} pairs saw the same groups")
}

/// What a robot saw when it decided, and when it had last heard of whom.
fn join(out: &mut Report, join: &Join, question: &Question) {
    let groups = question
        .task_ids()
        .map(|task| format!("{} {}", question.tasks[task.index()].name, ids(join.sees.of(task))));
    let late = if join.is_late { ", when its time was over" } else { "" };
    let (after_s, groups) = (join.after_s, groups.collect::<Vec<_>>().join("; "));
    out.say(format!("  {after_s:.1} s after the negotiation began{late}, it saw the groups {groups}"));
    let age = |(robot, age): (&u32, &Option<f64>)| match age {
        Some(seconds) => format!("{robot}: {seconds:.1} s"),
        None => format!("{robot}: never"),
    };
    let heard: Vec<String> = join.ages_s.iter().map(age).collect();
    out.say(format!("  It had heard of the others so long ago: {}", heard.join(", ")));
}

/// What a robot heard and said before it decided, and what it knew of the others in the end.
fn negotiated(out: &mut Report, negotiation: &Negotiation, team: &[Member]) {
    let short = |what: &serde_json::Value| {
        let text = what.to_string();
        let cut = text.char_indices().nth(LONGEST).map_or(text.len(), |(at, _)| at);
        format!("{}{}", &text[..cut], if cut < text.len() { ".." } else { "" })
    };
    for turn in &negotiation.turns {
        let TurnTaken { since_s, told, says, shares, joins } = turn;
        let told = told.iter().map(|(from, what)| format!("robot {from} said {}", short(what)));
        let says = says.iter().map(|(to, what)| match to {
            Some(to) => format!("it says to robot {to} {}", short(what)),
            None => format!("it says to all {}", short(what)),
        });
        let shares = shares.then(|| "it says how the others are".to_owned());
        let joins = joins.then(|| "it decides".to_owned());
        let all: Vec<String> = told.chain(says).chain(shares).chain(joins).collect();
        let all = if all.is_empty() { "it waits".to_owned() } else { all.join("; ") };
        out.say(format!("  {since_s:.1} s: {all}"));
    }
    let level = |level: Option<f64>| or_dash(level, |level| format!("{level:.1}"));
    let row = |knew: &Member| {
        let is = team.iter().find(|member| member.id == knew.id);
        let of = |name: LevelId| [level(knew.level(name)), level(is.and_then(|is| is.level(name)))];
        let cells = [vec![knew.id.to_string()], of(ENERGY).to_vec(), of(HP).to_vec()].concat();
        cells.into_iter().map(right).collect::<Vec<_>>()
    };
    let names = ["robot", "energy as it knew", "true", "HP as it knew", "true"];
    let known: Vec<_> = negotiation.knew.members.iter().map(row).collect();
    out.show("knew", Table::of(names.to_vec(), known));
}

impl Account<'_> {
    /// The name of the trust measure, and its unit.
    fn measured(&self) -> [&str; 2] {
        [&self.measure, &self.unit].map(|text| text.as_deref().unwrap_or_default())
    }
}

/// What each robot had said of itself, what the estimator believed, and what was true, where the base had to
/// go by reports.
fn said_and_true(account: &Account) -> Option<Table> {
    let evidence = account.question.evidence.as_ref()?;
    let believed = account.decision.believed.as_deref();
    let mut names = vec!["robot", "role", "energy said", "believed", "true"];
    names.extend(["HP said", "believed", "true", "trust", "heard, s ago"]);
    names.retain(|name| believed.is_some() || !["believed", "trust"].contains(name));
    let level = |level: Option<f64>| or_dash(level, |level| format!("{level:.1}"));
    let row = |(place, (said, is)): (usize, (&Member, &Member))| {
        let thought = believed.and_then(|all| all.get(place));
        let think = |at: usize| thought.map(|it| level(Some(it.levels[at])));
        let trust = thought.map(|it| format!("{:.2}", it.trust));
        let last = evidence.reports.iter().rev().find(|report| report.of == said.id);
        let age = last.map_or("never".to_owned(), |last| format!("{:.1}", account.time_s - last.sent_s));
        let robot = [said.id.to_string(), account.question.roles[said.role.index()].clone()].map(Some);
        let told = |of: LevelId| [Some(level(said.level(of))), think(of.index()), Some(level(is.level(of)))];
        robot.into_iter().chain(told(ENERGY)).chain(told(HP)).chain([trust, Some(age)]).flatten().map(right)
    };
    Some(Table::of(names, account.question.members.iter().zip(account.team).enumerate().map(row)))
}

fn nats(score: Option<RelativeNeedsEntropy>) -> String {
    match score.map(RelativeNeedsEntropy::nats) {
        None => "no score".to_owned(),
        Some(None) => "infinite".to_owned(),
        Some(Some(nats)) => format!("{nats:.3e} nats"),
    }
}

/// The distance to the runner-up, in words.
fn margin(best: Option<RelativeNeedsEntropy>, next: Option<RelativeNeedsEntropy>) -> String {
    let value = |score: Option<RelativeNeedsEntropy>| score.and_then(RelativeNeedsEntropy::nats);
    let (Some(best), Some(next)) = (value(best), value(next)) else { return String::new() };
    if best <= 0.0 {
        return " (a tie)".to_owned();
    }
    let share = (best - next) / best;
    let close = if share < CLOSE { ", a close call" } else { "" };
    format!(" ({:.1} % less{close})", 100.0 * share)
}

fn parts(parts: &[Vec<u32>]) -> String {
    let parts: Vec<String> = parts.iter().map(|part| format!("{{{}}}", ids(part))).collect();
    parts.join(" ")
}

fn rne(out: &mut Report, question: &Question, account: &RneAccount) {
    out.say(
        "How RNE came to it: the parts of each role that differ most, merged so that the groups differ most",
    );
    for split in &account.splits {
        let role = &question.roles[split.role.index()];
        let next = split.runner_up.as_ref().map_or("; there is no other split".to_owned(), |next| {
            format!(
                "; next best {}: {}{}",
                parts(&next.parts),
                nats(next.score),
                margin(split.score, next.score)
            )
        });
        out.say(format!(
            "  {role}: {} of {} splits: {}{next}",
            parts(&split.parts),
            split.searched,
            nats(split.score)
        ));
    }
    for merge in &account.merges {
        let role = &question.roles[merge.role.index()];
        let next = merge.runner_up.as_ref().map_or(String::new(), |next| {
            format!("; the next best way: {}{}", nats(next.score), margin(merge.score, next.score))
        });
        out.say(format!("  {role} joins the groups so far: {}{next}", nats(merge.score)));
    }
    if account.suitability.iter().any(|suited| suited.value.is_some()) {
        out.say("  then the hardest task takes the best-suited group (option hard_rule), the next the next");
    }
    for suited in &account.suitability {
        let name = &question.tasks[suited.task.index()].name;
        let value = suited.value.map_or("undefined".to_owned(), |value| format!("{value:.3e}"));
        out.say(format!("  {name} got the group whose suitability for a hard task is {value}"));
    }
}

fn ranked(out: &mut Report, question: &Question, ranking: &Ranking) {
    out.say(format!(
        "It sorted the members of each role by {}; the first go to the hardest task",
        ranking.key
    ));
    for (role, members) in question.roles.iter().zip(&ranking.roles) {
        let members: Vec<String> =
            members.iter().map(|member| format!("{} ({:.1})", member.id, member.value)).collect();
        out.say(format!("  {role}: {}", members.join(", ")));
    }
}

/// What the best exchange of places would have changed.
fn exchange(best: &Exchange, score: f64, account: &Account, asked: &Trial) -> String {
    let [measure, unit] = account.measured();
    let then = best.score.map_or("infinite".to_owned(), |value| format!("{value:.3e}"));
    let with = best.with;
    if asked.registry.chosen_measure().is_some() {
        return format!(
            "  In the place of robot {with}, {measure} between the groups would be {then} instead of \
             {score:.3e} {unit}"
        );
    }
    let verdict = match best.score {
        Some(value) if value <= score * (1.0 + ROUNDING) => {
            "no exchange with a robot of its role would have raised the score"
        }
        _ => "an exchange would have raised the score: the roles are split one by one, and not all together",
    };
    format!(
        "  In its group because {verdict}:\n  in the place of robot {with} the score is {then} instead of \
         {score:.3e} {unit}"
    )
}

/// The contribution of each need to the distrust between two groups, the largest first.
fn needs(out: &mut Report, account: &Account, pair: &Directed) {
    let ([measure, unit], question) = (account.measured(), &account.question);
    let [from, to] = [pair.from, pair.to].map(|task| &question.tasks[task.index()].name);
    out.say(format!(
        "\nWhat drove it: {measure} from the {from} group to the {to} group, {}, need by need",
        pair.distrust.map_or("infinite".to_owned(), |value| format!("{value:.3e} {unit}"))
    ));
    let mut needs: Vec<usize> = (0..pair.by_need.len()).collect();
    let size = |k: usize| pair.by_need[k].map_or(f64::INFINITY, f64::abs);
    needs.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let row = |k: usize| {
        let [p, q] = pair.shares[k].map(|share| format!("{:.3} %", 100.0 * share));
        let adds = pair.by_need[k].map_or("infinite".to_owned(), |nats| format!("{nats:+.3e}"));
        [question.needs[k].name.clone(), p, q, adds].map(right)
    };
    let header = ["need".to_owned(), format!("share in {from}"), format!("share in {to}")];
    let header = header.into_iter().chain([format!("adds ({unit})")]);
    out.show("account", Table::of(header, needs.into_iter().map(row)));
}

fn others(out: &mut Report, question: &Question, others: &[OtherChoice]) {
    if others.is_empty() {
        return;
    }
    out.say("\nWhat others would have decided");
    for other in others {
        let groups = question
            .task_ids()
            .map(|task| format!("{} {}", question.tasks[task.index()].name, ids(other.assignment.of(task))));
        let groups = groups.collect::<Vec<_>>().join("; ");
        let moved = match (&other.refused, other.moved.len()) {
            (Some(reason), _) => format!("an answer that is refused: {reason}"),
            (None, 0) => "the same".to_owned(),
            (None, count) => format!("{count} robots elsewhere: {groups}"),
        };
        out.say(format!("  {}: {moved}", other.policy));
    }
}

fn oracle(out: &mut Report, account: &Account, asked: &Trial) {
    if account.oracle.is_empty() {
        return out.say(format!(
            "\nHow good it was: not known; `usar oracle {} --seed {} --round {} --policy '{}'` plays all \
             assignments",
            asked.file.display(),
            asked.seed,
            account.round,
            asked.spec.plain()
        ));
    }
    out.say("\nHow good it was, among all assignments that the quotas allow");
    out.extend(account.oracle.iter().map(|said| format!("  {}", judged(said))));
}

/// A judgement of the oracle in words.
fn judged(said: &OracleSays) -> String {
    let OracleSays { metric, then, value, best, worst, rank, played } = said;
    let [value, best, worst] = [value, best, worst].map(|number| digits(*number, 4));
    let over = then.as_ref().map_or("in this round".to_owned(), |then| {
        format!("from here to the trial's end, where {then} decides the later rounds")
    });
    if best == worst {
        return format!("{metric} {over}: {value} with each of the {played}, so that it tells nothing here");
    }
    format!("{metric} {over}: rank {rank} of {played}, with {value}; the best has {best}, the worst {worst}")
}

fn robot(out: &mut Report, story: &RobotStory, account: &Account, asked: &Trial) {
    let RobotStory { robot, role, task, at_s, energy, hp, .. } = story;
    let task = task.as_deref().unwrap_or("no");
    out.say(format!(
        "\nRobot {robot}, {role}, in the {task} group; at {at_s:.1} s it has energy {energy:.1} % and HP \
         {hp:.1} %"
    ));
    if let (Some(best), Some(score)) = (story.exchanges.first(), account.between) {
        out.say(exchange(best, score, account, asked));
    }
    let delay = in_words(story.delay, story.waits_for);
    out.say(format!(
        "  At {at_s:.1} s it {delay} (since {:.1} s; {}, {:.2} m/s)",
        story.since_s, story.activity, story.speed_mps
    ));
    if story.given_up > 0 {
        out.say(format!(
            "  Its group gave up on {} that {} still: it knows no way there, or came no nearer. It tries \
             again in the next round, with the ways that it knows then",
            counted(story.given_up, "rescuee"),
            if story.given_up == 1 { "waits" } else { "wait" }
        ));
    }
    if let Some(turned) = &story.turned_back {
        let (rules, level) =
            (&asked.scenario.mission, if turned.cause == "hp" { turned.hp } else { turned.energy });
        let (name, threshold) = match turned.cause {
            "hp" => ("HP", rules.hp_threshold),
            _ => ("energy", rules.energy_threshold),
        };
        let why = if level < threshold {
            format!("below the threshold of {threshold} %")
        } else {
            "too little for the way to rest with its reserve".to_owned()
        };
        out.say(format!("  It turned back at {:.1} s with {name} {level:.1} %, {why}", turned.at_s));
    }
}
