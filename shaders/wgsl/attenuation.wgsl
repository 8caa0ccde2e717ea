#define_import_path welkin::attenuation
// What an optical depth takes, without cancellation where it is small.

// 1 - exp(-tau).
fn opacity(tau: vec3<f32>) -> vec3<f32> {
    let thin = tau * (1.0 - tau * (0.5 - tau * (1.0 / 6.0 - tau * (1.0 / 24.0 - tau / 120.0))));
    return select(1.0 - exp(-tau), thin, tau < vec3<f32>(0.2));
}

// (1 - exp(-tau)) / tau, the mean of exp(-t) over t from 0 to tau.
fn mean_transmittance(tau: vec3<f32>) -> vec3<f32> {
    let is_thin = tau < vec3<f32>(1e-2);
    let thin = 1.0 - tau * (0.5 - tau / 6.0);
    return select((1.0 - exp(-tau)) / select(tau, vec3<f32>(1.0), is_thin), thin, is_thin);
}

// Mean of exp(-t) over t from one depth to another, neither of them negative.
fn mean_between(first: vec3<f32>, last: vec3<f32>) -> vec3<f32> {
    return exp(-min(first, last)) * mean_transmittance(abs(last - first));
}

// The share of an even slice's opacity that lies before a share of its length.
fn share_of_opacity(tau: vec3<f32>, length_share: f32) -> vec3<f32> {
    let is_clear = tau < vec3<f32>(1e-4);
    return select(opacity(length_share * tau) / opacity(select(tau, vec3<f32>(1.0), is_clear)), vec3<f32>(length_share), is_clear);
}
