//! Homogeneous slabs: fluxes and radiances by the forward codes, radiances also by the path tracer.

use std::collections::BTreeMap;
use std::time::Instant;

use welkin::probe::Orders;
use welkin::reference::Effort;
use welkin::reference::path::{FirstOrderBy, View};
use welkin::reference::probe::run;
use welkin::reference::slab::{Exit, Side, Slab};
use welkin_lut::PhaseFunction;

use crate::ledger::Ledger;
use crate::options::Options;
use crate::tables::{self, Row};

struct Score {
    z: f64,
    relative_error: f64,
    line: String,
}

/// Fluxes of every `every`-th row; true when the codes differ.
pub fn fluxes(options: &Options) -> Result<bool, String> {
    let ledger = Ledger::open(options.ledger.as_deref(), &options.identity("slab.csv"))?;
    let mut groups: BTreeMap<String, Vec<Score>> = BTreeMap::new();
    let mut longest = 0.0_f64;
    for (i, row) in tables::read("slab.csv").iter().enumerate().step_by(options.every) {
        let slab = slab(row, tables::phase(row.text("phase")), row.number("surface_albedo"));
        let found = ledger.answer(&format!("{slab:?}"), || {
            let start = Instant::now();
            let own = slab.fluxes_to(options.error, options.seed << 32 | i as u64);
            let measured = [own.reflectance, own.diffuse_transmittance, own.absorbed, own.balance];
            let numbers = measured.into_iter().flat_map(|m| [m.value, m.standard_error]);
            numbers.chain([start.elapsed().as_secs_f64()]).collect()
        });
        longest = longest.max(found[8]);
        let group = groups.entry(format!("tau {:>4}", row.text("tau"))).or_default();
        for (column, at) in [("R_diffuse", 0), ("T_diffuse", 2), ("absorbed", 4)] {
            // The table has eight decimals.
            group.push(score(row, column, found[at], found[at + 1], 1e-7));
        }
        let z = (found[6] - 1.0) / found[7].max(1e-13);
        group.push(Score {
            z,
            relative_error: found[7],
            line: format!("balance {slab:?}: {} ± {:e}", found[6], found[7]),
        });
    }
    println!("longest {longest:.1} s");
    Ok(report(groups))
}

/// Radiances of every `every`-th row; true when the codes differ.
pub fn radiances(options: &Options) -> Result<bool, String> {
    let ledger = Ledger::open(options.ledger.as_deref(), &options.identity("slab_radiance.csv"))?;
    let mut groups: BTreeMap<String, Vec<Score>> = BTreeMap::new();
    let mut longest = 0.0_f64;
    for (i, row) in tables::read("slab_radiance.csv").iter().enumerate().step_by(options.every) {
        let found = ledger.answer(&row.line(), || {
            let start = Instant::now();
            let (value, error) = radiance(row, options, options.seed << 32 | i as u64);
            vec![value, error, start.elapsed().as_secs_f64()]
        });
        longest = longest.max(found[2]);
        // The table claims 1e-4 for most rows and 1e-3 at worst.
        let accuracy = 3e-4 * row.number("radiance");
        let group = groups.entry(format!("tau {:>4}", row.text("tau"))).or_default();
        group.push(score(row, "radiance", found[0], found[1], accuracy));
    }
    println!("longest {longest:.1} s");
    Ok(report(groups))
}

fn radiance(row: &Row, options: &Options, seed: u64) -> (f64, f64) {
    let phase = tables::phase(row.text("phase"));
    if options.path {
        let world = tables::slab_world(row.number("tau"), row.number("ssa"), phase, row.number("mu0"), 0.0);
        let (position, direction) = tables::slab_ray(row);
        let view = View::new(&world, position, direction, FirstOrderBy::Quadrature);
        let estimate = run(&view, Effort::RelativeError(options.error), Orders::All, seed, 0);
        return (estimate.mean.total()[0], estimate.total_error[0]);
    }
    let slab = slab(row, phase, 0.0);
    let side = if row.text("side") == "top_up" { Side::Top } else { Side::Bottom };
    let azimuth_rad = row.number("rel_azimuth_deg").to_radians();
    let found = slab.radiance_to(&Exit { side, mu: row.number("mu_view"), azimuth_rad }, options.error, seed);
    (found.value, found.standard_error)
}

fn slab(row: &Row, phase: PhaseFunction, surface_albedo: f64) -> Slab {
    Slab {
        optical_thickness: row.number("tau"),
        albedo: row.number("ssa"),
        phase,
        mu0: row.number("mu0"),
        surface_albedo,
    }
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
    let n = all.len() as f64;
    let beyond = all.iter().filter(|s| s.z.abs() > 3.0).count();
    let chi_square = all.iter().map(|s| s.z * s.z).sum::<f64>() / n;
    println!(
        "all {n}: chi-square / number {chi_square:.3}; beyond 3: {beyond}, of which chance explains {:.1}",
        0.0027 * n
    );
    all.sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
    println!("worst:");
    all.iter().take(8).for_each(|score| println!("  z {:6.2}  {}", score.z, score.line));
    all[0].z.abs() > 5.0
}
