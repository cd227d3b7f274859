//! Sections of which a part may be left out. A missing part gets a default that depends on its place.

use ron_fields::{Fields, Misfit};
use serde::de::Error;
use serde::ser::SerializeStructVariant;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::file::{self, Door, Normal, Point, ResolverRule, RightOfWay, WallFile};
use super::{reading, ron_options};
use crate::vitals;

/// Initial levels as they are written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
pub(super) struct InitialLevels {
    energy: PartOfNormal,
    hp: PartOfNormal,
}

#[derive(Default, Deserialize)]
#[serde(rename = "Normal", deny_unknown_fields, default)]
struct PartOfNormal {
    mean: Option<f64>,
    sd: Option<f64>,
}

impl From<InitialLevels> for file::InitialLevels {
    fn from(written: InitialLevels) -> Self {
        let whole = |part: PartOfNormal, default: Normal| Normal {
            mean: part.mean.unwrap_or(default.mean),
            sd: part.sd.unwrap_or(default.sd),
        };
        let default = Self::default();
        Self { energy: whole(written.energy, default.energy), hp: whole(written.hp, default.hp) }
    }
}

/// Costs as they are written.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Costs {
    unit: file::CostUnit,
    energy: PartOfRates,
    hp: PartOfRates,
    work: vitals::WorkRates,
}

#[derive(Default, Deserialize)]
#[serde(rename = "Rates", deny_unknown_fields, default)]
struct PartOfRates {
    per_step: Option<f64>,
    per_metre: Option<f64>,
    per_second: Option<f64>,
}

impl From<Costs> for file::Costs {
    fn from(written: Costs) -> Self {
        let whole = |part: PartOfRates, default: vitals::Rates| vitals::Rates {
            per_step: part.per_step.unwrap_or(default.per_step),
            per_metre: part.per_metre.unwrap_or(default.per_metre),
            per_second: part.per_second.unwrap_or(default.per_second),
        };
        let default = Self::default();
        let (energy, hp) = (whole(written.energy, default.energy), whole(written.hp, default.hp));
        Self { unit: written.unit, energy, hp, work: written.work }
    }
}

/// The text of a value without surrounding blanks, to be read in one of two ways.
pub(super) fn text_of<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let raw: Box<ron::value::RawValue> = Deserialize::deserialize(deserializer)?;
    Ok(raw.trim().get_ron().to_owned())
}

fn read<T: for<'de> Deserialize<'de>, E: Error>(text: &str) -> Result<T, E> {
    ron_options().from_str(text).map_err(|error| {
        let path = reading::read::<T>(text).err().map_or(String::new(), |found| found.1);
        let at = reading::offset(text, error.span.start.line, error.span.start.col);
        E::custom(Misfit::new(&error.code, &path, (text, at), &Fields::of(text)).packed())
    })
}

/// The forms of a resolver with all their brackets.
#[derive(Deserialize)]
#[serde(rename = "ResolverRule")]
enum InBrackets {
    Reciprocal,
    Rotation(PartOfRule),
    Swap(PartOfRule),
    None,
}

/// The values of the paper's rule, between the brackets of a variant.
type PartOfRule = RightOfWay;

impl<'de> Deserialize<'de> for ResolverRule {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = text_of(deserializer)?;
        let name_end = text.find('(').unwrap_or(text.len());
        let name = text[..name_end].trim_end();
        let text = match (name, &text[name_end..]) {
            ("Rotation" | "Swap", "") => format!("{name}(())"),
            ("Rotation" | "Swap", inside) => format!("{name}({inside})"),
            _ => text,
        };
        Ok(match read(&text)? {
            InBrackets::Reciprocal => Self::Reciprocal,
            InBrackets::Rotation(rule) => Self::Rotation(rule),
            InBrackets::Swap(rule) => Self::Swap(rule),
            InBrackets::None => Self::None,
        })
    }
}

impl Serialize for ResolverRule {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (index, name, rule) = match self {
            Self::Reciprocal => return serializer.serialize_unit_variant("ResolverRule", 0, "Reciprocal"),
            Self::None => return serializer.serialize_unit_variant("ResolverRule", 3, "None"),
            Self::Rotation(rule) => (1, "Rotation", rule),
            Self::Swap(rule) => (2, "Swap", rule),
        };
        let mut variant = serializer.serialize_struct_variant("ResolverRule", index, name, 3)?;
        variant.serialize_field("margin_m", &rule.margin_m)?;
        variant.serialize_field("horizon_s", &rule.horizon_s)?;
        variant.serialize_field("deadlock_steps", &rule.deadlock_steps)?;
        variant.end()
    }
}

