//! Phase functions as one word on the command line: `henyey-greenstein:0.85`.

use welkin_lut::PhaseFunction;

/// What the word may be, for messages.
const ALLOWED: &str = "isotropic, rayleigh, henyey-greenstein:G, double-henyey-greenstein:WEIGHT,G1,G2, schlick:K, \
                       cornette-shanks:G, draine:G,ALPHA or henyey-greenstein-draine:DIAMETER_UM";

/// Reads a name and its parameters, and checks their domains.
pub fn parse(text: &str) -> Result<PhaseFunction, String> {
    let (name, list) = text.split_once(':').unwrap_or((text, ""));
    let numbers: Vec<f64> = list
        .split(',')
        .filter(|part| !part.is_empty())
        .map(|part| part.trim().parse().map_err(|_| format!("'{part}' is not a number")))
        .collect::<Result<_, _>>()?;
    let phase = match (name, numbers.as_slice()) {
        ("isotropic", []) => PhaseFunction::Isotropic,
        ("rayleigh", []) => PhaseFunction::Rayleigh,
        ("henyey-greenstein", &[g]) => PhaseFunction::HenyeyGreenstein { g },
        ("double-henyey-greenstein", &[weight, g1, g2]) => PhaseFunction::DoubleHenyeyGreenstein { weight, g1, g2 },
        ("schlick", &[k]) => PhaseFunction::Schlick { k },
        ("cornette-shanks", &[g]) => PhaseFunction::CornetteShanks { g },
        ("draine", &[g, alpha]) => PhaseFunction::Draine { g, alpha },
        ("henyey-greenstein-draine", &[droplet_diameter_um]) => {
            PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um }
        }
        _ => return Err(format!("it must be {ALLOWED}")),
    };
    phase.validate().map_err(|e| e.to_string())?;
    Ok(phase)
}
