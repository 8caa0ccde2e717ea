//! What became of each pass, and why.

use egui::{Color32, Grid, RichText, Ui};

use crate::plan::Decision;
use crate::window::session::Session;

pub fn show(ui: &mut Ui, session: &Session) {
    let Some(timings) = &session.timings else {
        ui.label("no picture yet");
        return;
    };
    Grid::new("passes").num_columns(4).striped(true).spacing([8.0, 2.0]).show(ui, |ui| {
        for heading in ["pass", "", "ms", "MB"] {
            ui.label(RichText::new(heading).weak());
        }
        ui.end_row();
        for pass in &timings.plan.passes {
            let (word, colour) = match pass.decision {
                Decision::Run => ("run", Color32::from_rgb(140, 200, 255)),
                Decision::Reuse => ("reuse", Color32::from_rgb(150, 220, 150)),
                Decision::Skip => ("skip", Color32::from_gray(120)),
            };
            ui.label(RichText::new(pass.name).color(colour)).on_hover_text(&pass.reason);
            ui.label(RichText::new(word).color(colour)).on_hover_text(&pass.reason);
            let took = timings.milliseconds.get(pass.name).filter(|_| pass.decision == Decision::Run);
            ui.label(took.map_or(String::new(), |ms| format!("{ms:.2}")));
            ui.label(if pass.bytes > 0 { format!("{:.2}", pass.bytes as f64 / 1e6) } else { String::new() });
            ui.end_row();
        }
    });
    let all_ms: f64 = timings.milliseconds.values().sum();
    let bytes: u64 = timings.plan.passes.iter().map(|pass| pass.bytes).sum();
    ui.label(format!("all: {all_ms:.1} ms, {:.1} MB; the reasons appear under the pointer:", bytes as f64 / 1e6));
    egui::CollapsingHeader::new("all reasons").show(ui, |ui| {
        for pass in &timings.plan.passes {
            ui.label(RichText::new(format!("{}: {}", pass.name, pass.reason)).small());
        }
    });
}
