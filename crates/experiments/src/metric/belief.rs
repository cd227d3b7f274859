//! How far what was believed of robots was true, in the decisions of a trial in which the base went by
//! reports: by the policy's estimator, or else as it was said last.

use statistics::scores::{Forecast, area_under_curve, brier, calibration_error, crps, log_score, tau_b};
use teaming::{Estimate, Member};
use usar_sim::model::Liar;
use usar_sim::record::{DecisionRecord, HeardRecord, TrialRecord};
use usar_sim::robot::{ENERGY, HP};

/// A robot with less trust than this counts as detected.
const DETECTED_BELOW: f64 = 0.5;

/// A level that was believed of a member, and what it was.
#[derive(Debug, Clone, Copy)]
struct Belief {
    level: usize,
    mean: f64,
    sd: f64,
    truth: f64,
}

/// Reports that the base heard.
pub(super) fn reports_heard(record: &TrialRecord) -> Option<f64> {
    heard(record).map(|heard| heard.evidence.reports.len() as f64)
}

/// Robots that told a lie.
pub(super) fn liars(record: &TrialRecord) -> Option<f64> {
    heard(record).map(|heard| heard.liars.len() as f64)
}

/// Mean distance of believed levels from the true ones.
pub(super) fn level_mae(record: &TrialRecord) -> Option<f64> {
    mean(beliefs(record).map(|it| (it.mean - it.truth).abs()))
}

/// Mean score of believed levels as normal forecasts.
pub(super) fn level_crps(record: &TrialRecord) -> Option<f64> {
    mean(beliefs(record).map(|it| crps(it.mean, it.sd, it.truth)))
}

/// Mean rank correlation of believed and true levels over decisions and levels.
pub(super) fn rank_agreement(record: &TrialRecord) -> Option<f64> {
    heard(record)?;
    let of = |made: &DecisionRecord, level: usize| {
        let all: Vec<Belief> = beliefs_of(made).filter(|it| it.level == level).collect();
        let side = |value: fn(&Belief) -> f64| all.iter().map(value).collect::<Vec<_>>();
        tau_b(&side(|it| it.mean), &side(|it| it.truth))
    };
    let decisions = record.decisions.iter().filter(|made| made.joins.is_empty());
    mean(decisions.flat_map(|made| [of(made, 0), of(made, 1)]).flatten())
}

/// How often an honest robot is trusted more than a liar.
pub(super) fn trust_auc(record: &TrialRecord) -> Option<f64> {
    area_under_curve(&forecasts(record)?)
}

/// The Brier score of trust as the probability that a robot is honest.
pub(super) fn trust_brier(record: &TrialRecord) -> Option<f64> {
    brier(&forecasts(record)?)
}

/// The logarithmic score of the same.
pub(super) fn trust_log(record: &TrialRecord) -> Option<f64> {
    log_score(&forecasts(record)?)
}

/// The calibration error of the same.
pub(super) fn trust_ece(record: &TrialRecord) -> Option<f64> {
    calibration_error(&forecasts(record)?)
}

/// Mean number of rounds until a liar has little trust, from the first round on in which it lies. One that is
/// never detected counts with all of these.
pub(super) fn rounds_to_detect(record: &TrialRecord) -> Option<f64> {
    let liars = &heard(record)?.liars;
    judged(record).next()?;
    let until = |liar: &Liar| {
        let is_detected = |made: &DecisionRecord| {
            pairs(made).any(|(member, it)| member.id == liar.robot && it.trust < DETECTED_BELOW)
        };
        let lied: Vec<&DecisionRecord> =
            record.decisions.iter().filter(|made| asked_at_s(record, made) >= liar.since_s).collect();
        let rounds = lied.iter().position(|made| is_detected(made)).unwrap_or(lied.len());
        (!lied.is_empty()).then_some(rounds as f64)
    };
    mean(liars.iter().filter_map(until))
}

/// How often an honest robot was left at home by a policy that judges robots.
pub(super) fn false_exclusions(record: &TrialRecord) -> Option<f64> {
    heard(record)?;
    judged(record).next()?;
    let of = |made: &DecisionRecord| {
        let idle = made.decision.assignment.idle.iter();
        idle.filter(|id| !lies(record, made, **id)).count()
    };
    Some(judged(record).map(of).sum::<usize>() as f64)
}

fn heard(record: &TrialRecord) -> Option<&HeardRecord> {
    record.heard.as_ref()
}

/// The decisions in which an estimator judged what robots said.
fn judged(record: &TrialRecord) -> impl Iterator<Item = &DecisionRecord> {
    record.decisions.iter().filter(|made| made.decision.believed.is_some())
}

/// The members of a decision with what was thought of them.
fn pairs(made: &DecisionRecord) -> impl Iterator<Item = (&Member, &Estimate)> {
    made.question.members.iter().zip(made.decision.believed.iter().flatten())
}

/// Trust as a forecast that a robot is honest, for each member of each decision.
fn forecasts(record: &TrialRecord) -> Option<Vec<Forecast>> {
    heard(record)?;
    let of = |made| {
        pairs(made).map(|(member, it): (&Member, &Estimate)| Forecast {
            probability: it.trust,
            was_so: !lies(record, made, member.id),
        })
    };
    let all: Vec<Forecast> = record.decisions.iter().flat_map(of).collect();
    (!all.is_empty()).then_some(all)
}

/// Whether a robot lies, or has lied, when a decision is made. Until its lie begins, a liar is honest.
fn lies(record: &TrialRecord, made: &DecisionRecord, robot: u32) -> bool {
    let liars = record.heard.iter().flat_map(|heard| &heard.liars);
    let at_s = asked_at_s(record, made);
    liars.into_iter().any(|liar| liar.robot == robot && liar.since_s <= at_s)
}

/// When a decision was asked for, in seconds.
fn asked_at_s(record: &TrialRecord, made: &DecisionRecord) -> f64 {
    let round = record.rounds.iter().find(|round| round.round == made.question.round);
    round.map_or(record.time_s, |round| round.start_s)
}

/// All levels that the base believed, in trials with reports in which it decides.
fn beliefs(record: &TrialRecord) -> impl Iterator<Item = Belief> {
    let decisions = record.heard.iter().flat_map(|_| &record.decisions);
    decisions.filter(|made| made.joins.is_empty()).flat_map(beliefs_of)
}

fn beliefs_of(made: &DecisionRecord) -> impl Iterator<Item = Belief> {
    let estimates = made.decision.believed.as_deref();
    let members = made.question.members.iter().zip(made.team()).enumerate();
    members.flat_map(move |(place, (said, is))| {
        let [said, truth] = [said, is].map(|member| [ENERGY, HP].map(|level| member.level(level)));
        let estimate = estimates.and_then(|all| all.get(place));
        [0, 1].into_iter().filter_map(move |level| {
            let mean = estimate.map_or(said[level], |it| Some(it.levels[level]))?;
            let sd = estimate.map_or(0.0, |it| it.sd[level]);
            Some(Belief { level, mean, sd, truth: truth[level]? })
        })
    })
}

pub(super) fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let all: Vec<f64> = values.collect();
    (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
}
