#define_import_path welkin::media_sum
// The sum of what all media along a ray send and hide, and what of it stands in an image's pixel.
//
// Definitions: CLOUDS; LOCAL_LIGHT_COUNT; LOCAL_VOLUMES (some volume is no fog); FOG_COUNT.

#import welkin::atmosphere::{atmosphere, PI}
#ifdef CLOUDS
#import welkin::attenuation::mean_transmittance
#endif
#import welkin::cluster::{cluster_of, slice_of}
#import welkin::cluster_members::{next_member, volumes_of, NONE}
#import welkin::fog_daylight::fog_share
#import welkin::media_between::Between
#import welkin::media_ground::{ground_lit_by_lamps, volume_share}
#import welkin::media_light::from_volume
#import welkin::media_march::{
    follow_air, leave_air, left_on_surface, observer_position, pass_air, position_m, Air, Ray, NEVER_M,
}
#import welkin::media_step::Step
#import welkin::volume_field::{place_of, volume_density, Place, FOG_COUNT}
#import welkin::volume_source::{Piece, Stretch}
#ifdef CLOUDS
#import welkin::cloud_matter::cloud_matter
#import welkin::cloud_source::PHASE_COUNT
#import welkin::cloud_step::{cloud_extinction, from_clouds, CloudStep}
#if LOCAL_LIGHT_COUNT > 0
#import welkin::media_light::clouds_lit_by_lamps
#endif
#endif

struct Sum {
    radiance: vec3<f32>,
    // Light from behind that forward peaks pass on.
    passed: vec3<f32>,
    // Optical depth so far: of clouds, of fog and volumes.
    clouds: f32,
    local: vec3<f32>,
    // Of the sky's light behind clouds, the share that they scatter by small angles only.
    passed_by_clouds: f32,
    // That of the medium similar to all of them: welkin::volume_source.
    similar: vec3<f32>,
}

// What the images hold.
struct Found {
    radiance: vec4<f32>,
    transmittance: vec4<f32>,
    beam: vec4<f32>,
    diffuse: vec4<f32>,
}

fn depth_of(sum: Sum) -> vec3<f32> {
    return vec3<f32>(sum.clouds) + sum.local;
}

// What media let pass of the light of the air behind them.
fn left_of_air(sum: Sum) -> vec3<f32> {
    return (exp(-sum.clouds) + sum.passed_by_clouds) * exp(-sum.local);
}

// Extinction of clouds in a step, 1/m.
fn cloudiness(step: Step, here: Between) -> f32 {
#ifdef CLOUDS
    return select(0.0, cloud_extinction(step.place.map, step.place.altitude_m), here.clouds);
#else
    return 0.0;
#endif
}

// A step of a march that has come to a distance, with so much extinction of clouds in it.
fn stretch_of(sum: Sum, ray: ptr<function, Ray>, from_m: f32, step: Step, cloudy: f32) -> Stretch {
    var stretch = Stretch((*ray).direction, observer_position(), from_m, step.length_m, depth_of(sum), vec3<f32>(0.0), sum.similar, vec3<f32>(0.0));
    stretch.within = (step.extinction + cloudy) * step.length_m;
    stretch.similar_within = step.similar_extinction * step.length_m;
#ifdef CLOUDS
    // Droplets of all layers are taken to be those of the first.
    stretch.similar_within += cloud_matter[0].similarity * cloudy * step.length_m;
#endif
    return stretch;
}

#ifdef CLOUDS
// Adds what clouds send and hide in a step.
fn add_clouds(sum: ptr<function, Sum>, stretch: Stretch, step: Step, cloudy: f32, cluster: u32, air_leaves: vec3<f32>, phase: ptr<function, array<f32, PHASE_COUNT>>) {
    let at = step.place;
    let up = normalize(vec3<f32>(at.p.xy, at.p.z + atmosphere.radius_m));
    let clouds = CloudStep(at.map, at.altitude_m, up, cloudy, (*sum).clouds, cloudy * step.length_m);
    let light = from_clouds(clouds, stretch.view, phase);
    (*sum).radiance += air_leaves * exp(-(*sum).local) * mean_transmittance(step.extinction * step.length_m) * light.radiance;
    (*sum).passed_by_clouds += light.passed;
#if LOCAL_LIGHT_COUNT > 0
    (*sum).radiance += air_leaves * clouds_lit_by_lamps(at, cloudy, stretch, cluster);
#endif
    (*sum).clouds += cloudy * step.length_m;
}
#endif

