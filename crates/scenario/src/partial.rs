//! Sections of which a part may be left out. A missing part gets a default that depends on its place.

use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeStructVariant;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::file::{self, Door, Normal, Point, ResolverRule, WallFile};
use crate::{Rates, WorkRates};

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
    work: WorkRates,
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
        let whole = |part: PartOfRates, default: Rates| Rates {
            per_step: part.per_step.unwrap_or(default.per_step),
            per_metre: part.per_metre.unwrap_or(default.per_metre),
            per_second: part.per_second.unwrap_or(default.per_second),
        };
        let default = Self::default();
        let (energy, hp) = (whole(written.energy, default.energy), whole(written.hp, default.hp));
        Self { unit: written.unit, energy, hp, work: written.work }
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
        deserializer.deserialize_any(WallVisitor)
    }
}

struct WallVisitor;

impl<'de> Visitor<'de> for WallVisitor {
    type Value = WallFile;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("(from: (x, y), to: (x, y)), or short ((x, y), (x, y))")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut ends: A) -> Result<WallFile, A::Error> {
        let missing = |count| A::Error::invalid_length(count, &self);
        let from = ends.next_element()?.ok_or_else(|| missing(0))?;
        let to = ends.next_element()?.ok_or_else(|| missing(1))?;
        Ok(WallFile { from, to, thickness_m: thickness_m(), doors: Vec::new() })
    }

    fn visit_map<A: MapAccess<'de>>(self, fields: A) -> Result<WallFile, A::Error> {
        let Wall { from, to, thickness_m, doors } = Wall::deserialize(MapAccessDeserializer::new(fields))?;
        Ok(WallFile { from, to, thickness_m, doors })
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
    use ron_tree::Node;

    use super::*;
    use crate::RightOfWay;

    fn value<T: for<'de> Deserialize<'de>>(text: &str) -> Result<T, String> {
        Node::parse(text).unwrap().read_as().map_err(|problem| problem.to_string())
    }

    #[test]
    fn what_is_left_out_has_the_default_of_its_place() {
        let costs: file::Costs = value("(hp: (per_second: 2.0))").unwrap();
        let default = file::Costs::default();
        assert_eq!(costs.energy, default.energy);
        assert_eq!(costs.hp, Rates { per_second: 2.0, ..default.hp });
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
            let written = Node::of(&rule).unwrap().to_string();
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
