//! A policy whose robots talk before they decide: `RULE by PROTOCOL`.

use std::sync::Arc;

use crate::decision::Decision;
use crate::error::PolicyError;
use crate::made::MadePolicy;
use crate::protocol::{Act, Turn};
use crate::session::{Asked, Basis, Driver, Session, TrialStart, each_alone};

/// How often robots may ask their rule in one turn.
const MOST_ASKED: usize = 3;

/// A rule and a protocol. Where the base decides, only the rule is asked.
#[derive(Debug, Clone)]
pub struct By {
    /// How a robot groups the team; none for a protocol that needs no rule.
    pub rule: Option<MadePolicy>,
    /// How robots talk.
    pub protocol: MadePolicy,
}

impl By {
    fn parts(&self) -> impl Iterator<Item = &MadePolicy> {
        self.rule.iter().chain([&self.protocol])
    }
}

impl Driver for By {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        let rule = self.rule.as_ref().map(MadePolicy::open).transpose()?;
        Ok(Box::new(BySession { rule, protocol: self.protocol.open()? }))
    }

    fn basis(&self) -> Basis {
        let is_any = |basis| self.parts().any(|part| part.it.basis() == basis);
        let others = [Basis::Absent, Basis::Undetermined, Basis::Trial];
        others.into_iter().find(|basis| is_any(*basis)).unwrap_or(Basis::Question)
    }

    fn needs_truth(&self) -> bool {
        self.parts().any(|part| part.it.needs_truth())
    }

    fn leaves_idle(&self) -> bool {
        self.parts().any(|part| part.it.leaves_idle())
    }

    fn least_raters(&self) -> Option<u32> {
        self.parts().filter_map(|part| part.it.least_raters()).max()
    }

    fn idle_part(&self) -> Option<String> {
        self.parts().find_map(|part| part.it.idle_part())
    }

    fn labelled(&self, label: &str) -> Option<Arc<dyn Driver>> {
        let rule = self.rule.clone().map(|rule| rule.labelled(label));
        Some(Arc::new(Self { rule, protocol: self.protocol.clone().labelled(label) }))
    }

    fn program(&self) -> Option<String> {
        let programs: Vec<String> = self.parts().filter_map(|part| part.it.program()).collect();
        (!programs.is_empty()).then(|| programs.join(", "))
    }

    fn permission(&self) -> Result<(), PolicyError> {
        self.parts().try_for_each(|part| part.it.permission())
    }

    fn gave_up(&self) -> Option<String> {
        self.parts().find_map(|part| part.it.gave_up())
    }

    /// It leans on its rule and on its protocol.
    fn fingerprint(&self) -> Option<String> {
        let rule = self.rule.as_ref().map_or(Some(String::new()), MadePolicy::fingerprint)?;
        Some(format!("{rule} by {}", self.protocol.fingerprint()?))
    }
}

/// A rule and a protocol at work.
struct BySession {
    rule: Option<Box<dyn Session>>,
    protocol: Box<dyn Session>,
}

impl Session for BySession {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        if let Some(rule) = &mut self.rule {
            rule.reset(trial)?;
        }
        self.protocol.reset(trial)
    }

    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        self.rule.as_mut().ok_or(PolicyError::NoRule)?.decide(asked)
    }

    /// Robots that are out of time do not talk any more.
    fn act(&mut self, turns: &[Turn], base: &Asked<'_>) -> Result<Vec<Act>, PolicyError> {
        if turns.iter().any(|turn| turn.late.is_some()) {
            return match &mut self.rule {
                Some(rule) => each_alone(&mut **rule, turns, base),
                None => Ok(turns.iter().map(|_| Act::default()).collect()),
            };
        }
        let mut acts = self.protocol.act(turns, base)?;
        for _ in 0..MOST_ASKED {
            self.tell_rule(turns, &mut acts, base)?;
        }
        if acts.iter().any(|act| act.asks) {
            let text = "a robot asked its rule again and again in one turn";
            return Err(PolicyError::Other(text.to_owned()));
        }
        Ok(acts)
    }
}

impl BySession {
    /// Robots that ask their rule get its answer in another turn. What they said stays said.
    fn tell_rule(&mut self, turns: &[Turn], acts: &mut [Act], base: &Asked<'_>) -> Result<(), PolicyError> {
        let asking: Vec<usize> = (0..acts.len()).filter(|place| acts[*place].asks).collect();
        let mut again = Vec::new();
        for place in &asking {
            let (turn, act) = (&turns[*place], &acts[*place]);
            let rule = self.rule.as_mut().ok_or(PolicyError::NoRule)?;
            let groups = rule.decide(&base.about(&turn.question))?.assignment;
            again.push(Turn {
                told: Vec::new(),
                state: act.state.clone(),
                rule: Some(groups),
                ..turn.clone()
            });
        }
        if again.is_empty() {
            return Ok(());
        }
        let answers = self.protocol.act(&again, base)?;
        for (place, answer) in asking.into_iter().zip(answers) {
            let before = std::mem::replace(&mut acts[place], answer);
            let act = &mut acts[place];
            act.says.splice(0..0, before.says);
            act.shares |= before.shares;
        }
        Ok(())
    }
}
