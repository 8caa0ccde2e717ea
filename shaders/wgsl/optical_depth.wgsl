// Pass: optical depth from every altitude along every direction above the horizon to the top of the atmosphere.
//
// Optical depth rather than transmittance: it survives half float where transmittance underflows, it interpolates
// better, and its exponential is free where it joins the view ray's in one exp. Layers are left out (OMIT_LAYERS): who
// reads the table adds them in closed form.

#import welkin::atmosphere::atmosphere
#import welkin::mapping
#import welkin::march::{air_ray, optical_depth_along}

#ifdef HALF_TABLES
@group(0) @binding(6) var optical_depth_table: texture_storage_2d<rgba16float, write>;
#else
@group(0) @binding(6) var optical_depth_table: texture_storage_2d<rgba32float, write>;
#endif

// No light passes, and a half float holds it.
const OPAQUE: f32 = 6e4;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let size = textureDimensions(optical_depth_table);
    if any(texel.xy >= size) {
        return;
    }
    let unit = mapping::unit_from_texel(texel.xy, vec2<f32>(size));
    let start = mapping::optical_depth_from_unit(unit, atmosphere.radius_m, atmosphere.top_m);
    let ray = air_ray(start.altitude_m, start.mu, 1.0, start.mu, false);
    textureStore(optical_depth_table, texel.xy, vec4<f32>(min(optical_depth_along(ray), vec3<f32>(OPAQUE)), 0.0));
}
