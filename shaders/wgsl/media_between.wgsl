#define_import_path welkin::media_between
// Boundaries of media along a ray, and what lies between two of them.
//
// Definitions: CLOUDS; FOG_COUNT; LOCAL_VOLUMES.

#import welkin::cluster::{cluster_of, slice_beyond, slice_end_m, slice_of}
#ifdef LOCAL_VOLUMES
#import welkin::cluster_members::{next_member, volumes_of, NONE}
#endif
#import welkin::media_march::{altitude_m, next_crossing_m, observer_position, Ray, NEVER_M}
#import welkin::volume_field::{local_span_m, volumes, FOG_COUNT}
#ifdef CLOUDS
#import welkin::cloud_step::is_in_clouds

const CLOUD_STEP_M: f32 = #{CLOUD_STEP_M}.0;
#endif

// The next boundary after a distance: of a layer, a local volume or a cluster's slice, or the ray's end.
fn next_boundary_m(ray: ptr<function, Ray>, t_m: f32) -> f32 {
    let after_m = t_m * 1.000001 + 1e-4;
    let slice = slice_beyond(after_m);
    var next = min(next_crossing_m(ray, t_m), slice_end_m(slice));
#ifdef LOCAL_VOLUMES
    var locals = volumes_of(cluster_of((*ray).pixel, slice));
    for (var index = next_member(&locals); index != NONE; index = next_member(&locals)) {
        let span_m = local_span_m(index, observer_position(), (*ray).direction);
        next = select(next, min(next, span_m.x), span_m.x > after_m && span_m.y > span_m.x);
        next = select(next, min(next, span_m.y), span_m.y > after_m && span_m.y > span_m.x);
    }
#endif
    return min(next, (*ray).end_m);
}

// What lies between two boundaries.
struct Between {
    // Longest step that its detail allows, m; NEVER_M where there is nothing.
    detail_m: f32,
    clouds: bool,
    // Whether there is nothing else, and an altitude there.
    clouds_alone: bool,
    middle_altitude_m: f32,
    // Whether density changes within its detail: then every pixel looks at another place of a step.
    uneven: bool,
    // First word of its cluster.
    cluster: u32,
}

fn between(ray: ptr<function, Ray>, from_m: f32, to_m: f32) -> Between {
    let middle_m = 0.5 * (from_m + min(to_m, 1e8));
    let altitude = altitude_m(ray, middle_m);
    var found = Between(NEVER_M, false, false, altitude, false, cluster_of((*ray).pixel, slice_of(middle_m)));
    for (var i = 0u; i < FOG_COUNT; i++) {
        if altitude > volumes[i].bottom_m && altitude < volumes[i].top_m {
            // What counts is the change along the ray: of altitude, or of the billows.
            let slope = max(abs(altitude_m(ray, to_m) - altitude_m(ray, from_m)) / max(to_m - from_m, 1e-6), 0.02);
            let along = select(slope, 1.0, volumes[i].noise_strength > 0.0);
            found.uneven = found.uneven || volumes[i].noise_strength > 0.0;
            found.detail_m = min(found.detail_m, volumes[i].detail_m / along);
        }
    }
#ifdef LOCAL_VOLUMES
    var locals = volumes_of(found.cluster);
    for (var index = next_member(&locals); index != NONE; index = next_member(&locals)) {
        let span_m = local_span_m(index, observer_position(), (*ray).direction);
        if span_m.x < middle_m && middle_m < span_m.y {
            found.uneven = found.uneven || volumes[index].is_even == 0u;
            found.detail_m = min(found.detail_m, min(volumes[index].detail_m, 0.125 * (span_m.y - span_m.x)));
        }
    }
#endif
#ifdef CLOUDS
    found.clouds = is_in_clouds(altitude);
    found.clouds_alone = found.clouds && found.detail_m >= NEVER_M;
    if found.clouds {
        found.detail_m = min(found.detail_m, CLOUD_STEP_M);
        found.uneven = true;
    }
#endif
    return found;
}
