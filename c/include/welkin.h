/* Sky tables for engines: bake those of a scene, verify a pack, read and sample it.
 *
 * Units: lengths in m, angles only as cosines, light linear at three wavelengths and for unit irradiance of the sun above
 * the air: multiply by your sun's. docs/tables.md says what packs hold.
 *
 * Errors: every function that can fail returns a welkin_status, and welkin_last_error() says what, where and what to do.
 * Nothing is written to what an argument points to unless WELKIN_OK is returned. No function ends the process.
 *
 * Threads: all functions may be called from any thread. A pack may be read by several at once, and closed by one when no
 * other uses it.
 */
#ifndef WELKIN_H
#define WELKIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Changes when a caller must be compiled anew; compare it with welkin_abi_version(). */
#define WELKIN_ABI_VERSION 1u

typedef uint32_t welkin_status;
#define WELKIN_OK 0u
/* A pointer is null, a text is not UTF-8, or a number is none of those allowed. */
#define WELKIN_INVALID_ARGUMENT 1u
/* The scene cannot be read, or has no tables. */
#define WELKIN_SCENE 2u
/* A file or folder cannot be read or written. */
#define WELKIN_FILE 3u
/* There is no pack, or one of another version. */
#define WELKIN_NO_PACK 4u
/* The pack is not as it was written. */
#define WELKIN_BROKEN_PACK 5u
/* A fault of this library: please report it. */
#define WELKIN_FAULT 6u

typedef uint32_t welkin_quality;
#define WELKIN_LOW 0u
#define WELKIN_MEDIUM 1u
#define WELKIN_HIGH 2u
#define WELKIN_ULTRA 3u

/* Containers of tables, to be joined by |. */
#define WELKIN_EXR 1u
#define WELKIN_KTX2 2u
#define WELKIN_DDS 4u
#define WELKIN_RAW 8u

/* Numbers of tables, to be joined by |. */
#define WELKIN_F16 1u
#define WELKIN_F32 2u

typedef uint32_t welkin_table;
#define WELKIN_TRANSMITTANCE 0u
#define WELKIN_IRRADIANCE 1u
#define WELKIN_MULTIPLE_SCATTERING 2u
#define WELKIN_SCATTERING 3u

/* Called while tables are baked, from any of several threads: what is computed, and the share of all work done, 0 to 1. */
typedef void (*welkin_progress)(void *user, const char *stage, double done);

typedef struct welkin_bake_options {
    welkin_quality quality;
    uint32_t containers;
    uint32_t precisions;
    /* May be null. */
    welkin_progress progress;
    void *user;
} welkin_bake_options;

/* What a verification has looked at. */
typedef struct welkin_verified {
    uint64_t files;
    uint64_t table_files;
    uint64_t probes;
} welkin_verified;

/* A pack in memory. */
typedef struct welkin_pack welkin_pack;

/* A table's texels, as they are stored: columns, rows, slices, x fastest; row 0 is y = 0, slice 0 is z = 0. Red, green, blue
 * and 1. They live as long as the pack. */
typedef struct welkin_texels {
    const float *rgba;
    uint32_t width;
    uint32_t height;
    uint32_t depth;
} welkin_texels;

/* A question: the observer's altitude above the ground, and the cosines of view and up, sun and up, view and sun. */
typedef struct welkin_ray {
    double altitude_m;
    double mu;
    double mu_s;
    double nu;
} welkin_ray;

/* The answers, at the three wavelengths. */
typedef struct welkin_sky {
    /* From the observer towards the sun; 0 where the planet is in the way. */
    double transmittance_to_space[3];
    /* Of the view ray's air, to space or to the ground. */
    double view_transmittance[3];
    /* Of the sky on a horizontal plane that faces up. */
    double sky_irradiance[3];
    /* Of the sun itself on that plane. */
    double sun_irradiance[3];
    /* Of the air along the view ray, 1/sr: without the sun's disc and the ground. */
    double sky_radiance[3];
    /* Of the ground through the air before it, 1/sr. */
    double ground_radiance[3];
} welkin_sky;

/* WELKIN_ABI_VERSION of the library. */
uint32_t welkin_abi_version(void);

/* Why the last call of this thread that failed has done so, in UTF-8; empty before. It lives until the thread's next call. */
const char *welkin_last_error(void);

/* Medium quality, KTX2, half floats, no progress. */
welkin_bake_options welkin_default_bake_options(void);

/* Bakes the tables of a scene file's air on the CPU, on all cores, and writes a pack: whole or not at all. An older pack in
 * the folder is replaced. Without options, those of welkin_default_bake_options(). */
welkin_status welkin_bake(const char *scene_path, const char *pack_path, const welkin_bake_options *options);

/* Checks a pack: hashes, all containers against each other, and the probes. verified may be null. */
welkin_status welkin_verify(const char *pack_path, welkin_verified *verified);

/* Reads a pack with the tables of one precision, WELKIN_F16 or WELKIN_F32, of any of its containers. Hashes are checked. */
welkin_status welkin_pack_open(const char *pack_path, uint32_t precision, welkin_pack **pack);

/* Ends the life of a pack and of all that it has given; null is allowed. */
void welkin_pack_close(welkin_pack *pack);

/* The pack's manifest.json (schemas/pack.schema.json). It lives as long as the pack. */
welkin_status welkin_pack_manifest(const welkin_pack *pack, const char **json);

/* A table. */
welkin_status welkin_pack_table(const welkin_pack *pack, welkin_table table, welkin_texels *texels);

/* The uniform block `sky` of the shaders, std140. It lives as long as the pack. */
welkin_status welkin_pack_sky_parameters(const welkin_pack *pack, const uint8_t **block, size_t *bytes);

/* Samples the tables as the shaders do, in double precision: the measure for your own sampler. */
welkin_status welkin_pack_sample(const welkin_pack *pack, const welkin_ray *ray, welkin_sky *sky);

#ifdef __cplusplus
}
#endif

#endif
