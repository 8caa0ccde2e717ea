//! Fog, local volumes and lamps that are degenerate. All but the last have the same shaders.

use super::{Bound, Case};

const APPROXIMATE: &str = "docs/fog.md has what light that matter scatters is off by";
const SHADE: &str = "volumes do not shade the clear air (docs/fog.md)";
const ENDLESS: &str = "the path tracer's walks do not end in matter that takes nothing away";

/// A bank of fog, a ball of smoke and a lamp: numbers that the cases change.
struct Media {
    fog_per_m: f64,
    fog_albedo: f64,
    fog_g: f64,
    fog_top_m: f64,
    centre_m: [f64; 3],
    size_m: f64,
    scattering_per_m: f64,
    absorption_per_m: f64,
    emission_per_m: f64,
    volume_g: f64,
    lamp_m: [f64; 3],
    /// W/(sr nm).
    lamp: f64,
}

/// In the middle of the picture, in front of the sky.
const USUAL: Media = Media {
    fog_per_m: 1e-3,
    fog_albedo: 0.9,
    fog_g: 0.5,
    fog_top_m: 60.0,
    centre_m: [30.0, -52.0, 15.0],
    size_m: 20.0,
    scattering_per_m: 0.05,
    absorption_per_m: 0.05,
    emission_per_m: 0.0,
    volume_g: 0.5,
    lamp_m: [15.0, -26.0, 10.0],
    lamp: 0.1,
};

/// The same without anything that scatters light in the fog, the volume or the lamp: what is left has closed forms.
const BLACK: Media = Media { fog_albedo: 0.0, scattering_per_m: 0.0, lamp: 1e-12, ..USUAL };

impl Media {
    fn edit(&self) -> String {
        format!(
            "[[fog]]\nextinction_per_m = {:e}\nalbedo = {:e}\nphase.henyey_greenstein.g = {}\n\
             profile.layer = {{ top_m = {:e} }}\n\
             [[volumes]]\nname = \"ball\"\nshape = \"ellipsoid\"\ncentre_m = {:?}\nsize_m = {:?}\n\
             scattering_per_m = {:e}\nabsorption_per_m = {:e}\nemission_per_m = {:e}\nphase.henyey_greenstein.g = {}\n\
             [[light.point]]\nname = \"lamp\"\nposition_m = {:?}\nintensity = {:e}\n",
            self.fog_per_m,
            self.fog_albedo,
            self.fog_g,
            self.fog_top_m,
            self.centre_m,
            [self.size_m; 3],
            self.scattering_per_m,
            self.absorption_per_m,
            self.emission_per_m,
            self.volume_g,
            self.lamp_m,
            self.lamp,
        )
    }
}

pub fn cases() -> Vec<Case> {
    let exact = |name: &str, media: Media| Case::new(name, media.edit());
    let laws = |name: &str, media: Media| exact(name, media).bound(Bound::LawsOnly(APPROXIMATE));
    let endless = |name: &str, media: Media| exact(name, media).bound(Bound::LawsOnly(ENDLESS));
    let camera_m = [0.0, 0.0, 2.0];
    vec![
        exact("fog that only absorbs", BLACK).quick(),
        exact(
            "fog of 1e-9 /m, a ball of 1e-9 /m",
            Media { fog_per_m: 1e-9, scattering_per_m: 5e-10, absorption_per_m: 5e-10, lamp: 1e-12, ..USUAL },
        ),
        exact("fog of 1e6 /m around the camera, black", Media { fog_per_m: 1e6, ..BLACK }),
        endless("fog of 1e6 /m around the camera, white", Media { fog_per_m: 1e6, fog_albedo: 1.0, ..USUAL }),
        exact("fog 1 mm high", Media { fog_top_m: 1e-3, ..BLACK }),
        exact("fog up to the camera", Media { fog_top_m: 2.0, fog_per_m: 0.1, ..BLACK }),
        laws("fog of albedo 1", Media { fog_albedo: 1.0, ..USUAL }),
        laws("fog, g = 0.9999", Media { fog_g: 0.9999, ..USUAL }),
        laws("fog, g = -0.9999", Media { fog_g: -0.9999, ..USUAL }).quick(),
        exact("a ball of 1 mm", Media { size_m: 1e-3, ..BLACK }),
        exact("a ball of 10 000 km around the camera", Media { size_m: 1e7, absorption_per_m: 1e-6, ..BLACK })
            .bound(Bound::LawsOnly(SHADE)),
        exact("a ball of 1e6 /m", Media { absorption_per_m: 1e6, ..BLACK }),
        laws("a white ball of 1e6 /m", Media { scattering_per_m: 1e6, absorption_per_m: 0.0, ..USUAL }),
        exact("the camera on a ball's surface", Media { centre_m: [5.0, -8.660254, 2.0], ..BLACK }),
        exact("the camera in a ball", Media { centre_m: camera_m, ..BLACK }),
        laws("a ball, g = 0.9999", Media { volume_g: 0.9999, ..USUAL }),
        laws("a ball, g = -0.9999", Media { volume_g: -0.9999, ..USUAL }),
        exact("a ball that glows", Media { emission_per_m: 1e-3, fog_per_m: 1e-9, ..BLACK }),
        exact(
            "a ball of 1e6 /m that glows with 1e6 /m",
            Media { emission_per_m: 1e6, absorption_per_m: 1e6, fog_per_m: 1e-9, ..BLACK },
        ),
        laws("a lamp at the camera", Media { lamp_m: camera_m, ..USUAL }),
        laws(
            "a lamp in opaque matter",
            Media { lamp_m: USUAL.centre_m, scattering_per_m: 9e5, absorption_per_m: 1e5, ..USUAL },
        ),
        laws("a lamp on the ground", Media { lamp_m: [15.0, -26.0, 0.0], ..USUAL }),
        laws("a lamp below the ground", Media { lamp_m: [15.0, -26.0, -10.0], ..USUAL }),
        laws("a lamp of 1e12 W/(sr nm)", Media { lamp: 1e12, ..USUAL }),
        Case {
            edit: USUAL.edit() + "[camera]\nwidth = 8192\nheight = 1\nvertical_field_of_view_deg = 0.01\n",
            ..laws("8192 x 1 pixels of fog", USUAL)
        },
        one_voxel(),
    ]
}

/// A grid of one sample, which is 1.
fn one_voxel() -> Case {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hard_cases/one-voxel.npy");
    let volume = format!(
        "[[volumes]]\nname = \"box\"\nshape = \"box\"\ncentre_m = {:?}\nsize_m = [20, 20, 20]\nabsorption_per_m = 0.05\n\
         grid.file = {file:?}\n",
        USUAL.centre_m
    );
    Case::new("a box of one voxel", volume)
}
