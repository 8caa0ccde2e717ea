#define_import_path welkin::media_advance
// A march through the sum of all media, step by step.
//
// A ray is cut where it crosses a layer of clouds or fog, where it enters and leaves local volumes, and at the ends of
// clusters' slices. Between two cuts the same matter is there. In a step (welkin::media_step) the light of each kind of matter
// (welkin::media_light) is integrated with the attenuation of all. Empty pieces are taken in one step.
//
// Fog and volumes take from the air's light and shade the ground; that they shade thin air is left out.
//
// Definitions: CLOUDS; VOLUME_MAX_STEPS.

#ifdef CLOUDS
#import welkin::cloud_source::PHASE_COUNT
#endif
#import welkin::media_between::{between, next_boundary_m, Between}
#import welkin::media_march::{follow_air, growth_behind, pass_air, through_air, Air, Ray, NEVER_M, OPAQUE}
#import welkin::media_step::{greatest, next_step}
#ifdef CLOUDS
#import welkin::media_step::empty_ahead_m
#endif
#import welkin::media_sum::{add_volumes, cloudiness, depth_of, left_of_air, stretch_of, Sum}
#ifdef CLOUDS
#import welkin::media_sum::add_clouds
#endif

const MAX_STEPS: u32 = #{VOLUME_MAX_STEPS}u;
// Behind it steps grow. Lamps deep in matter are not smooth: twice the depth of clouds that none lights.
const SMOOTH_DEPTH: f32 = 4.0;
#ifdef CLOUDS
const PHASE_SLOTS: u32 = PHASE_COUNT;
#else
const PHASE_SLOTS: u32 = 1u;
#endif

// Where a march is.
struct March {
    t_m: f32,
    steps: u32,
    // The next cut, and what lies before it.
    boundary_m: f32,
    here: Between,
    // Whether it has left all media, or sees nothing more.
    is_over: bool,
    // A distance at which it must stop, beside those of boundaries, m.
    cut_m: f32,
}

// Goes a step on, or through what is empty.
fn advance(march: ptr<function, March>, sum: ptr<function, Sum>, air: ptr<function, Air>, ray: ptr<function, Ray>, offset: f32, phase: ptr<function, array<f32, PHASE_SLOTS>>) {
    let t_m = (*march).t_m;
    if t_m >= (*march).boundary_m {
        (*march).boundary_m = next_boundary_m(ray, t_m);
        (*march).here = between(ray, t_m, (*march).boundary_m);
    }
    let boundary_m = min((*march).boundary_m, (*march).cut_m);
    let here = (*march).here;
    let before = depth_of(*sum);
    let is_empty = here.detail_m >= NEVER_M;
    (*march).is_over = boundary_m >= NEVER_M || (!is_empty && min(before.r, min(before.g, before.b)) >= OPAQUE);
    if (*march).is_over {
        return;
    }
    if is_empty {
        follow_air(air, ray);
        pass_air(air, ray, left_of_air(*sum), boundary_m);
        (*march).t_m = boundary_m;
        return;
    }
#ifdef CLOUDS
    let empty_m = empty_ahead_m(ray, t_m, here);
    if empty_m > 0.0 {
        (*march).t_m = min(t_m + empty_m, boundary_m);
        pass_air(air, ray, left_of_air(*sum), (*march).t_m);
        return;
    }
#endif
    let step = next_step(ray, t_m, boundary_m, here, growth_behind(greatest(before), SMOOTH_DEPTH), select(0.5, offset, here.uneven));
    let air_leaves = through_air(air, t_m);
    let cloudy = cloudiness(step, here);
    let stretch = stretch_of(*sum, ray, t_m, step, cloudy);
#ifdef CLOUDS
    if cloudy > 0.0 {
        add_clouds(sum, stretch, step, cloudy, here.cluster, air_leaves, phase);
    }
#endif
    add_volumes(sum, stretch, step, (*ray).pixel, here.cluster, air_leaves);
    (*march).t_m += step.length_m;
    pass_air(air, ray, left_of_air(*sum), (*march).t_m);
}
