//! Deceit, as it is written: which robots lie, how, about what, and when.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Scenario;
use super::checker::{Checker, meant, shown};
use super::file::{Happening, ScenarioFile};
use super::rules::BeliefSharing;

/// A lie and who tells it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Deceit {
    /// Who lies.
    pub who: Who,
    /// The lie.
    pub lie: Lie,
    /// What it is about; nothing for lies about others and about names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub on: Vec<Channel>,
    /// When it begins, in seconds.
    #[serde(default)]
    pub since_s: f64,
    /// When it ends, in seconds; without it, never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_s: Option<f64>,
    /// The least level that is said, in percent.
    #[serde(default)]
    pub floor: f64,
}

/// Who lies. Counts take the first robots of one permutation of ids, drawn in each trial: more of them are
/// these and others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Who {
    /// These robots, by their ids.
    Robots(Vec<u32>),
    /// So many robots of a role: `Role("carrier", 2)`.
    Role(String, u32),
    /// So many robots.
    Count(u32),
    /// This share of the robots, rounded to the nearest number, half up.
    Share(f64),
}

/// What a lie is about.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Channel {
    /// The battery level, and all needs that follow from it.
    Energy,
    /// The health level, and all needs that follow from it.
    Hp,
    /// One need alone, by its name, as a share of what it is in a fresh robot of the role.
    Need(String),
}

/// A lie. Lies about a level turn the level x, in percent, into another, which lies between the floor and
/// 100.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Lie {
    /// x + by (100 - x).
    Exaggerate {
        /// From 0 (true) to 1 (always 100).
        by: f64,
    },
    /// x (1 - by).
    Understate {
        /// From 0 (true) to 1 (always 0).
        by: f64,
    },
    /// x + points.
    Offset {
        /// Percent points.
        points: f64,
    },
    /// x times a factor. A need without `reports.clip` may be above that of a fresh robot.
    Scale {
        /// The factor.
        factor: f64,
    },
    /// What it was when the lie began.
    Stuck,
    /// 100 - x.
    Complement,
    /// Anything, drawn anew for each report.
    Uniform {
        /// The least, in percent.
        low: f64,
        /// The most, in percent.
        high: f64,
    },
    /// What the others of its role said on average; the truth as long as none has been heard.
    Copycat,
    /// Another lie for a part of each period.
    OnOff {
        /// The period, in seconds.
        period_s: f64,
        /// The part of it in which the robot lies, from 0 to 1; it lies first.
        duty: f64,
        /// The lie.
        lie: Box<Lie>,
    },
    /// Says of mates that they stood still.
    BadMouth {
        /// Of which mates.
        of: Mates,
    },
    /// Says of mates that they went as fast as they said.
    BallotStuff {
        /// Of which mates.
        of: Mates,
    },
    /// Says the opposite of what it saw of mates.
    Flip,
    /// Says nothing of mates.
    Silent,
    /// `BadMouth` of the honest and `BallotStuff` of the liars.
    Collude,
    /// Takes a new name.
    Whitewash {
        /// After each rest.
        at_rest: bool,
    },
    /// Its reports arrive under the name of another robot as well, after the true ones.
    Impersonate {
        /// The other robot.
        #[serde(rename = "as")]
        name: u32,
    },
    /// Does not tell its group-mates of radiation that it noticed.
    HideRadiation,
    /// Does not tell its group-mates of robots that it saw stopped for good.
    HideMate,
    /// Tells its group-mates wrong places: of debris and rescuees that it noticed, and of itself.
    Misplace {
        /// How far they are off, in metres. The direction is drawn for each thing.
        by_m: f64,
    },
    /// Tells its group-mates of a rescuee that does not exist, somewhere among those of their task, again and
    /// again.
    PhantomRescuee {
        /// Time between two of them, in seconds.
        every_s: f64,
    },
}

/// Some of a robot's mates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Mates {
    /// Those that tell no lie in this trial.
    Honest,
    /// Those that do.
    Liars,
    /// All.
    All,
}

