#define_import_path welkin::media_step
// How far the march through the sum of all media goes at a time, and what matter is there.
//
// Steps are as long as the detail of what is there, and grow with the distance. In a step extinction is constant.
//
// Definitions: CLOUDS; VOLUME_GROWTH_PERMILLE, a step's share of the distance; LOCAL_VOLUMES (some volume is no fog); FOG_COUNT; LOCAL_LIGHT_COUNT.

#import welkin::atmosphere::atmosphere
#import welkin::cluster_members::{next_member, volumes_of, NONE}
#import welkin::media_between::Between
#import welkin::media_march::{altitude_m, position_m, rise_at, Ray, NEVER_M}
#import welkin::volume_field::{fog_density, place_of, volume_density, volumes, Place, FOG_COUNT}
#if FOG_COUNT > 0
#import welkin::observer::observer
#import welkin::slab_field::LOWEST_SUN
#import welkin::volume_grid::spot_of
#import welkin::volume_source::similar_depths
#endif
#ifdef CLOUDS
#import welkin::cloud_step::gap_of_layers_m
#endif

const FOG_SLOTS: u32 = max(FOG_COUNT, 1u);
const STEP_GROWTH: f32 = #{VOLUME_GROWTH_PERMILLE}.0 * 0.001;
// Longest step in optical depths, while little is hidden.
const STEP_DEPTH: f32 = 0.7;
// By how much the depth to a light may change within a step at the top of fog, and by which share of the depth to it farther down.
const BEAM_DEPTH: f32 = 0.3;
const BEAM_GROWTH: f32 = 0.3;
#ifdef CLOUDS
// A lamp's light changes more within a cloud than the sun's.
#if LOCAL_LIGHT_COUNT > 0
const CLOUD_STEP_SHARE: f32 = 0.5;
#else
const CLOUD_STEP_SHARE: f32 = 1.0;
#endif
const CLOUD_STEP_M: f32 = CLOUD_STEP_SHARE * #{CLOUD_STEP_M}.0;
const CLOUD_GROWTH: f32 = CLOUD_STEP_SHARE * 0.001 * #{CLOUD_STEP_PERMILLE}.0;
#endif

fn greatest(v: vec3<f32>) -> f32 {
    return max(v.r, max(v.g, v.b));
}

// A step: the point that stands for it, and the extinction of fog and volumes there, 1/m.
struct Step {
    length_m: f32,
    place: Place,
    half_rise_m: f32,
    extinction: vec3<f32>,
    // Of the similar medium.
    similar_extinction: vec3<f32>,
    // Densities of the banks of fog.
    fog: array<f32, FOG_SLOTS>,
}

fn add_matter(step: ptr<function, Step>, index: u32, density: f32) {
    let own = volumes[index].extinction_per_m * density;
    (*step).extinction += own;
    (*step).similar_extinction += volumes[index].similar_extinction * own;
}

fn step_at(ray: ptr<function, Ray>, t_m: f32, length_m: f32, share: f32, cluster: u32) -> Step {
    var step: Step;
    step.length_m = length_m;
    step.place = place_of(position_m(ray, t_m + share * length_m));
    step.half_rise_m = 0.5 * (altitude_m(ray, t_m + length_m) - altitude_m(ray, t_m));
    // Fog is everywhere in a known number of banks: with an index that compilers foresee, a bank's numbers are read once for all pixels.
    for (var bank = 0u; bank < FOG_COUNT; bank++) {
        step.fog[bank] = fog_density(bank, step.place, step.half_rise_m);
        add_matter(&step, bank, step.fog[bank]);
    }
#ifdef LOCAL_VOLUMES
    var locals = volumes_of(cluster);
    for (var index = next_member(&locals); index != NONE; index = next_member(&locals)) {
        add_matter(&step, index, volume_density(index, step.place));
    }
#endif
    return step;
}

#if FOG_COUNT > 0
// The longest step in which light of the first light that fog has scattered changes little, m: it falls with the depth to that light, fastest
// where it is strong.
fn longest_in_beam_m(ray: ptr<function, Ray>, step: Step) -> f32 {
    let p = vec3<f32>(step.place.p.xy, step.place.p.z + atmosphere.radius_m);
    let mu_s = dot(normalize(p), observer.lights[0].direction);
    // Extinction over the cosine by which the ray climbs against the light.
    let slope_per_m = step.similar_extinction.g * abs(dot(normalize(p), (*ray).direction)) / max(mu_s, LOWEST_SUN);
    var longest_m = NEVER_M;
    for (var bank = 0u; bank < FOG_COUNT && mu_s > 0.0; bank++) {
        if step.place.altitude_m < volumes[bank].top_m && step.place.altitude_m > volumes[bank].bottom_m {
            // At that end of the step which is nearer to the light.
            let to_light = max(similar_depths(spot_of(bank, step.place)).x / max(mu_s, LOWEST_SUN) - 0.5 * slope_per_m * step.length_m, 0.0);
            longest_m = min(longest_m, (BEAM_DEPTH + BEAM_GROWTH * to_light) / max(slope_per_m, 1e-20));
        }
    }
    return longest_m;
}
#endif

// The longest step that detail, distance, the next boundary, what it would hide and how light changes in it allow.
fn next_step(ray: ptr<function, Ray>, t_m: f32, boundary_m: f32, here: Between, growth: f32, share: f32) -> Step {
    var length_m = growth * max(here.detail_m, STEP_GROWTH * t_m);
#ifdef CLOUDS
    if here.clouds {
        length_m = min(length_m, growth * max(CLOUD_STEP_M, CLOUD_GROWTH * t_m));
    }
#endif
    length_m = min(length_m, boundary_m - t_m);
    var step = step_at(ray, t_m, length_m, share, here.cluster);
    var longest_m = growth * STEP_DEPTH / max(greatest(step.extinction), 1e-20);
#if FOG_COUNT > 0
    longest_m = min(longest_m, growth * longest_in_beam_m(ray, step));
#endif
    if longest_m < length_m {
        step = step_at(ray, t_m, longest_m, share, here.cluster);
    }
    step.length_m = select(step.length_m, boundary_m - t_m, t_m + step.length_m >= boundary_m * 0.999999);
    return step;
}

#ifdef CLOUDS
// A distance in which there is nothing where there is nothing but clouds, m.
fn empty_ahead_m(ray: ptr<function, Ray>, t_m: f32, here: Between) -> f32 {
    if !here.clouds_alone {
        return 0.0;
    }
    let place = place_of(position_m(ray, t_m));
    return gap_of_layers_m(place.map, place.altitude_m, rise_at(ray, t_m, place.altitude_m), here.middle_altitude_m);
}
#endif
