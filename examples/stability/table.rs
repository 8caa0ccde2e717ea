//! The table in Markdown.

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use welkin::gpu::DeviceInfo;
use welkin::plan::{MultipleScattering, Quality, Settings};
use welkin::renderer::Renderer;

use super::hard_cases::judge::{Judgement, TRANSMITTANCE_PERCENT};
use super::hard_cases::{BY_DAY, Bound, Case, IN_TWILIGHT};
use super::hard_cases::{furnace, named};

const BEGIN: &str = "<!-- made by `cargo run --release --example stability` -->\n";
const END: &str = "<!-- end of what is made -->\n";

/// Puts what was made into a page, in place of what stands between the two marks.
pub fn put_into(path: &Path, made: &str) -> io::Result<()> {
    let [head, tail] = around_marks(path)?;
    fs::write(path, format!("{head}{BEGIN}{made}{END}{tail}"))
}

/// What stands before and behind the place of a page for what is made; asked before hours of work, too.
pub fn around_marks(path: &Path) -> io::Result<[String; 2]> {
    let page = fs::read_to_string(path)?;
    let marks = page.split_once(BEGIN).and_then(|(head, rest)| Some([head, rest.split_once(END)?.1]));
    let around = marks.ok_or_else(|| io::Error::other(format!("has no lines '{BEGIN}' and '{END}'")))?;
    Ok(around.map(str::to_owned))
}

/// The table of cases, and what fails.
pub fn page(
    info: &DeviceInfo,
    cases: &[Case],
    qualities: &[Quality],
    columns: &[Vec<Judgement>],
    walks: u64,
) -> String {
    let mut page = format!(
        "Device: {} ({} {}); {walks} walks a pixel.\n\n| case | bound | {} |\n|---|---|{}\n",
        info.name,
        info.driver,
        info.driver_version,
        qualities.iter().map(ToString::to_string).collect::<Vec<_>>().join(" | "),
        "---|".repeat(qualities.len())
    );
    for (index, case) in cases.iter().enumerate() {
        let cells: Vec<_> = columns.iter().map(|column| cell(&column[index])).collect();
        let _ = writeln!(page, "| {} | {} | {} |", case.name, bound(case.bound), cells.join(" | "));
    }
    let failing = |(index, case): (usize, &Case)| -> Vec<String> {
        let of = |(column, quality): (&Vec<Judgement>, &Quality)| -> Vec<String> {
            let found = &column[index];
            found
                .broken
                .iter()
                .chain(&found.missed)
                .map(|words| format!("- {}, {quality}: {words}", case.name))
                .collect()
        };
        columns.iter().zip(qualities).flat_map(of).collect()
    };
    let failing: Vec<_> = cases.iter().enumerate().flat_map(failing).collect();
    let lines = [("day", BY_DAY), ("twilight", IN_TWILIGHT), ("transmittance", TRANSMITTANCE_PERCENT)];
    page.push('\n');
    for (name, percents) in lines {
        let _ =
            writeln!(page, "- {name}: at most {} % from low to ultra.", percents.map(|p| p.to_string()).join(" / "));
    }
    let _ = writeln!(page, "\nWhat fails, of {1} cells: {0}.", failing.len(), cases.len() * qualities.len());
    for line in failing {
        let _ = writeln!(page, "{line}");
    }
    page
}

fn bound(bound: Bound) -> &'static str {
    match bound {
        Bound::Day => "day",
        Bound::Twilight => "twilight",
        Bound::LawsOnly(_) => "laws",
    }
}

/// Error of radiance and of transmittance, per cent, and whether all holds.
fn cell(found: &Judgement) -> String {
    let mark = if found.broken.is_empty() && found.missed.is_empty() { "" } else { " **fails**" };
    match (&found.radiance, &found.transmittance) {
        (Some(radiance), Some(transmittance)) => {
            format!("{:.2} ± {:.2} / {:.3}{mark}", radiance.percent, radiance.noise_percent, transmittance.percent)
        }
        (Some(radiance), None) => format!("{:.2} ± {:.2}{mark}", radiance.percent, radiance.noise_percent),
        _ => format!("holds{mark}").replace("holds **", "**"),
    }
}

/// The head of the table of energies.
pub fn furnace_head() -> String {
    "\n| white furnace | treatment | seen over what must be seen, less 1, %: up, slanting, down; r / g / b |\n|---|---|---|\n"
        .to_owned()
}

/// A quality's lines in it.
pub fn furnace(renderer: &mut Renderer, quality: Quality) -> String {
    let scene = named("scattering only, white ground").scene();
    let line = |multiple_scattering: MultipleScattering| {
        let settings = Settings { multiple_scattering, ..Settings::of(quality) };
        let mut cell = |view| {
            let shares = furnace::energy(renderer, &scene, settings, view);
            shares.map(|share| format!("{:+.2}", 100.0 * (share - 1.0))).join(" / ")
        };
        format!("| {quality} | {multiple_scattering} | {} |\n", furnace::VIEWS_RAD.map(&mut cell).join("; "))
    };
    [MultipleScattering::Harmonics, MultipleScattering::SourceFunction].map(line).concat()
}
