//! Rays through the clear sky.

use std::collections::BTreeMap;
use std::time::Instant;

use rayon::prelude::*;
use welkin::probe::{Orders, Ray};
use welkin::reference::probe::probe_world;
use welkin::reference::{Effort, World};
use welkin_lut::Bands;

use crate::ledger::Ledger;
use crate::options::Options;
use crate::tables::{self, Row};

/// A view of a table: what was asked, and the rows (one for each band) that answer it.
struct Question {
    ray: Ray,
    variant: String,
    albedo: f64,
    rows: Vec<Row>,
}

struct Score {
    z: f64,
    ratio: f64,
    own_error: f64,
    line: String,
}

/// What the columns of a table are called.
pub struct Columns {
    /// File beside the tests.
    pub file: &'static str,
    /// Light scattered once.
    pub single: &'static str,
    /// All light.
    pub total: &'static str,
    /// One standard error of that.
    pub error: &'static str,
}

/// Compares every `every`-th view (of the sun at one zenith angle, if given); true when the codes differ.
pub fn run(columns: &Columns, options: &Options) -> Result<bool, String> {
    let questions: Vec<(usize, Question)> = questions(columns)
        .into_iter()
        .enumerate()
        .filter(|(_, q)| options.sun_deg.is_none_or(|sun| (q.ray.sun_zenith_rad.to_degrees() - sun).abs() < 1e-6))
        .step_by(options.every)
        .collect();
    let ledger = Ledger::open(options.ledger.as_deref(), &options.identity(columns.file))?;
    Ok(validate(columns, &questions, options, &ledger))
}

fn questions(columns: &Columns) -> Vec<Question> {
    let mut by_view: BTreeMap<String, Question> = BTreeMap::new();
    for row in tables::read(columns.file) {
        let views = columns.file == "earth_views.csv";
        let variant = if views { "B" } else { row.text("variant") }.to_owned();
        let altitude_m = if views { row.number("observer_alt_m") } else { 500.0 };
        let ray = Ray {
            altitude_m,
            view_zenith_rad: row.number("vza_deg").to_radians(),
            view_azimuth_rad: row.number("rel_azimuth_deg").to_radians(),
            sun_zenith_rad: row.number("sza_deg").to_radians(),
            sun_azimuth_rad: 0.0,
            distance_m: f64::INFINITY,
        };
        let albedo = row.number("ground_albedo");
        let key = format!("{variant} {albedo} {ray:?}");
        by_view.entry(key).or_insert(Question { ray, variant, albedo, rows: Vec::new() }).rows.push(row);
    }
    let mut questions: Vec<Question> = by_view.into_values().collect();
    // High suns are quick.
    questions.sort_by(|a, b| a.ray.sun_zenith_rad.total_cmp(&b.ray.sun_zenith_rad));
    questions
}

/// What the reference found for a view: radiance, its standard error, order 1.
struct Found {
    radiance: Bands,
    standard_error: Bands,
    single: Bands,
    seconds: f64,
}

#[derive(Default)]
struct BySun {
    scores: Vec<Score>,
    singles: Vec<f64>,
    seconds: f64,
    rays: usize,
}

fn validate(columns: &Columns, questions: &[(usize, Question)], options: &Options, ledger: &Ledger) -> bool {
    let worlds: BTreeMap<_, World> = questions
        .iter()
        .map(|(_, q)| ((q.variant.clone(), q.albedo.to_bits()), tables::earth(&q.variant, q.albedo)))
        .collect();
    let answer = |(number, q): &(usize, Question)| {
        let world = &worlds[&(q.variant.clone(), q.albedo.to_bits())];
        let key = format!("{} {} {:?}", q.variant, q.albedo, q.ray);
        let values = ledger.answer(&key, || trace(world, &q.ray, options, *number));
        let bands = |at: usize| [values[at], values[at + 1], values[at + 2]];
        Found { radiance: bands(0), standard_error: bands(3), single: bands(6), seconds: values[9] }
    };
    let found: Vec<Found> = questions.par_iter().with_max_len(1).map(answer).collect();
    let mut by_sun: BTreeMap<u32, BySun> = BTreeMap::new();
    for ((_, q), found) in questions.iter().zip(&found) {
        let entry = by_sun.entry(q.ray.sun_zenith_rad.to_degrees().round() as u32).or_default();
        entry.seconds += found.seconds;
        entry.rays += 1;
        for row in &q.rows {
            entry.scores.push(score(columns, q, row, found));
            let (table, own) = (row.number(columns.single), found.single[row.band()]);
            if table > 0.0 {
                entry.singles.push((own / table - 1.0).abs());
            }
        }
    }
    report(by_sun)
}

