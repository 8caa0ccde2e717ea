//! The keys.

use egui::{Align2, Context, Grid, RichText, Window};

use crate::window::session::Session;
use crate::window::shortcuts::{HELD, SHORTCUTS};

pub fn show(context: &Context, session: &mut Session) {
    let mut open = true;
    let window = Window::new("Keys").open(&mut open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
        let rows: Vec<_> = SHORTCUTS.iter().map(|shortcut| (shortcut.keys, shortcut.does)).collect();
        ui.horizontal_top(|ui| {
            let half = rows.len() / 2;
            for (name, column) in
                [("left", [&HELD[..], &rows[..half - 3]].concat()), ("right", rows[half - 3..].to_vec())]
            {
                Grid::new(name).num_columns(2).spacing([16.0, 4.0]).show(ui, |ui| {
                    for (keys, does) in column {
                        ui.label(RichText::new(keys).monospace().strong());
                        ui.label(does);
                        ui.end_row();
                    }
                });
                ui.add_space(16.0);
            }
        });
    });
    session.help &= open;
}
