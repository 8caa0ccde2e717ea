// Pass: the march through the sum of all media where a scene has fog, local volumes or local lights: clouds are one more
// kind of matter in it.
//
// A ray is cut where it crosses a layer of clouds or fog, where it enters and leaves local volumes, and at the ends of
// clusters' slices. Between two cuts the same matter is there; steps are as long as its detail, and grow with the distance.
// In a step extinction is constant and the light is integrated with its own attenuation. Empty pieces are taken in one step.
//
// The air's light in front of a depth is found as in the pass of the clouds. Fog and volumes take from it, and shade the
// ground; that they shade thin air is left out.
//
// Definitions: CLOUDS; SURFACE; AIR; VOLUME_GROWTH_PERMILLE, a step's share of the distance; VOLUME_MAX_STEPS;
// LOCAL_LIGHT_COUNT.

#import welkin::atmosphere::{atmosphere, extinction_at, PI}
#import welkin::camera::view_direction
#import welkin::cloud_noise::hash
#import welkin::cluster::{cluster_of, slice_end_m, slice_of, LIGHT_WORDS, VOLUME_WORDS}
#import welkin::geometry
#import welkin::media_ground::{cluster_masks, fog_share, lit_by_lamps, volume_share}
#import welkin::observer::observer
#import welkin::volume_field::{fog_density, local_span_m, place_of, volume_density, volumes, Place, FOG_COUNT}
#import welkin::volume_source::{from_lights, mean_through, seen, Piece, Stretch}
#if LOCAL_LIGHT_COUNT > 0
#import welkin::volume_source::from_local_light
#endif
#ifdef CLOUDS
#import welkin::cloud_daylight::{clear_fluxes, daylight, diffuse_share, ClearFluxes}
#import welkin::cloud_field::{cloud_layers, layer_density, CLOUD_LAYER_COUNT}
#import welkin::cloud_skip::empty_m
#import welkin::cloud_source::{phases, step_radiance, Sample, PHASE_COUNT}
#endif

// Light of clouds, fog and volumes at the observer, and what they leave of the beam on the surface at the end.
@group(1) @binding(50) var media_radiance_image: texture_storage_2d<rgba32float, write>;
// Their transmittance, and what they leave of the diffuse light there.
@group(1) @binding(51) var media_transmittance_image: texture_storage_2d<rgba32float, write>;
// int T S dT_air and T T_air at the end, as in the pass of the clouds: of the beam, and of diffuse light.
@group(1) @binding(52) var media_beam_image: texture_storage_2d<rgba32float, write>;
@group(1) @binding(53) var media_diffuse_image: texture_storage_2d<rgba32float, write>;
#ifdef SURFACE
@group(0) @binding(19) var surface_image: texture_2d<f32>;
#endif

const MAX_STEPS: u32 = #{VOLUME_MAX_STEPS}u;
const STEP_GROWTH: f32 = #{VOLUME_GROWTH_PERMILLE}.0 * 0.001;
const NEVER_M: f32 = 1e30;
const OPAQUE: f32 = 24.0;
// Longest step in optical depths, while little is hidden.
const STEP_DEPTH: f32 = 0.7;
const SMOOTH_DEPTH: f32 = 4.0;
const SMOOTH_GROWTH: f32 = 4.0;
#ifdef CLOUDS
const CLOUD_STEP_M: f32 = #{CLOUD_STEP_M}.0;
const CLOUD_GROWTH: f32 = #{CLOUD_STEP_PERMILLE}.0 * 0.001;
#endif

struct Ray {
    pixel: vec2<u32>,
    direction: vec3<f32>,
    end_m: f32,
    meets_ground: bool,
}

struct Sum {
    radiance: vec3<f32>,
    // Optical depth so far: of clouds, of fog and volumes, of air.
    clouds: f32,
    local: vec3<f32>,
    air: vec3<f32>,
    // int T S dT_air, of beam and diffuse light.
    beam: vec3<f32>,
    diffuse: vec3<f32>,
}