/// What a lie changes. Of two lies of a robot at one time, each must change something else.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Subject {
    /// A level or a need.
    Own(Channel),
    /// What it says of its mates.
    Mates,
    /// Under which name it is known.
    Name,
    /// Under which other name it reports.
    OtherName,
    /// What it tells its mates of radiation.
    Radiation,
    /// What it tells its mates of wrecks.
    Wrecks,
    /// The places that it tells its mates.
    Places,
    /// What it tells its mates of rescuees.
    Rescuees,
}

impl Lie {
    /// Whether it is about a level of the liar.
    pub fn is_about_levels(&self) -> bool {
        self.subject().is_none()
    }

    /// Whether it is about what the liar saw of its mates.
    pub fn is_about_mates(&self) -> bool {
        self.subject() == Some(Subject::Mates)
    }

    /// Whether it is about things in the field.
    fn is_about_the_field(&self) -> bool {
        use Subject::{Places, Radiation, Rescuees, Wrecks};
        matches!(self.subject(), Some(Radiation | Wrecks | Places | Rescuees))
    }

    /// What it changes, if that is no level.
    fn subject(&self) -> Option<Subject> {
        match self {
            Self::Exaggerate { .. }
            | Self::Understate { .. }
            | Self::Offset { .. }
            | Self::Scale { .. }
            | Self::Stuck
            | Self::Complement
            | Self::Uniform { .. }
            | Self::Copycat
            | Self::OnOff { .. } => None,
            Self::BadMouth { .. } | Self::BallotStuff { .. } | Self::Flip | Self::Silent | Self::Collude => {
                Some(Subject::Mates)
            }
            Self::Whitewash { .. } => Some(Subject::Name),
            Self::Impersonate { .. } => Some(Subject::OtherName),
            Self::HideRadiation => Some(Subject::Radiation),
            Self::HideMate => Some(Subject::Wrecks),
            Self::Misplace { .. } => Some(Subject::Places),
            Self::PhantomRescuee { .. } => Some(Subject::Rescuees),
        }
    }

    /// What it changes, told on these channels.
    fn subjects(&self, on: &[Channel]) -> Vec<Subject> {
        self.subject().map_or_else(|| on.iter().cloned().map(Subject::Own).collect(), |subject| vec![subject])
    }
}

/// Checks who lies, and how.
pub(super) fn deceit(check: &mut Checker, file: &ScenarioFile) {
    for (i, deceit) in file.deceit.iter().enumerate() {
        let field = format!("deceit[{i}]");
        who(check, &format!("{field}.who"), &deceit.who, file);
        told(check, &field, &deceit.lie, &deceit.on, file);
        if let Some(until) = deceit.until_s.filter(|until| *until < deceit.since_s) {
            check.fail(format!("{field}.until_s"), "must not be before since_s", until);
        }
        if let (Lie::Impersonate { name }, Who::Robots(ids)) = (&deceit.lie, &deceit.who)
            && ids.contains(name)
        {
            check.fail(format!("{field}.lie.as"), "must be another robot", name);
        }
        for other in file.deceit[..i].iter().filter(|other| may_clash(deceit, other)) {
            let at = file.deceit.iter().position(|entry| std::ptr::eq(entry, other)).unwrap_or_default();
            let rule =
                format!("must not be about what deceit[{at}] is about, for the same robots at one time");
            check.fail(&field, rule, "both");
        }
    }
}

/// Checks a lie of the timeline.
pub(super) fn told(check: &mut Checker, field: &str, lie: &Lie, on: &[Channel], file: &ScenarioFile) {
    values(check, &format!("{field}.lie"), lie, file);
    if lie.is_about_the_field() && file.mission.belief_sharing != BeliefSharing::ByRadio {
        let rule = "needs mission.belief_sharing: ByRadio, as mates are told nothing otherwise";
        check.fail(format!("{field}.lie"), rule, format!("{:?}", file.mission.belief_sharing));
    }
    if lie.is_about_levels() && on.is_empty() {
        check.fail(
            format!("{field}.on"),
            "must say what the lie is about (Energy, Hp, Need(name))",
            "nothing",
        );
    } else if !lie.is_about_levels() && !on.is_empty() {
        check.fail(format!("{field}.on"), "must be empty: the lie is about no level", on.len());
    }
    for (i, channel) in on.iter().enumerate() {
        let Channel::Need(name) = channel else { continue };
        if !file.needs.iter().any(|need| need.name == *name) {
            let hint = meant(name, file.needs.iter().map(|need| need.name.as_str()));
            check.fail_with(
                format!("{field}.on[{i}]"),
                "must name a need of the scenario",
                hint,
                shown(name),
            );
        }
    }
    if let Some(i) = (1..on.len()).find(|i| on[..*i].contains(&on[*i])) {
        check.fail(format!("{field}.on[{i}]"), "must not be listed twice", format!("{:?}", on[i]));
    }
}

