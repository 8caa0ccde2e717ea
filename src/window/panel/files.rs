//! Which scene, and what is done with it.

use std::path::PathBuf;

use egui::{ComboBox, TextEdit, Ui};

use crate::window::scenes::SCENES;
use crate::window::session::{Session, Tone};
use crate::window::shortcuts::Action;

pub fn show(ui: &mut Ui, session: &mut Session) {
    let mut chosen = None;
    ui.horizontal(|ui| {
        let name = session.document.scene().name.clone();
        ComboBox::from_label("scene").width(170.0).selected_text(name).height(400.0).show_ui(ui, |ui| {
            for &(name, text) in SCENES {
                if ui.selectable_label(false, name).clicked() {
                    chosen = Some((name, text));
                }
            }
        });
    });
    if let Some((name, text)) = chosen
        && let Err(error) =
            session.open(text, &PathBuf::from(format!("{}.toml", name.rsplit('/').next().unwrap_or(name))))
    {
        session.say(Tone::Failed, error.to_string());
    }
    ui.horizontal(|ui| {
        ui.add(TextEdit::singleline(&mut session.save_name).desired_width(190.0).hint_text("scene.toml"));
        let save = ui.button("save").on_hover_text("Writes the scene file; its comments are not kept");
        if save.clicked() {
            session.save(PathBuf::from(&session.save_name));
        }
        if ui.button("reload").on_hover_text("F5").clicked() {
            session.asked.push(Action::Reload);
        }
    });
    let (undo, redo) = session.history.steps();
    ui.horizontal(|ui| {
        if ui.add_enabled(undo > 0, egui::Button::new("undo")).on_hover_text("Ctrl Z").clicked() {
            session.travel(true);
        }
        if ui.add_enabled(redo > 0, egui::Button::new("redo")).on_hover_text("Ctrl Y").clicked() {
            session.travel(false);
        }
        if ui
            .button("picture")
            .on_hover_text("F12: PNG, EXR and the scene that `welkin render` makes them of")
            .clicked()
        {
            session.asked.push(Action::Screenshot);
        }
        if ui.button("copy command").on_hover_text("Ctrl C: the command that renders this picture").clicked() {
            session.asked.push(Action::CopyCommand);
        }
        if ui.button("keys").on_hover_text("F1").clicked() {
            session.help = true;
        }
    });
    ui.separator();
}
