//! The picture beside the truth.

use egui::{Align2, Color32, Context, FontId, Id, LayerId, Order, Slider, Stroke, Ui, pos2};

use crate::window::session::Session;
use crate::window::shortcuts::Action;

pub fn show(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        let label = if session.truth.is_some() { "stop" } else { "compare with the path tracer" };
        if ui.button(label).on_hover_text("T").clicked() {
            session.asked.push(Action::Truth);
        }
        if ui.button(session.wipe.name()).on_hover_text("Y: the next pair").clicked() {
            session.wipe.turn();
        }
    });
    ui.add(Slider::new(&mut session.wipe.at, 0.0..=1.0).text("line (X, C)").show_value(false));
    let mut percent = 100.0 * session.kept.truth_scale;
    if ui
        .add(Slider::new(&mut percent, 5.0..=100.0).suffix(" %").max_decimals(0).text("of the window's side"))
        .changed()
    {
        session.kept.truth_scale = percent / 100.0;
    }
    if let Some(state) = &session.truth {
        ui.label(state);
    }
}

/// The line between two pictures, with what is on either side.
pub fn line(context: &Context, session: &Session) {
    let window = context.content_rect();
    let x = window.left() + session.wipe.at * window.width();
    let painter = context.layer_painter(LayerId::new(Order::Background, Id::new("line")));
    painter.line_segment([pos2(x, window.top()), pos2(x, window.bottom())], Stroke::new(1.5, Color32::WHITE));
    let name = session.wipe.name();
    let (left, right) = name.split_once(" | ").unwrap_or((&name, ""));
    for (text, align, at) in [(left, Align2::RIGHT_TOP, x - 8.0), (right, Align2::LEFT_TOP, x + 8.0)] {
        painter.text(pos2(at + 1.0, 9.0), align, text, FontId::proportional(15.0), Color32::BLACK);
        painter.text(pos2(at, 8.0), align, text, FontId::proportional(15.0), Color32::WHITE);
    }
    if let Some(state) = &session.truth {
        painter.text(pos2(x + 9.0, 29.0), Align2::LEFT_TOP, state, FontId::proportional(13.0), Color32::BLACK);
        painter.text(pos2(x + 8.0, 28.0), Align2::LEFT_TOP, state, FontId::proportional(13.0), Color32::WHITE);
    }
}
