//! The CPU bake against what is known of light.

mod small_air;

use std::f64::consts::PI;
use std::sync::Mutex;

use small_air::{SMALL, earth};
use welkin_lut::bake::{Air, AirError, BakeSettings, Baked, SourceGrid};
use welkin_lut::mapping::{OpticalDepthMapping, unit_from_texel};
use welkin_lut::phase::TabulatedPhase;
use welkin_lut::{DensityProfile, Medium, PhaseFunction, Planet, Table};

#[test]
fn optical_depth_straight_up_is_the_column_of_all_constituents() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    // Rayleigh 8 km, haze 1.2 km, ozone's tent 15 km: columns in closed form.
    let column = |scale_m: f64| scale_m * -(-100_000.0 / scale_m).exp_m1();
    let rayleigh = [5.802e-6, 13.558e-6, 33.1e-6];
    let ozone = [0.65e-6, 1.881e-6, 0.085e-6];
    let found = baked.tables().transmittance_to_space(0.0, 1.0);
    for band in 0..3 {
        let depth = rayleigh[band] * column(8000.0) + 4.44e-6 * column(1200.0) + ozone[band] * 15_000.0;
        // Ozone's tent is in closed form; haze leaves Simpson's rule with 64 panels a millionth.
        assert!((-found[band].ln() / depth - 1.0).abs() < 2e-6, "{band}: {} and {depth}", -found[band].ln());
    }
}

/// The share of the sun's light that leaves the top of a flat layer of air again.
fn reflectance(ground_albedo: f64, mu_s: f64) -> f64 {
    let mut constituents = earth().scatterers().to_vec();
    constituents.truncate(1);
    constituents[0].scattering_per_m = [20e-6; 3];
    let planet = Planet { radius_m: 6e8, atmosphere_height_m: 60_000.0, ground_albedo: [ground_albedo; 3] };
    let air = Air::new(&planet, &Medium { constituents }).unwrap();
    let source_grid = SourceGrid { ground: 4, low: 4, high: 4, azimuths: 8 };
    let finer = BakeSettings { nodes_per_leg: 12, orders: 8, source_grid, source_size: [32, 12], ..SMALL };
    let baked = Baked::new(&air, finer, &|_| {});
    let tables = baked.tables();
    let (cosines, azimuths) = (200, 16);
    let mut up = 0.0;
    for i in 0..cosines {
        let mu = -(f64::from(i) + 0.5) / f64::from(cosines);
        for k in 0..azimuths {
            let phi = (f64::from(k) + 0.5) * PI / f64::from(azimuths);
            let nu = mu * mu_s + ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).sqrt() * phi.cos();
            let cosines_of_ray = [mu, mu_s, nu];
            let air = tables.sky_radiance(60_000.0, cosines_of_ray)[1];
            let ground = tables.ground_radiance(60_000.0, cosines_of_ray)[1];
            up += -mu * (air + ground) * 2.0 * PI / f64::from(azimuths) / f64::from(cosines);
        }
    }
    up / mu_s
}

#[test]
fn air_that_absorbs_nothing_over_white_ground_gives_all_light_back() {
    for mu_s in [0.3, 1.0] {
        let white = reflectance(1.0, mu_s);
        println!("mu_s {mu_s}: {white:.4}");
        // Within what the small tables cost.
        assert!((white - 1.0).abs() < 0.015, "{white}");
    }
    // Negative control: ground that keeps a twentieth is noticed.
    assert!(reflectance(0.95, 1.0) < 0.97);
}

#[test]
fn a_bake_says_how_far_it_has_come_and_is_the_same_on_any_number_of_threads() {
    let air = earth();
    let said = Mutex::new(Vec::new());
    let baked = Baked::new(&air, SMALL, &|progress| said.lock().unwrap().push(progress.done));
    let said = said.into_inner().unwrap();
    assert!(said.len() > 4 && said[0] == 0.0 && said.last() == Some(&1.0), "{said:?}");
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let again = alone.install(|| Baked::new(&air, SMALL, &|_| {}));
    assert!(baked.tables() == again.tables());
}

#[test]
fn tables_are_what_evaluation_gives_at_their_texels() {
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let table = &baked.tables().set().multiple_scattering;
    let mapping = welkin_lut::mapping::MultipleScatteringMapping::new(air.planet());
    // By how much the values of a texel differ at most: logarithms of light that is not dark, and ratios.
    let difference = |[x, y]: [u32; 2], [altitude_m, mu_s]: [f64; 2]| {
        let values = baked.multiple_scattering(altitude_m, mu_s);
        let of_value = |(k, value): (usize, &[f64; 3])| {
            let stored = table.texel(x, y, k as u32);
            let lit = (0..3).filter(|&band| stored[band] > -20.0);
            lit.map(|band| (value[band] - stored[band]).abs()).fold(0.0, f64::max)
        };
        values.iter().enumerate().map(of_value).fold(0.0, f64::max)
    };
    for texel in [[5, 0], [7, 3], [11, 7], [15, 0]] {
        let place = mapping.parameters(unit_from_texel(texel, [16, 8]));
        let found = difference(texel, place);
        println!("{texel:?} at {place:?}: {found:.1e}");
        // Evaluation walks the light of all orders once more; the table ends the series with a constant ratio of orders, after
        // three of them here.
        assert!(found < 0.01, "{texel:?}: {found}");
        // Negative control: the sun two degrees away.
        let elsewhere = difference(texel, [place[0], place[1] - 0.035]);
        assert!(elsewhere > 0.02, "{texel:?}: {elsewhere}");
    }
}

