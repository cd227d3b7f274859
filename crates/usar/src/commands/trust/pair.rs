//! Relative Needs Entropy between two robots or groups, from needs on the command line.

use clap::ValueEnum;
use rne_core::{LogBase, NeedDistribution, NeedVector, NeedWeights, relative_entropy};
use serde_json::json;

use crate::arguments::numbers;
use crate::prelude::*;

/// Needs on the command line.
#[derive(Debug, Args)]
pub(super) struct PairArguments {
    /// Needs of the robot that trusts; repeat the flag for a group
    #[arg(long, requires = "trustee", conflicts_with_all = ["format", "measure"], allow_hyphen_values = true)]
    trustor: Vec<String>,
    /// Needs of the robot that is trusted; repeat the flag for a group
    #[arg(long, requires = "trustor", allow_hyphen_values = true)]
    trustee: Vec<String>,
    /// Base of the logarithm in which the RNE is given
    #[arg(long, default_value = "e", conflicts_with = "file")]
    log_base: Base,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Base {
    E,
    #[value(name = "2")]
    Two,
    #[value(name = "10")]
    Ten,
}

impl PairArguments {
    /// The RNE of the first side towards the second.
    pub(super) fn told(&self, weights: Option<&str>) -> Result<Report, Failure> {
        let weights = self.weights(weights)?;
        let from = distribution("--trustor", &self.trustor, &weights)?;
        let to = distribution("--trustee", &self.trustee, &weights)?;
        let rne = relative_entropy(&from, &to).map_err(Failure::input)?;
        let (base, unit) = match self.log_base {
            Base::E => (LogBase::E, "nats"),
            Base::Two => (LogBase::Two, "bits"),
            Base::Ten => (LogBase::Ten, "bans"),
        };
        let in_base = rne.in_base(base);
        let value = in_base.map_or("infinite".to_owned(), |value| format!("{value:.6} {unit}"));
        let trust = rne.trust();
        let mut out = Report::of([
            format!("RNE    {value}"),
            format!("trust  {trust:.6}   (exp of minus the RNE in nats: 1 is full trust, 0 none)"),
            format!("from   {}", shares(&from)),
            format!("to     {}", shares(&to)),
        ]);
        let pair = json!({"rne": rne.nats(), "trust": trust, unit: in_base, "from": from, "to": to});
        out.rows("pair", [&pair])?;
        Ok(out)
    }

    fn weights(&self, weights: Option<&str>) -> Result<NeedWeights, Failure> {
        let weights = match (weights, self.trustor.first()) {
            (Some(weights), _) => numbers("--weights", weights)?,
            (None, first) => vec![1.0; first.map_or(0, |first| first.split(',').count())],
        };
        NeedWeights::new(weights).map_err(Failure::input_at("--weights"))
    }
}

fn distribution(flag: &str, members: &[String], weights: &NeedWeights) -> Result<NeedDistribution, Failure> {
    let vector = |(i, text): (usize, &String)| {
        let flag = if members.len() == 1 { flag.to_owned() } else { format!("{flag} (number {})", i + 1) };
        let needs = NeedVector::new(numbers(&flag, text)?)
            .and_then(|needs| NeedDistribution::of_agent(&needs, weights).map(|_| needs));
        needs.map_err(Failure::input_at(flag))
    };
    let vectors = members.iter().enumerate().map(vector).collect::<Result<Vec<_>, _>>()?;
    NeedDistribution::of_group(&vectors, weights).map_err(Failure::input_at(flag))
}

fn shares(distribution: &NeedDistribution) -> String {
    let shares: Vec<String> = distribution.shares().iter().map(|share| format!("{share:.4}")).collect();
    format!("({})", shares.join(", "))
}