fn who(check: &mut Checker, field: &str, who: &Who, file: &ScenarioFile) {
    let robots: u32 = file.team.iter().map(|row| row.count).sum();
    match who {
        Who::Robots(ids) => {
            if ids.is_empty() {
                check.fail(field, "must name at least one robot", "none");
            }
            for id in ids.iter().filter(|id| **id >= robots) {
                check.fail(field, format!("must be ids of the {robots} robots, from 0"), id);
            }
        }
        Who::Role(role, count) => {
            let of_role = file.team.iter().filter(|row| row.role == *role).map(|row| row.count).sum();
            if !file.roles.iter().any(|known| known.name == *role) {
                let hint = meant(role, file.roles.iter().map(|role| role.name.as_str()));
                check.fail_with(field, "must name a role of the scenario", hint, shown(role));
            } else if *count > of_role {
                check.fail(field, format!("must be at most the {of_role} robots of the role"), count);
            }
        }
        Who::Count(count) => {
            if *count > robots {
                check.fail(field, format!("must be at most the {robots} robots of the team"), count);
            }
        }
        Who::Share(share) => {
            if *share > 0.0 && rounded_share(*share, robots) == 0 {
                check.fail(field, format!("must be 0 or make one of {robots} robots, or more"), share);
            }
        }
    }
}

/// A share of the robots, rounded half up.
pub fn rounded_share(share: f64, robots: u32) -> u32 {
    (share * f64::from(robots) + 0.5).floor() as u32
}

fn values(check: &mut Checker, field: &str, lie: &Lie, file: &ScenarioFile) {
    let robots: u32 = file.team.iter().map(|row| row.count).sum();
    match lie {
        Lie::Uniform { low, high } => {
            if low > high {
                check.fail(format!("{field}.high"), "must not be below low", high);
            }
        }
        Lie::OnOff { lie, .. } => {
            if !lie.is_about_levels() || matches!(**lie, Lie::OnOff { .. }) {
                check.fail(format!("{field}.lie"), "must be a lie about a level, and not OnOff", "another");
            } else {
                values(check, &format!("{field}.lie"), lie, file);
            }
        }
        Lie::Whitewash { at_rest } => {
            if !at_rest {
                check.fail(
                    format!("{field}.at_rest"),
                    "must be true: a new name is taken after a rest",
                    "false",
                );
            }
        }
        Lie::Impersonate { name } => {
            if *name >= robots {
                check.fail(
                    format!("{field}.as"),
                    format!("must be the id of one of the {robots} robots"),
                    name,
                );
            }
        }
        Lie::Exaggerate { .. }
        | Lie::Understate { .. }
        | Lie::Offset { .. }
        | Lie::Scale { .. }
        | Lie::PhantomRescuee { .. }
        | Lie::Stuck
        | Lie::Complement
        | Lie::Copycat
        | Lie::BadMouth { .. }
        | Lie::BallotStuff { .. }
        | Lie::Flip
        | Lie::Silent
        | Lie::Collude
        | Lie::HideRadiation
        | Lie::HideMate
        | Lie::Misplace { .. } => {}
    }
}

