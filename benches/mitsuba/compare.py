#!/usr/bin/env python3
"""Time to a given standard error: welkin's reference against Mitsuba 3, on the same cores in one run.

    python3 -m venv VENV && VENV/bin/pip install mitsuba numpy
    cargo build --release --example reference_speed
    DRJIT_LIBLLVM_PATH=... VENV/bin/python benches/mitsuba/compare.py target/release/examples/reference_speed OUT.md

Each round runs every program once, one after the other, with a seed of its own; times are medians over the rounds and
standard errors come from the spread between seeds (pictures) or between the pixels and batches of each run (fluxes).
The time to a standard error s is t (sigma/s)^2. The kernels of the LLVM variant are compiled in a first run that is not
counted. CPU seconds are those of all cores together; on a machine that does other work they are the steadier number.
"""

import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

ROUNDS = 25
SIZE = 64
WIDTH = 48
# Pixels along the plate that measures the slab's flux: the scalar variant gives every core a block of them.
PLATE = 64
LIGHT = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
# tau, albedo, g, mu0
SLABS = [(1.0, 0.9, 0.0, 0.5), (1.0, 1.0, 0.85, 0.5), (8.0, 0.999, 0.85, 0.5)]
# sigma_t in 1/m of a cube of side 2 m, albedo, g
GRIDS = [(5.0, 0.9, 0.0), (20.0, 0.999, 0.85)]
VARIANTS = ["scalar_rgb", "llvm_ad_mono"]


def cloud():
    """Densities in [0, 1] on a cube: three octaves of smooth noise, cut off below and towards the edges."""
    random = np.random.default_rng(1)
    axis = (np.arange(SIZE) + 0.5) / SIZE
    total = np.zeros((SIZE, SIZE, SIZE))
    for octave in range(3):
        n = 4 << octave
        coarse = random.random((n, n, n)) / (1 << octave)
        for dimension in range(3):
            at = axis * (n - 1)
            low = np.minimum(at.astype(int), n - 2)
            share = (at - low).reshape([-1 if i == dimension else 1 for i in range(3)])
            coarse = np.take(coarse, low, dimension) * (1 - share) + np.take(coarse, low + 1, dimension) * share
        total += coarse
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    radius = np.sqrt((x - 0.5) ** 2 + (y - 0.5) ** 2 + (z - 0.5) ** 2)
    density = np.clip(2.5 * (total / total.max() - 0.45), 0, None) * np.clip(4 * (0.48 - radius), 0, 1)
    return (density / density.max()).astype(np.float32)


def slab_scene(tau, albedo, g, mu0):
    """The upward flux above a slab that is 2000 times as wide as thick, as in the reference tables of the project."""
    transform = mi.ScalarTransform4f
    return {
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": -1, "rr_depth": 100000},
        "light": {"type": "directional", "direction": [np.sqrt(1 - mu0**2), 0, -mu0], "irradiance": spectrum(1.0)},
        "slab": {
            "type": "cube",
            "to_world": transform().scale([2000, 2000, 0.5]),
            "bsdf": {"type": "null"},
            "interior": {
                "type": "homogeneous",
                "albedo": float(albedo),
                "sigma_t": float(tau),
                "phase": {"type": "hg", "g": g},
            },
        },
        "plate": {
            "type": "rectangle",
            # So far above that its own shadow is negligible: at a distance of its own width it takes 0.5 % away.
            "to_world": transform().translate([0, 0, 1.5]).rotate([1, 0, 0], 180).scale(0.001),
            "bsdf": {"type": "null"},
            "sensor": {
                "type": "irradiancemeter",
                "sampler": {"type": "independent"},
                "film": {"type": "hdrfilm", "width": PLATE, "height": PLATE, "rfilter": {"type": "box"}, "pixel_format": "luminance"},
            },
        },
    }


def spectrum(value):
    """The same number in every band."""
    return {"type": "rgb", "value": [value] * 3} if "rgb" in mi.variant() else {"type": "uniform", "value": value}


