//! `probes.json`: golden inputs and outputs, by which an importer finds out whether it reads the tables rightly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Precision;
use crate::Bands;
use crate::sky_tables::SkyTables;

/// Golden inputs and outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "welkin pack probes")]
pub struct Probes {
    /// What to do with them.
    pub how_to: String,
    /// How far an importer in 32-bit floats may be from `answers`: relative, and absolute below `dark`.
    pub relative_tolerance: f64,
    /// Answers below are compared with this as their size.
    pub dark: f64,
    /// The questions.
    pub inputs: Vec<ProbeInput>,
    /// The answers from the tables, for each precision in which the pack holds them.
    pub answers: Vec<ProbeAnswers>,
}

/// Arguments of the functions, each a 32-bit float exactly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeInput {
    /// Of the observer, m.
    pub altitude_m: f64,
    /// Cosine of the view's zenith angle.
    pub mu: f64,
    /// Cosine of the sun's zenith angle.
    pub mu_s: f64,
    /// Cosine of the angle between view and sun.
    pub nu: f64,
}

/// All answers from tables of one precision.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeAnswers {
    /// Of the tables.
    pub precision: Precision,
    /// In the order of the inputs.
    pub values: Vec<ProbeAnswer>,
}

/// What the functions of these names answer, for unit irradiance of the sun.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeAnswer {
    /// From the observer towards the sun: `transmittance_to_space(altitude_m, mu_s)`.
    pub transmittance_to_space: Bands,
    /// `view_transmittance(altitude_m, mu)`.
    pub view_transmittance: Bands,
    /// `sky_irradiance(altitude_m, mu_s)`.
    pub sky_irradiance: Bands,
    /// `sun_irradiance(altitude_m, mu_s)`.
    pub sun_irradiance: Bands,
    /// `sky_radiance(altitude_m, mu, mu_s, nu)`, 1/sr.
    pub sky_radiance: Bands,
    /// `ground_radiance(altitude_m, mu, mu_s, nu)`, 1/sr.
    pub ground_radiance: Bands,
}

/// How far an importer may be off: 32-bit floats turn angles of a ray near the horizon by 1e-7, and a table's slope and
/// the logarithms in it make up to a thousand times as much of it. `tests/engine_shaders.rs` measures it on a device.
const RELATIVE_TOLERANCE: f64 = 1e-3;

/// Light that is less than this share of the sun's.
const DARK: f64 = 1e-12;

impl ProbeAnswer {
    /// What tables answer.
    pub fn of(tables: &SkyTables, input: &ProbeInput) -> Self {
        let &ProbeInput { altitude_m, mu, mu_s, nu } = input;
        Self {
            transmittance_to_space: tables.transmittance_to_space(altitude_m, mu_s),
            view_transmittance: tables.view_transmittance(altitude_m, mu),
            sky_irradiance: tables.sky_irradiance(altitude_m, mu_s),
            sun_irradiance: tables.sun_irradiance(altitude_m, mu_s),
            sky_radiance: tables.sky_radiance(altitude_m, [mu, mu_s, nu]),
            ground_radiance: tables.ground_radiance(altitude_m, [mu, mu_s, nu]),
        }
    }

    /// The quantities with their names, in order.
    pub fn quantities(&self) -> [(&'static str, Bands); 6] {
        [
            ("transmittance_to_space", self.transmittance_to_space),
            ("view_transmittance", self.view_transmittance),
            ("sky_irradiance", self.sky_irradiance),
            ("sun_irradiance", self.sun_irradiance),
            ("sky_radiance", self.sky_radiance),
            ("ground_radiance", self.ground_radiance),
        ]
    }
}

/// Where probes look from: from the ground, in the air, at its top and from space; as shares of the air's height.
const ALTITUDES: [f64; 6] = [2e-5, 5e-3, 0.1, 0.6, 1.0, 4.0];
/// Zenith angles of the view, of which some meet the ground, and azimuths from the sun, degrees.
const VIEWS_DEG: [[f64; 2]; 6] = [[0.0, 0.0], [40.0, 20.0], [75.0, 170.0], [89.0, 5.0], [100.0, 90.0], [160.0, 60.0]];
/// Zenith angles of the sun, from high to deep twilight, degrees.
const SUNS_DEG: [f64; 5] = [0.0, 45.0, 80.0, 89.0, 95.0];

/// The probes of an air of this height, m: seen from low and from high, into the sky and onto the ground, by day and in
/// twilight. Rays at the horizon itself are left out: which side of it they are on is a matter of rounding.
pub fn probe_inputs(top_m: f64) -> Vec<ProbeInput> {
    let exactly = |value: f64| f64::from(value as f32);
    let mut inputs = Vec::new();
    for share in ALTITUDES {
        for (index, [zenith_deg, azimuth_deg]) in VIEWS_DEG.into_iter().enumerate() {
            // Two suns for each view, in turn.
            for sun in [index, index + 2] {
                let (zenith, azimuth) = (zenith_deg.to_radians(), azimuth_deg.to_radians());
                let sun = SUNS_DEG[sun % SUNS_DEG.len()].to_radians();
                let nu = zenith.cos() * sun.cos() + zenith.sin() * sun.sin() * azimuth.cos();
                let [altitude_m, mu, mu_s, nu] = [share * top_m, zenith.cos(), sun.cos(), nu].map(exactly);
                inputs.push(ProbeInput { altitude_m, mu, mu_s, nu });
            }
        }
    }
    inputs
}

impl Probes {
    pub(super) fn new(top_m: f64, tables: &[(Precision, SkyTables)]) -> Self {
        let inputs = probe_inputs(top_m);
        let answers = tables.iter().map(|(precision, tables)| ProbeAnswers {
            precision: *precision,
            values: inputs.iter().map(|input| ProbeAnswer::of(tables, input)).collect(),
        });
        Self {
            how_to:
                "call each function with the inputs, in the units of the manifest, and compare with the answers of \
                     the precision that you have imported: sky_probe of the pack's shaders does so in one dispatch"
                    .to_owned(),
            relative_tolerance: RELATIVE_TOLERANCE,
            dark: DARK,
            answers: answers.collect(),
            inputs,
        }
    }

    /// The first value that is farther from an answer than tolerated, by index, name, expectation and find.
    pub fn first_difference(
        &self,
        answers: &ProbeAnswers,
        found: &[ProbeAnswer],
        relative_tolerance: f64,
    ) -> Option<(usize, &'static str, Bands, Bands)> {
        let differs = |expected: Bands, found: Bands| {
            let close = |(e, f): (f64, f64)| (e - f).abs() <= relative_tolerance * e.abs().max(self.dark);
            !expected.into_iter().zip(found).all(close)
        };
        answers.values.iter().zip(found).enumerate().find_map(|(index, (expected, found))| {
            let pairs = expected.quantities().into_iter().zip(found.quantities());
            let (expected, found) = pairs.into_iter().find(|(e, f)| differs(e.1, f.1))?;
            Some((index, expected.0, expected.1, found.1))
        })
    }
}
