//! Writes values as trees.

use serde::ser::{self, Serialize, Serializer};

use crate::de::NODE;
use crate::node::{Node, Value};
use crate::problem::Problem;

type Unwritten = Box<Problem>;

impl Node {
    /// The tree of a value.
    ///
    /// # Errors
    /// A type refuses to be written.
    pub fn of(value: &impl Serialize) -> Result<Self, Box<Problem>> {
        value.serialize(Writer)
    }
}

impl Serialize for Node {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_newtype_struct(NODE, &self.to_string())
    }
}

impl ser::Error for Box<Problem> {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        <Self as serde::de::Error>::custom(message)
    }
}

/// A number with a fraction, or with `.0`.
fn float(value: f64) -> Node {
    let whole = if value.fract() == 0.0 { ".0" } else { "" };
    Node::word(format!("{value}{whole}"))
}

struct Writer;

/// Values that are written as one word.
macro_rules! words {
    ($($method:ident $type:ty;)+) => {
        $(fn $method(self, value: $type) -> Result<Node, Unwritten> {
            Ok(Node::word(value.to_string()))
        })+
    };
}

impl Serializer for Writer {
    type Ok = Node;
    type Error = Unwritten;
    type SerializeSeq = Sequence;
    type SerializeTuple = Sequence;
    type SerializeTupleStruct = Sequence;
    type SerializeTupleVariant = Sequence;
    type SerializeMap = Mapping;
    type SerializeStruct = Mapping;
    type SerializeStructVariant = Mapping;

    words! {
        serialize_bool bool;
        serialize_i8 i8;
        serialize_i16 i16;
        serialize_i32 i32;
        serialize_i64 i64;
        serialize_u8 u8;
        serialize_u16 u16;
        serialize_u32 u32;
        serialize_u64 u64;
    }

    fn serialize_f32(self, value: f32) -> Result<Node, Unwritten> {
        Ok(float(value.into()))
    }

    fn serialize_f64(self, value: f64) -> Result<Node, Unwritten> {
        Ok(float(value))
    }

    fn serialize_char(self, value: char) -> Result<Node, Unwritten> {
        self.serialize_str(value.encode_utf8(&mut [0; 4]))
    }

    fn serialize_str(self, value: &str) -> Result<Node, Unwritten> {
        Ok(Value::Text(value.into()).into())
    }

    fn serialize_bytes(self, _: &[u8]) -> Result<Node, Unwritten> {
        Err(ser::Error::custom("bytes are not written in RON"))
    }

    fn serialize_none(self) -> Result<Node, Unwritten> {
        Ok(Node::word("None"))
    }

    fn serialize_some<T: ?Sized + Serialize>(self, value: &T) -> Result<Node, Unwritten> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<Node, Unwritten> {
        Ok(Value::Tuple("".into(), Vec::new()).into())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<Node, Unwritten> {
        self.serialize_unit()
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, name: &'static str) -> Result<Node, Unwritten> {
        Ok(Node::word(name))
    }

    fn serialize_newtype_struct<T: ?Sized + Serialize>(
        self,
        name: &'static str,
        value: &T,
    ) -> Result<Node, Unwritten> {
        let node = value.serialize(Self)?;
        match node.as_text().filter(|_| name == NODE) {
            Some(text) => Node::parse(text).map_err(ser::Error::custom),
            None if name == NODE => Ok(node),
            None => Ok(Value::Tuple("".into(), vec![node]).into()),
        }
    }

    fn serialize_newtype_variant<T: ?Sized + Serialize>(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        value: &T,
    ) -> Result<Node, Unwritten> {
        Ok(Value::Tuple(name.into(), vec![value.serialize(Self)?]).into())
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Sequence, Unwritten> {
        Ok(Sequence { name: None, entries: Vec::new() })
    }

    fn serialize_tuple(self, _: usize) -> Result<Sequence, Unwritten> {
        Ok(Sequence { name: Some(""), entries: Vec::new() })
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Sequence, Unwritten> {
        self.serialize_tuple(0)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        _: usize,
    ) -> Result<Sequence, Unwritten> {
        Ok(Sequence { name: Some(name), entries: Vec::new() })
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Mapping, Unwritten> {
        Ok(Mapping { name: None, fields: Vec::new(), key: None })
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Mapping, Unwritten> {
        Ok(Mapping { name: Some(""), fields: Vec::new(), key: None })
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        _: usize,
    ) -> Result<Mapping, Unwritten> {
        Ok(Mapping { name: Some(name), fields: Vec::new(), key: None })
    }
}

/// A list, or a tuple with its name.
struct Sequence {
    name: Option<&'static str>,
    entries: Vec<Node>,
}

impl Sequence {
    fn push<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Unwritten> {
        self.entries.push(value.serialize(Writer)?);
        Ok(())
    }

    fn finish(self) -> Node {
        match self.name {
            Some(name) => Value::Tuple(name.into(), self.entries).into(),
            None => Value::List(self.entries).into(),
        }
    }
}

/// A map, or a struct with its name.
struct Mapping {
    name: Option<&'static str>,
    fields: Vec<(Node, Node)>,
    key: Option<Node>,
}

impl Mapping {
    fn push<T: ?Sized + Serialize>(&mut self, name: Node, value: &T) -> Result<(), Unwritten> {
        self.fields.push((name, value.serialize(Writer)?));
        Ok(())
    }

    fn finish(self) -> Node {
        match self.name {
            Some(name) if self.fields.is_empty() => Value::Tuple(name.into(), Vec::new()).into(),
            Some(name) => Value::Struct(name.into(), self.fields).into(),
            None => Value::Map(self.fields).into(),
        }
    }
}

/// Implements a trait of serde for entries.
macro_rules! entries {
    ($($trait:ident $method:ident;)+) => {
        $(impl ser::$trait for Sequence {
            type Ok = Node;
            type Error = Unwritten;

            fn $method<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Unwritten> {
                self.push(value)
            }

            fn end(self) -> Result<Node, Unwritten> {
                Ok(self.finish())
            }
        })+
    };
}

entries! {
    SerializeSeq serialize_element;
    SerializeTuple serialize_element;
    SerializeTupleStruct serialize_field;
    SerializeTupleVariant serialize_field;
}

/// Implements a trait of serde for fields.
macro_rules! fields {
    ($($trait:ident)+) => {
        $(impl ser::$trait for Mapping {
            type Ok = Node;
            type Error = Unwritten;

            fn serialize_field<T: ?Sized + Serialize>(
                &mut self,
                name: &'static str,
                value: &T,
            ) -> Result<(), Unwritten> {
                self.push(Node::word(name), value)
            }

            fn end(self) -> Result<Node, Unwritten> {
                Ok(self.finish())
            }
        })+
    };
}

fields! { SerializeStruct SerializeStructVariant }

impl ser::SerializeMap for Mapping {
    type Ok = Node;
    type Error = Unwritten;

    fn serialize_key<T: ?Sized + Serialize>(&mut self, key: &T) -> Result<(), Unwritten> {
        self.key = Some(key.serialize(Writer)?);
        Ok(())
    }

    fn serialize_value<T: ?Sized + Serialize>(&mut self, value: &T) -> Result<(), Unwritten> {
        let key = self.key.take().ok_or_else(|| <Unwritten as ser::Error>::custom("a key is missing"))?;
        self.push(key, value)
    }

    fn end(self) -> Result<Node, Unwritten> {
        Ok(self.finish())
    }
}