fn observer_position() -> vec3<f32> {
    return vec3<f32>(0.0, 0.0, observer.altitude_m);
}

fn altitude_m(ray: Ray, t_m: f32) -> f32 {
    return geometry::altitude_along(atmosphere.radius_m, observer.altitude_m, ray.direction.z, t_m);
}

fn ray_of(pixel: vec2<u32>) -> Ray {
    var ray = Ray(pixel, view_direction(pixel), NEVER_M, false);
    if ray.direction.z < geometry::horizon_mu(atmosphere.radius_m, observer.altitude_m) {
        ray.end_m = geometry::distance_to_shell_from_above(atmosphere.radius_m, observer.altitude_m, ray.direction.z, 0.0);
        ray.meets_ground = true;
    }
#ifdef SURFACE
    // Without a surface it is never.
    let surface_m = textureLoad(surface_image, pixel, 0).a;
    ray.meets_ground = ray.meets_ground && surface_m > ray.end_m;
    ray.end_m = min(ray.end_m, surface_m);
#endif
    return ray;
}

// The nearest crossing of a shell after a distance.
fn next_shell_m(ray: Ray, shell_m: f32, after_m: f32) -> f32 {
    let cuts_m = geometry::shell_crossings_m(atmosphere.radius_m, observer.altitude_m, ray.direction.z, shell_m);
    return select(select(NEVER_M, cuts_m.y, cuts_m.y > after_m), cuts_m.x, cuts_m.x > after_m);
}

// The next boundary after a distance.
fn next_boundary_m(ray: Ray, t_m: f32) -> f32 {
    let after_m = t_m * 1.000001 + 1e-4;
    let slice = slice_of(after_m);
    var next = min(ray.end_m, slice_end_m(slice));
    next = select(next, NEVER_M, next <= after_m);
    for (var i = 0u; i < FOG_COUNT; i++) {
        next = min(next, next_shell_m(ray, volumes[i].bottom_m, after_m));
        next = min(next, next_shell_m(ray, volumes[i].top_m, after_m));
    }
#ifdef CLOUDS
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        next = min(next, next_shell_m(ray, cloud_layers[layer].base_m, after_m));
        next = min(next, next_shell_m(ray, cloud_layers[layer].base_m + cloud_layers[layer].thickness_m, after_m));
    }
#endif
    let first = cluster_of(ray.pixel, slice);
    for (var word = 0u; word < VOLUME_WORDS; word++) {
        var bits = cluster_masks[first + word];
        while bits != 0u {
            let bit = firstTrailingBit(bits);
            bits &= bits - 1u;
            let span_m = local_span_m(FOG_COUNT + 32u * word + bit, observer_position(), ray.direction);
            next = select(next, min(next, span_m.x), span_m.x > after_m && span_m.y > span_m.x);
            next = select(next, min(next, span_m.y), span_m.y > after_m && span_m.y > span_m.x);
        }
    }
    return min(next, ray.end_m);
}

// What lies between two boundaries.
struct Between {
    // Longest step that its detail allows, m; NEVER_M where there is nothing.
    detail_m: f32,
    clouds: bool,
    // Whether density changes within its detail: then every pixel looks at another place of a step.
    uneven: bool,
    // First word of its cluster.
    cluster: u32,
}

