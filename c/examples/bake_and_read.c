/* Bakes the tables of a scene, verifies the pack, reads it and asks for the sky; and shows that mistakes are errors.
 *
 *     cc -std=c11 -Wall -Wextra -Werror -pedantic -I c/include c/examples/bake_and_read.c -L target/release -lwelkin_c -lm
 *     LD_LIBRARY_PATH=target/release ./a.out scenes/noon.toml pack
 */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "welkin.h"

/* The library's side has the same sizes (c/tests/c_program.rs). */
_Static_assert(sizeof(welkin_status) == 4 && sizeof(welkin_quality) == 4 && sizeof(welkin_table) == 4, "numbers");
_Static_assert(sizeof(welkin_bake_options) == 12 + 4 + 2 * sizeof(void *) || sizeof(void *) != 8, "welkin_bake_options");
_Static_assert(sizeof(welkin_verified) == 24, "welkin_verified");
_Static_assert(sizeof(welkin_texels) == sizeof(void *) + 12 + 4 || sizeof(void *) != 8, "welkin_texels");
_Static_assert(sizeof(welkin_ray) == 32, "welkin_ray");
_Static_assert(sizeof(welkin_sky) == 144, "welkin_sky");

/* Several threads call it. */
static void count(void *user, const char *stage, double done) {
    if (stage[0] != '\0' && done >= 0.0 && done <= 1.0) {
        atomic_fetch_add((atomic_int *)user, 1);
    }
}

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, welkin_last_error());
    return 1;
}

/* A call that must fail so, and whose message must name what is wrong. */
static int refused(const char *what, welkin_status found, welkin_status expected, const char *word) {
    if (found == expected && strstr(welkin_last_error(), word) != NULL) {
        return 0;
    }
    fprintf(stderr, "%s: status %u in place of %u: %s\n", what, found, expected, welkin_last_error());
    return 1;
}

static int mistakes(const char *scene, const welkin_pack *pack) {
    welkin_bake_options options = welkin_default_bake_options();
    welkin_pack *none = NULL;
    welkin_sky sky;
    welkin_texels texels;
    const welkin_ray outside = {2.0, 1.5, 1.0, 1.0};
    int wrong = 0;
    wrong += refused("no path", welkin_bake(NULL, "pack", NULL), WELKIN_INVALID_ARGUMENT, "scene_path");
    wrong += refused("no such scene", welkin_bake("nowhere.toml", "pack", NULL), WELKIN_SCENE, "nowhere.toml");
    options.quality = 7;
    wrong += refused("quality", welkin_bake(scene, "pack", &options), WELKIN_INVALID_ARGUMENT, "7");
    options.quality = WELKIN_LOW;
    options.containers = 64;
    wrong += refused("container", welkin_bake(scene, "pack", &options), WELKIN_INVALID_ARGUMENT, "0x40");
    wrong += refused("no pack", welkin_pack_open("nowhere", WELKIN_F16, &none), WELKIN_NO_PACK, "nowhere");
    wrong += refused("not UTF-8", welkin_pack_open("\xff", WELKIN_F16, &none), WELKIN_INVALID_ARGUMENT, "UTF-8");
    wrong += refused("a cosine", welkin_pack_sample(pack, &outside, &sky), WELKIN_INVALID_ARGUMENT, "1.5");
    wrong += refused("a table", welkin_pack_table(pack, 9, &texels), WELKIN_INVALID_ARGUMENT, "9");
    wrong += refused("no answer", welkin_pack_sample(pack, &outside, NULL), WELKIN_INVALID_ARGUMENT, "ray");
    wrong += refused("no pack", welkin_pack_manifest(NULL, NULL), WELKIN_INVALID_ARGUMENT, "pack");
    return wrong + (none != NULL);
}

int main(int count_of_arguments, char **arguments) {
    if (count_of_arguments != 3) {
        fprintf(stderr, "usage: bake_and_read SCENE.toml PACK\n");
        return 2;
    }
    if (welkin_abi_version() != WELKIN_ABI_VERSION) {
        fprintf(stderr, "this program was compiled for another library\n");
        return 1;
    }
    const char *scene = arguments[1], *folder = arguments[2];

    atomic_int calls = 0;
    welkin_bake_options options = welkin_default_bake_options();
    options.quality = WELKIN_LOW;
    options.containers = WELKIN_KTX2 | WELKIN_RAW;
    options.precisions = WELKIN_F16;
    options.progress = count;
    options.user = &calls;
    if (welkin_bake(scene, folder, &options) != WELKIN_OK) {
        return failed("bake");
    }

    welkin_verified verified;
    if (welkin_verify(folder, &verified) != WELKIN_OK) {
        return failed("verify");
    }
    welkin_pack *pack = NULL;
    if (refused("the other precision", welkin_pack_open(folder, WELKIN_F32, &pack), WELKIN_INVALID_ARGUMENT, "f32")) {
        return 1;
    }
    if (welkin_pack_open(folder, WELKIN_F16, &pack) != WELKIN_OK) {
        return failed("open");
    }

    /* What an engine uploads: four floats a texel, and the shaders' uniform block. */
    const char *manifest = NULL;
    const uint8_t *block = NULL;
    size_t bytes = 0;
    welkin_texels transmittance, scattering;
    if (welkin_pack_manifest(pack, &manifest) || welkin_pack_sky_parameters(pack, &block, &bytes)
        || welkin_pack_table(pack, WELKIN_TRANSMITTANCE, &transmittance)
        || welkin_pack_table(pack, WELKIN_SCATTERING, &scattering)) {
        return failed("read");
    }
    /* The last texel of the first row looks straight up from the ground: there exp(-value) is the transmittance. */
    const float *texel = transmittance.rgba + 4 * (transmittance.width - 1);
    const welkin_ray up = {0.0, 1.0, 1.0, 1.0};
    welkin_sky sky;
    if (welkin_pack_sample(pack, &up, &sky) != WELKIN_OK) {
        return failed("sample");
    }
    for (int band = 0; band < 3; band++) {
        if (fabs(exp(-texel[band]) - sky.transmittance_to_space[band]) > 1e-6 || texel[3] != 1.0f) {
            fprintf(stderr, "the texel and the sample differ\n");
            return 1;
        }
    }
    /* Noon from the ground, 60 degrees from the sun: the sky is blue. */
    const welkin_ray noon = {2.0, 0.5, 1.0, 0.5};
    if (welkin_pack_sample(pack, &noon, &sky) != WELKIN_OK || sky.sky_radiance[2] < 2.0 * sky.sky_radiance[0]) {
        return failed("the sky at noon");
    }
    printf("%.17g %.17g %.17g\n", sky.sky_radiance[0], sky.sky_radiance[1], sky.sky_radiance[2]);
    printf("%u x %u x %u, %zu bytes of parameters, %llu files, %llu probes\n", scattering.width, scattering.height,
           scattering.depth, bytes, (unsigned long long)verified.files, (unsigned long long)verified.probes);

    int wrong = mistakes(scene, pack);
    if (strstr(manifest, "welkin-pack") == NULL || bytes % 16 != 0 || block == NULL || atomic_load(&calls) == 0) {
        fprintf(stderr, "the pack is not what it should be\n");
        wrong++;
    }
    welkin_pack_close(pack);
    welkin_pack_close(NULL);
    return wrong != 0;
}
