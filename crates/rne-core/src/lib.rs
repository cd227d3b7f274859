//! Trust between robots as *Relative Needs Entropy* (RNE): needs, their distributions, relative entropy,
//! hierarchy.
//!
//! The mathematics of Yang & Parasuraman, *How Can Robots Trust Each Other For Better Cooperation?* (IEEE SMC
//! 2021, arXiv 2105.07443), with every ambiguity of the text as a named option. This crate has no world,
//! reads no files and no clock.
//!
//! ```
//! use rne_core::{NeedDistribution, NeedVector, NeedWeights, relative_entropy};
//!
//! let weights = NeedWeights::new(vec![6.0, 4.0, 2.0])?;
//! let r1 = NeedDistribution::of_agent(&NeedVector::new(vec![86.0, 120.0, 30.0])?, &weights)?;
//! let r2 = NeedDistribution::of_agent(&NeedVector::new(vec![20.0, 30.0, 10.0])?, &weights)?;
//! let rne = relative_entropy(&r1, &r2)?; // the paper's Example 1 prints 0.00373
//! assert!((rne.nats().unwrap() - 0.003_725_460_660_859_402).abs() < 1e-12);
//! assert!(rne.trust() > 0.996);
//! # Ok::<(), rne_core::NeedsError>(())
//! ```

pub mod divergence;
pub mod error;
pub mod hierarchy;
pub mod needs;
pub mod trust;

pub use divergence::{
    jeffreys, jensen_shannon, mutual_information, relative_entropy, relative_entropy_by_need,
};
pub use error::NeedsError;
pub use needs::{NeedDistribution, NeedVector, NeedWeights};
pub use trust::{LogBase, RelativeNeedsEntropy};

/// The README's example is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