/// A wall with the names of its fields.
#[derive(Serialize, Deserialize)]
#[serde(rename = "WallFile", deny_unknown_fields)]
struct Wall {
    from: Point,
    to: Point,
    #[serde(default = "thickness_m")]
    thickness_m: f64,
    #[serde(default)]
    doors: Vec<Door>,
}

/// Default thickness of a wall.
fn thickness_m() -> f64 {
    0.2
}

impl<'de> Deserialize<'de> for WallFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = text_of(deserializer)?;
        if text.strip_prefix('(').is_some_and(|inside| inside.trim_start().starts_with('(')) {
            let (from, to) = read(&text)?;
            return Ok(Self { from, to, thickness_m: thickness_m(), doors: Vec::new() });
        }
        let Wall { from, to, thickness_m, doors } = read(&text)?;
        Ok(Self { from, to, thickness_m, doors })
    }
}

impl Serialize for WallFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { from, to, thickness_m, doors } = self.clone();
        Wall { from, to, thickness_m, doors }.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value<T: for<'de> Deserialize<'de>>(text: &str) -> Result<T, String> {
        ron_options().from_str(text).map_err(|error| error.code.to_string())
    }

    #[test]
    fn what_is_left_out_has_the_default_of_its_place() {
        let costs: file::Costs = value("(hp: (per_second: 2.0))").unwrap();
        let default = file::Costs::default();
        assert_eq!(costs.energy, default.energy);
        assert_eq!(costs.hp, vitals::Rates { per_second: 2.0, ..default.hp });
        let levels: file::InitialLevels = value("(hp: (mean: 50), energy: (sd: 0))").unwrap();
        assert_eq!(levels.hp, Normal { mean: 50.0, sd: 10.0 });
        assert_eq!(levels.energy, Normal { mean: 80.0, sd: 0.0 });
        let mission: file::MissionRules = value("(rest_s: 10.0)").unwrap();
        assert_eq!(mission, file::MissionRules { rest_s: 10.0, ..file::MissionRules::default() });
        let movable: file::Movable = value("(mass_kg: 9)").unwrap();
        assert_eq!((movable.mass_kg, movable.friction), (9.0, 0.5));
    }

    #[test]
    fn a_resolver_has_its_values_in_brackets_or_the_defaults() {
        let default = RightOfWay::default();
        for (text, rule) in [
            ("Rotation", ResolverRule::Rotation(default)),
            ("Rotation()", ResolverRule::Rotation(default)),
            ("Swap ( margin_m : 0.3 )", ResolverRule::Swap(RightOfWay { margin_m: 0.3, ..default })),
            ("None", ResolverRule::None),
            ("Reciprocal", ResolverRule::Reciprocal),
        ] {
            let read: ResolverRule = value(text).unwrap();
            assert_eq!(read, rule, "{text}");
            let written = ron::to_string(&rule).unwrap();
            assert_eq!(value::<ResolverRule>(&written).unwrap(), rule, "{written}");
        }
        assert!(value::<ResolverRule>("Rotation(margin: 0.3)").unwrap_err().contains("margin_m"));
        assert!(value::<ResolverRule>("Luck").unwrap_err().contains("Rotation"));
        assert!(value::<ResolverRule>("Reciprocal(margin_m: 1)").is_err());
    }

    #[test]
    fn a_wall_is_written_short_or_with_names() {
        let wall = WallFile { from: [0.0, 0.0], to: [10.0, 0.0], thickness_m: 0.2, doors: Vec::new() };
        for text in ["((0, 0), (10, 0))", "(from: (0, 0), to: (10, 0))"] {
            assert_eq!(value::<WallFile>(text).unwrap(), wall);
        }
        let door: WallFile = value("(from: (0, 0), to: (9, 0), doors: [(at_m: 2, width_m: 1)])").unwrap();
        assert_eq!(door.doors, [Door { at_m: 2.0, width_m: 1.0, name: None, is_closed: false }]);
        assert!(value::<WallFile>("(from: (0, 0))").is_err());
        assert!(value::<WallFile>("((0, 0), 1)").is_err());
    }
}
