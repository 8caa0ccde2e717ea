#define_import_path welkin::cloud_matter
// What each layer of clouds is made of.

struct CloudMatter {
    // b / c.
    albedo: vec3<f32>,
    // 1 - mean cosine of the phase function.
    backward: f32,
    // 1 - f, f the second Legendre moment: the share of extinction that turns light away from its line.
    similarity: f32,
    padding_a: f32,
    padding_b: f32,
    padding_c: f32,
}

@group(1) @binding(8) var<storage, read> cloud_matter: array<CloudMatter>;

// Share of the extinction that is the similar medium's: 1 - W f.
fn similar_share(matter: CloudMatter) -> f32 {
    let albedo = dot(matter.albedo, vec3<f32>(1.0 / 3.0));
    return 1.0 - albedo * (1.0 - matter.similarity);
}
