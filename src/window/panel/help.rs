//! The keys.

use egui::{Align2, Context, Grid, RichText, ScrollArea, Ui, Window};

use crate::window::session::Session;
use crate::window::shortcuts::{HELD, SHORTCUTS};

/// Points of a window that its title and edges take.
const AROUND: [f32; 2] = [40.0, 70.0];

pub fn show(context: &Context, session: &mut Session) {
    let mut open = true;
    let [around_x, around_y] = AROUND;
    let most = context.content_rect().size();
    let window = Window::new("Keys").open(&mut open).collapsible(false).resizable(false);
    window.anchor(Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
        // A small window shows them in part.
        let area = ScrollArea::both().max_width(most.x - around_x).max_height(most.y - around_y);
        area.show(ui, columns);
    });
    session.help &= open;
}

/// All keys, in two columns of about the same length.
fn columns(ui: &mut Ui) {
    let rows: Vec<_> = SHORTCUTS.iter().map(|shortcut| (shortcut.keys, shortcut.does)).collect();
    let left = (HELD.len() + rows.len()).div_ceil(2) - HELD.len();
    ui.horizontal_top(|ui| {
        for (name, column) in [("left", [&HELD[..], &rows[..left]].concat()), ("right", rows[left..].to_vec())] {
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
}
