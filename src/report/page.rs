//! One HTML page that holds everything: it opens without a network, and nothing lies beside it.

use std::fmt::Write as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::goals::goal_section;
use super::markdown::{error_with_bar, milliseconds, percent};
use super::overall::{Overall, tables};
use super::pictures::{FULL_DIFFERENCE, difference_path, picture_path};
use super::plot::{plot, slab_plot};
use super::results::{SceneResults, Study};
use super::{ReportError, beats_clearly};
use crate::plan::Quality;

const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}\
    table{border-collapse:collapse;margin:1em 0;font-size:14px}td,th{border:1px solid #ccc;padding:.2em .6em;text-align:left}\
    td.n{text-align:right}tr.preset{background:#fbeef1}svg{max-width:100%;height:auto}figure{display:inline-block;margin:.4em}\
    figcaption{font-size:13px}img{display:block;width:320px}img.cells{image-rendering:pixelated}details{margin:1em 0}";

/// The page; pictures are read from the folder where [`super::save_picture`] has put them.
///
/// # Errors
/// [`ReportError::Plot`].
pub fn page(study: &Study, pictures: &Path) -> Result<String, ReportError> {
    let from = &study.provenance;
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>What accuracy costs in time</title>\
         <link rel=\"icon\" href=\"data:,\"><style>{STYLE}</style></head><body>\n<h1>What accuracy costs in time</h1>\n\
         <p>welkin {} ({}) on {}, {}. {}. {}</p>\n<p>Error: root mean square of the relative error of linear radiance against \
         the path tracer, less what its noise puts in, ± one standard error. Time: all passes of a first picture, once its shaders are compiled, on the \
         device, median and quartiles.</p>\n",
        escape(&from.version),
        escape(&from.commit),
        escape(&from.device),
        escape(&from.driver),
        escape(&from.machine),
        escape(&from.load)
    );
    for left_out in &study.left_out {
        let _ = writeln!(html, "<p>Not measured: {}: {}.</p>", escape(&left_out.scene), escape(&left_out.reason));
    }
    for (title, rows) in tables(study) {
        overall_table(&mut html, &title, &rows);
    }
    for scene in study.scenes.iter().filter(|scene| !scene.random) {
        scene_section(&mut html, scene, pictures)?;
    }
    let random: Vec<_> = study.scenes.iter().filter(|scene| scene.random).collect();
    if !random.is_empty() {
        let _ = writeln!(html, "<h2>Scenes drawn at random</h2>");
        for scene in random {
            let _ = writeln!(html, "<details><summary>{}</summary>", escape(&scene.scene));
            table(&mut html, scene);
            html.push_str("</details>\n");
        }
    }
    html.push_str(&goal_section(study));
    slabs(&mut html, study)?;
    html.push_str("</body></html>\n");
    Ok(html)
}

fn slabs(html: &mut String, study: &Study) -> Result<(), ReportError> {
    html.push_str(
        "<h2>The families of methods on a slab</h2><p>Against 64 discrete ordinates; times on the CPU.</p>\n",
    );
    html.push_str(&slab_plot(&study.slabs)?);
    for slab in &study.slabs {
        let _ = write!(
            html,
            "<details><summary>{}</summary><table><tr><th>method<th>reflectance: error %<th>transmittance: error %<th>ms</tr>",
            escape(&slab.slab)
        );
        for point in &slab.points {
            let _ = writeln!(
                html,
                "<tr><td>{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}</tr>",
                escape(&point.name),
                percent(point.reflectance_error),
                percent(point.transmittance_error),
                milliseconds(point.milliseconds.median)
            );
        }
        html.push_str("</table></details>\n");
    }
    Ok(())
}

fn overall_table(html: &mut String, title: &str, rows: &[Overall]) {
    let _ = write!(
        html,
        "<h2>{title}</h2><p>Geometric means.</p><table><tr><th>settings<th>error %<th>ms<th>faster and more accurate</tr>"
    );
    for row in rows {
        let class = if row.is_preset { " class=\"preset\"" } else { "" };
        let _ = writeln!(
            html,
            "<tr{class}><td>{}<td class=\"n\">{}<td class=\"n\">{}<td>{}</tr>",
            escape(&row.name),
            percent(row.error),
            milliseconds(row.milliseconds),
            escape(row.dominated_by.as_deref().unwrap_or("-"))
        );
    }
    html.push_str("</table>\n");
}

fn scene_section(html: &mut String, scene: &SceneResults, pictures: &Path) -> Result<(), ReportError> {
    let name = &scene.scene;
    let _ = writeln!(
        html,
        "<h2>{}</h2><p>{} x {} pixels; truth of {} walks a pixel.</p>",
        escape(name),
        scene.width,
        scene.height,
        scene.truth_walks
    );
    html.push_str(&plot(scene)?);
    html.push_str("<div>");
    figure(html, &picture_path(pictures, name, "truth"), "the path tracer, on the grid of comparison", true);
    for quality in Quality::ALL {
        figure(html, &picture_path(pictures, name, quality.name()), quality.name(), false);
        let full = 100.0 * FULL_DIFFERENCE;
        let caption = format!("{quality} less the truth: blue -{full:.0} % and darker, red +{full:.0} % and brighter");
        figure(html, &difference_path(pictures, name, quality.name()), &caption, true);
    }
    html.push_str("</div>\n<details><summary>All settings</summary>");
    table(html, scene);
    html.push_str("</details>\n<details><summary>Time of each pass, ms</summary>");
    passes(html, scene);
    html.push_str("</details>\n");
    Ok(())
}

/// A picture, if it is there: a preset beyond those measured has none.
fn figure(html: &mut String, path: &Path, caption: &str, cells: bool) {
    let Ok(bytes) = std::fs::read(path) else { return };
    let class = if cells { " class=\"cells\"" } else { "" };
    let (data, caption) = (STANDARD.encode(bytes), escape(caption));
    let _ = writeln!(
        html,
        "<figure><img{class} alt=\"{caption}\" src=\"data:image/png;base64,{data}\"><figcaption>{caption}</figcaption></figure>"
    );
}

fn table(html: &mut String, scene: &SceneResults) {
    html.push_str("<table><tr><th>settings<th>error %<th>median %<th>99th percentile %<th>ms<th>quartiles<th>faster and more accurate</tr>\n");
    for point in &scene.points {
        let class = if point.preset.is_some() { " class=\"preset\"" } else { "" };
        let preset = point.preset.as_ref().map(|preset| format!(" ({preset})")).unwrap_or_default();
        let (error, time) = (&point.error, &point.milliseconds);
        let better = point.dominated_by.as_ref().and_then(|name| scene.points.iter().find(|other| other.name == *name));
        let clearly = better.is_some_and(|other| beats_clearly(other, point));
        let _ = writeln!(
            html,
            "<tr{class}><td>{}{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{}<td>{} to {}<td>{}{}</tr>",
            escape(&point.name),
            escape(&preset),
            escape(&error_with_bar(error)),
            percent(error.median),
            percent(error.p99),
            milliseconds(time.median),
            milliseconds(time.first_quartile),
            milliseconds(time.third_quartile),
            escape(better.map_or("-", |other| &other.name)),
            if clearly { ", clearly" } else { "" }
        );
    }
    html.push_str("</table>");
}

fn passes(html: &mut String, scene: &SceneResults) {
    let mut names: Vec<&String> = scene.points.iter().flat_map(|point| point.passes.keys()).collect();
    names.sort();
    names.dedup();
    html.push_str("<table><tr><th>settings");
    names.iter().for_each(|name| {
        let _ = write!(html, "<th>{}", escape(name));
    });
    html.push_str("</tr>\n");
    for point in scene.points.iter().filter(|point| !point.passes.is_empty()) {
        let _ = write!(html, "<tr><td>{}", escape(&point.name));
        for name in &names {
            let time = point.passes.get(*name).map_or("-".to_owned(), |time| milliseconds(time.median));
            let _ = write!(html, "<td class=\"n\">{time}");
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</table>");
}

/// Text that a browser shows as it is.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
