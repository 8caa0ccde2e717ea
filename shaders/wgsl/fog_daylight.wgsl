#define_import_path welkin::fog_daylight
// What fog makes of daylight outside itself: on the ground and on hills, and in the air above it, which receives what fog sends up.
//
// Fog is that of the first bank, as an even slab (welkin::slab_field).
//
// Definitions: FOG_COUNT, VOLUME_ORDERS.

#import welkin::atmosphere::PI
#import welkin::cloud_daylight::{light_in_air, surroundings}
#import welkin::observer::observer
#import welkin::slab_field::{beam_table, sky_table, slab_above, slab_on_ground, slab_spot, AZIMUTHS, LOWEST_SUN}
#import welkin::tables::table_sampler
#import welkin::volume_field::{volumes, Place, FOG_COUNT}
#import welkin::volume_grid::{block_uvw, spot_of, FOG_LEVELS}
#import welkin::volume_source::{similar_depths, volume_sky_image}

// Share of the light on a horizontal plane, of which shares of the beam and of the sky reach the top of the fog.
fn fog_share(place: Place, above: vec2<f32>) -> f32 {
    if FOG_COUNT == 0u || place.altitude_m >= volumes[0].top_m {
        return 1.0;
    }
    let depths = similar_depths(spot_of(0u, place));
    let mu = observer.lights[0].direction.z;
    let beam = above.x * max(mu, 0.0) * light_in_air(0u, place.altitude_m, mu);
    let sky = above.y * PI * surroundings(place.altitude_m, mu, observer.lights[0].irradiance).above;
    let on_ground = slab_spot(depths.x, depths.z);
    let straight = exp(-depths.x / max(mu, LOWEST_SUN));
    let from_beam = beam * (straight + slab_on_ground(beam_table(0u, 0u), on_ground, AZIMUTHS));
    let from_sky = sky * slab_on_ground(sky_table(0u), on_ground, 1u);
    return ((from_beam + from_sky) / max(beam + sky, vec3<f32>(1e-20))).g;
}

// Of the diffuse light of the air above the fog, the share of what there is without it. Fog is as deep as below the middle of its widest
// grid.
fn air_above_fog() -> vec3<f32> {
#ifdef VOLUME_ORDERS
    let top_m = volumes[0].top_m;
    let mu = observer.lights[0].direction.z;
    let around = surroundings(top_m, mu, observer.lights[0].irradiance);
    let clear = around.above + around.below;
    let widest = volumes[0].first_block + FOG_LEVELS - 1u;
    let uvw = block_uvw(widest, vec3<f32>(0.5, 0.5, 1.0), 0u, 1u);
    let spot = slab_spot(0.0, textureSampleLevel(volume_sky_image, table_sampler, uvw, 0.0).z);
    let beam = max(mu, 0.0) * light_in_air(0u, top_m, mu);
    let sent_up = beam * slab_above(beam_table(0u, 0u), spot, AZIMUTHS) + PI * around.above * slab_above(sky_table(0u), spot, 1u);
    return select(vec3<f32>(1.0), (around.above + sent_up) / max(clear, vec3<f32>(1e-20)), clear > vec3<f32>(1e-20));
#else
    return vec3<f32>(1.0);
#endif
}
