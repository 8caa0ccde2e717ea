#!/usr/bin/env python3
"""From nothing to the first picture, and the most memory held: welkin beside Bevy's atmosphere, as whole processes.

    cargo build --release
    benches/bevy/starts.py target/release/welkin BEVY_SKY [--rounds N] > OUT.md

Each program starts with empty folders for what drivers and programs compile (cold), and then again with what it has left
there (warm). welkin's time is that of the whole process: scene file, device, pipelines, tables, and a picture that is written
to a file. Bevy's is what the program prints: from its first line until half of the picture is lit; it says `first sky T ms`.
Memory is the largest resident set of the process, as the system counts it. VK_DRIVER_FILES chooses the driver for both.
"""

import argparse
import os
import re
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

SCENE = Path(__file__).parent / "sky.toml"


def run(command, caches):
    """What a process prints; ms until it has ended; MiB of its largest resident set."""
    places = {"WELKIN_CACHE": caches / "welkin", "MESA_SHADER_CACHE_DIR": caches / "mesa"}
    environment = os.environ | {name: str(place) for name, place in places.items()}
    begun = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{command[0]} failed")
    passed = 1e3 * (time.monotonic() - begun)
    return text, passed, usage.ru_maxrss / 1024


def welkin(program, caches):
    with tempfile.TemporaryDirectory() as folder:
        _, *costs = run([program, "render", SCENE, "-o", Path(folder) / "sky.png"], caches)
    return costs


def bevy(program, caches):
    # As few frames after the first as the program allows.
    text, _, memory = run([program, "1280", "720", "default", "--frames", "1", "--secs", "0"], caches)
    return [float(re.search(r"first sky ([0-9.]+) ms", text).group(1)), memory]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("welkin")
    parser.add_argument("bevy_sky")
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    programs = {"welkin, medium": (welkin, arguments.welkin), "Bevy": (bevy, arguments.bevy_sky)}
    costs = {(name, start): [] for start in ["cold", "warm"] for name in programs}
    for _ in range(arguments.rounds):
        for name, (measure, program) in programs.items():
            with tempfile.TemporaryDirectory() as caches:
                for start in ["cold", "warm"]:
                    costs[name, start].append(measure(program, Path(caches)))
    print("| program | start | ms to the first picture | peak memory, MiB |")
    print("|---|---|---|---|")
    for (name, start), rows in costs.items():
        passed, memory = (statistics.median(column) for column in zip(*rows))
        print(f"| {name} | {start} | {passed:.0f} | {memory:.0f} |")
    for start in ["cold", "warm"]:
        pairs = list(zip(costs["welkin, medium", start], costs["Bevy", start]))
        time_ratio, memory_ratio = (statistics.median(a[i] / b[i] for a, b in pairs) for i in [0, 1])
        print(f"\n{start}: {time_ratio:.2f} of Bevy's time, {memory_ratio:.2f} of its memory.")


if __name__ == "__main__":
    main()