fn between(ray: Ray, from_m: f32, to_m: f32) -> Between {
    let middle_m = 0.5 * (from_m + min(to_m, 1e8));
    let altitude = altitude_m(ray, middle_m);
    var found = Between(NEVER_M, false, false, cluster_of(ray.pixel, slice_of(middle_m)));
    for (var i = 0u; i < FOG_COUNT; i++) {
        if altitude > volumes[i].bottom_m && altitude < volumes[i].top_m {
            // What counts is the change along the ray: of altitude, or of the billows.
            let slope = max(abs(altitude_m(ray, to_m) - altitude_m(ray, from_m)) / max(to_m - from_m, 1e-6), 0.02);
            let along = select(slope, 1.0, volumes[i].noise_strength > 0.0);
            found.uneven = found.uneven || volumes[i].noise_strength > 0.0;
            found.detail_m = min(found.detail_m, volumes[i].detail_m / along);
        }
    }
    let p = observer_position() + ray.direction * middle_m;
    for (var word = 0u; word < VOLUME_WORDS; word++) {
        var bits = cluster_masks[found.cluster + word];
        while bits != 0u {
            let index = FOG_COUNT + 32u * word + firstTrailingBit(bits);
            bits &= bits - 1u;
            let span_m = local_span_m(index, observer_position(), ray.direction);
            if span_m.x < middle_m && middle_m < span_m.y {
                found.uneven = found.uneven || volumes[index].is_even == 0u;
                found.detail_m = min(found.detail_m, min(volumes[index].detail_m, 0.125 * (span_m.y - span_m.x)));
            }
        }
    }
#ifdef CLOUDS
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = altitude - cloud_layers[layer].base_m;
        found.clouds = found.clouds || (up_m >= 0.0 && up_m <= cloud_layers[layer].thickness_m);
    }
    if found.clouds {
        found.detail_m = min(found.detail_m, CLOUD_STEP_M);
        found.uneven = true;
    }
#endif
    return found;
}

const AIR_STEP_M: f32 = 400.0;
const AIR_STEP_GROWTH: f32 = 0.05;
const AIR_STEPS: f32 = 24.0;

// Moves through air alone.
fn pass_air(sum: ptr<function, Sum>, ray: Ray, from_m: f32, to_m: f32) {
#ifdef AIR
#ifdef CLOUDS
    let clear = clear_fluxes(cloud_layers[0].base_m, observer.lights[0].direction.z);
#endif
    let longest_m = max(AIR_STEP_M, AIR_STEP_GROWTH * from_m);
    let count = u32(clamp(ceil((to_m - from_m) / longest_m), 1.0, AIR_STEPS));
    let step_m = (to_m - from_m) / f32(count);
    for (var i = 0u; i < count; i++) {
        let middle_m = from_m + (f32(i) + 0.5) * step_m;
        let altitude = altitude_m(ray, middle_m);
        let before = exp(-(*sum).air);
        (*sum).air += step_m * extinction_at(altitude);
        let share = exp(-(*sum).clouds - (*sum).local) * (before - exp(-(*sum).air));
#ifdef CLOUDS
        let day = daylight(place_of(observer_position() + ray.direction * middle_m).map, altitude);
        (*sum).beam += day.straight * share;
        (*sum).diffuse += diffuse_share(day, clear) * share;
#else
        (*sum).beam += share;
        (*sum).diffuse += share;
#endif
    }
#endif
}

#ifdef CLOUDS
fn cloud_extinction(place: Place) -> f32 {
    var extinction = 0.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        extinction += cloud_layers[layer].extinction_per_m * layer_density(layer, place.map, place.altitude_m);
    }
    return extinction;
}

// Light of the clouds in a step.
fn from_clouds(
    sum: ptr<function, Sum>, place: Place, view: vec3<f32>, extinction: f32, step_m: f32, phase: ptr<function, array<f32, PHASE_COUNT>>
) -> vec3<f32> {
    var sample: Sample;
    sample.map = place.map;
    sample.altitude_m = place.altitude_m;
    sample.up = normalize(vec3<f32>(place.p.xy, place.p.z + atmosphere.radius_m));
    sample.before = (*sum).clouds;
    sample.step = extinction * step_m;
    var light = vec3<f32>(0.0);
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        sample.height = (place.altitude_m - cloud_layers[layer].base_m) / cloud_layers[layer].thickness_m;
        if sample.height >= 0.0 && sample.height <= 1.0 {
            sample.layer = layer;
            let own = cloud_layers[layer].extinction_per_m * layer_density(layer, place.map, place.altitude_m);
            light += own / extinction * step_radiance(sample, view, phase);
        }
    }
    return light;
}
#endif

