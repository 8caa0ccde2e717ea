#!/usr/bin/env python3
"""Processor time of a frame of sky: welkin beside Bevy's atmosphere, on the same driver, in turn.

    cargo build --release
    benches/bevy/compare.py target/release/welkin BEVY_SKY [--rounds N] > OUT.md

BEVY_SKY is a program that renders Bevy's atmosphere without a window: it takes width, height and `default`, `paper` (the
sizes of Hillaire 2020) or `none` (an empty frame), `--frames N` and `--secs S`, and prints `process CPU time X ms/frame`.
Bevy computes all its tables in every frame. Its times are net of its empty frame, which holds what an engine does besides;
welkin's are whole. VK_DRIVER_FILES chooses the driver for both.

Every round runs every program once, one after the other; ratios are taken within a round, and what is printed are medians
over the rounds. Times are those of all threads of the process, so that others who use the machine disturb little.
"""

import argparse
import json
import re
import statistics
import subprocess
from pathlib import Path

SCENE = Path(__file__).parent / "sky.toml"
SIZES = ["1280x720", "640x360"]
# What is measured of welkin, by settings and motion, and how much of Bevy's time it may take.
CASES = [("bevy-sizes", "anew", 0.5), ("medium", "sun", 0.25), ("medium", "turn", None), ("medium", "still", 0.1)]


def bevy_ms(program, size, preset, seconds):
    width, height = size.split("x")
    command = [program, width, height, preset, "--frames", "100", "--secs", str(seconds)]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return float(re.search(r"process CPU time ([0-9.]+) ms/frame", text).group(1))


def welkin_ms(program, size, quality, motion):
    command = [program, "bench", str(SCENE), "--size", size, "--quality", quality, "--motion", motion]
    text = subprocess.run([*command, "--rounds", "3", "--json"], capture_output=True, text=True, check=True).stdout
    measured = json.loads(text)
    return statistics.median(measured["frames"][0]["processor_ms"]["values"]), measured["driver"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("welkin")
    parser.add_argument("bevy_sky")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4)
    arguments = parser.parse_args()
    print("| size | welkin | processor ms a frame | Bevy's ms, net of an empty frame | ratio | asked for |")
    print("|---|---|---|---|---|---|")
    driver = ""
    for size in SIZES:
        ours, bevy, ratios = {case: [] for case in CASES}, [], {case: [] for case in CASES}
        for _ in range(arguments.rounds):
            empty = bevy_ms(arguments.bevy_sky, size, "none", arguments.seconds)
            net = bevy_ms(arguments.bevy_sky, size, "default", arguments.seconds) - empty
            bevy.append(net)
            for case in CASES:
                milliseconds, driver = welkin_ms(arguments.welkin, size, case[0], case[1])
                ours[case].append(milliseconds)
                ratios[case].append(milliseconds / net)
        for quality, motion, bound in CASES:
            case = (quality, motion, bound)
            ratio, spread = statistics.median(ratios[case]), (min(ratios[case]), max(ratios[case]))
            asked = f"≤ {bound}" if bound else "–"
            print(
                f"| {size} | {quality}, {motion} | {statistics.median(ours[case]):.1f} | {statistics.median(bevy):.1f} "
                f"| {ratio:.2f} ({spread[0]:.2f}–{spread[1]:.2f}) | {asked} |",
                flush=True,
            )
    print(f"\n{driver}, {arguments.rounds} rounds.")


if __name__ == "__main__":
    main()
