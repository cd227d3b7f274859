//! `Leader`: all go where the leader sees them. Each robot tells its rank, and after a while the one that has
//! heard of no better tells all how it sees the groups. A robot that has heard no leader by then goes by its
//! own view. Where messages are lost, there may be two leaders: the better one counts for whoever hears both.
//!
//! The robot with the best rank leads, then the one with the lowest number: the bully algorithm
//! (Garcia-Molina, IEEE Trans. Computers C-31(1), 1982) with one exchange and a deadline in the place of
//! acknowledgements.

use serde::{Deserialize, Serialize};
use teaming::levels::ENERGY;
use teaming::{Act, Assignment, Choice, PolicyError, Protocol, ProtocolKind, Talk, Turn};

use super::is_fit;

/// Who leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
enum Rank {
    /// The robot with the lowest number.
    #[default]
    Id,
    /// The robot that says that it has the most energy, then the one with the lowest number.
    Energy,
}

/// Its options.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Leader {
    by: Rank,
    /// How long each waits for the ranks of the others, and then for the leader, in seconds.
    wait_s: f64,
}

impl Default for Leader {
    fn default() -> Self {
        Self { by: Rank::Id, wait_s: 1.0 }
    }
}

/// What robots tell each other.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Told {
    rank: f64,
    /// How the leader sees the groups.
    groups: Option<Assignment>,
}

/// What a robot keeps in mind.
#[derive(Default, Serialize, Deserialize)]
struct Mind {
    rank: f64,
    /// Whether it has heard of a better rank than its own.
    follows: bool,
    /// Whether it has asked its rule once its first wait was over.
    has_asked: bool,
    /// The rank and the number of the best leader that it has heard, and that leader's groups.
    leader: Option<(f64, u32, Assignment)>,
    own: Option<Assignment>,
}

/// The kind.
pub fn kind() -> ProtocolKind {
    let about = "all go where the leader sees them, or by their own view if they hear none";
    let kind = ProtocolKind::made("Leader", about, |options: Leader, _| {
        is_fit(options.wait_s).map(|()| Talk::shared(options))
    });
    kind.from_sources(env!("SOURCES_PROTOCOL_LEADER"))
}

/// Whether a rank is better than another.
fn is_better(rank: f64, robot: u32, than: f64, other: u32) -> bool {
    rank.total_cmp(&than).then(other.cmp(&robot)).is_gt()
}

impl Leader {
    fn rank_of(self, turn: &Turn) -> f64 {
        let level = turn.question.levels.iter().position(|level| level.name == ENERGY);
        let member = turn.question.members.iter().find(|member| member.id == turn.robot);
        match self.by {
            Rank::Id => 0.0,
            Rank::Energy => member.and_then(|member| *member.levels.get(level?)?).unwrap_or(0.0),
        }
    }
}

impl Mind {
    fn hear(&mut self, turn: &Turn) {
        for (from, Told { rank, groups }) in turn.heard::<Told>() {
            self.follows |= is_better(rank, from, self.rank, turn.robot);
            let known = self.leader.as_ref();
            if let Some(groups) = groups
                && known.is_none_or(|(than, other, _)| is_better(rank, from, *than, *other))
            {
                self.leader = Some((rank, from, groups));
            }
        }
    }

    /// Where it goes in the end: by its leader, or by its own view.
    fn decision(&self, turn: &Turn) -> Option<Assignment> {
        let is_placed =
            |groups: &&Assignment| groups.idle.contains(&turn.robot) || groups.task_of(turn.robot).is_some();
        let led = self.leader.as_ref().map(|(_, _, groups)| groups).filter(is_placed);
        led.or(self.own.as_ref()).cloned()
    }
}

impl Protocol for Leader {
    fn turn(&self, turn: &Turn) -> Result<Act, PolicyError> {
        if turn.is_first() {
            let mind = Mind { rank: self.rank_of(turn), ..Mind::default() };
            let told = Told { rank: mind.rank, groups: None };
            return Ok(Act::waits(self.wait_s).saying(&told).keeping(&mind));
        }
        let mut mind: Mind = turn.mind();
        mind.hear(turn);
        let waits = |until_s: f64| Act::waits(until_s - turn.since_s);
        let (heard_ranks, heard_leader) = (self.wait_s, 2.0 * self.wait_s);
        if let Some(groups) = &turn.rule {
            mind.own = Some(groups.clone());
            if mind.follows {
                return Ok(waits(heard_leader).keeping(&mind));
            }
            mind.leader = Some((mind.rank, turn.robot, groups.clone()));
            let told = Told { rank: mind.rank, groups: Some(groups.clone()) };
            return Ok(waits(heard_leader).saying(&told).keeping(&mind));
        }
        if turn.since_s < heard_ranks {
            return Ok(waits(heard_ranks).keeping(&mind));
        }
        if !mind.has_asked {
            mind.has_asked = true;
            return Ok(Act::asks().keeping(&mind));
        }
        if turn.since_s < heard_leader {
            return Ok(waits(heard_leader).keeping(&mind));
        }
        Ok(Act { joins: mind.decision(turn).map(Choice::Groups), ..Act::default() }.keeping(&mind))
    }
}
