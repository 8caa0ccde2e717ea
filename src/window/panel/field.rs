//! One number of the scene with its unit and range.

use std::ops::RangeInclusive;

use egui::{Slider, Ui};

use crate::window::fly::rounded;
use crate::window::session::Session;

/// How a number is shown.
pub struct Field {
    pub label: &'static str,
    pub path: &'static str,
    pub unit: &'static str,
    pub range: RangeInclusive<f64>,
    pub logarithmic: bool,
}

/// A slider for a field, which stands where the scene has it even when the file does not say it.
pub fn slider(ui: &mut Ui, session: &mut Session, field: &Field, present: f64) {
    let mut value = present;
    let slider = Slider::new(&mut value, field.range.clone())
        .logarithmic(field.logarithmic)
        .suffix(field.unit)
        .max_decimals(3)
        .smallest_positive(0.1)
        .clamping(egui::SliderClamping::Edits)
        .text(field.label);
    if ui.add(slider).changed() {
        session.set(field.path, Some(rounded(value).into()));
    }
}
