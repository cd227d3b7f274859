//! `usar trust`: Relative Needs Entropy between robots or groups, from needs on the command line.

use clap::ValueEnum;
use rne_core::{LogBase, NeedDistribution, NeedVector, NeedWeights, relative_entropy};
use serde_json::json;

use crate::arguments::{JsonArgument, numbers};
use crate::prelude::*;

/// Relative Needs Entropy (RNE) and trust of robots or groups
#[derive(Debug, Args)]
#[command(after_help = "\
Lower RNE means more trust. It is not symmetric: try both directions.

Examples:
  usar trust --weights 6,4,2 --from 86,120,30 --to 20,30,10
  usar trust --weights 6,4,2 --from 86,120,30 --to 82,114,24 --to 79,117,23 --json    towards a group of \
  two")]
pub(crate) struct Arguments {
    /// Weight of each need, separated by commas; only their ratios matter
    #[arg(long, allow_hyphen_values = true)]
    weights: String,
    /// Needs of the robot that trusts; repeat the flag for a group
    #[arg(long, required = true, allow_hyphen_values = true)]
    from: Vec<String>,
    /// Needs of the robot that is trusted; repeat the flag for a group
    #[arg(long, required = true, allow_hyphen_values = true)]
    to: Vec<String>,
    /// Base of the logarithm in which the RNE is given
    #[arg(long, default_value = "e")]
    log_base: Base,
    #[command(flatten)]
    json: JsonArgument,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Base {
    E,
    #[value(name = "2")]
    Two,
    #[value(name = "10")]
    Ten,
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let weights =
            NeedWeights::new(numbers("--weights", &self.weights)?).map_err(Failure::input_at("--weights"))?;
        let from = distribution("--from", &self.from, &weights)?;
        let to = distribution("--to", &self.to, &weights)?;
        let rne = relative_entropy(&from, &to).map_err(Failure::input)?;
        let (base, name, unit) = match self.log_base {
            Base::E => (LogBase::E, "e", "nats"),
            Base::Two => (LogBase::Two, "2", "bits"),
            Base::Ten => (LogBase::Ten, "10", "bans"),
        };
        let in_base = rne.in_base(base);
        if self.json.json {
            return print_json(&json!({
                "rne": rne.nats(),
                "infinite": rne.is_infinite(),
                "trust": rne.trust(),
                "base": name,
                "rne_in_base": in_base,
                "from": from,
                "to": to,
            }));
        }
        let value = in_base.map_or("infinite".to_owned(), |value| format!("{value:.6} {unit}"));
        writeln!(out, "RNE    {value}")?;
        let trust = rne.trust();
        writeln!(out, "trust  {trust:.6}   (exp of minus the RNE in nats: 1 is full trust, 0 none)")?;
        writeln!(out, "from   {}", shares(&from))?;
        writeln!(out, "to     {}", shares(&to))?;
        Ok(())
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