// Adds what one volume sends.
fn add_volume(sum: ptr<function, Sum>, stretch: Stretch, piece: Piece, pixel: vec2<u32>, cluster: u32, air_leaves: vec3<f32>) {
    let sent = from_volume(piece, stretch, pixel, cluster);
    (*sum).radiance += air_leaves * sent.scattered;
    (*sum).passed += air_leaves * sent.passed;
}

// Adds what fog and volumes send and hide in a step, and the depth of what is similar to all media in it.
fn add_volumes(sum: ptr<function, Sum>, stretch: Stretch, step: Step, pixel: vec2<u32>, cluster: u32, air_leaves: vec3<f32>) {
#if FOG_COUNT > 0
    for (var bank = 0u; bank < FOG_COUNT; bank++) {
        if step.fog[bank] > 0.0 {
            add_volume(sum, stretch, Piece(bank, step.fog[bank], step.place), pixel, cluster, air_leaves);
        }
    }
#endif
#ifdef LOCAL_VOLUMES
    var locals = volumes_of(cluster);
    for (var index = next_member(&locals); index != NONE; index = next_member(&locals)) {
        let density = volume_density(index, step.place);
        if density > 0.0 {
            add_volume(sum, stretch, Piece(index, density, step.place), pixel, cluster, air_leaves);
        }
    }
#endif
    (*sum).local += step.extinction * step.length_m;
    (*sum).similar += stretch.similar_within;
}

// The light that what the ray ends on receives: shares of the beam and of diffuse light in clear air.
fn ground_share(place: Place, air: ptr<function, Air>) -> vec2<f32> {
    var share = left_on_surface(air, place.map, place.altitude_m);
    share.x *= volume_share(place);
    return share * fog_share(place, share);
}

// What lies before where the air has been followed to. Ground other than smooth has its own light.
fn found(sum: Sum, air: ptr<function, Air>) -> Found {
    let transmittance = exp(-depth_of(sum));
    let behind = transmittance * exp(-(*air).depth);
    // Less than nothing of the light from behind cannot pass. What is no number stays none, and is seen.
    let radiance = sum.radiance + select(sum.passed, vec3<f32>(0.0), sum.passed < vec3<f32>(0.0));
    // The fourth channel of the third tells the lattice where clouds are.
    return Found(
        vec4<f32>(radiance, 1.0), vec4<f32>(transmittance, 1.0),
        vec4<f32>((*air).beam + behind, sum.clouds), vec4<f32>((*air).diffuse + behind, 0.0)
    );
}

// What lies before the ray's end.
fn found_at_end(sum: Sum, air: ptr<function, Air>, ray: ptr<function, Ray>) -> Found {
    if (*ray).end_m >= NEVER_M {
        leave_air(air, ray, left_of_air(sum));
        return found(sum, air);
    }
    pass_air(air, ray, left_of_air(sum), (*ray).end_m);
    follow_air(air, ray);
    var all = found(sum, air);
    if (*ray).meets_ground {
        let end = place_of(position_m(ray, (*ray).end_m));
        let ground = Place(end.p, max(end.altitude_m, 0.0), end.map);
        let share = ground_share(ground, air);
        let lit = ground_lit_by_lamps(ground, (*ray).pixel, (*ray).end_m, cluster_of((*ray).pixel, slice_of((*ray).end_m)));
        let left = all.transmittance.rgb * exp(-(*air).depth);
        all.radiance = vec4<f32>(all.radiance.rgb + left * atmosphere.ground_albedo / PI * lit, share.x);
        all.transmittance.a = share.y;
    }
    return all;
}
