//! What engines take, and for which air it is written here: shared by the tests and by `benches/shaderc`.

use welkin_shaders::{Definition, Definitions};

/// Passes that engines take.
pub const PASSES: [&str; 5] = ["pack_probe", "optical_depth", "first_source", "higher_source", "scattering_table"];

/// The Earth's air: two exponential scatterers and ozone, which only absorbs.
pub fn definitions() -> Definitions {
    let numbers = [
        ("CONSTITUENT_COUNT", 3),
        ("SCATTERING_EXPONENTIAL_END", 2),
        ("SCATTERING_TENT_END", 2),
        ("SCATTERER_COUNT", 2),
        ("ABSORBING_EXPONENTIAL_END", 2),
        ("ABSORBING_TENT_END", 3),
        ("LOBE_COUNT", 1),
        ("PROFILE_GROUP_COUNT", 2),
        ("NODE_COUNT", 10),
        ("FINE_PANELS", 64),
        ("GRID_GROUND_COUNT", 4),
        ("GRID_LOW_COUNT", 5),
        ("GRID_HIGH_COUNT", 5),
        ("GRID_AZIMUTH_COUNT", 8),
        ("GRID_MU_S_COUNT", 40),
        ("GRID_ALTITUDE_COUNT", 20),
        ("GRID_INVOCATION_COUNT", 112),
        ("DEGREE_COUNT", 3),
        ("COEFFICIENT_COUNT", 6),
    ];
    let flags = ["AIR", "LIT", "GROUND", "MULTIPLE_SCATTERING", "SOURCE_FUNCTION"];
    let numbers = numbers.map(|(name, value)| (name.to_owned(), Definition::U32(value)));
    numbers.into_iter().chain(flags.map(|name| (name.to_owned(), Definition::Bool(true)))).collect()
}
