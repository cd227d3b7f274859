//! Reads types from a tree.

use std::iter::Enumerate;
use std::slice::Iter;

use serde::de::{self, DeserializeSeed, Deserializer, Error, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};

use crate::node::{Node, Value};
use crate::parse::is_number;
use crate::problem::{MUST_BE_GIVEN, NO_FIELD, Problem};

/// The name of a newtype that stands for the node itself.
pub(crate) const NODE: &str = "$ron_tree::Node";

type Misread = Box<Problem>;

impl Node {
    /// Reads a type. `Some` may be left out, and a variant that holds a struct has the fields of the struct
    /// in its own brackets, or no brackets if all are left out.
    ///
    /// # Errors
    /// The first value that does not fit, with its path, line, rule and value.
    pub fn read_as<'n, T: Deserialize<'n>>(&'n self) -> Result<T, Box<Problem>> {
        T::deserialize(Reader::of(self))
    }
}

impl<'de> Deserialize<'de> for Node {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Printed;
        impl Visitor<'_> for Printed {
            type Value = Node;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a value in RON")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Node, E> {
                let mut node = Node::parse(text).map_err(|error| E::custom(error.message))?;
                node.put_at(crate::node::Place::default());
                Ok(node)
            }
        }
        deserializer.deserialize_newtype_struct(NODE, Printed)
    }
}

/// Reads one node.
#[derive(Clone, Copy)]
struct Reader<'de> {
    node: &'de Node,
    /// Whether the name before the brackets is that of a variant which holds the struct to be read.
    is_content: bool,
}

/// Whole numbers.
macro_rules! whole {
    ($($method:ident $visit:ident $type:ty;)+) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
            let number = self.whole(|number| <$type>::try_from(number).ok())?;
            visitor.$visit(number).map_err(|error| self.told(error))
        })+
    };
}

impl<'de> Reader<'de> {
    fn of(node: &'de Node) -> Self {
        Self { node, is_content: false }
    }

    fn wrong<T>(self, rule: impl Into<String>) -> Result<T, Misread> {
        let problem = Problem::new("", rule, self.node);
        Err(self.told(Box::new(problem)))
    }

    /// The error with the line and the value of this node, unless it has those of a node within.
    fn told(self, mut error: Misread) -> Misread {
        let line = self.node.place.line as usize;
        error.line = error.line.or((line > 0).then_some(line));
        let is_of_name = [NO_FIELD, MUST_BE_GIVEN].contains(&error.rule.as_str());
        if error.found.is_empty() && error.field.is_empty() && !is_of_name {
            error.found = Problem::new("", "", self.node).found;
        }
        error
    }

    /// The entries, if the node is in round brackets without a name, or with this name.
    fn tuple(self, name: &str) -> Result<&'de [Node], Misread> {
        match &self.node.value {
            Value::Tuple(own, entries) if own.is_empty() || **own == *name => Ok(entries),
            _ => self.wrong("must be in round brackets: (...)"),
        }
    }

    fn visit_entries<V: Visitor<'de>>(self, entries: &'de [Node], visitor: V) -> Result<V::Value, Misread> {
        let mut rest = Entries(entries.iter().enumerate());
        let value = visitor.visit_seq(&mut rest).map_err(|error| self.told(error))?;
        match rest.0.next() {
            None => Ok(value),
            Some((count, _)) => self.wrong(format!("must have {count} entries")),
        }
    }

    fn visit_fields<V: Visitor<'de>>(
        self,
        fields: &'de [(Node, Node)],
        visitor: V,
    ) -> Result<V::Value, Misread> {
        visitor.visit_map(Fields { rest: fields.iter(), last: None }).map_err(|error| self.told(error))
    }

    fn exactly<V: Visitor<'de>>(
        self,
        entries: &'de [Node],
        count: usize,
        visitor: V,
    ) -> Result<V::Value, Misread> {
        if entries.len() == count {
            return self.visit_entries(entries, visitor);
        }
        let noun = if count == 1 { "entry" } else { "entries" };
        self.wrong(format!("must have {count} {noun}"))
    }

    fn number(self) -> Result<f64, Misread> {
        match self.node.as_word() {
            Some(word) if is_of_other_base(word) => self.wrong("must be a decimal number"),
            word => word.and_then(float).map_or_else(|| self.wrong("must be a number"), Ok),
        }
    }

    fn whole<T>(self, fit: impl Fn(i128) -> Option<T>) -> Result<T, Misread> {
        let Some(number) = self.node.as_word().and_then(integer) else {
            return self.wrong("must be a whole number");
        };
        match fit(number) {
            Some(number) => Ok(number),
            None if number < 0 => self.wrong("must be a whole number of at least 0"),
            None => self.wrong("must be a smaller whole number"),
        }
    }

    fn text<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        let Some(text) = self.node.as_text() else { return self.wrong("must be a text in double quotes") };
        visitor.visit_borrowed_str(text).map_err(|error| self.told(error))
    }
}

