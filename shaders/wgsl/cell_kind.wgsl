#define_import_path welkin::cell_kind
// What a square cell of pixels shows: sky, ground, or what is not to be interpolated over.

#import welkin::camera::{pixel_angle_rad, view_through}
#import welkin::observer::{observer, DISC_COUNT}

// Too near the horizon or a disc to be interpolated, all sky, or all ground.
const MIXED_CELL: f32 = 0.0;
const SKY_CELL: f32 = 1.0;
const GROUND_CELL: f32 = 2.0;

// What a cell around a place in the picture is, whose view and zenith angle are given; sides in pixels. No point of it is farther from its
// centre than its corners are, nor does a zenith angle change by more than the direction does.
fn kind_of_cell(centre: vec2<f32>, half_side: f32, view: vec3<f32>, zenith_rad: f32) -> f32 {
    var chord = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let corner = centre + half_side * (2.0 * vec2<f32>(f32(i % 2u), f32(i / 2u)) - 1.0);
        chord = max(chord, distance(view_through(corner), view));
    }
    let pixel_rad = pixel_angle_rad(view);
    // The arc over a chord below 1 is at most 4.8 % longer.
    let reach_rad = 1.05 * chord + pixel_rad;
    var kind = select(SKY_CELL, GROUND_CELL, zenith_rad > observer.view.horizon_rad);
    if chord > 1.0 || abs(zenith_rad - observer.view.horizon_rad) <= reach_rad {
        kind = MIXED_CELL;
    }
    for (var light = 0u; light < DISC_COUNT; light++) {
        let disc = observer.lights[light];
        let shown = disc.angular_radius_rad > 0.0 && zenith_rad <= observer.view.horizon_rad;
        let disc_rad = max(disc.angular_radius_rad, pixel_rad) + pixel_rad;
        if shown && distance(view, disc.direction) < disc_rad + reach_rad {
            kind = MIXED_CELL;
        }
    }
    return kind;
}
