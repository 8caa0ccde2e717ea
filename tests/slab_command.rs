//! `welkin slab` as a user calls it.

use std::process::{Command, Output};

fn slab(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_welkin")).arg("slab").args(arguments.split(' ')).output().expect("welkin runs")
}

#[test]
fn prints_where_the_light_of_van_de_hulsts_slab_ends() {
    let output = slab("--optical-thickness 2 --albedo 0.9 --phase henyey-greenstein:0.75 --mu0 1 --json");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let fluxes: serde_json::Value = serde_json::from_slice(&output.stdout).expect("standard output is JSON");
    let number = |name: &str| fluxes[name].as_f64().unwrap_or_else(|| panic!("{name} in {fluxes}"));
    assert!((number("reflectance") - 0.09739).abs() < 4.0 * number("reflectance_stderr") + 5e-6);
    let transmitted = number("diffuse_transmittance") + number("direct_transmittance");
    assert!((transmitted - 0.66096).abs() < 4.0 * number("diffuse_transmittance_stderr") + 5e-6);
    let all = number("reflectance") + transmitted + number("absorbed");
    assert!((all - 1.0).abs() < 4.0 * number("absorbed_stderr"));
}

#[test]
fn resolves_three_thousandths_of_what_comes_through_unless_told_otherwise() {
    let run = |more: &str| {
        let arguments = "--optical-thickness 16 --albedo 0.5 --phase isotropic --mu0 0.5 --json";
        let output = slab(&format!("{arguments}{more}"));
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let fluxes: serde_json::Value = serde_json::from_slice(&output.stdout).expect("standard output is JSON");
        let number = |name: &str| fluxes[name].as_f64().unwrap();
        (number("diffuse_transmittance"), number("diffuse_transmittance_stderr"))
    };
    let (value, error) = run("");
    // PythonicDISORT with eight decimals: 5e-8.
    assert!((value - 5e-8).abs() < 5e-9 && error < 0.0039 * value, "{value} ± {error}");
    let (value, error) = run(" --max-error 0.03");
    assert!(error > 0.0039 * value && error < 0.039 * value, "{value} ± {error}");
}

#[test]
fn says_so_when_the_error_asked_for_is_out_of_reach() {
    let arguments =
        "--optical-thickness 300 --albedo 0.001 --phase henyey-greenstein:0.999 --mu0 1 --max-error 0.0000001";
    let output = slab(arguments);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("above the 0.0000001 asked for"));
    assert!(!output.stdout.is_empty());
}

#[test]
fn refuses_impossible_slabs_and_says_what_is_allowed() {
    let cases = [
        ("--optical-thickness -1 --albedo 0.9 --phase rayleigh --mu0 1", "]0, ∞["),
        ("--optical-thickness 1 --albedo 1.1 --phase rayleigh --mu0 1", "[0, 1]"),
        ("--optical-thickness 1 --albedo 0.9 --phase rayleigh --mu0 0", "]0, 1]"),
        ("--optical-thickness 1 --albedo 0.9 --phase henyey-greenstein:1 --mu0 1", "]-1, 1["),
        ("--optical-thickness 1 --albedo 0.9 --phase mie --mu0 1", "cornette-shanks:G"),
        ("--optical-thickness 1 --albedo 0.9 --phase rayleigh --mu0 1 --max-error 2", "]0, 1["),
        (
            "--optical-thickness 1 --albedo 0.9 --phase rayleigh --mu0 1 --max-error 0.1 --photons 9",
            "cannot be used with",
        ),
    ];
    for (arguments, allowed) in cases {
        let output = slab(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains(allowed), "{arguments}: {message}");
        assert!(output.stdout.is_empty());
    }
}