impl<'de> Deserializer<'de> for Reader<'de> {
    type Error = Misread;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        match &self.node.value {
            Value::Word(word) => match &**word {
                "true" | "false" => self.deserialize_bool(visitor),
                _ if integer(word).is_some_and(|number| i64::try_from(number).is_ok()) => {
                    self.deserialize_i64(visitor)
                }
                _ if float(word).is_some() => self.deserialize_f64(visitor),
                _ => self.deserialize_enum("", &[], visitor),
            },
            Value::Text(_) => self.text(visitor),
            Value::List(entries) => self.visit_entries(entries, visitor),
            Value::Map(fields) => self.visit_fields(fields, visitor),
            Value::Tuple(name, entries) if name.is_empty() => self.visit_entries(entries, visitor),
            Value::Struct(name, fields) if name.is_empty() => self.visit_fields(fields, visitor),
            Value::Tuple(..) | Value::Struct(..) => self.deserialize_enum("", &[], visitor),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        match self.node.as_word() {
            Some("true") => visitor.visit_bool(true).map_err(|error| self.told(error)),
            Some("false") => visitor.visit_bool(false).map_err(|error| self.told(error)),
            _ => self.wrong("must be true or false"),
        }
    }

    whole! {
        deserialize_i8 visit_i8 i8;
        deserialize_i16 visit_i16 i16;
        deserialize_i32 visit_i32 i32;
        deserialize_i64 visit_i64 i64;
        deserialize_u8 visit_u8 u8;
        deserialize_u16 visit_u16 u16;
        deserialize_u32 visit_u32 u32;
        deserialize_u64 visit_u64 u64;
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        visitor.visit_f64(self.number()?).map_err(|error| self.told(error))
    }

    fn deserialize_char<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        self.text(visitor)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        self.text(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        self.text(visitor)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        self.text(visitor)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        self.text(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        match &self.node.value {
            Value::Word(word) if &**word == "None" => visitor.visit_none(),
            Value::Tuple(name, entries) if &**name == "Some" && entries.len() == 1 => {
                visitor.visit_some(Self::of(&entries[0]))
            }
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        let entries = self.tuple("")?;
        if entries.is_empty() { visitor.visit_unit() } else { self.wrong("must be ()") }
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Misread> {
        if self.node.as_word() == Some(name) { visitor.visit_unit() } else { self.deserialize_unit(visitor) }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Misread> {
        match &self.node.value {
            _ if name == NODE => visitor.visit_string(self.node.to_string()),
            Value::Tuple(own, entries) if entries.len() == 1 && (own.is_empty() || **own == *name) => {
                visitor.visit_newtype_struct(Self::of(&entries[0]))
            }
            _ => visitor.visit_newtype_struct(self),
        }
        .map_err(|error| self.told(error))
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        match &self.node.value {
            Value::List(entries) => self.visit_entries(entries, visitor),
            _ => self.wrong("must be a list in square brackets: [...]"),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Misread> {
        self.exactly(self.tuple("")?, count, visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        count: usize,
        visitor: V,
    ) -> Result<V::Value, Misread> {
        self.exactly(self.tuple(name)?, count, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        match &self.node.value {
            Value::Map(fields) => self.visit_fields(fields, visitor),
            _ => self.wrong("must be a map in curly brackets: {\"name\": ...}"),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Misread> {
        let is_its = |own: &str| own.is_empty() || own == name || self.is_content;
        match &self.node.value {
            Value::Struct(own, fields) if is_its(own) => self.visit_fields(fields, visitor),
            Value::Tuple(own, entries) if is_its(own) && entries.is_empty() => {
                self.visit_fields(&[], visitor)
            }
            Value::Word(_) if self.is_content => self.visit_fields(&[], visitor),
            _ => self.wrong("must be in round brackets: (...)"),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Misread> {
        match &self.node.value {
            Value::Word(name) | Value::Tuple(name, _) | Value::Struct(name, _) if !name.is_empty() => {
                visitor.visit_enum(Variant { reader: self, name }).map_err(|error| self.told(error))
            }
            _ => self.wrong("must be a name without quotes"),
        }
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        match &self.node.value {
            Value::Word(name) | Value::Text(name) => visitor.visit_borrowed_str(name),
            _ => self.wrong("must be a name without quotes"),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        visitor.visit_unit()
    }
}

/// A whole number as in the text.
fn integer(word: &str) -> Option<i128> {
    let word = word.replace('_', "");
    let digits = word.trim_start_matches(['+', '-']);
    let number = match digits.get(..2) {
        Some("0x") => i128::from_str_radix(&digits[2..], 16),
        Some("0b") => i128::from_str_radix(&digits[2..], 2),
        Some("0o") => i128::from_str_radix(&digits[2..], 8),
        _ => digits.parse(),
    };
    number.ok().map(|number| if word.starts_with('-') { -number } else { number })
}

/// Whether a word is a whole number that is written in hexadecimal, binary or octal digits.
fn is_of_other_base(word: &str) -> bool {
    !is_number(word.trim_start_matches(['+', '-'])) && integer(word).is_some()
}

/// A number as in the text.
fn float(word: &str) -> Option<f64> {
    if !is_number(word.trim_start_matches(['+', '-'])) {
        return integer(word).map(|number| number as f64);
    }
    word.replace('_', "").parse().ok()
}

struct Entries<'de>(Enumerate<Iter<'de, Node>>);

impl<'de> de::SeqAccess<'de> for &mut Entries<'de> {
    type Error = Misread;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Misread> {
        let Some((i, entry)) = self.0.next() else { return Ok(None) };
        seed.deserialize(Reader::of(entry)).map(Some).map_err(|error| error.within(&format!("[{i}]")))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

struct Fields<'de> {
    rest: Iter<'de, (Node, Node)>,
    last: Option<&'de (Node, Node)>,
}

impl<'de> de::MapAccess<'de> for Fields<'de> {
    type Error = Misread;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Misread> {
        self.last = self.rest.next();
        let Some((name, value)) = self.last else { return Ok(None) };
        let line = (value.place.line > 0).then_some(value.place.line as usize);
        let read = seed.deserialize(Reader::of(name));
        read.map(Some).map_err(|error| Box::new(Problem { line: error.line.or(line), ..*error }))
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Misread> {
        let Some((name, value)) = self.last else { return Err(Misread::custom("a value is missing")) };
        seed.deserialize(Reader::of(value)).map_err(|error| error.within(&name.to_string()))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

struct Variant<'de> {
    reader: Reader<'de>,
    name: &'de str,
}

/// Reads the name of a variant.
struct Name<'de>(&'de str);

impl<'de> Deserializer<'de> for Name<'de> {
    type Error = Misread;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Misread> {
        visitor.visit_borrowed_str(self.0)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

impl<'de> de::EnumAccess<'de> for Variant<'de> {
    type Error = Misread;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Misread> {
        Ok((seed.deserialize(Name(self.name))?, self))
    }
}

impl<'de> de::VariantAccess<'de> for Variant<'de> {
    type Error = Misread;

    fn unit_variant(self) -> Result<(), Misread> {
        match &self.reader.node.value {
            Value::Word(_) => Ok(()),
            _ => self.reader.wrong(format!("must be {} without brackets", self.name)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Misread> {
        match self.reader.node.entries() {
            [one] => seed.deserialize(Reader::of(one)).map_err(|error| error.within("[0]")),
            _ => seed.deserialize(Reader { is_content: true, ..self.reader }).map_err(|mut error| {
                if error.field.is_empty() {
                    "must have 1 entry".clone_into(&mut error.rule); // it is no struct
                }
                error
            }),
        }
    }

    fn tuple_variant<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Misread> {
        self.reader.exactly(self.reader.tuple(self.name)?, count, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Misread> {
        Reader { is_content: true, ..self.reader }.deserialize_struct("", fields, visitor)
    }
}
