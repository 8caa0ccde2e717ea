#define_import_path welkin::lamp_source
// Light of a local light that matter in a step sends along the step's direction.
//
// The inverse square of the distance is integrated along the step in closed form, as an angle at the light (Kulla & Fajardo 2012,
// section 3). What is scattered once has the phase function; what was scattered before has the table of welkin::lamp_field.

#import welkin::atmosphere::atmosphere
#import welkin::lamp_field::{above_ground, scattered_again_per_sr, spread_of_field}
#import welkin::lamp_grid::{near_share, tile_rad}
#import welkin::local_light::{cone_share, depth_to_local_light, local_lights, scattered_cone_share}
#import welkin::volume_field::{altitude_of, place_of, volumes}
#import welkin::volume_source::{phase_per_sr, Piece, Stretch}

// Which share of a lamp's light is asked for: welkin::lamp_grid.
const ALL: u32 = 0u;
const NEAR: u32 = 1u;
const FAR: u32 = 2u;

// Angle at a local light over which one sample stands for a step, rad.
const LIGHT_ANGLE_RAD: f32 = 0.2;
const MOST_LIGHT_SAMPLES: u32 = 8u;
// Of the width of a tile, as seen from a place, the share over which a far lamp's forward peak is spread.
const BLUR: f32 = 0.4;

// Cosine of an angle that is spread over another.
fn blurred(nu: f32, by_rad: f32) -> f32 {
    let angle = acos(clamp(nu, -1.0, 1.0));
    return cos(min(sqrt(angle * angle + by_rad * by_rad), 3.14159265));
}

// Mean over the step, per density, b and metre.
fn from_local_light(light: u32, piece: Piece, stretch: Stretch, asked: u32) -> vec3<f32> {
    let position_m = local_lights[light].position_m;
    let nearest_m = dot(position_m - stretch.origin, stretch.view);
    let off = stretch.origin + stretch.view * nearest_m - position_m;
    let off_m = sqrt(dot(off, off) + local_lights[light].size_squared + 1e-6);
    let first = (stretch.from_m - nearest_m) / off_m;
    let last = first + stretch.step_m / off_m;
    let reach_m = local_lights[light].reach_m;
    let closest = off_m * off_m + pow(max(max(first, -last), 0.0) * off_m, 2.0);
    if closest >= reach_m * reach_m {
        return vec3<f32>(0.0);
    }
    let from_rad = atan(first);
    let opening_rad = max(atan(last) - from_rad, 0.0);
    let count = u32(clamp(ceil(opening_rad / LIGHT_ANGLE_RAD), 1.0, f32(MOST_LIGHT_SAMPLES)));
    let per_sample = opening_rad / (f32(count) * off_m * stretch.step_m);
    let lamp_altitude_m = altitude_of(position_m);
    var radiance = vec3<f32>(0.0);
    for (var i = 0u; i < count; i++) {
        let t_m = clamp(
            nearest_m + off_m * tan(from_rad + opening_rad * (f32(i) + 0.5) / f32(count)),
            stretch.from_m, stretch.from_m + stretch.step_m
        );
        let p = stretch.origin + stretch.view * t_m;
        let offset = position_m - p;
        let distance_m = max(length(offset), 1e-6);
        let toward = offset / distance_m;
        var share = 1.0;
        var nu = dot(stretch.view, toward);
        if asked != ALL {
            let near = near_share(light, stretch.origin, stretch.view, t_m, toward, distance_m);
            share = select(1.0 - near, near, asked == NEAR);
            if share <= 0.0 {
                continue;
            }
        }
        if asked == FAR {
            nu = blurred(nu, BLUR * tile_rad() * (1.0 + t_m / distance_m));
        }
        let place = place_of(p);
        let to_light = depth_to_local_light(light, place, toward, distance_m);
        let to_eye = stretch.before + stretch.within * ((t_m - stretch.from_m) / stretch.step_m);
        let cone = cone_share(light, -toward);
        var scattered = cone * phase_per_sr(piece.index, nu) * exp(-to_light);
#ifdef VOLUME_ORDERS
        let field = volumes[piece.index].lamp_field;
        let spread = spread_of_field(field, to_light);
        scattered += scattered_cone_share(light, cone, to_light) * scattered_again_per_sr(field, to_light, nu)
            * above_ground(spread, lamp_altitude_m, place.altitude_m, distance_m, atmosphere.ground_albedo);
#endif
        radiance += share * per_sample * exp(-to_eye) * scattered;
    }
    return local_lights[light].intensity * radiance;
}
