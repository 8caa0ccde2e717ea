//! What the air is made of.

use welkin::plan::{Directions, Settings};

use super::{Bound, Case};

pub fn cases() -> Vec<Case> {
    let looking_up = "camera.elevation_deg = 70\ncamera.vertical_field_of_view_deg = 60\n";
    let mut cases = vec![
        Case::new("vacuum", "medium = []").quick(),
        Case::new("absorption only, optical depth 13", looking_up.to_owned() + &isotropic("0", "1.625e-3")).quick(),
        Case::new("scattering only, white ground", white("\"rayleigh\"")).quick(),
        glow(),
    ];
    cases.extend(optical_depths());
    cases.extend(asymmetries());
    cases.extend(scale_heights());
    cases
}

/// Light of the air alone, above a ground that it lights; fewer directions than the glow's field has coefficients.
fn glow() -> Case {
    let layer = "[medium.glow]\nemission_per_m = 1e-6\nprofile.layer = { bottom_m = 90000, top_m = 95000 }";
    let night = "sun.irradiance = 0\ncamera.elevation_deg = -40\n";
    let few = |settings| Settings { directions: Directions { below: 3, band: 1, above: 3, azimuths: 4 }, ..settings };
    Case { settings: few, ..Case::new("air that glows, seven directions", format!("{night}{layer}")) }
}

/// Matter with an exponential profile of scale height 8 km.
fn isotropic(scattering_per_m: &str, absorption_per_m: &str) -> String {
    format!(
        "[[medium]]\nname = \"matter\"\nscattering_per_m = {scattering_per_m}\nabsorption_per_m = {absorption_per_m}\n\
         phase = \"isotropic\"\nprofile.exponential.scale_height_m = 8000\n"
    )
}

/// Nothing takes light away: albedo 1 in the air and on the ground.
fn white(phase: &str) -> String {
    format!(
        "planet.ground_albedo = 1\n[[medium]]\nname = \"matter\"\nscattering_per_m = [5.8e-6, 1.36e-5, 3.3e-5]\n\
         phase = {phase}\nprofile.exponential.scale_height_m = 8000\n"
    )
}

/// Isotropic matter of albedo 0.9: thin, seen from the ground; thick, seen from space, and from the dark inside.
fn optical_depths() -> Vec<Case> {
    let of = |depth: f64| isotropic(&format!("{:e}", 0.9 * depth / 8000.0), &format!("{:e}", 0.1 * depth / 8000.0));
    let thin = [1e-6, 1e-3, 1.0].map(|depth| Case::new(format!("optical depth {depth:e}"), of(depth)));
    let from_space = "camera.altitude_m = 4e5\ncamera.elevation_deg = -50\n";
    let thick = [1e2, 1e4, 1e6]
        .map(|depth| Case::new(format!("optical depth {depth:e} from space"), from_space.to_owned() + &of(depth)));
    let inside = Case::new("optical depth 1e6 from below", of(1e6));
    thin.into_iter().chain(thick).chain([inside]).collect()
}

/// Ten times the preset's haze with another phase function.
fn asymmetries() -> Vec<Case> {
    let of = |g: f64| {
        Case::new(
            format!("haze, g = {g}"),
            format!("[medium.mie]\ndensity_factor = 10\nphase.henyey_greenstein.g = {g}"),
        )
    };
    [0.0, 0.5, -0.5, 0.99, -0.99, 0.9999, -0.9999].map(of).into()
}

fn scale_heights() -> Vec<Case> {
    let haze = |name: &str, height_m: &str, factor: &str| {
        Case::new(
            name,
            format!("[medium.mie]\ndensity_factor = {factor}\nprofile.exponential.scale_height_m = {height_m}"),
        )
    };
    let layer = |name: &str, bottom_m: &str, top_m: &str| {
        let layer = format!("absorption_per_m = 1e-4\nprofile.layer = {{ bottom_m = {bottom_m}, top_m = {top_m} }}");
        Case::new(name, format!("[medium.layer]\n{layer}"))
    };
    vec![
        haze("haze of scale height 10 m", "10", "100"),
        haze("haze of scale height 100 km", "1e5", "0.1"),
        layer("an absorbing layer of 1 km", "1000", "2000"),
        layer("an absorbing layer of 1 m", "1000", "1001"),
        layer("a layer above the top", "2e5", "3e5"),
        Case::new("twelve constituents of every profile", twelve())
            .bound(Bound::LawsOnly("a law of counts, not of light")),
    ]
}

fn twelve() -> String {
    let profiles = [
        "exponential.scale_height_m = 3000",
        "tent = { centre_m = 9000, half_width_m = 4000 }",
        "layer = { bottom_m = 500, top_m = 900 }",
    ];
    let one = |i: usize| {
        let scattering = if i.is_multiple_of(2) { 1e-6 } else { 0.0 };
        format!(
            "[[medium]]\nname = \"{i}\"\nscattering_per_m = {scattering:e}\nabsorption_per_m = 1e-6\nphase = \"rayleigh\"\n\
             profile.{}\n",
            profiles[i % 3]
        )
    };
    (0..12).map(one).collect()
}