/// All bands of one view share their walks; every view has a seed of its own, so views are independent.
fn trace(world: &World, ray: &Ray, options: &Options, number: usize) -> Vec<f64> {
    let start = Instant::now();
    let seed = options.seed << 32 | number as u64;
    let one = |orders| probe_world(world, &[*ray], orders, Effort::RelativeError(options.error), seed)[0];
    let (all, single) = (one(Orders::All), one(Orders::Single));
    let seconds = start.elapsed().as_secs_f64();
    [all.radiance, all.standard_error, single.radiance].into_iter().flatten().chain([seconds]).collect()
}

fn score(columns: &Columns, q: &Question, row: &Row, found: &Found) -> Score {
    let band = row.band();
    let (own, own_error) = (found.radiance[band], found.standard_error[band]);
    let (table, table_error) = (row.number(columns.total), row.number(columns.error));
    let combined = (own_error.powi(2) + table_error.powi(2)).sqrt();
    let z = if own == table { 0.0 } else { (own - table) / combined };
    let ratio = if table == 0.0 { 1.0 } else { own / table };
    let line = format!(
        "{} {} albedo {} h {} sza {} vza {} az {}: own {own:.6e} ± {own_error:.1e}, table {table:.6e} ± {table_error:.1e}",
        q.variant,
        row.text("band"),
        q.albedo,
        q.ray.altitude_m,
        row.text("sza_deg"),
        row.text("vza_deg"),
        row.text("rel_azimuth_deg"),
    );
    Score { z, ratio, own_error: if own == 0.0 { 0.0 } else { own_error / own }, line }
}

fn report(by_sun: BTreeMap<u32, BySun>) -> bool {
    let mut all = Vec::new();
    println!("sun   rows  z mean  z rms  z max  ratio-1 %  own error % (max)  single max      s/ray");
    for (sun, BySun { scores, singles, seconds, rays }) in by_sun {
        let n = scores.len() as f64;
        let mean = scores.iter().map(|s| s.z).sum::<f64>() / n;
        let rms = (scores.iter().map(|s| s.z * s.z).sum::<f64>() / n).sqrt();
        let max = scores.iter().map(|s| s.z.abs()).fold(0.0, f64::max);
        let ratio = 100.0 * (scores.iter().map(|s| s.ratio).sum::<f64>() / n - 1.0);
        let error = 100.0 * scores.iter().map(|s| s.own_error).sum::<f64>() / n;
        let error_max = 100.0 * scores.iter().map(|s| s.own_error).fold(0.0, f64::max);
        let single = singles.into_iter().fold(0.0, f64::max);
        println!(
            "{sun:3} {:6} {mean:7.2} {rms:6.2} {max:6.2} {ratio:9.3} {error:9.3} ({error_max:.3})  {single:12.1e} {:10.4}",
            scores.len(),
            seconds / rays as f64
        );
        all.extend(scores);
    }
    let n = all.len() as f64;
    let chi_square: f64 = all.iter().map(|s| s.z * s.z).sum();
    println!("all {n}: chi-square / rows {:.3}", chi_square / n);
    let beyond = all.iter().filter(|s| s.z.abs() > 3.0).count();
    println!("beyond 3: {beyond}, of which chance explains {:.1}", 0.0027 * n);
    all.sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
    println!("worst rows:");
    for score in all.iter().take(16) {
        println!("  z {:6.2}  {}", score.z, score.line);
    }
    all[0].z.abs() > 5.0
}
