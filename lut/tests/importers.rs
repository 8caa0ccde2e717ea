//! The probes tell an importer that reads tables rightly from one that confuses what can be confused.

mod small_air;

use small_air::{SMALL, earth};
use welkin_lut::bake::Baked;
use welkin_lut::pack::{ProbeAnswer, ProbeInput, probe_inputs};
use welkin_lut::sky_tables::{SkyTables, TableSet};
use welkin_lut::{Bands, Table};

/// How far importers in 32-bit floats may be: what `probes.json` says.
const TOLERANCE: f64 = 1e-3;

/// Whether an importer passes the probes.
fn passes(tables: &SkyTables, importer: impl Fn(&ProbeInput) -> ProbeAnswer) -> bool {
    let close = |expected: Bands, found: Bands| {
        expected.into_iter().zip(found).all(|(e, f)| (e - f).abs() <= TOLERANCE * e.abs().max(1e-12))
    };
    probe_inputs(100_000.0).iter().all(|input| {
        let pairs = ProbeAnswer::of(tables, input).quantities().into_iter().zip(importer(input).quantities());
        pairs.into_iter().all(|(expected, found)| close(expected.1, found.1))
    })
}

/// The tables after a mistake that is made with all of them.
fn mistaken(tables: &SkyTables, mistake: impl Fn(&Table) -> Table) -> SkyTables {
    let set = tables.set();
    tables.with_set(TableSet {
        transmittance: mistake(&set.transmittance),
        irradiance: mistake(&set.irradiance),
        multiple_scattering: mistake(&set.multiple_scattering),
        scattering: mistake(&set.scattering),
    })
}

/// Texels by their places.
fn rearranged(table: &Table, from: impl Fn([u32; 3]) -> Bands) -> Table {
    let [width, height, depth] = table.size();
    let places = (0..depth).flat_map(|z| (0..height).flat_map(move |y| (0..width).map(move |x| [x, y, z])));
    Table::new(table.size(), places.map(from).collect())
}

fn srgb_decoded(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// View and sun as unit vectors (east, north, up) that have a probe's cosines.
fn vectors(input: &ProbeInput) -> [Vector; 2] {
    let (sine, sine_s) = ((1.0 - input.mu * input.mu).sqrt(), (1.0 - input.mu_s * input.mu_s).max(0.0).sqrt());
    let cos_phi = ((input.nu - input.mu * input.mu_s) / (sine * sine_s).max(1e-9)).clamp(-1.0, 1.0);
    let view = [sine * (1.0 - cos_phi * cos_phi).sqrt(), sine * cos_phi, input.mu];
    [view, [0.0, sine_s, input.mu_s]]
}

/// The cosines that an engine finds in its own axes, with what it takes for up.
fn cosines(input: &ProbeInput, to_engine: impl Fn(Vector) -> Vector, up: Vector) -> ProbeInput {
    let [view, sun] = vectors(input).map(to_engine);
    ProbeInput { altitude_m: input.altitude_m, mu: dot(view, up), mu_s: dot(sun, up), nu: dot(view, sun) }
}

#[test]
fn whoever_reads_the_tables_as_they_are_passes() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let tables = baked.tables();
    assert!(passes(tables, |input| ProbeAnswer::of(tables, input)));
    let in_f32 = |input: &ProbeInput| {
        let cut = |value: f64| f64::from(value as f32);
        let ProbeInput { altitude_m, mu, mu_s, nu } = *input;
        ProbeAnswer::of(tables, &ProbeInput { altitude_m: cut(altitude_m), mu: cut(mu), mu_s: cut(mu_s), nu: cut(nu) })
    };
    assert!(passes(tables, in_f32));
}

#[test]
fn flipped_rows_slices_in_another_order_and_transposed_tables_are_noticed() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let tables = baked.tables();
    let fails = |mistake: &dyn Fn(&Table) -> Table| {
        let wrong = mistaken(tables, mistake);
        !passes(tables, |input| ProbeAnswer::of(&wrong, input))
    };
    assert!(!fails(&|table| rearranged(table, |[x, y, z]| table.texel(x, y, z))), "control: nothing rearranged");
    assert!(fails(&|table| rearranged(table, |[x, y, z]| table.texel(x, table.size()[1] - 1 - y, z))), "rows");
    assert!(fails(&|table| rearranged(table, |[x, y, z]| table.texel(table.size()[0] - 1 - x, y, z))), "columns");
    assert!(fails(&|table| rearranged(table, |[x, y, z]| table.texel(x, y, table.size()[2] - 1 - z))), "slices");
    assert!(
        fails(&|table| rearranged(table, |[x, y, z]| table.texel(x, y, z).map(|_| table.texel(x, y, z)[0]))),
        "bands"
    );
}

#[test]
fn half_a_texel_and_gamma_are_noticed() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let tables = baked.tables();
    // Coordinates of 0 and 1 taken for the edges of the first and last texel instead of their centres.
    let at_edges = |table: &Table| {
        rearranged(table, |[x, y, z]| {
            let at = |i: u32, n: u32| f64::from(i) * f64::from(n) / f64::from(n - 1).max(1.0) - 0.5;
            table.bilinear([at(x, table.size()[0]), at(y, table.size()[1])], z)
        })
    };
    let wrong = mistaken(tables, at_edges);
    assert!(!passes(tables, |input| ProbeAnswer::of(&wrong, input)), "texel centres");
    let wrong = mistaken(tables, |table| rearranged(table, |[x, y, z]| table.texel(x, y, z).map(srgb_decoded)));
    assert!(!passes(tables, |input| ProbeAnswer::of(&wrong, input)), "an import that takes numbers for sRGB");
}

#[test]
fn kilometres_and_centimetres_are_noticed() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let tables = baked.tables();
    for scale in [1e-3, 100.0] {
        let altered = |input: &ProbeInput| ProbeInput { altitude_m: input.altitude_m * scale, ..*input };
        assert!(!passes(tables, |input| ProbeAnswer::of(tables, &altered(input))), "{scale}");
    }
}

#[test]
fn up_is_whichever_axis_the_engine_says_as_long_as_it_says_the_right_one() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let tables = baked.tables();
    // East, north, up in the axes of engines: Y-up right-handed (Bevy, Godot), Y-up left-handed (Unity), Z-up left-handed
    // (Unreal).
    let y_up_right = |[e, n, u]: Vector| [e, u, -n];
    let y_up_left = |[e, n, u]: Vector| [e, u, n];
    let z_up_left = |[e, n, u]: Vector| [n, e, u];
    let (y, z) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let right = |to_engine: fn(Vector) -> Vector, up: Vector| {
        passes(tables, |input| ProbeAnswer::of(tables, &cosines(input, to_engine, up)))
    };
    assert!(right(y_up_right, y) && right(y_up_left, y) && right(z_up_left, z));
    // Negative controls: the other axis.
    assert!(!right(y_up_right, z) && !right(y_up_left, z) && !right(z_up_left, y));
}
