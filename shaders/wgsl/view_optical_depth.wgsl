// Pass: mean extinction of the air along every view ray of one observer, to the ground or to space: optical depth over
// the length of air, 1/m. It has no kink where the length has one.
//
// It depends on the zenith angle alone, so the table has one row an angle and one column for each half of the view
// sphere: the sky's, then the ground's.

#import welkin::mapping
#import welkin::march::{optical_depth_along, table_altitude_m, view_ray}
#import welkin::observer::observer

@group(0) @binding(6) var view_optical_depth_table: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(2, 32)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(view_optical_depth_table);
    if any(texel.xy >= size) {
        return;
    }
    let below_horizon = texel.x == 1u;
    let unit = mapping::unit_from_texel(texel.xy, vec2<f32>(size));
    let mu = cos(mapping::sky_view_from_unit(unit, below_horizon, observer.view).zenith_rad);
    let ray = view_ray(table_altitude_m(observer.altitude_m), mu, 1.0, mu, below_horizon);
    let mean = optical_depth_along(ray) / max(ray.length_m, 1e-3);
    textureStore(view_optical_depth_table, texel.xy, vec4<f32>(mean, 0.0));
}
