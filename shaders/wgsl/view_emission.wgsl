// Pass: what the air's own emission, all that it becomes on its way included, adds to every view ray of one observer.
//
// It is the same in all azimuths: rows and columns are those of view_optical_depth_table. Above the horizon it is kept
// over the length of air, as the other views are.

#import welkin::emission::glow_along
#import welkin::mapping
#import welkin::march::{table_altitude_m, view_ray}
#import welkin::observer::observer

@group(0) @binding(6) var view_emission_table: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(2, 32)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(view_emission_table);
    if any(texel.xy >= size) {
        return;
    }
    let below_horizon = texel.x == 1u;
    let unit = mapping::unit_from_texel(texel.xy, vec2<f32>(size));
    let mu = cos(mapping::sky_view_from_unit(unit, below_horizon, observer.view).zenith_rad);
    let ray = view_ray(table_altitude_m(observer.altitude_m), mu, 1.0, mu, below_horizon);
    let factor = select(1.0 / max(ray.length_m, 1e-3), 1.0, below_horizon);
    textureStore(view_emission_table, texel.xy, vec4<f32>(factor * glow_along(ray, below_horizon), 0.0));
}
