//! What shaders are specialised by: facts of the scene, and numbers of its settings.

use welkin_lut::cloud::CloudKind;
use welkin_shaders::{Definition, Definitions};

use super::blocks::{ZONAL_COUNT, cloud_term_count, emission_breakpoints_m, lobe_count, local_light_count};
use super::{lamp_froxels, local_clusters, ordinates, sky_view, volume_light};
use crate::plan::{CloudScattering, Facts, Surface, TableFormat, Treatment, lattice_cell, media_cell, media_froxels};
use crate::probe::Orders;

/// Invocations of a workgroup that every Vulkan device takes.
const MAX_INVOCATIONS: u32 = 128;

/// The definitions that every pass of a frame is compiled with.
pub fn definitions(facts: &Facts) -> Definitions {
    let (settings, groups, directions) = (&facts.settings, &facts.groups, &facts.settings.directions);
    let grid = &facts.source_grid();
    let lattice_cell = lattice_cell(facts).ok();
    let media_cell = media_cell(facts).ok();
    let has_overlay = facts.has_overlay();
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
        ("FINE_PANELS", settings.optical_depth_panels),
        ("DEGREE_COUNT", facts.degree_count()),
        ("COEFFICIENT_COUNT", facts.coefficient_count()),
        ("BELOW_COUNT", directions.below),
        ("BAND_COUNT", directions.band),
        ("ABOVE_COUNT", directions.above),
        ("AZIMUTH_COUNT", directions.azimuths),
        ("COSINE_COUNT", directions.cosines()),
        ("SLICE_COUNT", settings.froxel_size[2]),
        ("PROFILE_GROUP_COUNT", facts.profile_group_count().max(1)),
        ("GRID_GROUND_COUNT", grid.ground),
        ("GRID_LOW_COUNT", grid.low),
        ("GRID_HIGH_COUNT", grid.high),
        ("GRID_AZIMUTH_COUNT", grid.azimuths),
        ("GRID_MU_S_COUNT", settings.source_size[0]),
        ("GRID_ALTITUDE_COUNT", settings.source_size[1]),
        ("GRID_INVOCATION_COUNT", grid.count().min(MAX_INVOCATIONS)),
        ("FAN_COUNT", sky_view::FAN_COUNT),
        ("INVOCATION_COUNT", directions.count().min(MAX_INVOCATIONS)),
        ("LATTICE_CELL", lattice_cell.unwrap_or(1)),
        ("LATTICE_PPM", (1e6 * settings.lattice_tolerance) as u32),
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
    let (volumes, blocks) = (&settings.volumes, volume_light::blocks(facts));
    let volume_numbers = [
        ("VOLUME_COUNT", facts.volumes.len() as u32),
        ("FOG_COUNT", facts.fog_count()),
        ("LOCAL_LIGHT_COUNT", local_light_count(facts)),
        ("VOLUME_CELLS", blocks.cells),
        ("VOLUME_COLUMNS", blocks.columns),
        ("VOLUME_ROWS", blocks.rows),
        ("VOLUME_BLOCKS", volume_light::block_count(facts)),
        ("FOG_LEVELS", volumes.fog_levels),
        ("FOG_CELL_M", volumes.fog_cell_m),
        ("CLUSTER_COLUMNS", local_clusters::columns(facts)),
        ("VOLUME_LIGHT_SAMPLES", volumes.beam_samples),
        ("LOCAL_LIGHT_SAMPLES", volumes.lamp_samples),
        ("VOLUME_GROWTH_PERMILLE", volumes.step_permille),
        ("VOLUME_MAX_STEPS", volumes.max_steps),
        ("MEDIA_CELL", media_cell.unwrap_or(1)),
        ("MEDIA_PERMILLE", volumes.lattice_permille),
    ];
    let flags = [
        ("AIR", facts.has_air()),
        ("LIT", facts.is_lit()),
        ("EMISSION", !facts.emitters.is_empty()),
        ("SHADE", facts.is_in_shadow()),
        ("EDGE_OF_SHADOW", facts.sees_edge_of_shadow()),
        ("DISC", facts.lights.iter().any(|light| facts.is_wide(light))),
        ("SPHERE", facts.has_sphere()),
        ("GROUND", facts.orders == Orders::All),
        ("MULTIPLE_SCATTERING", facts.has_multiple_scattering()),
        ("CLOUDS", !facts.clouds.is_empty()),
        ("FOLLOWED_CLOUDS", facts.follows_clouds()),
        ("CLOUD_DISTANCE", facts.keeps_cloud_distance()),
        ("CLOUD_ORDINATES", facts.ordinate_groups() > 0),
        ("CLOUD_ANVIL", facts.clouds.iter().any(|layer| layer.kind == CloudKind::Cumulonimbus)),
        ("LOCAL_MEDIA", facts.has_local_media()),
        ("MEDIA_LATTICE", facts.has_local_media() && media_cell.is_some()),
        ("MEDIA_FROXELS", media_froxels(facts).is_ok()),
        ("LOCAL_VOLUMES", facts.volumes.len() as u32 > facts.fog_count()),
        ("LAMP_FROXELS", lamp_froxels::are_there(facts)),
        ("VOLUME_NOISE", facts.has_volume_noise()),
        ("VOLUME_GRIDS", facts.volumes.iter().any(|volume| volume.grid.is_some())),
        ("VOLUME_ORDERS", facts.cloud_scattering() != CloudScattering::Single),
        ("SOURCE_FUNCTION", facts.treatment == Treatment::SourceFunction),
        ("CAPTURE", facts.outputs.capture),
        ("FOR_SCREEN", facts.for_screen),
        ("SURFACE", facts.surface.is_some()),
        ("SURFACE_HILLS", facts.surface == Some(Surface::Terrain)),
        ("OVERLAY", has_overlay),
        ("LATTICE", lattice_cell.is_some()),
        ("LATTICE_TRANSMITTANCE", facts.outputs.capture || has_overlay),
        ("LAYERS", facts.groups.has_layers()),
        ("HALF_TABLES", settings.table_format == TableFormat::Float16),
    ];
    let numbers = numbers.into_iter().chain(cloud_numbers).chain(volume_numbers);
    let numbers = numbers.map(|(name, value)| (name.to_owned(), Definition::U32(value)));
    let flags = flags.map(|(name, value)| (name.to_owned(), Definition::Bool(value)));
    let ordinates = ordinates::problem(facts).map(|problem| problem.definitions());
    numbers.chain(flags).chain(ordinates.into_iter().flatten()).collect()
}
