//! The CSV tables that a probe reads and writes.

use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;

use super::{Ray, RayRadiance, RaysError};
use csv::{ReaderBuilder, StringRecord, Trim, WriterBuilder};

/// The columns of a ray, in the order of [`Ray`]'s fields.
const RAY_COLUMNS: [&str; 5] =
    ["altitude_m", "view_zenith_deg", "view_azimuth_deg", "sun_zenith_deg", "sun_azimuth_deg"];

/// The column that may be missing: every ray then runs to the ground or to space.
const DISTANCE_COLUMN: &str = "distance_m";

/// The columns of an answer.
const ANSWER_COLUMNS: [&str; 9] = [
    "radiance_r",
    "radiance_g",
    "radiance_b",
    "transmittance_r",
    "transmittance_g",
    "transmittance_b",
    "stderr_r",
    "stderr_g",
    "stderr_b",
];

/// Highest observer, m: as a scene's camera.
const HIGHEST_M: f64 = 1e10;

/// Rays with the rows that they were read from.
#[derive(Debug)]
pub struct RayTable {
    header: StringRecord,
    rows: Vec<StringRecord>,
    rays: Vec<Ray>,
}

impl RayTable {
    /// Reads a CSV file of rays on a planet of some radius.
    ///
    /// # Errors
    /// [`RaysError`] with the line, the column, the value and what is allowed.
    pub fn read(path: &Path, planet_radius_m: f64) -> Result<Self, RaysError> {
        let text = fs::read_to_string(path).map_err(|source| RaysError::Read { path: path.to_owned(), source })?;
        Self::parse(&text, path, planet_radius_m)
    }

    /// The same of a text; `path` stands in messages.
    ///
    /// # Errors
    /// As [`RayTable::read`].
    pub fn parse(text: &str, path: &Path, planet_radius_m: f64) -> Result<Self, RaysError> {
        let csv_error = |source| RaysError::Csv { path: path.to_owned(), source };
        let mut reader = ReaderBuilder::new().trim(Trim::All).from_reader(text.as_bytes());
        let header = reader.headers().map_err(csv_error)?.clone();
        let columns = find_columns(path, &header)?;
        let distance_column = header.iter().position(|name| name == DISTANCE_COLUMN);
        // Just above the centre, where directions still have a vertical.
        let altitudes = -planet_radius_m * (1.0 - 1e-9)..=HIGHEST_M;
        let (mut rows, mut rays) = (Vec::new(), Vec::new());
        for row in reader.records() {
            let row = row.map_err(csv_error)?;
            rays.push(ray(path, &row, columns, distance_column, &altitudes)?);
            rows.push(row);
        }
        Ok(Self { header, rows, rays })
    }

    /// The rays, in the order of their rows.
    pub fn rays(&self) -> &[Ray] {
        &self.rays
    }

    /// The same rows with an answer each, as CSV text.
    ///
    /// # Errors
    /// None: there is a row for every answer and memory for the text.
    pub fn with_answers(&self, answers: &[RayRadiance]) -> Result<Vec<u8>, csv::Error> {
        let mut writer = WriterBuilder::new().from_writer(Vec::new());
        writer.write_record(self.header.iter().chain(ANSWER_COLUMNS))?;
        for (row, answer) in self.rows.iter().zip(answers) {
            let values = [answer.radiance, answer.transmittance, answer.standard_error];
            let values = values.as_flattened().iter().map(|value| format!("{value:e}")).collect::<Vec<_>>();
            writer.write_record(row.iter().chain(values.iter().map(String::as_str)))?;
        }
        writer.flush()?;
        writer.into_inner().map_err(|error| error.into_error().into())
    }
}

fn find_columns(path: &Path, header: &StringRecord) -> Result<[usize; 5], RaysError> {
    if let Some(&column) = ANSWER_COLUMNS.iter().find(|&&column| header.iter().any(|name| name == column)) {
        return Err(RaysError::Reserved { path: path.to_owned(), column });
    }
    let mut columns = [0; RAY_COLUMNS.len()];
    for (index, &column) in columns.iter_mut().zip(&RAY_COLUMNS) {
        let found: Vec<usize> = (0..header.len()).filter(|&at| &header[at] == column).collect();
        let [only] = found[..] else {
            let (path, header) = (path.to_owned(), header.iter().collect::<Vec<_>>().join(", "));
            return Err(RaysError::Column { path, column, count: found.len(), header });
        };
        *index = only;
    }
    Ok(columns)
}

fn ray(
    path: &Path,
    row: &StringRecord,
    columns: [usize; 5],
    distance_column: Option<usize>,
    altitudes: &RangeInclusive<f64>,
) -> Result<Ray, RaysError> {
    let refused = |column: &'static str, text: &str, allowed: String| RaysError::Value {
        path: path.to_owned(),
        line: row.position().map_or(0, csv::Position::line),
        column,
        value: text.to_owned(),
        allowed,
    };
    let value = |field: usize, range: &RangeInclusive<f64>| {
        let text = &row[columns[field]];
        text.parse().ok().filter(|number| range.contains(number)).ok_or_else(|| {
            refused(RAY_COLUMNS[field], text, format!("a number from {} to {}", range.start(), range.end()))
        })
    };
    let distance_m = distance_column.map_or(Ok(f64::INFINITY), |column| {
        let text = &row[column];
        let distance = text.parse().ok().filter(|&distance: &f64| distance > 0.0);
        distance.ok_or_else(|| refused(DISTANCE_COLUMN, text, "a number above 0, or inf".to_owned()))
    })?;
    let (zenith, azimuth) = (0.0..=180.0, -360.0..=360.0);
    Ok(Ray {
        altitude_m: value(0, altitudes)?,
        view_zenith_rad: value(1, &zenith)?.to_radians(),
        view_azimuth_rad: value(2, &azimuth)?.to_radians(),
        sun_zenith_rad: value(3, &zenith)?.to_radians(),
        sun_azimuth_rad: value(4, &azimuth)?.to_radians(),
        distance_m,
    })
}