/// Whether a robot may tell both lies about one thing at one time.
fn may_clash(a: &Deceit, b: &Deceit) -> bool {
    let until = |deceit: &Deceit| deceit.until_s.unwrap_or(f64::INFINITY);
    let at_one_time = a.since_s < until(b) && b.since_s < until(a);
    let about = b.lie.subjects(&b.on);
    at_one_time && may_be_one(&a.who, &b.who) && a.lie.subjects(&a.on).iter().any(|it| about.contains(it))
}

fn may_be_one(a: &Who, b: &Who) -> bool {
    let is_nobody = |who: &Who| match who {
        Who::Robots(ids) => ids.is_empty(),
        Who::Role(_, count) | Who::Count(count) => *count == 0,
        Who::Share(share) => *share == 0.0,
    };
    match (a, b) {
        _ if is_nobody(a) || is_nobody(b) => false,
        (Who::Robots(a), Who::Robots(b)) => a.iter().any(|id| b.contains(id)),
        (Who::Role(a, _), Who::Role(b, _)) => a == b,
        (Who::Robots(_) | Who::Role(..) | Who::Count(_) | Who::Share(_), _) => true,
    }
}

impl Scenario {
    /// Whether any robot sees rescuees where they are not, or overlooks them.
    pub fn has_sight_errors(&self) -> bool {
        self.roles.iter().any(|role| !role.sight.is_exact())
    }

    /// Whether robots may speak of rescuees that do not exist.
    pub fn has_phantoms(&self) -> bool {
        self.has_lie(|lie| matches!(lie, Lie::PhantomRescuee { .. }))
            || self.roles.iter().any(|role| role.sight.false_alarms_per_min > 0.0)
    }

    /// Whether robots may say that things are where they are not.
    pub fn has_misplaced(&self) -> bool {
        self.has_lie(|lie| matches!(lie, Lie::Misplace { .. }))
    }

    /// Whether any robot tells such a lie, sooner or later.
    fn has_lie(&self, is_it: impl Fn(&Lie) -> bool) -> bool {
        let happens = self.timeline.iter().filter_map(|moment| match &moment.event {
            Happening::RobotLies { lie, .. } => Some(lie),
            _ => None,
        });
        self.deceit.iter().map(|deceit| &deceit.lie).chain(happens).any(is_it)
    }

    /// Whether the base goes by reports: robots report, a medium carries what they say, or robots lie.
    pub fn goes_by_reports(&self) -> bool {
        let is_about_reports = |event: &Happening| {
            matches!(
                event,
                Happening::RobotLies { .. } | Happening::RobotIsHonest(_) | Happening::RobotDrops(_)
            )
        };
        self.reports.is_some()
            || self.medium.is_some()
            || !self.deceit.is_empty()
            || self.timeline.iter().any(|moment| is_about_reports(&moment.event))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(who: Who, on: Channel, since_s: f64, until_s: Option<f64>) -> Deceit {
        Deceit { who, lie: Lie::Stuck, on: vec![on], since_s, until_s, floor: 0.0 }
    }

    #[test]
    fn two_lies_clash_if_one_robot_may_tell_both_at_one_time() {
        let count = || Who::Count(2);
        let one = entry(count(), Channel::Energy, 0.0, Some(10.0));
        let clash = |who, on, since_s| may_clash(&one, &entry(who, on, since_s, None));
        assert!(clash(Who::Robots(vec![3]), Channel::Energy, 9.0));
        assert!(!clash(Who::Robots(vec![3]), Channel::Energy, 10.0), "the first has ended");
        assert!(!clash(count(), Channel::Hp, 0.0));
        assert!(!clash(Who::Count(0), Channel::Energy, 0.0));
        let carriers = |role: &str| Who::Role(role.to_owned(), 1);
        let role = entry(carriers("a"), Channel::Hp, 0.0, None);
        assert!(!may_clash(&role, &entry(carriers("b"), Channel::Hp, 0.0, None)));
        assert!(may_clash(&role, &entry(carriers("a"), Channel::Hp, 0.0, None)));
    }

    #[test]
    fn a_share_is_rounded_half_up() {
        assert_eq!([0.0, 0.04, 0.125, 0.25, 1.0].map(|share| rounded_share(share, 12)), [0, 0, 2, 3, 12]);
    }
}
