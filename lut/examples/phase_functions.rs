//! Writes `phase-functions.md` and its plot: how far the analytic phase functions are from Mie theory.
//!
//! `cargo run --release -p welkin-lut --example phase_functions -- docs`

#[path = "../tests/phase_reference/mod.rs"]
mod phase_reference;

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use phase_reference::{Band, MieTable, mie_tables, root_mean_square_log_ratio};
use plotters::prelude::*;
use welkin_lut::PhaseFunction;

const FORWARD: Band = Band { from_deg: 0.0, to_deg: 30.0 };
const SIDE: Band = Band { from_deg: 30.0, to_deg: 150.0 };
const BACK: Band = Band { from_deg: 150.0, to_deg: 180.0 };

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).ok_or("usage: phase_functions DIRECTORY")?;
    let directory = Path::new(&directory);
    let tables = mie_tables();
    std::fs::write(directory.join("phase-functions.md"), page(&tables)?)?;
    plot(&tables[0], &directory.join("phase-functions.svg"))
}

/// The functions that stand in for a size distribution, each with the parameter that a user would give it.
fn models(table: &MieTable) -> Vec<(String, PhaseFunction)> {
    let g = table.mean_cosine;
    let cornette_shanks = cornette_shanks_parameter(g);
    let mut models = vec![
        (format!("Henyey-Greenstein, g {g:.4}"), PhaseFunction::HenyeyGreenstein { g }),
        (format!("Cornette-Shanks, g {cornette_shanks:.4}"), PhaseFunction::CornetteShanks { g: cornette_shanks }),
    ];
    let droplet_diameter_um = 2.0 * table.effective_radius_um;
    let fit = PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um };
    if fit.validate().is_ok() {
        models.push((format!("HG+Draine, {droplet_diameter_um} µm"), fit));
    }
    models
}

/// The parameter with which Cornette-Shanks has a mean cosine, by bisection; the mean cosine rises with it.
fn cornette_shanks_parameter(mean_cosine: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (PhaseFunction::CornetteShanks { g: middle }).mean_cosine() < mean_cosine {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn page(tables: &[MieTable]) -> Result<String, std::fmt::Error> {
    let mut page = String::from(INTRODUCTION);
    for table in tables {
        let mie = table.phase_function();
        for (name, phase) in models(table) {
            // Adding 0 turns -0 into 0.
            let excess = (1e4 * (phase.mean_cosine() - table.mean_cosine)).round() / 1e4 + 0.0;
            let rms = |band| root_mean_square_log_ratio(&phase, &mie, band);
            let share = |band: Band| band.integral(|c| phase.value(c)) / band.integral(|c| mie.value(c)) - 1.0;
            writeln!(
                page,
                "| {} | {name} | {:.4} | {:.2} | {:.2} | {:.2} | {:.2} | {:+.1} | {:+.1} | {:+.1} |",
                table.name.replace('_', " "),
                excess,
                rms(Band::SPHERE),
                rms(FORWARD),
                rms(SIDE),
                rms(BACK),
                100.0 * share(FORWARD),
                100.0 * share(SIDE),
                100.0 * share(BACK),
            )?;
        }
    }
    page.push_str(TABLES_AS_GIVEN);
    for table in tables {
        writeln!(
            page,
            "| {} | {:+.1e} | {:+.1e} |",
            table.name.replace('_', " "),
            table.phase().table_integral() - 1.0,
            table.phase_function().mean_cosine() - table.mean_cosine,
        )?;
    }
    Ok(page)
}

const INTRODUCTION: &str = "\
# Phase functions against Mie theory
Made by `cargo run --release -p welkin-lut --example phase_functions -- docs`.

Water droplets scatter as Mie theory says. The analytic functions stand in for it; this is what each costs. The truth
is the five size distributions of `lut/tests/reference/mie.csv` (refractive index 1.333, 0.55 µm; the README beside it
tells how they were made). Henyey-Greenstein and Cornette-Shanks get the parameter that gives them the mean cosine of
the Mie series; HG+Draine gets twice the effective radius as the droplets' diameter, and is left out where that is
below the 5 µm at which the fit begins.

- *rms*: √(mean of (ln P/P_Mie)²), every direction weighing the same: 0.69 is a factor of two.
- *share*: the light scattered into a band of angles, relative to Mie theory, in per cent.
- Bands: forward 0-30°, side 30-150°, back 150-180°.

![cloud droplets of 10 µm](phase-functions.svg)

| droplets | function | mean cosine - Mie | rms, sphere | rms, forward | rms, side | rms, back | share, forward % | share, side % | share, back % |
|---|---|---|---|---|---|---|---|---|---|
";

const TABLES_AS_GIVEN: &str = "
No analytic function has the glory and the cloud bow at the back, nor the whole diffraction peak; where they matter,
give the Mie table itself as the phase function. What the table then loses by its steps of 0.5°:

| droplets | ∫P dω - 1 before scaling | mean cosine - Mie |
|---|---|---|
";

fn plot(table: &MieTable, path: &Path) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (800, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..180.0, (1e-3..1e3).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("scattering angle, degrees")
        .y_desc("P, 1/sr")
        .y_label_formatter(&|value| format!("{value:.0e}"))
        .draw()?;
    let mie = (format!("Mie, {}", table.name.replace('_', " ")), table.phase_function());
    let colours = [BLACK, RGBColor(0, 114, 178), RGBColor(230, 159, 0), RGBColor(0, 158, 115)];
    for ((name, phase), colour) in std::iter::once(mie).chain(models(table)).zip(colours) {
        let curve = (0..=360).map(|i| f64::from(i) / 2.0).map(|theta| (theta, phase.value(theta.to_radians().cos())));
        chart
            .draw_series(LineSeries::new(curve, colour.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(2)));
    }
    chart.configure_series_labels().background_style(WHITE).border_style(BLACK).draw()?;
    root.present()?;
    Ok(())
}
