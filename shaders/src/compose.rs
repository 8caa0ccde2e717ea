//! Joins a pass with the modules it imports into one naga module.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, ComposerError, NagaModuleDescriptor, ShaderDefValue, get_preprocessor_data,
};

use crate::locate::{self, Originals};
use crate::{Definition, Definitions, ShaderError, Sources};

/// What naga_oil puts between a name and its module, in place of `::`.
const DECORATION: &str = "X_naga_oil_mod_X";

/// Composes a pass. The result is valid by naga's rules.
pub(crate) fn compose(
    sources: &Sources,
    pass: &str,
    definitions: &Definitions,
) -> Result<(String, naga::Module), ShaderError> {
    let (file, text) = sources.pass(pass)?;
    let modules = sources.modules();
    let originals = Originals::new(&modules, &file, text);
    let mut composer = Composer::default();
    let located = |composer: &Composer, error: ComposerError| locate::wgsl_error(composer, &error, &originals);
    for import_path in needed_modules(text, &modules)? {
        let (file_path, source) = &modules[import_path];
        let descriptor = ComposableModuleDescriptor { source, file_path, ..Default::default() };
        if let Err(error) = composer.add_composable_module(descriptor) {
            return Err(located(&composer, error));
        }
    }
    let shader_defs = shader_defs(definitions);
    let descriptor = NagaModuleDescriptor { source: text, file_path: &file, shader_defs, ..Default::default() };
    match composer.make_naga_module(descriptor) {
        Ok(module) => Ok((file, module)),
        Err(error) => Err(located(&composer, error)),
    }
}

/// Those definitions whose names occur in a pass or in what it imports: no other can change what it compiles to.
pub(crate) fn relevant(sources: &Sources, pass: &str, definitions: &Definitions) -> Result<Definitions, ShaderError> {
    let (_, text) = sources.pass(pass)?;
    let modules = sources.modules();
    let mut texts: Vec<&str> = needed_modules(text, &modules)?.into_iter().map(|path| modules[path].1).collect();
    texts.push(text);
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let words: BTreeSet<&str> = texts.iter().flat_map(|text| text.split(|c| !is_part(c))).collect();
    Ok(definitions.iter().filter(|(name, _)| words.contains(name.as_str())).map(|(n, d)| (n.clone(), *d)).collect())
}

/// Definitions in naga_oil's terms. What is `false` stays undefined, as `#ifdef` asks for existence only.
fn shader_defs(definitions: &Definitions) -> HashMap<String, ShaderDefValue> {
    let value = |definition: &Definition| match *definition {
        Definition::Bool(false) => None,
        Definition::Bool(true) => Some(ShaderDefValue::Bool(true)),
        Definition::I32(value) => Some(ShaderDefValue::Int(value)),
        Definition::U32(value) => Some(ShaderDefValue::UInt(value)),
    };
    definitions.iter().filter_map(|(name, definition)| Some((name.clone(), value(definition)?))).collect()
}

/// The import paths that a source needs, each after those that it needs itself. Imports of unknown modules are left
/// out here: naga_oil reports them with their place.
pub(crate) fn needed_modules<'a>(
    text: &str,
    modules: &BTreeMap<&'a str, (String, &'a str)>,
) -> Result<Vec<&'a str>, ShaderError> {
    fn visit<'a>(
        text: &str,
        modules: &BTreeMap<&'a str, (String, &'a str)>,
        open: &mut Vec<&'a str>,
        done: &mut Vec<&'a str>,
    ) -> Result<(), ShaderError> {
        for import in get_preprocessor_data(text).1 {
            let Some((&path, (_, module_text))) = modules.get_key_value(import.import.as_str()) else { continue };
            if done.contains(&path) {
                continue;
            }
            if let Some(start) = open.iter().position(|&other| other == path) {
                let chain = open[start..].iter().chain([&path]).copied().collect::<Vec<_>>().join(" -> ");
                return Err(ShaderError::ImportCycle { chain });
            }
            open.push(path);
            visit(module_text, modules, open, done)?;
            open.pop();
            done.push(path);
        }
        Ok(())
    }
    let mut done = Vec::new();
    visit(text, modules, &mut Vec::new(), &mut done)?;
    Ok(done)
}

/// A text with names as they were written: without naga_oil's module decorations.
pub(crate) fn undecorated(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(DECORATION) {
        plain.push_str(&rest[..start]);
        let module = &rest[start + DECORATION.len()..];
        // The module's path is written in base 32 (A-Z, 2-7) and closed by an X, which base 32 has too: the closing
        // one is the last of the run.
        let run = module.bytes().take_while(|byte| byte.is_ascii_uppercase() || matches!(byte, b'2'..=b'7')).count();
        let end = module[..run].rfind('X').map_or(run, |last| last + 1);
        rest = &module[end..];
    }
    plain.push_str(rest);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_their_module_decoration_and_keep_what_follows() {
        let decorated = Composer::decorated_name(Some("welkin::atmosphere"), "planet");
        assert_ne!(decorated, "planet");
        assert_eq!(undecorated(&format!("`{decorated}` and {decorated}.radius")), "`planet` and planet.radius");
        assert_eq!(undecorated("plain"), "plain");
    }

    #[test]
    fn modules_come_after_what_they_import() {
        let a = "#define_import_path a\n#import b\nfn f() -> f32 { return b::g(); }\n";
        let b = "#define_import_path b\nfn g() -> f32 { return 1.0; }\n";
        let modules = BTreeMap::from([("a", ("a.wgsl".to_owned(), a)), ("b", ("b.wgsl".to_owned(), b))]);
        let pass = "#import a\n@compute @workgroup_size(1) fn main() { _ = a::f(); }\n";
        assert_eq!(needed_modules(pass, &modules).unwrap(), ["b", "a"]);
    }
}
