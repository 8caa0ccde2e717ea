//! Where in a scene file a field stands: from its path to a line, and back.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A scene file's text and the places of everything in it.
pub struct Document<'a> {
    text: &'a str,
    fields: Vec<Field>,
}

struct Field {
    path: String,
    key: Range<usize>,
    value: Range<usize>,
}

/// A place in a file as people count: from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The whole line.
    pub text: String,
    /// How many characters of it are meant, at least 1.
    pub length: usize,
}

impl<'a> Document<'a> {
    /// Reads the places of all fields; of a text that is not TOML, none.
    pub fn new(text: &'a str) -> Self {
        let mut fields = Vec::new();
        if let Ok(root) = DeTable::parse(text) {
            collect_table("", root.get_ref(), &mut fields);
        }
        Self { text, fields }
    }

    /// The path of the field that a byte range lies in, as in `medium[0].profile`.
    pub fn path_at(&self, span: &Range<usize>) -> Option<&str> {
        let contains = |range: &Range<usize>| range.start <= span.start && span.end <= range.end;
        let hits = self.fields.iter().flat_map(|field| {
            [&field.key, &field.value].into_iter().filter(|range| contains(range)).map(move |range| (range, field))
        });
        hits.min_by_key(|(range, _)| range.len()).map(|(_, field)| field.path.as_str())
    }

    /// The bytes of a field's value, or of the nearest table around it where the file does not say it.
    pub fn span_of(&self, path: &str) -> Range<usize> {
        let mut path = path;
        loop {
            if let Some(field) = self.fields.iter().find(|field| field.path == path) {
                return field.value.clone();
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => return 0..0,
            }
        }
    }

    /// A byte range as a line and column.
    pub fn place(&self, span: &Range<usize>) -> Place {
        let start = span.start.min(self.text.len());
        let line_start = self.text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let text = self.text[line_start..].lines().next().unwrap_or_default().to_owned();
        let column = self.text[line_start..start].chars().count() + 1;
        let meant = self.text[start..span.end.clamp(start, self.text.len())].lines().next().unwrap_or_default();
        let line = self.text[..line_start].matches('\n').count() + 1;
        Place { line, column, text, length: meant.chars().count().max(1) }
    }
}

fn collect_table(prefix: &str, table: &DeTable<'_>, fields: &mut Vec<Field>) {
    for (key, value) in table {
        let separator = if prefix.is_empty() { "" } else { "." };
        let path = format!("{prefix}{separator}{}", key.get_ref());
        collect(path, key.span(), value, fields);
    }
}

fn collect(path: String, key: Range<usize>, value: &Spanned<DeValue<'_>>, fields: &mut Vec<Field>) {
    match value.get_ref() {
        DeValue::Table(table) => collect_table(&path, table, fields),
        DeValue::Array(array) => {
            for (index, element) in array.iter().enumerate() {
                collect(format!("{path}[{index}]"), element.span(), element, fields);
            }
        }
        _ => {}
    }
    fields.push(Field { path, key, value: value.span() });
}

#[cfg(test)]
mod tests {
    use super::Document;

    const TEXT: &str = "a = 1\n[camera]\nwidth = 0\n[[medium]]\nprofile = { layer = { top_m = -1 } }\n";

    #[test]
    fn a_field_is_found_by_its_path_and_its_path_by_its_place() {
        let document = Document::new(TEXT);
        for (path, line, column) in [("a", 1, 5), ("camera.width", 3, 9), ("medium[0].profile.layer.top_m", 5, 31)] {
            let span = document.span_of(path);
            let place = document.place(&span);
            assert_eq!((place.line, place.column), (line, column), "{path}");
            assert_eq!(document.path_at(&span), Some(path));
        }
    }

    #[test]
    fn a_field_that_is_not_there_is_placed_at_the_table_that_lacks_it() {
        let document = Document::new(TEXT);
        assert_eq!(document.place(&document.span_of("camera.height")).line, 2);
        assert_eq!(document.place(&document.span_of("sun.elevation_deg")).line, 1);
    }

    #[test]
    fn places_count_characters_not_bytes() {
        let document = Document::new("name = \"wörld\" # ü\nb = 1");
        let start = "name = \"wö".len();
        let place = document.place(&(start..start + 1));
        assert_eq!((place.line, place.column), (1, 11));
    }
}