// What one volume adds in a step, before the air.
fn from_volume(index: u32, density: f32, place: Place, stretch: Stretch, cluster: u32) -> vec3<f32> {
    let piece = Piece(index, density, place);
    let own = density * stretch.step_m;
    var radiance = own * volumes[index].emission_per_m * seen(stretch, vec3<f32>(1.0));
    if all(volumes[index].scattering_per_m <= vec3<f32>(0.0)) {
        return radiance;
    }
    var arriving = from_lights(piece, stretch);
#if LOCAL_LIGHT_COUNT > 0
    for (var word = 0u; word < LIGHT_WORDS; word++) {
        var bits = cluster_masks[cluster + VOLUME_WORDS + word];
        while bits != 0u {
            let light = 32u * word + firstTrailingBit(bits);
            bits &= bits - 1u;
            arriving += from_local_light(light, piece, stretch);
        }
    }
#endif
    return radiance + own * volumes[index].scattering_per_m * arriving;
}

fn volume_extinction(place: Place, half_rise_m: f32, cluster: u32) -> vec3<f32> {
    var extinction = vec3<f32>(0.0);
    for (var i = 0u; i < FOG_COUNT; i++) {
        extinction += volumes[i].extinction_per_m * fog_density(i, place, half_rise_m);
    }
    for (var word = 0u; word < VOLUME_WORDS; word++) {
        var bits = cluster_masks[cluster + word];
        while bits != 0u {
            let index = FOG_COUNT + 32u * word + firstTrailingBit(bits);
            bits &= bits - 1u;
            extinction += volumes[index].extinction_per_m * volume_density(index, place);
        }
    }
    return extinction;
}

// The light that what the ray ends on receives: shares of the beam and of diffuse light in clear air.
fn ground_share(place: Place) -> vec2<f32> {
    var share = vec2<f32>(1.0);
#ifdef CLOUDS
    let day = daylight(place.map, place.altitude_m);
    share = vec2<f32>(day.through, day.diffuse);
#endif
    share.x *= volume_share(place);
    return share * fog_share(place, share);
}

fn random(pixel: vec2<u32>) -> f32 {
    return f32(hash(vec3<i32>(vec2<i32>(pixel), 0), 1u) >> 8u) / 16777216.0;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(media_radiance_image)) {
        return;
    }
    let ray = ray_of(id.xy);
    let offset = random(id.xy);
#ifdef CLOUDS
    var phase = phases(ray.direction);
