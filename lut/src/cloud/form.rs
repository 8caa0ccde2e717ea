//! The kinds of clouds: what a layer of each looks like unless the user says otherwise.

use crate::PhaseFunction;

/// Genera of clouds, and the two larger species of cumulus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CloudKind {
    /// A low grey sheet.
    Stratus,
    /// A low sheet of rolls and patches.
    Stratocumulus,
    /// Cumulus humilis and mediocris: separate heaps of fair weather.
    Cumulus,
    /// Cumulus congestus: towers.
    Congestus,
    /// A thunderstorm, with its anvil.
    Cumulonimbus,
    /// High streaks of ice.
    Cirrus,
}

/// What a kind means in physical terms.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudDefaults {
    /// Altitude of the base, m.
    pub base_m: f64,
    /// Altitude of the highest tops, m.
    pub top_m: f64,
    /// Share of the area where there may be cloud, 0 to 1.
    pub coverage: f64,
    /// Liquid or frozen water in the densest part, g/m³.
    pub water_g_per_m3: f64,
    /// Effective radius of droplets or crystals, µm.
    pub effective_radius_um: f64,
    /// Speed at which shapes change as if they rose, m/s.
    pub evolution_m_per_s: f64,
}

/// The shape of a kind, relative to its layer. Fractions of height count from the base to the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CloudForm {
    /// Fractions of a column's height: fade in from, full from, full to, gone at.
    pub gradient: [f64; 4],
    /// 0: the map's convective cells; 1: its sheets.
    pub sheet: f64,
    /// Range of the map's values over which a cloud grows from nothing to its full strength.
    pub softness: f64,
    /// Height of the weakest columns, as a share of the layer's.
    pub reach: f64,
    /// The shape's tile along the stretch, across it and upwards, m.
    pub shape_tile_m: [f64; 3],
    /// The weather map's tile, m.
    pub weather_tile_m: f64,
    /// The erosion's tile, m.
    pub erosion_tile_m: f64,
    /// Strength of the erosion, 0 to below 1.
    pub erosion: f64,
    /// Displacement of the erosion by the curl map, m.
    pub curl_m: f64,
    /// How fast density rises inside the edge.
    pub edge: f64,
    /// Additional coverage that the anvil has, 0 without one.
    pub anvil: f64,
    /// Water at the base relative to that at the top: it condenses while air rises.
    pub water_at_base: f64,
}

impl CloudKind {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::Stratus, Self::Stratocumulus, Self::Cumulus, Self::Congestus, Self::Cumulonimbus, Self::Cirrus];

    /// What a scene file calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stratus => "stratus",
            Self::Stratocumulus => "stratocumulus",
            Self::Cumulus => "cumulus",
            Self::Congestus => "congestus",
            Self::Cumulonimbus => "cumulonimbus",
            Self::Cirrus => "cirrus",
        }
    }

    /// Typical altitudes, water contents and radii: Miles, Verlinde & Clothiaux 2000 (stratiform), Warner 1955 and
    /// Rosenfeld & Lensky 1998 (convective), Heymsfield et al. 2013 (cirrus), rounded.
    pub fn defaults(self) -> CloudDefaults {
        let of = |[base_m, top_m]: [f64; 2], coverage, water_g_per_m3, effective_radius_um, evolution_m_per_s| {
            CloudDefaults { base_m, top_m, coverage, water_g_per_m3, effective_radius_um, evolution_m_per_s }
        };
        match self {
            Self::Stratus => of([300.0, 700.0], 0.95, 0.2, 7.0, 0.1),
            Self::Stratocumulus => of([800.0, 1400.0], 0.75, 0.3, 9.0, 0.3),
            Self::Cumulus => of([1000.0, 2300.0], 0.35, 0.3, 7.0, 1.0),
            Self::Congestus => of([900.0, 5000.0], 0.2, 1.0, 10.0, 2.0),
            Self::Cumulonimbus => of([800.0, 11_000.0], 0.1, 2.5, 15.0, 3.0),
            Self::Cirrus => of([8500.0, 9700.0], 0.5, 0.01, 30.0, 0.2),
        }
    }

    /// How matter of the kind scatters: the Mie fit for droplets of its size, or crystals' smoother function.
    pub fn phase(self, effective_radius_um: f64) -> PhaseFunction {
        match self {
            // Mean cosine of aggregates and bullet rosettes in the visible, 0.75 to 0.8 (Baran 2012).
            Self::Cirrus => PhaseFunction::HenyeyGreenstein { g: 0.77 },
            _ => PhaseFunction::HenyeyGreensteinDraine {
                droplet_diameter_um: (2.0 * effective_radius_um).clamp(5.0, 50.0),
            },
        }
    }

    /// Height gradients of stratus, stratocumulus and cumulus are those that are common since Schneider 2015, scaled
    /// from his one layer for all kinds to a layer for each.
    pub(super) fn form(self) -> CloudForm {
        let cumulus = CloudForm {
            gradient: [0.0, 0.06, 0.6, 1.0],
            sheet: 0.0,
            softness: 0.22,
            reach: 0.3,
            shape_tile_m: [4200.0; 3],
            weather_tile_m: 42_000.0,
            erosion_tile_m: 620.0,
            erosion: 0.35,
            curl_m: 60.0,
            edge: 6.0,
            anvil: 0.0,
            water_at_base: 0.3,
        };
        let sheet = CloudForm {
            gradient: [0.0, 0.3, 0.75, 1.0],
            sheet: 1.0,
            softness: 0.3,
            reach: 0.7,
            shape_tile_m: [5200.0; 3],
            weather_tile_m: 56_000.0,
            erosion: 0.2,
            edge: 3.0,
            water_at_base: 0.5,
            ..cumulus
        };
        match self {
            Self::Stratus => sheet,
            Self::Stratocumulus => CloudForm { sheet: 0.5, reach: 0.5, softness: 0.25, edge: 4.0, ..sheet },
            Self::Cumulus => cumulus,
            Self::Congestus => CloudForm {
                reach: 0.15,
                softness: 0.3,
                shape_tile_m: [6400.0; 3],
                weather_tile_m: 84_000.0,
                erosion_tile_m: 900.0,
                ..cumulus
            },
            Self::Cumulonimbus => CloudForm {
                gradient: [0.0, 0.03, 0.75, 1.0],
                reach: 0.1,
                softness: 0.3,
                shape_tile_m: [9600.0; 3],
                weather_tile_m: 210_000.0,
                erosion_tile_m: 1200.0,
                curl_m: 120.0,
                anvil: 0.12,
                ..cumulus
            },
            Self::Cirrus => CloudForm {
                gradient: [0.0, 0.4, 0.6, 1.0],
                softness: 0.45,
                reach: 0.9,
                shape_tile_m: [40_000.0, 3600.0, 5000.0],
                weather_tile_m: 90_000.0,
                erosion_tile_m: 1800.0,
                erosion: 0.4,
                curl_m: 500.0,
                edge: 1.5,
                water_at_base: 1.0,
                ..sheet
            },
        }
    }
}
