//! What a robot that decides for itself knew, was told and said before a round.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;
use teaming::{Act, Asked, Decision, PolicyError, Question, Session, Turn};

/// A session, of which the turns of one robot are kept.
pub(super) struct Overheard<'s> {
    session: &'s mut dyn Session,
    robot: u32,
    /// The negotiation before each round.
    negotiations: BTreeMap<u32, Negotiation>,
}

/// What a robot did in a negotiation.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Negotiation {
    /// Its turns.
    pub turns: Vec<TurnTaken>,
    /// The team as it knew it in its last turn.
    pub knew: Question,
}

/// A turn that a robot took.
#[derive(Debug, Clone, Serialize)]
pub(super) struct TurnTaken {
    /// How long after the negotiation began, in seconds.
    pub since_s: f64,
    /// Who told it something since its last turn, and what.
    pub told: Vec<(u32, Value)>,
    /// To whom it said something (null for all), and what.
    pub says: Vec<(Option<u32>, Value)>,
    /// Whether it said how the others are.
    pub shares: bool,
    /// Whether it decided.
    pub joins: bool,
}

impl<'s> Overheard<'s> {
    pub(super) fn new(session: &'s mut dyn Session, robot: u32) -> Self {
        Self { session, robot, negotiations: BTreeMap::new() }
    }

    /// The negotiation before a round.
    pub(super) fn before(mut self, round: u32) -> Option<Negotiation> {
        self.negotiations.remove(&round)
    }
}

impl Session for Overheard<'_> {
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.session.decide(asked)
    }

    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        let acts = self.session.act(turns, base)?;
        for (turn, act) in turns.iter().zip(&acts).filter(|(turn, _)| turn.robot == self.robot) {
            let taken = TurnTaken {
                since_s: turn.since_s,
                told: turn.told.iter().map(|told| (told.from, told.what.clone())).collect(),
                says: act.says.iter().map(|say| (say.to, say.what.clone())).collect(),
                shares: act.shares,
                joins: act.joins.is_some(),
            };
            let knew = turn.question.clone();
            let before = self.negotiations.remove(&knew.round);
            let turns = before.into_iter().flat_map(|before| before.turns).chain([taken]).collect();
            self.negotiations.insert(knew.round, Negotiation { turns, knew });
        }
        Ok(acts)
    }
}
