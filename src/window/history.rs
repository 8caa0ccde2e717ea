//! Undo and redo of edits.

use std::time::{Duration, Instant};

use toml::Table;

/// Edits of one kind that follow each other faster than this are one step: a drag, a flight.
const ONE_STEP: Duration = Duration::from_millis(700);

/// Steps that are kept.
const MOST_STEPS: usize = 200;

/// What a document said before each step, and what was undone.
#[derive(Debug, Default)]
pub struct History {
    before: Vec<Table>,
    undone: Vec<Table>,
    last: Option<(String, Instant)>,
}

impl History {
    /// Notes what the document said before an edit of a kind, named by the field or the motion.
    pub fn note(&mut self, kind: &str, before: &Table, now: Instant) {
        let goes_on = self.last.as_ref().is_some_and(|(last, at)| last == kind && now.duration_since(*at) < ONE_STEP);
        self.last = Some((kind.to_owned(), now));
        self.undone.clear();
        if !goes_on {
            self.before.push(before.clone());
            let surplus = self.before.len().saturating_sub(MOST_STEPS);
            self.before.drain(..surplus);
        }
    }

    /// What to go back to from what the document says now.
    pub fn undo(&mut self, now: &Table) -> Option<Table> {
        let before = self.before.pop()?;
        self.undone.push(now.clone());
        self.last = None;
        Some(before)
    }

    /// What was undone last.
    pub fn redo(&mut self, now: &Table) -> Option<Table> {
        let after = self.undone.pop()?;
        self.before.push(now.clone());
        self.last = None;
        Some(after)
    }

    /// How many steps can be undone and redone.
    pub fn steps(&self) -> (usize, usize) {
        (self.before.len(), self.undone.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(value: i64) -> Table {
        Table::from_iter([("a".to_owned(), value.into())])
    }

    #[test]
    fn a_drag_is_one_step_and_another_field_is_another() {
        let (mut history, start) = (History::default(), Instant::now());
        for step in 0..10 {
            history.note("sun", &table(step), start + Duration::from_millis(16 * step as u64));
        }
        history.note("camera", &table(10), start + Duration::from_millis(170));
        history.note("camera", &table(11), start + Duration::from_secs(9));
        assert_eq!(history.steps(), (3, 0));
        assert_eq!(history.undo(&table(12)), Some(table(11)));
        assert_eq!(history.undo(&table(11)), Some(table(10)));
        assert_eq!(history.undo(&table(10)), Some(table(0)), "the drag began at 0");
        assert_eq!(history.undo(&table(0)), None);
        assert_eq!(history.redo(&table(0)), Some(table(10)));
    }

    #[test]
    fn an_edit_after_an_undo_ends_what_could_be_redone() {
        let mut history = History::default();
        history.note("a", &table(0), Instant::now());
        history.undo(&table(1));
        history.note("b", &table(0), Instant::now());
        assert_eq!(history.redo(&table(2)), None);
    }
}
