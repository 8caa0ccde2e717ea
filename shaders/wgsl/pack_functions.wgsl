// Pass: names the functions that engines call, so that they are exported; does nothing else.

#import welkin::pack::{
    ground_radiance, sky_irradiance, sky_radiance, sun_irradiance, transmittance_to_space, view_transmittance
}

@compute @workgroup_size(1)
fn main() {
    _ = transmittance_to_space(0.0, 1.0);
    _ = view_transmittance(0.0, 1.0);
    _ = sky_irradiance(0.0, 1.0);
    _ = sun_irradiance(0.0, 1.0);
    _ = sky_radiance(0.0, 1.0, 1.0, 1.0);
    _ = ground_radiance(0.0, 1.0, 1.0, 1.0);
}
