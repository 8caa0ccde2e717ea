//! What accuracy is worth, and how fast pictures come.

use std::time::Instant;

use egui::{Checkbox, Color32, ComboBox, Slider, Stroke, Ui, pos2, vec2};

use super::FAULT;
use crate::plan::{MultipleScattering, Quality};
use crate::window::aim::Aim;
use crate::window::fly::rounded;
use crate::window::graph::Graph;
use crate::window::resolution::LEAST;
use crate::window::session::Session;

const SKY: Color32 = Color32::from_rgb(110, 170, 255);
const PANEL: Color32 = Color32::from_rgb(230, 190, 90);

pub fn show(ui: &mut Ui, session: &mut Session) {
    let mut aim = session.kept.aim;
    ui.horizontal(|ui| {
        ui.label("settings by");
        for other in Aim::ALL {
            ui.selectable_value(&mut aim, other, other.name());
        }
    });
    if aim != session.kept.aim {
        session.aim(aim);
    }
    match aim {
        Aim::Quality => by_quality(ui, session),
        Aim::Error => by_error(ui, session),
        Aim::Time => by_time(ui, session),
    }
    let resolution = &mut session.resolution;
    ui.add(Slider::new(&mut resolution.budget_ms, 4.0..=500.0).logarithmic(true).suffix(" ms").text("frame budget"));
    session.kept.budget_ms = resolution.budget_ms;
    let mut fixed = resolution.fixed.is_some();
    ui.horizontal(|ui| {
        ui.checkbox(&mut fixed, "fixed scale");
        let mut percent = 100.0 * resolution.scale();
        let slider = Slider::new(&mut percent, 100.0 * LEAST..=100.0).suffix(" %").max_decimals(0);
        let changed = ui.add_enabled(fixed, slider).changed();
        if fixed && (changed || resolution.fixed.is_none()) {
            resolution.fixed = Some(percent / 100.0);
        }
    });
    if !fixed {
        resolution.fixed = None;
    }
    session.kept.fixed_scale = resolution.fixed;
    let offered = session.offers_above_white;
    let light = Checkbox::new(&mut session.kept.above_white, "light above white");
    ui.add_enabled(offered, light).on_disabled_hover_text("this screen shows none");
    graph(ui, &session.graph, session.resolution.budget_ms as f32);
    ui.label(&session.device);
}

fn by_quality(ui: &mut Ui, session: &mut Session) {
    let before = (session.quality, session.multiple_scattering);
    ui.horizontal(|ui| {
        for quality in Quality::ALL {
            ui.selectable_value(&mut session.quality, quality, quality.name());
        }
    });
    let name = session.multiple_scattering.name();
    ComboBox::from_label("multiple scattering").selected_text(name).show_ui(ui, |ui| {
        for method in MultipleScattering::ALL {
            ui.selectable_value(&mut session.multiple_scattering, method, method.name());
        }
    });
    if before != (session.quality, session.multiple_scattering) {
        session.kept.quality = session.quality.name().to_owned();
        session.resolution.touch(Instant::now());
    }
}

fn by_error(ui: &mut Ui, session: &mut Session) {
    let mut percent = 100.0 * session.kept.target_error;
    let slider =
        Slider::new(&mut percent, 0.1..=50.0).logarithmic(true).suffix(" %").max_decimals(2).text("target error");
    if ui.add(slider).on_hover_text("root mean square of the relative error of radiance over the picture").changed() {
        session.kept.target_error = rounded(percent) / 100.0;
        session.resolution.touch(Instant::now());
    }
    chosen(ui, session);
}

fn by_time(ui: &mut Ui, session: &mut Session) {
    let slider =
        Slider::new(&mut session.kept.picture_ms, 1.0..=60_000.0).logarithmic(true).suffix(" ms").max_decimals(1);
    if ui
        .add(slider.text("picture"))
        .on_hover_text("time of a picture at rest on the device, all tables included")
        .changed()
    {
        session.kept.picture_ms = rounded(session.kept.picture_ms);
        session.resolution.touch(Instant::now());
    }
    chosen(ui, session);
}

/// The settings that were chosen, with what is predicted of them.
fn chosen(ui: &mut Ui, session: &Session) {
    match (session.chooser.progress(), session.chosen()) {
        (Some([done, all]), _) => ui.label(format!("measuring the device: {done} of {all}")),
        (None, Some(chosen)) if chosen.is_met => ui.label(&chosen.words),
        (None, Some(chosen)) => ui.colored_label(FAULT, &chosen.words),
        (None, None) => ui.label("chosen when nothing moves"),
    };
    if session.chosen().is_none_or(|chosen| chosen.step.is_none()) {
        ui.label(format!("meanwhile: quality {}", session.quality));
    }
}

/// Times of past frames as lines, with the budget.
fn graph(ui: &mut Ui, graph: &Graph, budget_ms: f32) {
    let (area, _) = ui.allocate_exact_size(vec2(ui.available_width().min(310.0), 70.0), egui::Sense::hover());
    let painter = ui.painter_at(area);
    painter.rect_filled(area, 2.0, Color32::from_black_alpha(160));
    let most = graph.sky_ms().chain(graph.panel_ms()).fold(1.5 * budget_ms, f32::max);
    let height = |ms: f32| area.bottom() - area.height() * (ms / most).min(1.0);
    let line = |times: &mut dyn Iterator<Item = f32>, colour: Color32| {
        let point = |(index, ms): (usize, f32)| pos2(area.left() + area.width() * index as f32 / 239.0, height(ms));
        painter.line(times.enumerate().map(point).collect(), Stroke::new(1.5, colour));
    };
    let level = [pos2(area.left(), height(budget_ms)), pos2(area.right(), height(budget_ms))];
    painter.line_segment(level, Stroke::new(1.0, Color32::from_gray(90)));
    line(&mut graph.sky_ms(), SKY);
    line(&mut graph.panel_ms(), PANEL);
    let words = |name: &str, times: Option<(f32, f32)>| match times {
        Some((median, most)) => format!("{name}: median {median:.1} ms, most {most:.0} ms"),
        None => format!("{name}: none yet"),
    };
    ui.colored_label(SKY, words("sky", Graph::summary(graph.sky_ms())));
    ui.colored_label(PANEL, words("panel", Graph::summary(graph.panel_ms())));
}