#[test]
fn air_that_shaders_cannot_read_is_refused_with_what_to_do() {
    let planet = earth().planet().clone();
    let nothing = Air::new(&planet, &Medium::default()).unwrap_err();
    assert_eq!(nothing, AirError::NothingScatters);
    let mut constituents = vec![earth().scatterers()[0].clone(); 9];
    let many = Air::new(&planet, &Medium { constituents: constituents.clone() }).unwrap_err();
    assert_eq!(many, AirError::TooManyScatterers(9));
    let table = TabulatedPhase::from_points(&[(-1.0, 0.7), (0.0, 0.5), (1.0, 1.0)]);
    constituents.truncate(1);
    constituents[0].phase = PhaseFunction::Tabulated(std::sync::Arc::new(table.unwrap()));
    let tabulated = Air::new(&planet, &Medium { constituents: constituents.clone() }).unwrap_err();
    assert!(tabulated.to_string().contains("closed forms"), "{tabulated}");
    constituents[0] = earth().scatterers()[0].clone();
    constituents[0].profile = DensityProfile::Layer { bottom_m: 1000.0, top_m: 2000.0 };
    let layer = Air::new(&planet, &Medium { constituents }).unwrap_err();
    assert!(layer.to_string().contains("exponential or tent"), "{layer}");
}

/// Length of a ray to space between two altitudes, in closed form: distances from where the ray is nearest to the centre.
fn length_within_m(radius_m: f64, [bottom_m, top_m]: [f64; 2], altitude_m: f64, mu: f64) -> f64 {
    let r = radius_m + altitude_m;
    let nearest_squared = r * r * (1.0 - mu * mu);
    let start_m = r * mu;
    let shell_m = |altitude_m: f64| ((radius_m + altitude_m).powi(2) - nearest_squared).max(0.0).sqrt();
    let (low_m, high_m) = (shell_m(bottom_m), shell_m(top_m));
    let overlap = |from: f64, to: f64| (to - from.max(start_m)).max(0.0);
    overlap(low_m, high_m) + overlap(-high_m, -low_m)
}

#[test]
fn a_table_would_blur_a_layer_with_sharp_bounds_and_does_not_blur_haze() {
    let (radius_m, top_m) = (6_360_000.0, 100_000.0);
    let mapping = OpticalDepthMapping { radius_m, top_m };
    let size = BakeSettings::MEDIUM.optical_depth_size;
    // Errors of transmittance between the texels of a table of exact values: 99th percentile and maximum.
    let errors = |optical_depth: &dyn Fn(f64, f64) -> f64| {
        let texel = |x: u32, y: u32| {
            let [altitude_m, mu] = mapping.parameters(unit_from_texel([x, y], size));
            [optical_depth(altitude_m, mu); 3]
        };
        let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])).map(|[x, y]| texel(x, y));
        let table = Table::new([size[0], size[1], 1], texels.collect());
        let places =
            (0..2000_u32).map(|n| [0.618_033_988_7, 0.754_877_666_2].map(|step| (step * f64::from(n)).fract()));
        let mut errors: Vec<f64> = places
            .map(|unit| {
                let [altitude_m, mu] = mapping.parameters(unit);
                ((-table.at_unit(unit, 0)[0]).exp() - (-optical_depth(altitude_m, mu)).exp()).abs()
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        [errors[errors.len() * 99 / 100], errors[errors.len() - 1]]
    };
    // Smoke of optical depth 0.33 from 1.5 to 3 km; and as much of it in shells as thin as air thins out.
    let layer = |altitude_m: f64, mu: f64| 2.2e-4 * length_within_m(radius_m, [1500.0, 3000.0], altitude_m, mu);
    let haze = |altitude_m: f64, mu: f64| {
        let shells = (0..400).map(|n| [250.0 * f64::from(n), 250.0 * f64::from(n + 1)]);
        let of_shell = |shell: [f64; 2]| {
            let density = (-0.5 * (shell[0] + shell[1]) / 8000.0).exp();
            4.125e-5 * density * length_within_m(radius_m, shell, altitude_m, mu)
        };
        shells.map(of_shell).sum::<f64>()
    };
    let (sharp, smooth) = (errors(&layer), errors(&haze));
    println!("transmittance between texels, 99 % and worst: {sharp:.4?} with a layer, {smooth:.4?} with haze");
    // A sample falls on every bound sooner or later: there all the smoke of a grazing ray is missed.
    assert!(sharp[1] > 0.5 && sharp[0] > 10.0 * smooth[0], "{sharp:?} {smooth:?}");
    assert!(smooth[1] < 2e-3, "{smooth:?}");
}
