//! The panel: one file a section.

mod field;
mod files;
mod help;
mod parameters;
mod plan;
mod quality;
mod truth;
mod view;

use egui::{Color32, Context, Frame, RichText, ScrollArea, SidePanel, TopBottomPanel, Ui};

use super::session::{Session, Tone};

pub use parameters::Schema;

const WIDTH: f32 = 340.0;
const FAULT: Color32 = Color32::from_rgb(255, 120, 100);
const DONE: Color32 = Color32::from_rgb(150, 220, 150);

/// Dark, and thin enough that the sky stays the picture.
pub fn style(context: &Context) {
    context.set_visuals(egui::Visuals::dark());
    context.style_mut(|style| {
        style.spacing.slider_width = 150.0;
        style.spacing.item_spacing.y = 4.0;
        // Nothing blinks or slides: the panel is drawn again only when something changes.
        style.animation_time = 0.0;
        style.visuals.text_cursor.blink = false;
    });
}

/// Lays the panel out.
pub fn show(context: &Context, session: &mut Session, schema: &Schema) {
    if session.help {
        help::show(context, session);
    }
    status(context, session);
    if session.truth.is_some() {
        truth::line(context, session);
    }
    if session.timings.is_none() && session.faults.iter().all(Option::is_none) {
        egui::Area::new("first".into()).anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
            ui.label(RichText::new("preparing the sky: shaders are compiled").size(18.0));
        });
    }
    if !session.kept.panel {
        return;
    }
    let frame = Frame::side_top_panel(&context.style()).fill(Color32::from_black_alpha(215));
    SidePanel::left("panel").exact_width(WIDTH).resizable(false).frame(frame).show(context, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            files::show(ui, session);
            section(ui, "Camera", true, |ui| view::camera(ui, session));
            section(ui, "Sun and time", true, |ui| view::time(ui, session));
            section(ui, "Exposure", true, |ui| view::exposure(ui, session));
            section(ui, "Quality", true, |ui| quality::show(ui, session));
            section(ui, "Passes", false, |ui| plan::show(ui, session));
            section(ui, "Truth", false, |ui| truth::show(ui, session));
            section(ui, "All parameters", false, |ui| parameters::show(ui, session, schema));
        });
    });
}

fn section(ui: &mut Ui, name: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    egui::CollapsingHeader::new(RichText::new(name).strong()).default_open(open).show(ui, content);
}

/// One line at the bottom: where one is, how fast pictures come, and what was said last; above it what is wrong.
fn status(context: &Context, session: &Session) {
    let frame = Frame::side_top_panel(&context.style()).fill(Color32::from_black_alpha(215));
    TopBottomPanel::bottom("status").resizable(false).show_separator_line(false).frame(frame).show(context, |ui| {
        for fault in session.faults.iter().flatten() {
            ui.label(RichText::new(fault).color(FAULT).monospace());
        }
        ui.horizontal(|ui| {
            let camera = &session.document.scene().camera;
            ui.label(format!("altitude {}", metres(camera.altitude_m)));
            ui.separator();
            if let Some((median, _)) = super::graph::Graph::summary(session.graph.sky_ms()) {
                ui.label(format!("sky {median:.0} ms at {:.0} %", 100.0 * session.resolution.scale()));
                ui.separator();
            }
            ui.label("F1: keys");
            if let Some((tone, text)) = &session.message {
                ui.separator();
                ui.label(RichText::new(text).color(if *tone == Tone::Done { DONE } else { FAULT }));
            }
        });
    });
}

/// A length as people say it.
pub fn metres(length_m: f64) -> String {
    match length_m.abs() {
        m if m < 1e4 => format!("{length_m:.1} m"),
        m if m < 1e6 => format!("{:.1} km", length_m / 1e3),
        _ => format!("{:.0} km", length_m / 1e3),
    }
}
