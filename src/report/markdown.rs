//! The short page for `docs/`.

use std::fmt::Write as _;

use super::Deviation;
use super::goals::goal_tables;
use super::overall::tables;
use super::pictures::file_name;
use super::results::{Point, SceneResults, Study};

/// Markdown that says what presets cost and how far they are off, with links to plots in `images/`.
pub fn markdown(study: &Study, command: &str) -> String {
    let from = &study.provenance;
    let mut text = format!(
        "# What accuracy costs in time\n\nMade by `{command}` at commit {}, on {} ({}); {}. {}\n\n\
         The error of a picture is the root of the mean squared relative error of linear radiance over a grid of its pixels \
         and three bands, against the path tracer; what the tracer's own noise puts in is subtracted, and one standard \
         error of the result stands behind ±. Time is that of all passes of a first picture, on the device, once its shaders are compiled: the median, and \
         the quartiles. A preset is *beaten* where something else that was measured is faster and more accurate, and *clearly* \
         so where neither error bars nor quartiles touch.\n",
        from.commit, from.device, from.driver, from.machine, from.load
    );
    for scene in study.scenes.iter().filter(|scene| !scene.random) {
        let name = &scene.scene;
        let _ = write!(
            text,
            "\n## {name}\n\n![error over time of {name}](images/cost-{}.svg)\n\n{} x {} pixels; the truth has {} walks a \
             pixel.\n\n| preset | error % | ms | beaten by |\n|---|---|---|---|\n",
            file_name(name),
            scene.width,
            scene.height,
            scene.truth_walks
        );
        presets(scene).for_each(|point| {
            let _ = writeln!(text, "{}", row(scene, point));
        });
    }
    overall_tables(study, &mut text);
    text.push_str(&goal_tables(study));
    slab_tables(study, &mut text);
    for left_out in &study.left_out {
        let _ = writeln!(text, "\nNot measured: {}: {}.", left_out.scene, left_out.reason);
    }
    text
}

fn presets(scene: &SceneResults) -> impl Iterator<Item = &Point> {
    scene.points.iter().filter(|point| point.preset.is_some())
}

fn row(scene: &SceneResults, point: &Point) -> String {
    let better = point.dominated_by.as_ref().and_then(|name| scene.points.iter().find(|other| other.name == *name));
    let beaten = better.map_or("-".to_owned(), |other| {
        let how = if super::beats_clearly(other, point) { "clearly by " } else { "" };
        format!("{how}{} ({} %, {} ms)", other.name, percent(other.error.rms), milliseconds(other.milliseconds.median))
    });
    let (error, time) = (&point.error, &point.milliseconds);
    format!(
        "| {} ({}) | {} | {} ({} to {}) | {beaten} |",
        point.preset.as_deref().unwrap_or_default(),
        point.name,
        error_with_bar(error),
        milliseconds(time.median),
        milliseconds(time.first_quartile),
        milliseconds(time.third_quartile)
    )
}

fn overall_tables(study: &Study, text: &mut String) {
    for (title, rows) in tables(study) {
        let _ = write!(
            text,
            "\n## {title}\n\nGeometric means.\n\n| settings | error % | ms | beaten by |\n|---|---|---|---|\n"
        );
        for row in rows {
            let name = if row.is_preset { format!("**{}**", row.name) } else { row.name };
            let beaten = row.dominated_by.unwrap_or_else(|| "-".to_owned());
            let _ =
                writeln!(text, "| {name} | {} | {} | {beaten} |", percent(row.error), milliseconds(row.milliseconds));
        }
    }
}

fn slab_tables(study: &Study, text: &mut String) {
    let _ = write!(
        text,
        "\n## The families of methods on a slab\n\n![families on slabs](images/cost-slabs.svg)\n\nError of reflectance and \
         diffuse transmittance against 64 discrete ordinates; time on the CPU.\n"
    );
    for slab in &study.slabs {
        let _ = write!(
            text,
            "\nA slab of {}:\n\n| method | reflectance: error % | transmittance: error % | ms |\n|---|---|---|---|\n",
            slab.slab
        );
        for point in &slab.points {
            let errors = [point.reflectance_error, point.transmittance_error].map(percent);
            let time = milliseconds(point.milliseconds.median);
            let _ = writeln!(text, "| {} | {} | {} | {time} |", point.name, errors[0], errors[1]);
        }
    }
}

/// An error in per cent with its bar; what cannot be told from zero has its upper bar alone.
pub fn error_with_bar(error: &Deviation) -> String {
    match error.low > 0.0 {
        true => format!("{} ± {}", percent(error.rms), percent(0.5 * (error.high - error.low))),
        false => format!("< {}", percent(error.high)),
    }
}

/// Per cent with two significant digits.
pub fn percent(share: f64) -> String {
    significant(100.0 * share)
}

/// Milliseconds with two significant digits or more.
pub fn milliseconds(value: f64) -> String {
    significant(value)
}

fn significant(value: f64) -> String {
    let digits = if value >= 10.0 || value <= 0.0 { 0 } else { (1.0 - value.log10().floor()).clamp(0.0, 6.0) as usize };
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_two_significant_digits() {
        assert_eq!([0.001234, 0.0123, 0.123, 1.23].map(percent), ["0.12", "1.2", "12", "123"]);
        assert_eq!(milliseconds(0.0), "0");
    }
}
