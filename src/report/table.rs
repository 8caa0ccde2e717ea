//! Results as tables for other programs: one line a point, and one line a pass.

use super::ReportError;
use super::results::{Family, Study};

/// Errors and times, one line for each scene and settings. Errors are shares, not per cent.
///
/// # Errors
/// [`ReportError::Csv`], never in practice.
pub fn points_csv(study: &Study) -> Result<Vec<u8>, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "scene",
        "name",
        "family",
        "preset",
        "error_rms",
        "error_low",
        "error_high",
        "truth_noise_rms",
        "error_median",
        "error_p95",
        "error_p99",
        "energy_ratio",
        "ms_median",
        "ms_first_quartile",
        "ms_third_quartile",
        "runs",
        "dominated_by",
    ])?;
    for scene in &study.scenes {
        for point in &scene.points {
            let (error, time) = (&point.error, &point.milliseconds);
            let family = match point.family {
                Family::Ladder => "ladder",
                Family::Variation => "variation",
                Family::Reference => "reference",
            };
            let numbers = [
                error.rms,
                error.low,
                error.high,
                error.noise,
                error.median,
                error.p95,
                error.p99,
                error.energy_ratio,
                time.median,
                time.first_quartile,
                time.third_quartile,
            ];
            let mut record = vec![scene.scene.clone(), point.name.clone(), family.to_owned()];
            record.push(point.preset.clone().unwrap_or_default());
            record.extend(numbers.iter().map(|number| format!("{number:e}")));
            record.push(time.runs.to_string());
            record.push(point.dominated_by.clone().unwrap_or_default());
            writer.write_record(&record)?;
        }
    }
    finish(writer)
}

/// Time of each pass, one line for each scene, settings and pass.
///
/// # Errors
/// [`ReportError::Csv`], never in practice.
pub fn passes_csv(study: &Study) -> Result<Vec<u8>, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["scene", "name", "pass", "ms_median", "ms_first_quartile", "ms_third_quartile", "runs"])?;
    for scene in &study.scenes {
        for point in &scene.points {
            for (pass, time) in &point.passes {
                let numbers = [time.median, time.first_quartile, time.third_quartile].map(|time| format!("{time:e}"));
                let names = [&scene.scene, &point.name, pass].map(String::as_str);
                let runs = time.runs.to_string();
                writer
                    .write_record(names.into_iter().chain(numbers.iter().map(String::as_str)).chain([runs.as_str()]))?;
            }
        }
    }
    finish(writer)
}

fn finish(writer: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, ReportError> {
    writer.into_inner().map_err(|error| ReportError::Csv(error.into_error().into()))
}
