//! A failing scene file made small: fields left out and numbers rounded as long as it still fails.

use toml::Value;

/// The smallest file that was found to fail, in at most so many trials.
pub fn shrunk(mut table: toml::Table, mut trials: usize, mut fails: impl FnMut(&toml::Table) -> bool) -> toml::Table {
    loop {
        let before = table.clone();
        for path in paths(&table) {
            for change in CHANGES {
                let mut smaller = table.clone();
                if !change_at(&mut smaller, &path, change) || smaller == table {
                    continue;
                }
                let Some(left) = trials.checked_sub(1) else { return table };
                trials = left;
                if fails(&smaller) {
                    table = smaller;
                    break;
                }
            }
        }
        if table == before {
            return table;
        }
    }
}

#[derive(Clone, Copy)]
enum Change {
    /// The field or item goes.
    Remove,
    /// A number becomes a simple one.
    Simple(f64),
    /// A number keeps its first digit.
    Round,
}

const CHANGES: [Change; 5] =
    [Change::Remove, Change::Simple(0.0), Change::Simple(1.0), Change::Simple(1000.0), Change::Round];

/// A step into a table or an array.
#[derive(Clone)]
enum Step {
    Key(String),
    Index(usize),
}

/// Every field and item, the outer ones first.
fn paths(table: &toml::Table) -> Vec<Vec<Step>> {
    let mut all = Vec::new();
    let mut open: Vec<(Vec<Step>, &Value)> =
        table.iter().map(|(key, value)| (vec![Step::Key(key.clone())], value)).collect();
    while let Some((path, value)) = open.pop() {
        let with = |step: Step| [&path[..], &[step]].concat();
        match value {
            Value::Table(fields) => {
                open.extend(fields.iter().map(|(key, value)| (with(Step::Key(key.clone())), value)))
            }
            Value::Array(items) => {
                open.extend(items.iter().enumerate().map(|(at, value)| (with(Step::Index(at)), value)))
            }
            _ => {}
        }
        all.push(path);
    }
    all.sort_by_key(Vec::len);
    all
}

/// Whether there was something to change.
fn change_at(table: &mut toml::Table, path: &[Step], change: Change) -> bool {
    let [Step::Key(key), rest @ ..] = path else { return false };
    match (rest, change) {
        ([], Change::Remove) => table.remove(key).is_some(),
        _ => table.get_mut(key).is_some_and(|value| change_in(value, rest, change)),
    }
}

fn change_in(value: &mut Value, path: &[Step], change: Change) -> bool {
    match (value, path, change) {
        (Value::Table(fields), path, change) => change_at(fields, path, change),
        (Value::Array(items), [Step::Index(at)], Change::Remove) if *at < items.len() => {
            items.remove(*at);
            true
        }
        (Value::Array(items), [Step::Index(at), rest @ ..], change) => {
            items.get_mut(*at).is_some_and(|item| change_in(item, rest, change))
        }
        (Value::Float(number), [], Change::Simple(simple)) => {
            let is_simple = [0.0, 1.0, 1000.0].iter().any(|simple| number == simple);
            *number = if is_simple { *number } else { simple };
            true
        }
        (Value::Float(number), [], Change::Round) => {
            *number = format!("{number:.0e}").parse().unwrap_or(*number);
            true
        }
        _ => false,
    }
}
