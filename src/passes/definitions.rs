//! What shaders are specialised by: facts of the scene, and numbers of its settings.

use welkin_lut::cloud::CloudKind;
use welkin_shaders::{Definition, Definitions};

use super::blocks::{ZONAL_COUNT, cloud_term_count, emission_breakpoints_m, lobe_count};
use super::ordinates;
use crate::plan::{Facts, TableFormat, Treatment};
use crate::probe::Orders;

/// Invocations of a workgroup that every Vulkan device takes.
const MAX_INVOCATIONS: u32 = 128;

/// The definitions that every pass of a frame is compiled with.
pub fn definitions(facts: &Facts) -> Definitions {
    let (settings, groups, directions) = (&facts.settings, &facts.groups, &facts.settings.directions);
    let grid = &settings.source_grid;
    let numbers = [
        ("CONSTITUENT_COUNT", groups.count),
        ("SCATTERING_EXPONENTIAL_END", groups.scattering_exponential_end),
        ("SCATTERING_TENT_END", groups.scattering_tent_end),
        ("SCATTERER_COUNT", groups.scatterer_count),
        ("ABSORBING_EXPONENTIAL_END", groups.absorbing_exponential_end),
        ("ABSORBING_TENT_END", groups.absorbing_tent_end),
        ("EMITTER_COUNT", facts.emitters_up_to(2)),
        ("EMITTING_EXPONENTIAL_END", facts.emitters_up_to(0)),
        ("EMITTING_TENT_END", facts.emitters_up_to(1)),
        ("ZONAL_COUNT", ZONAL_COUNT),
        ("BREAKPOINT_COUNT", emission_breakpoints_m(facts).len() as u32),
        ("LOBE_COUNT", lobe_count(facts)),
        ("LIGHT_COUNT", facts.light_slots()),
        ("FAINT_COUNT", facts.faint_discs.len() as u32),
        ("NODE_COUNT", settings.nodes_per_leg),
        ("DEGREE_COUNT", facts.degree_count()),
        ("COEFFICIENT_COUNT", facts.coefficient_count()),
        ("BELOW_COUNT", directions.below),
        ("BAND_COUNT", directions.band),
        ("ABOVE_COUNT", directions.above),
        ("AZIMUTH_COUNT", directions.azimuths),
        ("COSINE_COUNT", directions.below + directions.band + directions.above),
        ("SLICE_COUNT", settings.froxel_size[2]),
        ("PROFILE_GROUP_COUNT", facts.profile_group_count().max(1)),
        ("GRID_GROUND_COUNT", grid.ground),
        ("GRID_LOW_COUNT", grid.low),
        ("GRID_HIGH_COUNT", grid.high),
        ("GRID_AZIMUTH_COUNT", grid.azimuths),
        ("GRID_MU_S_COUNT", settings.source_size[0]),
        ("GRID_ALTITUDE_COUNT", settings.source_size[1]),
        ("GRID_INVOCATION_COUNT", grid.count().min(MAX_INVOCATIONS)),
        ("INVOCATION_COUNT", directions.count().min(MAX_INVOCATIONS)),
    ];
    let clouds = &settings.clouds;
    let cloud_numbers = [
        ("CLOUD_LAYER_COUNT", facts.clouds.len() as u32),
        ("CLOUD_TERM_COUNT", cloud_term_count(facts)),
        ("CLOUD_BLOCK", facts.cloud_block()),
        ("ORDINATES_LIGHT", ordinates::light(facts) as u32),
        ("CLOUD_NEAR_SAMPLES", clouds.near_samples),
        ("CLOUD_STEP_M", clouds.step_m),
        ("CLOUD_STEP_PERMILLE", clouds.step_permille),
        ("CLOUD_MAX_STEPS", clouds.max_steps),
        ("CLOUD_GRID_SIZE", clouds.grid_size),
        ("CLOUD_GRID_SLICES", clouds.grid_slices),
        ("CLOUD_GRID_LEVELS", clouds.grid_levels),
        ("CLOUD_CELL_M", clouds.cell_m),
    ];
    let flags = [
        ("AIR", facts.has_air()),
        ("LIT", facts.is_lit()),
        ("EMISSION", !facts.emitters.is_empty()),
        ("DISC", facts.lights.iter().any(|light| facts.is_wide(light))),
        ("SPHERE", facts.has_sphere()),
        ("GROUND", facts.orders == Orders::All),
        ("MULTIPLE_SCATTERING", facts.has_multiple_scattering()),
        ("CLOUDS", !facts.clouds.is_empty()),
        ("CLOUD_DISTANCE", facts.keeps_cloud_distance()),
        ("CLOUD_ORDINATES", facts.cloud_scattering().ordinate_groups() > 0),
        ("CLOUD_ANVIL", facts.clouds.iter().any(|layer| layer.kind == CloudKind::Cumulonimbus)),
        ("SOURCE_FUNCTION", facts.treatment == Treatment::SourceFunction),
        ("CAPTURE", facts.outputs.capture),
        ("SURFACE", facts.surface.is_some()),
        ("LAYERS", facts.groups.has_layers()),
        ("HALF_TABLES", settings.table_format == TableFormat::Float16),
    ];
    let numbers = numbers.into_iter().chain(cloud_numbers);
    let numbers = numbers.map(|(name, value)| (name.to_owned(), Definition::U32(value)));
    let flags = flags.map(|(name, value)| (name.to_owned(), Definition::Bool(value)));
    let ordinates = ordinates::problem(facts).map(|problem| problem.definitions());
    numbers.chain(flags).chain(ordinates.into_iter().flatten()).collect()
}
