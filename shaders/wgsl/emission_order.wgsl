// Pass: the radiance field of the air's own emission at every altitude, with one order of scattering more.
//
// One workgroup per altitude, one invocation per zenith angle: the field is the same in all azimuths. Each dispatch gives
// the sum of all orders so far. The last one (definition CLOSE_SERIES) adds the rest of the series, which is geometric.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::directions::{direction_of, AZIMUTH_COUNT, COSINE_COUNT}
#import welkin::emission::{glow_along, zonal_harmonics, ZONAL_COUNT}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::march::air_ray

@group(0) @binding(6) var emission_sum: texture_storage_2d<rgba32float, write>;
#ifdef CLOSE_SERIES
// The sums without the last order and without the last two.
@group(0) @binding(7) var sum_before: texture_2d<f32>;
@group(0) @binding(8) var sum_before_that: texture_2d<f32>;
#endif

// The largest ratio between orders that the tail believes.
const MAX_RATIO: f32 = 0.9;

var<workgroup> glow: array<vec3<f32>, COSINE_COUNT>;

// The ring of directions with a zenith angle: its cosine, and what all of it stands for, sr.
fn ring(cosine: u32, mu_h: f32) -> vec2<f32> {
    let direction = direction_of(cosine * AZIMUTH_COUNT, mu_h);
    return vec2<f32>(direction.mu, direction.solid_angle_sr * f32(AZIMUTH_COUNT));
}

// A column of the table: a coefficient of the field, or its irradiance from above.
fn column_value(column: u32, mu_h: f32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var j = 0u; j < COSINE_COUNT; j++) {
        let ring = ring(j, mu_h);
        var y = zonal_harmonics(ring.x);
        let weight = select(max(ring.x, 0.0), y[min(column, ZONAL_COUNT - 1u)], column < ZONAL_COUNT);
        sum += ring.y * weight * glow[j];
    }
    return sum;
}

@compute @workgroup_size(#{COSINE_COUNT})
fn main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let row = workgroup.x;
    let rows = textureDimensions(emission_sum).y;
    let unit_y = f32(row) / f32(rows - 1u);
    let unit = vec2<f32>(0.0, unit_y);
    let here = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let altitude_m = here.altitude_m;
    let mu_h = horizon_mu(atmosphere.radius_m, altitude_m);
    let mu = ring(invocation, mu_h).x;
    let hits_ground = direction_of(invocation * AZIMUTH_COUNT, mu_h).hits_ground;
    glow[invocation] = glow_along(air_ray(altitude_m, mu, 1.0, mu, hits_ground), hits_ground);
    workgroupBarrier();
    // Columns may be more than directions.
    for (var column = invocation; column <= ZONAL_COUNT; column += COSINE_COUNT) {
        var value = column_value(column, mu_h);
#ifdef CLOSE_SERIES
        let mean_before = textureLoad(sum_before, vec2<u32>(0u, row), 0).rgb;
        let last = column_value(0u, mu_h) - mean_before;
        let last_but_one = mean_before - textureLoad(sum_before_that, vec2<u32>(0u, row), 0).rgb;
        let zero = vec3<f32>(0.0);
        let ratio = select(zero, clamp(last / last_but_one, zero, vec3<f32>(MAX_RATIO)), last_but_one > zero);
        value += ratio / (1.0 - ratio) * (value - textureLoad(sum_before, vec2<u32>(column, row), 0).rgb);
#endif
        textureStore(emission_sum, vec2<u32>(column, row), vec4<f32>(value, 0.0));
    }
}
