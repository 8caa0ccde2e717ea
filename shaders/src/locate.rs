//! Finds the place in a WGSL file that a composer's error speaks of.

use std::collections::{BTreeMap, HashMap};
use std::error::Error;
use std::ops::Range;

use naga::Span;
use naga_oil::compose::{Composer, ComposerError, ComposerErrorInner};

use crate::compose::undecorated;
use crate::{Location, ShaderError};

/// naga_oil keeps a module's index above this bit of a span (`SPAN_SHIFT`, which it does not publish).
const SPAN_MODULE_SHIFT: usize = 21;

/// The files as they were written, by their paths; naga_oil's errors count in preprocessed text.
pub(crate) struct Originals<'a>(HashMap<&'a str, &'a str>);

impl<'a> Originals<'a> {
    pub(crate) fn new(modules: &'a BTreeMap<&str, (String, &'a str)>, file: &'a str, text: &'a str) -> Self {
        let modules = modules.values().map(|(path, text)| (path.as_str(), *text));
        Self(modules.chain([(file, text)]).collect())
    }
}

/// An error with the file, line and column it speaks of.
pub(crate) fn wgsl_error(composer: &Composer, error: &ComposerError, originals: &Originals) -> ShaderError {
    let file = error.source.path(composer).clone();
    let original = originals.0.get(file.as_str()).copied().unwrap_or_default();
    let preprocessed = error.source.source(composer);
    let location = match &error.inner {
        ComposerErrorInner::InvalidWgslDirective { position: line_index, .. } => {
            at_line(file, original, *line_index, 0)
        }
        inner => at_offset(file, original, &preprocessed, place(inner, error.source.offset())),
    };
    ShaderError::Wgsl { location, message: undecorated(&message(&error.inner)) }
}

/// What is wrong, with its causes.
fn message(error: &ComposerErrorInner) -> String {
    match error {
        ComposerErrorInner::WgslParseError(error) => {
            error.notes().fold(error.message().to_owned(), |text, note| format!("{text}; {note}"))
        }
        ComposerErrorInner::ShaderValidationError(error) | ComposerErrorInner::HeaderValidationError(error) => {
            let mut text = error.to_string();
            let mut cause = error.as_inner().source();
            while let Some(error) = cause {
                text.push_str(&format!(": {error}"));
                cause = error.source();
            }
            text
        }
        other => other.to_string(),
    }
}

/// The bytes of the preprocessed source that an error speaks of. `header` is the length of what naga_oil puts before
/// the source when naga reads it.
fn place(error: &ComposerErrorInner, header: usize) -> Range<usize> {
    use ComposerErrorInner as E;
    let within = |span: Option<Span>| {
        let mask = (1 << SPAN_MODULE_SHIFT) - 1;
        let range = span.and_then(Span::to_range).unwrap_or(0..0);
        (range.start & mask).saturating_sub(header)..(range.end & mask).saturating_sub(header)
    };
    match error {
        E::WgslParseError(error) => within(error.labels().next().map(|(span, _)| span)),
        E::ShaderValidationError(error) | E::HeaderValidationError(error) => within(innermost(error)),
        E::InvalidIdentifier { at, .. } => within(Some(*at)),
        E::DecorationInSource(range) => range.clone(),
        E::ImportParseError(_, at)
        | E::ImportNotFound(_, at)
        | E::NotEnoughEndIfs(at)
        | E::TooManyEndIfs(at)
        | E::ElseWithoutCondition(at)
        | E::DefineInModule(at)
        | E::UnknownShaderDefOperator { pos: at, .. }
        | E::UnknownShaderDef { pos: at, .. }
        | E::InvalidShaderDefComparisonValue { pos: at, .. }
        | E::OverrideNotVirtual { pos: at, .. }
        | E::InvalidShaderDefDefinitionValue { pos: at, .. } => *at..*at,
        _ => 0..0,
    }
}

/// The shortest span in the file of the last one, by which naga_oil names the file: the others are what encloses it.
fn innermost(error: &naga::WithSpan<naga::valid::ValidationError>) -> Option<Span> {
    let module = |span: &Span| span.to_range().map(|range| range.start >> SPAN_MODULE_SHIFT);
    let file = error.spans().last().and_then(|(span, _)| module(span))?;
    let in_file = error.spans().map(|(span, _)| *span).filter(|span| module(span) == Some(file));
    in_file.min_by_key(|span| span.to_range().map_or(0, |range| range.len()))
}

/// Preprocessing keeps the lines of a file but not their lengths, so the column is looked for anew: as the same
/// occurrence of the same text in the original line.
fn at_offset(file: String, original: &str, preprocessed: &str, range: Range<usize>) -> Location {
    let start = range.start.min(preprocessed.len());
    let before = preprocessed.get(..start).unwrap_or(preprocessed);
    let line_index = before.matches('\n').count();
    let line_before = before.rsplit('\n').next().unwrap_or_default();
    let text = undecorated(preprocessed.get(start..range.end).unwrap_or_default());
    let text = text.lines().next().unwrap_or_default();
    let source_line = original.lines().nth(line_index).unwrap_or_default();
    let column = if source_line.starts_with(line_before) || text.is_empty() {
        line_before.len()
    } else {
        let occurrence = undecorated(line_before).matches(text).count();
        source_line.match_indices(text).nth(occurrence).map_or(0, |(at, _)| at)
    };
    at_line(file, original, line_index, column.min(source_line.len()))
}

fn at_line(file: String, original: &str, line_index: usize, column_index: usize) -> Location {
    let source_line = original.lines().nth(line_index).unwrap_or_default().to_owned();
    Location { file, line: line_index + 1, column: column_index + 1, source_line }
}
