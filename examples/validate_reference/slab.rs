//! Homogeneous slabs: fluxes by the forward code, radiances by the path tracer.

use std::collections::BTreeMap;
use std::time::Instant;

use welkin::probe::Orders;
use welkin::reference::Effort;
use welkin::reference::path::{FirstOrderBy, View};
use welkin::reference::probe::run;
use welkin::reference::slab::Slab;

use crate::tables::{self, Row};

/// Walks of the first round, and the most.
const WALKS: [u64; 2] = [1 << 14, 1 << 24];

/// Walks for each radiance.
const RADIANCE_WALKS: u64 = 1 << 17;

struct Score {
    z: f64,
    relative_error: f64,
    line: String,
}

/// Fluxes of every `every`-th row, with the standard error of reflectance and diffuse transmittance below `error`
/// of the incident flux and, where they exceed 1 %, of themselves; true when the codes differ.
pub fn fluxes(every: usize, error: f64) -> bool {
    let mut groups: BTreeMap<String, Vec<Score>> = BTreeMap::new();
    let start = Instant::now();
    for row in tables::read("slab.csv").iter().step_by(every) {
        let slab = Slab {
            optical_thickness: row.number("tau"),
            albedo: row.number("ssa"),
            phase: tables::phase(row.text("phase")),
            mu0: row.number("mu0"),
            surface_albedo: row.number("surface_albedo"),
        };
        let mut walks = WALKS[0];
        let own = loop {
            let own = slab.fluxes(walks, 11 + walks);
            let excess = |m: welkin::reference::slab::Measured| m.standard_error / (error * m.value.max(0.01));
            let excess = excess(own.reflectance).max(excess(own.diffuse_transmittance));
            if excess <= 1.0 || walks >= WALKS[1] {
                break own;
            }
            walks = ((walks as f64 * (1.2 * excess).powi(2)) as u64).clamp(2 * walks, WALKS[1]);
        };
        let group = groups.entry(format!("tau {:>4}", row.text("tau"))).or_default();
        for (column, m) in
            [("R_diffuse", own.reflectance), ("T_diffuse", own.diffuse_transmittance), ("absorbed", own.absorbed)]
        {
            group.push(score(row, column, m.value, m.standard_error, 1e-7));
        }
        let scatter = own.balance;
        let z = (scatter.value - 1.0) / scatter.standard_error.max(1e-13);
        group.push(Score { z, relative_error: scatter.standard_error, line: format!("balance {slab:?}: {scatter:?}") });
    }
    println!("{:.1} s", start.elapsed().as_secs_f64());
    report(groups)
}

/// Radiances of every `every`-th row by the path tracer, with a fixed number of walks; true when the codes differ.
/// Light that has crossed many optical depths is left out: where the error stays above 2 %.
pub fn radiances(every: usize) -> bool {
    let mut groups: BTreeMap<String, Vec<Score>> = BTreeMap::new();
    let start = Instant::now();
    let mut unresolved = 0;
    for (i, row) in tables::read("slab_radiance.csv").iter().enumerate().step_by(every) {
        let phase = tables::phase(row.text("phase"));
        let world = tables::slab_world(row.number("tau"), row.number("ssa"), phase, row.number("mu0"), 0.0);
        let (position, direction) = tables::slab_ray(row);
        let view = View::new(&world, position, direction, FirstOrderBy::Quadrature);
        let estimate = run(&view, Effort::Walks(RADIANCE_WALKS), Orders::All, 1, i as u64);
        let (value, own_error) = (estimate.mean.total()[0], estimate.total_error[0]);
        if own_error > 0.02 * value {
            unresolved += 1;
            continue;
        }
        // The table claims 1e-4 for most rows and 1e-3 at worst.
        let accuracy = 3e-4 * row.number("radiance");
        groups
            .entry(format!("tau {:>4}", row.text("tau")))
            .or_default()
            .push(score(row, "radiance", value, own_error, accuracy));
    }
    println!("{:.1} s; {unresolved} rows left out", start.elapsed().as_secs_f64());
    report(groups)
}

fn score(row: &Row, column: &str, value: f64, own_error: f64, accuracy: f64) -> Score {
    let table = row.number(column);
    let z = (value - table) / (own_error.powi(2) + accuracy.powi(2)).sqrt();
    let line = format!("{column} own {value:.6e} ± {own_error:.1e}, table {table:.6e}: {}", row.line());
    Score { z, relative_error: if value > 1e-12 { own_error / value } else { 0.0 }, line }
}

fn report(groups: BTreeMap<String, Vec<Score>>) -> bool {
    println!("group     numbers  z mean  z rms  z max  own error % median (max)");
    let mut all = Vec::new();
    for (name, scores) in groups {
        let n = scores.len() as f64;
        let mean = scores.iter().map(|s| s.z).sum::<f64>() / n;
        let rms = (scores.iter().map(|s| s.z * s.z).sum::<f64>() / n).sqrt();
        let max = scores.iter().map(|s| s.z.abs()).fold(0.0, f64::max);
        let mut errors: Vec<f64> = scores.iter().map(|s| 100.0 * s.relative_error).collect();
        errors.sort_by(f64::total_cmp);
        let (median, most) = (errors[errors.len() / 2], errors[errors.len() - 1]);
        println!("{name} {:8} {mean:7.2} {rms:6.2} {max:6.2}  {median:.3} ({most:.2})", scores.len());
        all.extend(scores);
    }
    all.sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
    println!("worst:");
    all.iter().take(8).for_each(|score| println!("  z {:6.2}  {}", score.z, score.line));
    all[0].z.abs() > 5.0
}
