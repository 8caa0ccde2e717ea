//! What the pages say is there: files, commands and options. A page that promises what is gone fails here.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use pulldown_cmark::{Event, Parser, Tag, TagEnd};

/// Pages that describe the code: here every path in code type must exist as well.
const DESCRIPTIONS: [&str; 3] = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"];

/// Endings by which a word in code type is known as a file of the repository.
const FILE_ENDINGS: [&str; 12] =
    ["rs", "wgsl", "toml", "md", "sh", "json", "csv", "svg", "lock", "yml", "py", "schema.json"];

/// What the commands of the pages make; it is not in the repository.
const MADE: [&str; 2] = ["out/", "target/"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(page: &Path) -> String {
    fs::read_to_string(page).unwrap_or_else(|error| panic!("{}: {error}", page.display()))
}

/// All pages: those of the root, of `docs/` and of `docs/engines/`.
fn pages() -> Vec<PathBuf> {
    let folders = [root().to_owned(), root().join("docs"), root().join("docs/engines")];
    let paths = folders.iter().flat_map(|folder| folder.read_dir().unwrap()).map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect()
}

/// What a page links to or shows.
fn targets(markdown: &str) -> Vec<String> {
    let target = |event| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => Some(dest_url.to_string()),
        _ => None,
    };
    Parser::new(markdown).filter_map(target).collect()
}

/// Links to files that are not beside the page.
fn broken_links(folder: &Path, markdown: &str) -> Vec<String> {
    let local = targets(markdown).into_iter().filter(|target| !target.contains("://") && !target.starts_with('#'));
    local.filter(|target| !folder.join(target.split('#').next().unwrap()).exists()).collect()
}

/// The lines of a page in code type: its spans and the lines of its blocks.
fn code_lines(markdown: &str) -> Vec<String> {
    let (mut lines, mut in_block) = (Vec::new(), false);
    for event in Parser::new(markdown) {
        match event {
            Event::Start(Tag::CodeBlock(_)) => in_block = true,
            Event::End(TagEnd::CodeBlock) => in_block = false,
            Event::Text(text) if in_block => lines.extend(text.lines().map(str::to_owned)),
            Event::Code(text) => lines.push(text.to_string()),
            _ => {}
        }
    }
    lines
}

/// Whether a word of code is meant as a path of the repository.
fn is_path(word: &str) -> bool {
    let plain = word.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c));
    let ending = word.rsplit('.').next().is_some_and(|ending| word.contains('.') && FILE_ENDINGS.contains(&ending));
    let folder = word.ends_with('/') && word.len() > 1;
    plain && (ending || folder) && word.contains('/') && !MADE.iter().any(|made| word.starts_with(made))
}

fn missing_paths(markdown: &str) -> Vec<String> {
    let lines = code_lines(markdown);
    let words = lines.iter().flat_map(|line| line.split_whitespace());
    words.filter(|word| is_path(word) && !root().join(word).exists()).map(str::to_owned).collect()
}

fn help(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_welkin")).args(arguments).arg("--help").output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The subcommands that the program has.
fn subcommands() -> BTreeSet<String> {
    let help = help(&[]);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = listed.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
    names.map(str::to_owned).collect()
}

/// The calls of the program in a page: a subcommand, and the options that follow it.
fn calls(markdown: &str) -> Vec<(String, Vec<String>)> {
    let call = |line: &String| {
        let mut words = line.split_whitespace().skip_while(|word| *word != "welkin").skip(1);
        let name = words.next().filter(|name| name.chars().all(|c| c.is_ascii_lowercase()))?;
        let options = words.filter(|word| word.starts_with('-')).map(str::to_owned).collect();
        Some((name.to_owned(), options))
    };
    code_lines(markdown).iter().filter_map(call).collect()
}

/// Calls that the program would refuse because it lacks the subcommand or an option.
fn impossible_calls(markdown: &str) -> Vec<String> {
    let known = subcommands();
    let mut impossible = Vec::new();
    for (name, options) in calls(markdown) {
        if !known.contains(&name) {
            impossible.push(name);
            continue;
        }
        let help = help(&[&name]);
        let words: BTreeSet<_> = help.split(|c: char| c.is_whitespace() || c == ',').collect();
        let unknown = options.into_iter().filter(|option| !words.contains(option.as_str()));
        impossible.extend(unknown.map(|option| format!("{name} {option}")));
    }
    impossible
}

#[test]
fn every_link_leads_somewhere() {
    let mut links = 0;
    for page in pages() {
        let markdown = read(&page);
        links += targets(&markdown).len();
        assert_eq!(broken_links(page.parent().unwrap(), &markdown), Vec::<String>::new(), "{}", page.display());
    }
    assert!(links > 10, "found only {links} links in all pages");
}

#[test]
fn every_path_in_the_descriptions_exists() {
    for page in DESCRIPTIONS {
        assert_eq!(missing_paths(&read(&root().join(page))), Vec::<String>::new(), "{page}");
    }
}

#[test]
fn the_pages_call_the_program_as_it_is() {
    for page in pages() {
        assert_eq!(impossible_calls(&read(&page)), Vec::<String>::new(), "{}", page.display());
    }
}

#[test]
fn the_readme_shows_every_subcommand() {
    let shown: BTreeSet<String> = calls(&read(&root().join("README.md"))).into_iter().map(|(name, _)| name).collect();
    assert_eq!(subcommands(), shown);
}

#[test]
fn the_checks_notice_what_is_not_there() {
    let page = "[a](README.md), ![b](docs/none.png) and [c](https://example.org/none)\n";
    assert_eq!(broken_links(root(), page), ["docs/none.png"]);
    let page = "`src/lib.rs`, `src/none.rs` and 1/m\n```text\nscenes/noon.toml tests/none/ out/none.csv\n```\n";
    assert_eq!(missing_paths(page), ["src/none.rs", "tests/none/"]);
    let page = "`welkin render a.toml --quality low`, `welkin dance`\n\n    welkin compare a b --max-none 1\n";
    assert_eq!(impossible_calls(page), ["dance", "compare --max-none"]);
}