#endif
    var sum: Sum;
    var t_m = 0.0;
    var boundary_m = 0.0;
    var here: Between;
    for (var i = 0u; i < MAX_STEPS && t_m < ray.end_m; i++) {
        if t_m >= boundary_m {
            boundary_m = next_boundary_m(ray, t_m);
            here = between(ray, t_m, boundary_m);
        }
        if boundary_m >= NEVER_M {
            break;
        }
        if here.detail_m >= NEVER_M {
            pass_air(&sum, ray, t_m, boundary_m);
            t_m = boundary_m;
            continue;
        }
        let depth = sum.clouds + max(sum.local.r, max(sum.local.g, sum.local.b));
        if sum.clouds + min(sum.local.r, min(sum.local.g, sum.local.b)) >= OPAQUE {
            break;
        }
        let growth = clamp(depth / SMOOTH_DEPTH, 1.0, SMOOTH_GROWTH);
        var step_m = growth * max(here.detail_m, STEP_GROWTH * t_m);
#ifdef CLOUDS
        if here.clouds {
            step_m = min(step_m, growth * max(CLOUD_STEP_M, CLOUD_GROWTH * t_m));
        }
#endif
        step_m = min(step_m, boundary_m - t_m);
        let share = select(0.5, offset, here.uneven);
        var place = place_of(observer_position() + ray.direction * (t_m + share * step_m));
        var half_rise_m = 0.5 * (altitude_m(ray, t_m + step_m) - altitude_m(ray, t_m));
        var extinction = volume_extinction(place, half_rise_m, here.cluster);
        // No step hides more than a share of what is behind, while that is seen.
        let thickest = max(extinction.r, max(extinction.g, extinction.b));
        let longest_m = growth * STEP_DEPTH / max(thickest, 1e-20);
        if longest_m < step_m {
            step_m = longest_m;
            place = place_of(observer_position() + ray.direction * (t_m + share * step_m));
            half_rise_m = 0.5 * (altitude_m(ray, t_m + step_m) - altitude_m(ray, t_m));
            extinction = volume_extinction(place, half_rise_m, here.cluster);
        }
        step_m = select(step_m, boundary_m - t_m, t_m + step_m >= boundary_m * 0.999999);
        var all_media = extinction;
#ifdef CLOUDS
        let cloudy = select(0.0, cloud_extinction(place), here.clouds);
        all_media += cloudy;
#endif
        let before = vec3<f32>(sum.clouds) + sum.local;
        let stretch = Stretch(ray.direction, observer_position(), t_m, step_m, before, all_media * step_m);
        let through_air = exp(-sum.air);
        for (var index = 0u; index < FOG_COUNT; index++) {
            let density = fog_density(index, place, half_rise_m);
            if density > 0.0 {
                sum.radiance += through_air * from_volume(index, density, place, stretch, here.cluster);
            }
        }
        for (var word = 0u; word < VOLUME_WORDS; word++) {
            var bits = cluster_masks[here.cluster + word];
            while bits != 0u {
                let index = FOG_COUNT + 32u * word + firstTrailingBit(bits);
                bits &= bits - 1u;
                let density = volume_density(index, place);
                if density > 0.0 {
                    sum.radiance += through_air * from_volume(index, density, place, stretch, here.cluster);
                }
            }
        }
#ifdef CLOUDS
        if cloudy > 0.0 {
            let light = from_clouds(&sum, place, ray.direction, cloudy, step_m, &phase);
            sum.radiance += through_air * exp(-sum.local) * mean_through(extinction * step_m) * light;
            sum.clouds += cloudy * step_m;
        }
#endif
        sum.local += extinction * step_m;
        pass_air(&sum, ray, t_m, t_m + step_m);
        t_m += step_m;
    }
    var ground = vec2<f32>(1.0);
    if ray.end_m < NEVER_M {
        pass_air(&sum, ray, t_m, ray.end_m);
        let end = place_of(observer_position() + ray.direction * ray.end_m);
        let surface = Place(end.p, max(end.altitude_m, 0.0), end.map);
        ground = ground_share(surface);
        if ray.meets_ground {
            let up = normalize(vec3<f32>(end.p.xy, end.p.z + atmosphere.radius_m));
            let lit = lit_by_lamps(surface, up, cluster_of(ray.pixel, slice_of(ray.end_m)));
            sum.radiance += exp(-sum.clouds - sum.local - sum.air) * atmosphere.ground_albedo / PI * lit;
        }
    }
    let transmittance = exp(-sum.clouds - sum.local);
    let behind = transmittance * exp(-sum.air);
    textureStore(media_radiance_image, ray.pixel, vec4<f32>(sum.radiance, ground.x));
    textureStore(media_transmittance_image, ray.pixel, vec4<f32>(transmittance, ground.y));
    textureStore(media_beam_image, ray.pixel, vec4<f32>(sum.beam + behind, 0.0));
    textureStore(media_diffuse_image, ray.pixel, vec4<f32>(sum.diffuse + behind, 0.0));
}