def grid_scene(density, sigma_t, albedo, g):
    """The cube that `reference_speed grid` describes."""
    transform = mi.ScalarTransform4f
    # Mitsuba stores z, y, x, channel, from the lower corner on.
    volume = mi.VolumeGrid(np.ascontiguousarray(density.transpose(2, 1, 0))[..., None])
    camera = transform().look_at(origin=[0, -2, 0], target=[0, 0, 0], up=[0, 0, 1])
    return {
        "type": "scene",
        "integrator": {"type": "volpath", "max_depth": -1, "rr_depth": 100000},
        "light": {"type": "directional", "direction": list(-LIGHT), "irradiance": spectrum(1.0)},
        "cube": {
            "type": "cube",
            "bsdf": {"type": "null"},
            "interior": {
                "type": "heterogeneous",
                "albedo": float(albedo),
                "scale": sigma_t,
                "sigma_t": {
                    "type": "gridvolume",
                    "grid": volume,
                    "raw": True,
                    "to_world": transform().translate([-1, -1, -1]).scale(2),
                },
                "phase": {"type": "hg", "g": g},
            },
        },
        "sensor": {
            "type": "orthographic",
            "to_world": camera,
            "sampler": {"type": "independent"},
            "film": {"type": "hdrfilm", "width": WIDTH, "height": WIDTH, "rfilter": {"type": "box"}, "pixel_format": "luminance"},
        },
    }


def flux(pixels):
    """Mean over the plate, whose pixels all measure the same, and its standard error."""
    return np.array([pixels.mean()]), pixels.std(ddof=1) / np.sqrt(pixels.size)


class Mitsuba:
    """One variant on one scene."""

    def __init__(self, variant, scene, samples, result=lambda pixels: (pixels, None)):
        self.variant, self.samples, self.result = variant, samples, result
        mi.set_variant(variant)
        self.scene = mi.load_dict(scene())
        self.run(12345)

    def run(self, seed):
        """(seconds, cpu seconds, pixels, standard error if known) of one picture; seeds are spread widely, adjacent ones look correlated."""
        mi.set_variant(self.variant)
        cpu, wall = time.process_time(), time.perf_counter()
        # Reading the pixels waits for the kernel.
        pixels = np.array(mi.render(self.scene, spp=self.samples, seed=(1000003 * seed + 77) % (1 << 31))).ravel()
        return time.perf_counter() - wall, time.process_time() - cpu, *self.result(pixels)


