//! Names and comments of the WGSL, carried over to what naga writes.

use std::collections::{BTreeMap, BTreeSet};

use crate::Sources;
use crate::compose::{needed_modules, undecorated};

/// Takes naga_oil's decorations off all names. What then shares a name is told apart by naga's writers.
pub(super) fn make_readable(module: &mut naga::Module) {
    let plain = |name: &mut Option<String>| {
        if let Some(name) = name {
            *name = undecorated(name);
        }
    };
    module.functions.iter_mut().for_each(|(_, function)| plain(&mut function.name));
    module.global_variables.iter_mut().for_each(|(_, variable)| plain(&mut variable.name));
    module.constants.iter_mut().for_each(|(_, constant)| plain(&mut constant.name));
    let types: Vec<_> = module.types.iter().map(|(handle, ty)| (handle, ty.clone())).collect();
    for (handle, mut ty) in types {
        let before = ty.name.clone();
        plain(&mut ty.name);
        if ty.name != before {
            module.types.replace(handle, ty);
        }
    }
}

/// Replaces one identifier by another, unless that is taken already.
pub(super) fn rename(text: &str, from: &str, to: &str) -> String {
    if words(text).any(|word| word == to) { text.to_owned() } else { replace_words(text, from, to) }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}

fn replace_words(text: &str, from: &str, to: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(from) {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let end = at + from.len();
        let whole = !rest[..at].ends_with(is_word) && !rest[end..].starts_with(is_word);
        result.push_str(&rest[..at]);
        result.push_str(if whole { to } else { from });
        rest = &rest[end..];
    }
    result + rest
}

/// Puts the WGSL's comment above each function that has one there, and gives arguments and variables their own names.
pub(super) fn restored(text: &str, sources: &Sources, pass: &str) -> String {
    let comments = comments(sources, pass);
    let global = global_words(text);
    let mut result = String::with_capacity(text.len());
    let mut function: Vec<&str> = Vec::new();
    for line in text.lines() {
        if let Some(comment) = defined_function(line).and_then(|name| comments.get(name)) {
            result.push_str(comment);
        }
        if defined_function(line).is_some() || !function.is_empty() {
            function.push(line);
        }
        if function.is_empty() {
            result.push_str(line);
            result.push('\n');
        } else if line.starts_with('}') {
            result.push_str(&with_own_names(&std::mem::take(&mut function).join("\n"), text, &global));
            result.push('\n');
        }
    }
    result
}

/// Words that mean something outside of functions, and names of functions; members of structs are in nobody's way.
fn global_words(text: &str) -> BTreeSet<&str> {
    let mut global = BTreeSet::new();
    let mut inside = false;
    for line in text.lines() {
        if let Some(name) = defined_function(line) {
            global.insert(name);
            inside = true;
        } else if !inside {
            global.extend(words(line));
            inside = line.starts_with("struct ") && line.ends_with('{');
        }
        inside &= !line.starts_with('}');
    }
    global
}

/// naga numbers a name that another function has already (`mu_3`). Within its function it needs no number, unless the
/// plain name means something else there.
fn with_own_names(function: &str, text: &str, global: &BTreeSet<&str>) -> String {
    let numbered = |word: &&str| {
        let base = word.trim_end_matches(|c: char| c.is_ascii_digit());
        base.len() < word.len() && base.ends_with('_') && base.len() > 1 && !word.starts_with('_')
    };
    let mut own = function.to_owned();
    for word in words(function).filter(numbered).collect::<BTreeSet<_>>() {
        let base = word.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end_matches('_');
        // naga has used it elsewhere, so it is no word of the language.
        let known = words(text).any(|other| other == base);
        let free = !global.contains(base) && !global.contains(word) && !stands_alone(&own, base);
        if known && free {
            own = replace_words(&own, word, base);
        }
    }
    own
}

/// Whether a word is there as a name of its own, not as a member's.
fn stands_alone(text: &str, word: &str) -> bool {
    text.match_indices(word).any(|(at, _)| {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let (before, after) = (&text[..at], &text[at + word.len()..]);
        !before.ends_with(|c| is_word(c) || c == '.') && !after.starts_with(is_word)
    })
}

/// The function whose definition a line of any C-like language starts.
fn defined_function(line: &str) -> Option<&str> {
    let (before, _) = line.split_once('(')?;
    if line.starts_with([' ', '\t', '}', '#', '@', '/']) || line.trim_end().ends_with(';') {
        return None;
    }
    before.split_whitespace().last()
}

/// The comment above each function of the modules that a pass needs, by the function's name.
fn comments(sources: &Sources, pass: &str) -> BTreeMap<String, String> {
    let modules = sources.modules();
    let needed = sources.pass(pass).and_then(|(_, text)| needed_modules(text, &modules)).unwrap_or_default();
    let mut all = BTreeMap::new();
    for (_, text) in needed.iter().filter_map(|path| modules.get(path)) {
        let mut comment = String::new();
        for line in text.lines() {
            match line.strip_prefix("fn ") {
                _ if line.starts_with("//") => comment += &format!("{line}\n"),
                Some(rest) if !comment.is_empty() => {
                    let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                    all.insert(name, std::mem::take(&mut comment));
                }
                _ => comment.clear(),
            }
        }
    }
    all
}

/// What the module that a pass imports first says of itself: the comment below its name.
pub(super) fn legend(sources: &Sources, pass: &str) -> String {
    let modules = sources.modules();
    let Ok((_, text)) = sources.pass(pass) else { return String::new() };
    let first = text.lines().find_map(|line| line.strip_prefix("#import "));
    let path = first.map(|rest| rest.split("::{").next().unwrap_or(rest).trim());
    let Some((_, module)) = path.and_then(|path| modules.get(path)) else { return String::new() };
    let comment = module.lines().skip(1).take_while(|line| line.starts_with("//"));
    comment.map(|line| format!("{line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_words_are_renamed_unless_the_new_name_is_taken() {
        assert_eq!(rename("_g_1_cs + a_g_1_cs", "_g_1_cs", "table"), "table + a_g_1_cs");
        assert_eq!(rename("_g_1_cs + table", "_g_1_cs", "table"), "_g_1_cs + table");
    }

    #[test]
    fn a_name_loses_its_number_unless_the_plain_name_is_taken() {
        let text = "const float R = 1.0;\nfloat f(float mu, float R_1) {\n    return mu * R;\n}\n\
                    float g(float mu_1, float R_2) {\n    return f(mu_1, R_2);\n}\n";
        let restored = restored(text, &Sources::default(), "none");
        assert!(restored.contains("float g(float mu, float R_2) {\n    return f(mu, R_2);"), "{restored}");
        assert!(restored.contains("float f(float mu, float R_1)"), "{restored}");
    }

    #[test]
    fn a_function_is_known_by_the_line_that_defines_it_in_every_language() {
        for line in ["vec3 f(float x) {", "float3 f(", "fn f(x: f32) -> f32 {", "metal::float3 f("] {
            assert_eq!(defined_function(line), Some("f"), "{line}");
        }
        for line in ["    vec3 y = f(x);", "vec3 f(float x);", "@compute @workgroup_size(1)", "struct S {"] {
            assert_eq!(defined_function(line), None, "{line}");
        }
    }
}
