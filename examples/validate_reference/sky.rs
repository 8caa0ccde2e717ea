//! Rays through the clear sky.

use std::collections::BTreeMap;
use std::time::Instant;

use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::Effort;
use welkin::reference::probe::probe_world;

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

/// Every `every`-th view (of the sun at one zenith angle, if given); true when the codes differ.
pub fn run(columns: &Columns, every: usize, only_sun_deg: Option<f64>, effort: Effort) -> bool {
    let questions: Vec<Question> = questions(columns)
        .into_iter()
        .filter(|q| only_sun_deg.is_none_or(|sun| (q.ray.sun_zenith_rad.to_degrees() - sun).abs() < 1e-6))
        .step_by(every)
        .collect();
    validate(columns, &questions, effort)
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
        };
        let albedo = row.number("ground_albedo");
        let key = format!("{variant} {albedo} {ray:?}");
        by_view.entry(key).or_insert(Question { ray, variant, albedo, rows: Vec::new() }).rows.push(row);
    }
    by_view.into_values().collect()
}

fn validate(columns: &Columns, questions: &[Question], effort: Effort) -> bool {
    let mut by_sun: BTreeMap<u32, (Vec<Score>, Vec<f64>, f64, usize)> = BTreeMap::new();
    for variant in ["A", "B"] {
        for albedo in [0.0, 0.3] {
            let world = tables::earth(variant, albedo);
            let mut chosen: BTreeMap<u32, Vec<&Question>> = BTreeMap::new();
            for q in questions.iter().filter(|q| q.variant == variant && q.albedo == albedo) {
                chosen.entry(q.ray.sun_zenith_rad.to_degrees().round() as u32).or_default().push(q);
            }
            for (sun, chosen) in chosen {
                let rays: Vec<Ray> = chosen.iter().map(|q| q.ray).collect();
                let start = Instant::now();
                let all = probe_world(&world, &rays, Orders::All, effort, 1);
                let seconds = start.elapsed().as_secs_f64();
                let single = probe_world(&world, &rays, Orders::Single, effort, 1);
                let entry = by_sun.entry(sun).or_default();
                entry.2 += seconds;
                entry.3 += rays.len();
                for ((q, all), single) in chosen.iter().zip(&all).zip(&single) {
                    for row in &q.rows {
                        entry.0.push(score(columns, q, row, all));
                        let (table, own) = (row.number(columns.single), single.radiance[row.band()]);
                        if table > 0.0 {
                            entry.1.push((own / table - 1.0).abs());
                        }
                    }
                }
            }
        }
    }
    report(by_sun)
}

fn score(columns: &Columns, q: &Question, row: &Row, all: &RayRadiance) -> Score {
    let band = row.band();
    let (own, own_error) = (all.radiance[band], all.standard_error[band]);
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

fn report(by_sun: BTreeMap<u32, (Vec<Score>, Vec<f64>, f64, usize)>) -> bool {
    let mut all = Vec::new();
    println!("sun   rows  z mean  z rms  z max  ratio-1 %  own error % (max)  single max      s/ray");
    for (sun, (scores, singles, seconds, rays)) in by_sun {
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
    all.sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
    println!("worst rows:");
    for score in all.iter().take(12) {
        println!("  z {:6.2}  {}", score.z, score.line);
    }
    all[0].z.abs() > 5.0
}
