//! Camera, sun, time and exposure.

use egui::{ComboBox, TextEdit, Ui};
use toml::Value;

use super::field::{Field, slider};
use crate::scene::Light;
use crate::window::day;
use crate::window::document::set;
use crate::window::fly::{self, rounded};
use crate::window::session::{Session, Tone};
use crate::window::shortcuts::Action;

pub fn camera(ui: &mut Ui, session: &mut Session) {
    let camera = session.document.scene().camera;
    let fields = [
        ("altitude", "camera.altitude_m", " m", 0.5..=1e7, true, camera.altitude_m),
        ("elevation", "camera.elevation_deg", "°", -90.0..=90.0, false, camera.direction.elevation_rad.to_degrees()),
        (
            "azimuth",
            "camera.azimuth_deg",
            "°",
            0.0..=360.0,
            false,
            camera.direction.azimuth_rad.to_degrees().rem_euclid(360.0),
        ),
        (
            "field of view",
            "camera.vertical_field_of_view_deg",
            "°",
            1.0..=170.0,
            false,
            camera.vertical_field_of_view_rad.to_degrees(),
        ),
    ];
    for (label, path, unit, range, logarithmic, present) in fields {
        slider(ui, session, &Field { label, path, unit, range, logarithmic }, present);
    }
}

pub fn time(ui: &mut Ui, session: &mut Session) {
    let sun = session.document.scene().lights.iter().find_map(|light| match light {
        Light::Directional(light) => Some(light.direction),
        _ => None,
    });
    let Some(sun) = sun else { return };
    let (elevation_deg, azimuth_deg) = (sun.elevation_rad.to_degrees(), sun.azimuth_rad.to_degrees().rem_euclid(360.0));
    let (path, path_hour) = session.day_path();
    let date = session.date();
    let hour = date.and_then(|date| day::hour_of(&date)).unwrap_or(path_hour);
    let mut wanted = hour;
    let clock = |hour: f64, _: std::ops::RangeInclusive<usize>| {
        let minutes = (hour * 60.0).round() as u32;
        format!("{:02}:{:02}", minutes / 60, minutes % 60)
    };
    let slider_of_day = egui::Slider::new(&mut wanted, 0.0..=23.999).custom_formatter(clock).text("time of day");
    if ui
        .add(slider_of_day)
        .on_hover_text(if date.is_some() { "local time of the date" } else { "solar time over 45° north" })
        .changed()
    {
        match date.and_then(|date| day::later(date, (wanted - hour) * 3600.0)) {
            Some(date) => session.set("sun.when.date_time", Some(Value::Datetime(date))),
            None => {
                let toward = path.at(wanted).to_vector();
                session.edit("time of day", |table| fly::point(table, "sun", toward));
            }
        }
    }
    ui.horizontal(|ui| {
        let label = if session.playing { "stop" } else { "play" };
        if ui.button(label).on_hover_text("P").clicked() {
            session.asked.push(Action::Play);
        }
        let speed = egui::Slider::new(&mut session.kept.time_rate, 1.0..=100_000.0)
            .logarithmic(true)
            .suffix(" ×")
            .text("speed");
        ui.add(speed);
    });
    let mut dated = date.is_some();
    let on_earth = session.document.get("preset").is_none_or(|preset| preset.as_str() != Some("mars"));
    let toggle = ui.add_enabled(on_earth, egui::Checkbox::new(&mut dated, "by date and place on Earth"));
    if toggle.changed() {
        set_dated(session, dated, [elevation_deg, azimuth_deg]);
    }
    match date {
        Some(date) => date_and_place(ui, session, date),
        None => {
            let fields = [
                ("elevation", "sun.elevation_deg", -90.0..=90.0, elevation_deg),
                ("azimuth", "sun.azimuth_deg", 0.0..=360.0, azimuth_deg),
            ];
            for (label, path, range, present) in fields {
                slider(ui, session, &Field { label, path, unit: "°", range, logarithmic: false }, present);
            }
        }
    }
    if date.is_some() {
        ui.label(format!("sun at {elevation_deg:.2}° above the horizon, azimuth {azimuth_deg:.2}°"));
    }
}

/// From angles to a date, or from a date to the angles that it gave.
fn set_dated(session: &mut Session, dated: bool, [elevation_deg, azimuth_deg]: [f64; 2]) {
    session.edit("date", |table| {
        if dated {
            set(table, "sun.elevation_deg", None);
            set(table, "sun.azimuth_deg", None);
            set(table, "sun.when.date_time", Some(Value::Datetime(day::equinox())));
            set(table, "sun.when.latitude_deg", Some(45.0.into()));
            set(table, "sun.when.longitude_deg", Some(0.0.into()));
        } else {
            set(table, "sun.when", None);
            set(table, "sun.elevation_deg", Some(rounded(elevation_deg).into()));
            set(table, "sun.azimuth_deg", Some(rounded(azimuth_deg).into()));
        }
    });
}

fn date_and_place(ui: &mut Ui, session: &mut Session, date: toml::value::Datetime) {
    let id = ui.id().with("date");
    let mut text = ui.data_mut(|data| data.get_temp::<String>(id)).unwrap_or_else(|| date.to_string());
    let field = ui.add(TextEdit::singleline(&mut text).desired_width(220.0).hint_text("2026-06-21T12:00:00+02:00"));
    if field.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text.clone()));
    }
    if field.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        match text.parse() {
            Ok(date) => session.set("sun.when.date_time", Some(Value::Datetime(date))),
            Err(error) => session.say(Tone::Failed, format!("'{text}' is no date: {error}")),
        }
    }
    for (label, path, most) in
        [("latitude", "sun.when.latitude_deg", 90.0), ("longitude", "sun.when.longitude_deg", 180.0)]
    {
        let present = session.document.number(path).unwrap_or(0.0);
        slider(ui, session, &Field { label, path, unit: "°", range: -most..=most, logarithmic: false }, present);
    }
}

pub fn exposure(ui: &mut Ui, session: &mut Session) {
    let display = session.document.scene().display;
    let field =
        Field { label: "exposure", path: "display.exposure_ev", unit: " EV", range: -5.0..=25.0, logarithmic: false };
    slider(ui, session, &field, display.exposure_ev);
    let present = session.document.get("display.tone_map").and_then(Value::as_str).unwrap_or("filmic").to_owned();
    ComboBox::from_label("tone map").selected_text(&present).show_ui(ui, |ui| {
        for name in ["filmic", "none"] {
            if ui.selectable_label(present == name, name).clicked() {
                session.set("display.tone_map", Some(name.into()));
            }
        }
    });
}
