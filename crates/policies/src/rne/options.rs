//! The options of the RNE policy: each ambiguity of the paper's text by a name.

use serde::{Deserialize, Serialize};

use rne_core::trust::LogBase;

/// Which RNE between two groups is maximised. RNE is not symmetric and the paper does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ScoreDirection {
    /// The larger of the two directions. The default.
    #[default]
    MaxOfBoth,
    /// From the group with the lowest id to the other: Algorithm 3 called as in Algorithm 1, to the letter.
    FirstToSecond,
    /// The sum of both directions (Jeffreys).
    Sum,
    /// The Jensen-Shannon divergence.
    JensenShannon,
}

/// Which RNE decides how the parts of a role are merged with the groups so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum MergeReading {
    /// The RNE between the merged groups, which stay apart, summed over all pairs. The default: "maximum
    /// trust level difference between each other".
    #[default]
    Apart,
    /// The RNE between two parts that are put together: the literal lines of Algorithm 1, which add `GRC(i,
    /// j)` for a pair (i, j) that becomes one group. The largest of all pairs counts.
    Together,
}

/// Which group takes the hardest task, which one the next hardest, and so on. Ties go to the group with the
/// lowest id; empty groups take the easiest tasks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum HardRule {
    /// The group whose members have the lower mean RNE to their own group's distribution (Def. 2), that is,
    /// the more trust within. The default: the text's words.
    #[default]
    IntraGroupTrust,
    /// The group with the larger sum of weighted needs, each need scaled by its maximum over the team.
    Capability,
    /// The group with the higher mean battery level.
    MeanEnergy,
    /// The group with the higher mean health level.
    MeanHp,
}

teaming::options! {
    /// Options of the RNE policy. `studies/yang2021/docs/readings.md` tells why each default is what it is.
    pub struct RneOptions {
        /// Base of the logarithm in which scores are printed.
        pub log_base: LogBase = LogBase::E,
        /// Whether distributions are sorted before they are compared: Algorithm 4's last line to the letter,
        /// which compares needs of different kinds.
        pub sort: bool = false,
        /// Which RNE between two groups is maximised.
        pub score: ScoreDirection = ScoreDirection::MaxOfBoth,
        /// Weight of each need; `None` means those of the question.
        pub weights: Option<Vec<f64>> = None,
        /// Whether each need is divided by its maximum over the team first, so that no unit dominates.
        pub scale: bool = true,
        /// Which RNE decides how parts are merged.
        pub merge: MergeReading = MergeReading::Apart,
        /// Which group takes which task.
        pub hard_rule: HardRule = HardRule::IntraGroupTrust,
    }
}
