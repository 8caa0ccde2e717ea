// Pass: one sweep of discrete ordinates through the clouds' grids: light scattered so often that it has forgotten its
// direction but for a mean flow.
//
// Legend
//   psi          radiance along an ordinate, per unit irradiance of a light normal to its beam
//   group        the four ordinates of one zenith cosine, at azimuths 45°, 135°, 225° and 315°
//   moments      (I0, I1): mean of psi, and three times its mean weighted by direction
//   similarity   q = 1 - f, f the second moment of the phase function: what is scattered nearly straight ahead counts
//                as not scattered, so extinction is q sigma
// Inside a sweep light moves all the way up or down a column, and one cell sideways. Columns at a grid's edge have
// neighbours like themselves; nothing enters from above or below.
//
// Definitions: CLOUD_GROUPS (2: eight ordinates, 4: sixteen), CLOUD_FIRST_SWEEP (nothing is known yet).

#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}
#import welkin::cloud_grid::{cell_m, cell_of, local_direction, GRID_SIZE, GRID_SLICES, SLABS}
#import welkin::cloud_matter::cloud_matter
#import welkin::observer::observer

@group(0) @binding(3) var cloud_density_image: texture_3d<f32>;
@group(0) @binding(4) var cloud_light_image: texture_3d<f32>;
#ifndef CLOUD_FIRST_SWEEP
@group(0) @binding(5) var flow_before: texture_3d<f32>;
@group(0) @binding(6) var moments_before: texture_3d<f32>;
#endif
// Group by group, each with all slabs of all lights.
@group(0) @binding(7) var flow_after: texture_storage_3d<rgba32float, write>;
@group(0) @binding(8) var moments_after: texture_storage_3d<rgba32float, write>;

const PI: f32 = 3.14159265358979;
const GROUPS: u32 = #{CLOUD_GROUPS}u;

// A group's zenith cosine, and the weight of each of its ordinates. Sixteen: the double Gauss rule of four cosines;
// eight: the corners of a cube.
fn group_rule(group: u32) -> vec2<f32> {
#if CLOUD_GROUPS == 4
    let rule = select(vec2<f32>(0.8611363, 0.0434819), vec2<f32>(0.3399810, 0.0815181), (group & 2u) != 0u);
#else
    let rule = vec2<f32>(0.5773503, 0.125);
#endif
    return vec2<f32>(select(rule.x, -rule.x, (group & 1u) != 0u), rule.y);
}

// psi of a group at a column's neighbours, each ordinate from where its light comes: east is +x, north +y.
fn from_sides(texel: vec3<u32>) -> mat2x4<f32> {
#ifdef CLOUD_FIRST_SWEEP
    return mat2x4<f32>(vec4<f32>(0.0), vec4<f32>(0.0));
#else
    let at = vec3<i32>(texel);
    let last = i32(GRID_SIZE) - 1;
    let west = textureLoad(flow_before, vec3<i32>(max(at.x - 1, 0), at.yz), 0);
    let east = textureLoad(flow_before, vec3<i32>(min(at.x + 1, last), at.yz), 0);
    let south = textureLoad(flow_before, vec3<i32>(at.x, max(at.y - 1, 0), at.z), 0);
    let north = textureLoad(flow_before, vec3<i32>(at.x, min(at.y + 1, last), at.z), 0);
    // Towards (+, +), (-, +), (-, -), (+, -).
    return mat2x4<f32>(
        vec4<f32>(west.x, east.y, east.z, west.w), vec4<f32>(south.x, south.y, north.z, north.w)
    );
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) column: vec3<u32>) {
    if any(column.xy >= vec2<u32>(GRID_SIZE)) {
        return;
    }
    let light = column.z / SLABS;
    let slab = column.z % SLABS;
    let slices = textureDimensions(moments_after).z;
    let cell = cell_of(vec3<u32>(column.xy, slab * GRID_SLICES));
    let matter = cloud_matter[cell.layer];
    let toward = local_direction(cell.map, observer.lights[light].direction);
    let across_per_m = 1.0 / cell_m(cell.level);
    let upward_per_m = f32(GRID_SLICES) / cloud_layers[cell.layer].thickness_m;
    var moments: array<vec4<f32>, GRID_SLICES>;
    for (var group = 0u; group < GROUPS; group++) {
        let rule = group_rule(group);
        // sin * cos 45°.
        let side = sqrt(0.5 * (1.0 - rule.x * rule.x));
        let x = side * vec4<f32>(1.0, -1.0, -1.0, 1.0);
        let y = side * vec4<f32>(1.0, 1.0, -1.0, -1.0);
        let to_light = x * toward.x + y * toward.y + rule.x * toward.z;
        let sideways = side * across_per_m;
        let vertical = abs(rule.x) * upward_per_m;
        var psi = vec4<f32>(0.0);
        for (var i = 0u; i < GRID_SLICES; i++) {
            let slice = select(i, GRID_SLICES - 1u - i, rule.x < 0.0);
            let place = vec3<u32>(column.xy, column.z * GRID_SLICES + slice);
            let field = vec3<u32>(column.xy, slab * GRID_SLICES + slice);
            let extinction = matter.similarity * textureLoad(cloud_density_image, field, 0).x;
            let depth = matter.similarity * textureLoad(cloud_light_image, place, 0).x;
            var source = exp(-depth) / (4.0 * PI) * (1.0 - 3.0 * matter.asymmetry * to_light);
#ifndef CLOUD_FIRST_SWEEP
            let known = textureLoad(moments_before, place, 0);
            source += known.x + matter.asymmetry * (x * known.y + y * known.z + rule.x * known.w);
#endif
            let sides = from_sides(vec3<u32>(column.xy, group * slices + place.z));
            let arriving = sideways * (sides[0] + sides[1]) + vertical * psi;
            psi = (arriving + matter.scaled_albedo * extinction * source) / (2.0 * sideways + vertical + extinction);
            psi = max(psi, vec4<f32>(0.0));
            textureStore(flow_after, vec3<u32>(column.xy, group * slices + place.z), psi);
            let weighted = rule.y * psi;
            let flow = 3.0 * vec3<f32>(dot(weighted, x), dot(weighted, y), rule.x * dot(weighted, vec4<f32>(1.0)));
            moments[slice] += vec4<f32>(dot(weighted, vec4<f32>(1.0)), flow);
        }
    }
    for (var slice = 0u; slice < GRID_SLICES; slice++) {
        textureStore(moments_after, vec3<u32>(column.xy, column.z * GRID_SLICES + slice), moments[slice]);
    }
}