class Welkin:
    """The reference on one problem."""

    def __init__(self, program, arguments, samples, key):
        self.program, self.arguments, self.samples, self.key = program, arguments, samples, key
        self.run(12345)

    def run(self, seed):
        """As above; the program's own clock leaves out its start and the reading of the grid."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [self.program, *map(str, self.arguments), str(self.samples), str(seed)]
        result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return result["seconds"], cpu, np.atleast_1d(result[self.key]), result.get("standard_error")


def measure(runners, target):
    """Rounds of all runners; for each the median times to the target and the mean with its standard error."""
    records = {name: [] for name in runners}
    for seed in range(1, ROUNDS + 1):
        for name, runner in runners.items():
            records[name].append(runner.run(seed))
    rows = {}
    for name, runs in records.items():
        pixels = np.array([run[2] for run in runs])
        level = pixels.mean()
        known = [run[3] for run in runs if run[3] is not None]
        variance = np.mean(np.square(known)) if known else pixels.var(axis=0, ddof=1).mean()
        sigma = np.sqrt(variance) / level
        factor = (sigma / target) ** 2
        wall, cpu = (np.median([run[i] for run in runs]) for i in (0, 1))
        means = pixels.mean(axis=1)
        rows[name] = {
            "seconds": wall * factor,
            "cpu": cpu * factor,
            "run": wall,
            "sigma": sigma,
            "mean": level,
            "error": np.sqrt(variance / len(means)) if known else means.std(ddof=1) / np.sqrt(len(means)),
        }
    return rows


def table(title, target, rows):
    """One problem as Markdown; the means of all programs must agree."""
    reference = rows["welkin"]
    lines = [
        f"### {title}",
        f"Time to a relative standard error of {100 * target:g} %.",
        "",
        "| program | seconds | CPU seconds | welkin is faster by: seconds | CPU seconds | mean ± its standard error | one run: seconds, error |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, row in rows.items():
        distance = abs(row["mean"] - reference["mean"]) / np.hypot(row["error"], reference["error"] or 1e-300)
        if distance > 4:
            sys.exit(f"{title}: {name} gives {row['mean']:.6g}, welkin {reference['mean']:.6g}: {distance:.1f} standard errors")
        lines.append(
            f"| {name} | {row['seconds']:.3g} | {row['cpu']:.3g} | {row['seconds'] / reference['seconds']:.1f} | {row['cpu'] / reference['cpu']:.1f} "
            f"| {row['mean']:.6g} ± {row['error']:.1g} | {row['run']:.3g}, {100 * row['sigma']:.2g} % |"
        )
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: compare.py REFERENCE_SPEED OUT.md")
    program, output = sys.argv[1:]
    sections = []
    for problem in SLABS:
        tau, albedo, g, mu0 = problem
        runners = {"welkin": Welkin(program, ["slab", tau, albedo, g, mu0], 1 << 20, "reflectance")}
        for variant in VARIANTS:
            samples = (1 << (18 if variant == "scalar_rgb" else 20)) // PLATE**2
            runners[f"Mitsuba {variant}"] = Mitsuba(
                variant, lambda: slab_scene(*problem), samples, lambda pixels: flux(pixels / mu0)
            )
        title = f"Homogeneous slab: τ {tau:g}, albedo {albedo:g}, g {g:g}, μ₀ {mu0:g}, reflectance"
        sections.append(table(title, 1e-3, measure(runners, 1e-3)))
        print(sections[-1], file=sys.stderr)
    density = cloud()
    with tempfile.NamedTemporaryFile(suffix=".raw") as file:
        density.transpose(2, 1, 0).astype("<f4").tofile(file.name)
        for sigma_t, albedo, g in GRIDS:
            arguments = ["grid", file.name, SIZE, sigma_t, albedo, g, WIDTH]
            runners = {"welkin": Welkin(program, arguments, 64, "pixels")}
            for variant in VARIANTS:
                scene = lambda: grid_scene(density, sigma_t, albedo, g)
                runners[f"Mitsuba {variant}"] = Mitsuba(variant, scene, 16 if variant == "scalar_rgb" else 128)
            title = f"Grid of {SIZE}³ voxels: σ_t {sigma_t:g}/m in a cube of 2 m, albedo {albedo:g}, g {g:g}, {WIDTH}² pixels"
            sections.append(table(title, 1e-2, measure(runners, 1e-2)))
            print(sections[-1], file=sys.stderr)
    head = (
        "# Speed of the reference beside Mitsuba 3\n"
        "Made by `benches/mitsuba/compare.py`, whose head says how to run it.\n\n"
        f"Mitsuba {mi.__version__}, {os.cpu_count()} cores ({platform.processor() or platform.machine()}), {ROUNDS} rounds, "
        "programs in turn. What each does:\n\n"
        "- welkin, slab: `Slab::fluxes`, walks with the light whose exits are counted by expectation; the transmittance\n"
        "  comes with it. Grid: backward walks, local majorants, next events with ratio tracking; three bands, f64.\n"
        "- Mitsuba: `volpath` without a bound on depth, an irradiance meter above the slab or an orthographic camera;\n"
        "  one band (`llvm_ad_mono`) or three (`scalar_rgb`), f32.\n\n"
        "The slab's meter sees forward-peaked light only by chance, so its noise, not its speed, decides there; on the\n"
        "grid both programs walk backward from the camera, and the comparison is of like with like. The script fails\n"
        "where the means differ by more than 4 standard errors.\n\n"
    )
    with open(output + ".new", "w") as file:
        file.write(head + "\n".join(sections))
    os.replace(output + ".new", output)


main()
