//! The tree of a text.

/// A value, and its place in the text. Two nodes are equal if their values are, wherever they stand.
#[derive(Debug, Clone)]
pub struct Node {
    /// Where it stands.
    pub place: Place,
    /// The value.
    pub value: Value,
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

/// A place in a text. That of a node which comes from no text is the default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    /// Line, from 1; 0 for a node which comes from no text. For a field and an entry, the line on which it
    /// begins with its name.
    pub line: u32,
    /// First byte of the value.
    pub start: u32,
    /// First byte after the value.
    pub end: u32,
}

/// What a node holds. A name before round brackets is empty if there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number, a name, `true` or `false`, as in the text.
    Word(Box<str>),
    /// What stands between quotes, without escapes.
    Text(Box<str>),
    /// `[...]`.
    List(Vec<Node>),
    /// `Name(...)` with entries.
    Tuple(Box<str>, Vec<Node>),
    /// `Name(...)` with fields, each with its name.
    Struct(Box<str>, Vec<(Node, Node)>),
    /// `{...}`: keys and values.
    Map(Vec<(Node, Node)>),
}

impl From<Value> for Node {
    fn from(value: Value) -> Self {
        Self { place: Place::default(), value }
    }
}

impl Node {
    /// A node with a number or a name, from no text.
    pub fn word(word: impl Into<Box<str>>) -> Self {
        Value::Word(word.into()).into()
    }

    /// The word, if the node is one.
    pub fn as_word(&self) -> Option<&str> {
        match &self.value {
            Value::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The text, if the node is one.
    pub fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The fields of a struct or a map.
    pub fn fields(&self) -> &[(Self, Self)] {
        match &self.value {
            Value::Struct(_, fields) | Value::Map(fields) => fields,
            _ => &[],
        }
    }

    /// The entries of a list or a tuple.
    pub fn entries(&self) -> &[Self] {
        match &self.value {
            Value::List(entries) | Value::Tuple(_, entries) => entries,
            _ => &[],
        }
    }

    /// The node inside `Some(...)`; the node itself, if it is not in `Some`.
    pub fn peeled(&self) -> &Self {
        match &self.value {
            Value::Tuple(name, entries) if entries.len() == 1 && &**name == "Some" => entries[0].peeled(),
            _ => self,
        }
    }

    /// The node at a position: a field or an entry. Looks into `Some(...)`.
    pub(crate) fn child(&self, position: usize) -> Option<&Self> {
        let node = self.peeled();
        let field = node.fields().get(position).map(|(_, value)| value);
        field.or_else(|| node.entries().get(position))
    }

    /// The same, to be changed.
    pub(crate) fn child_mut(&mut self, position: usize) -> Option<&mut Self> {
        match &mut self.peeled_mut().value {
            Value::List(entries) | Value::Tuple(_, entries) => entries.get_mut(position),
            Value::Struct(_, fields) | Value::Map(fields) => fields.get_mut(position).map(|(_, value)| value),
            Value::Word(_) | Value::Text(_) => None,
        }
    }

    /// The node inside `Some(...)`, to be changed.
    pub fn peeled_mut(&mut self) -> &mut Self {
        if std::ptr::eq(self.peeled(), self) {
            return self;
        }
        match self.value {
            Value::Tuple(_, ref mut entries) => entries[0].peeled_mut(),
            _ => self,
        }
    }

    /// The nodes directly in the node, keys of maps aside.
    pub fn children(&self) -> impl Iterator<Item = &Self> {
        self.fields().iter().map(|(_, value)| value).chain(self.entries())
    }

    /// The nodes directly in the node, to be changed, each with the segment of its path: `.name` or `[0]`.
    pub fn children_mut(&mut self) -> Vec<(String, &mut Self)> {
        match &mut self.value {
            Value::List(entries) | Value::Tuple(_, entries) => {
                entries.iter_mut().enumerate().map(|(i, entry)| (format!("[{i}]"), entry)).collect()
            }
            Value::Struct(_, fields) | Value::Map(fields) => {
                fields.iter_mut().map(|(name, value)| (format!(".{name}"), value)).collect()
            }
            Value::Word(_) | Value::Text(_) => Vec::new(),
        }
    }

    /// Takes a field out of a struct or a map, and returns its value.
    pub fn remove(&mut self, name: &str) -> Option<Self> {
        let (Value::Struct(_, fields) | Value::Map(fields)) = &mut self.value else { return None };
        let at = fields.iter().position(|(field, _)| field.as_word() == Some(name))?;
        Some(fields.remove(at).1)
    }

    /// Moves the node and all within to one place.
    pub fn put_at(&mut self, place: Place) {
        self.place = place;
        match &mut self.value {
            Value::List(entries) | Value::Tuple(_, entries) => {
                entries.iter_mut().for_each(|entry| entry.put_at(place));
            }
            Value::Struct(_, fields) | Value::Map(fields) => {
                fields.iter_mut().for_each(|(name, value)| {
                    name.put_at(place);
                    value.put_at(place);
                });
            }
            Value::Word(_) | Value::Text(_) => {}
        }
    }

    /// The bytes of the text that the node takes.
    pub fn bytes(&self) -> std::ops::Range<usize> {
        self.place.start as usize..self.place.end as usize
    }
}
