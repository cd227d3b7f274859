//! The blindness of a trust measure to magnitude. Relative entropy compares proportions: two robots whose
//! levels differ greatly can have full trust in each other. This module looks for an example in real
//! trials.

use store::Failure;
use teaming::{Member, TrustMeasure};

use experiments::rounds::{Round, energy, hp};

/// Smaller values of a measure, such as RNE in nats, are rounding errors.
const LEAST: f64 = 1e-9;

/// Smaller distances between levels, in percent points, count as equal levels.
const LEAST_POINTS: f64 = 2.0;

/// Two robots of one role in one round.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The robot that trusts.
    pub from: Member,
    /// The robot that is trusted.
    pub to: Member,
    /// Its distrust, in the unit of the measure.
    pub distrust: f64,
}

impl Pair {
    /// Distance between their levels (energy, HP), in percent points.
    pub fn apart(&self) -> f64 {
        apart(&self.from, &self.to)
    }
}

fn apart(a: &Member, b: &Member) -> f64 {
    (energy(a) - energy(b)).hypot(hp(a) - hp(b))
}

/// How blind a trust measure was to magnitude in some rounds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Blindness {
    /// The clearest example: one pair is farther apart by some factor, and the other pair has the higher
    /// distrust by the same factor or more.
    pub plainest: Option<Example>,
    /// Number of comparisons between pairs of one role and round that differ in both distance and distrust.
    compared: u64,
    /// Number of these comparisons in which the pair with the nearer levels has the higher distrust.
    misjudged: u64,
}

/// Two pairs of one role and round.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// Number of the trial.
    pub trial: u32,
    /// Its seed.
    pub seed: u64,
    /// Number of the round.
    pub round: u32,
    /// The role of all these robots.
    pub role: String,
    /// The pair whose levels are farther apart.
    pub unlike: Pair,
    /// The pair whose levels are nearer, but which has the higher distrust.
    pub alike: Pair,
    /// How clear the example is: the lesser of the two ratios.
    plain: f64,
}

impl Blindness {
    /// The share of comparisons between pairs of one role and round in which the pair with the nearer
    /// levels has the higher distrust.
    pub fn misjudged(&self) -> Option<f64> {
        (self.compared > 0).then(|| self.misjudged as f64 / self.compared as f64)
    }

    /// Adds a round. Pairs with infinite distrust are left out.
    ///
    /// # Errors
    /// Needs that cannot be measured.
    pub fn add(&mut self, round: &Round, measure: &dyn TrustMeasure) -> Result<(), Failure> {
        let question = round.true_question();
        let trust = measure.of_team(&question).map_err(Failure::run)?;
        for role in round.question.role_ids() {
            let members: Vec<&Member> = round.of_role(role).collect();
            let mut pairs: Vec<Candidate> = Vec::new();
            for i in 0..members.len() {
                for j in (0..members.len()).filter(|j| *j != i) {
                    let distrust = trust.towards(&[members[i].id], &[members[j].id]).map_err(Failure::run)?;
                    if distrust.is_finite() {
                        pairs.push(Candidate { i, j, apart: apart(members[i], members[j]), distrust });
                    }
                }
            }
            self.count(&pairs);
            self.look_for_example(round, &round.question.roles[role.index()], &members, &pairs);
        }
        Ok(())
    }

    fn count(&mut self, pairs: &[Candidate]) {
        for (at, a) in pairs.iter().enumerate() {
            for b in &pairs[at + 1..] {
                let (apart, distrust) = (a.apart.total_cmp(&b.apart), a.distrust.total_cmp(&b.distrust));
                if apart.is_ne() && distrust.is_ne() {
                    self.compared += 1;
                    self.misjudged += u64::from(apart != distrust);
                }
            }
        }
    }

    fn look_for_example(&mut self, round: &Round, role: &str, members: &[&Member], pairs: &[Candidate]) {
        for unlike in pairs.iter().filter(|pair| pair.distrust > LEAST) {
            for alike in pairs.iter().filter(|pair| pair.apart > LEAST_POINTS) {
                let plain = (unlike.apart / alike.apart).min(alike.distrust / unlike.distrust);
                if plain <= self.plainest.as_ref().map_or(1.0, |known| known.plain) {
                    continue;
                }
                let pair = |of: &Candidate| Pair {
                    from: members[of.i].clone(),
                    to: members[of.j].clone(),
                    distrust: of.distrust,
                };
                self.plainest = Some(Example {
                    trial: round.trial,
                    seed: round.seed,
                    round: round.question.round,
                    role: role.to_owned(),
                    unlike: pair(unlike),
                    alike: pair(alike),
                    plain,
                });
            }
        }
    }
}

/// Two members, by their places.
struct Candidate {
    i: usize,
    j: usize,
    apart: f64,
    distrust: f64,
}

#[cfg(test)]
mod tests {
    use rne_core::NeedVector;
    use teaming::question::hardest_first;
    use teaming::{Decision, Level, Need, Question, Quota, RandomSeed, RoleId, Task};

    use super::*;

    /// Robots of one role, each with its levels (energy, HP) and the number of its task; the first task is
    /// the harder one.
    fn round(robots: &[(f64, f64, usize)]) -> Round {
        let member = |(id, (energy, hp, _)): (u32, &(f64, f64, usize))| Member {
            id,
            role: RoleId(0),
            home: [0.0, 0.0],
            needs: NeedVector::new(vec![*hp, *energy]).unwrap(),
            levels: vec![Some(*energy), Some(*hp)],
        };
        let ids = |task: usize| {
            let of_task = (0..).zip(robots).filter(|(_, robot)| robot.2 == task);
            of_task.map(|(id, _)| id).collect::<Vec<u32>>()
        };
        let tasks = vec![Task::new("far", 2), Task::new("near", 1)];
        let order = hardest_first(tasks.iter().map(|task| task.difficulty));
        let question = Question {
            roles: vec!["walker".into()],
            needs: ["hp", "eng"].map(|name| Need { name: name.into(), weight: 1.0 }).to_vec(),
            tasks,
            quotas: Quota::equal(&[robots.len()], &order),
            members: (0..).zip(robots).map(member).collect(),
            levels: Level::energy_and_hp(),
            random_seed: RandomSeed::from(1),
            ..Question::default()
        };
        let (decision, team) = (Decision::unscored(vec![ids(0), ids(1)]), question.members.clone());
        Round { trial: 3, seed: 7, question, decision, team }
    }

    #[test]
    fn proportional_needs_are_full_trust_however_far_apart() {
        let round = round(&[(90.0, 80.0, 0), (45.0, 40.02, 0), (90.0, 60.0, 0)]);
        let mut found = Blindness::default();
        found.add(&round, &*policies::standard().measure("RNE").unwrap().it).unwrap();
        let example = found.plainest.clone().unwrap();
        let mut ids = [example.unlike.from.id, example.unlike.to.id];
        ids.sort_unstable();
        assert_eq!(ids, [0, 1]);
        assert!(example.unlike.distrust < 1e-6 && example.alike.distrust > 1e-3);
        assert!(example.alike.apart() < example.unlike.apart());
        // Of the three distances, 0-1 is the greatest and has the least distrust. The two directions of a
        // pair are equally far apart and are not compared with each other. This leaves 12 comparisons, 4
        // for each two distances. All comparisons with 0-1 are misjudged.
        assert!(found.misjudged().unwrap() >= 8.0 / 12.0, "{:?}", found.misjudged());
        assert_eq!(Blindness::default().misjudged(), None);
    }
}
