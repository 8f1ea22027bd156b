#!/usr/bin/env python3
"""Frames per second of `burnish view` while a hand orbits, on a virtual X server.

usage: bench/view.py [BURNISH] [--input SCENE] [--seconds S] [--runs N] [--threads N] [--size WxH]

Needs Xvfb and xdotool. The viewer itself counts, from one picture on the screen to the next, blit
included; a hand moves the mouse 100 times a second. Prints each run, then the medians of all.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time


def display():
    """A server on a free display, and its name."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x1000x24", "-nolisten", "tcp"],
        pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as name:
        return server, ":" + name.readline().strip()


def orbit(environment, seconds):
    """Left drags to and fro across the window, as xdotool's own script."""
    def tool(*words):
        subprocess.run(["xdotool", *words], env=environment, check=True)

    for _ in range(200):
        found = subprocess.run(["xdotool", "search", "--name", "burnish"], env=environment,
                               capture_output=True, text=True).stdout.split()
        if found:
            break
        time.sleep(0.05)
    time.sleep(1.0)
    tool("mousemove", "--window", found[0], "700", "400")
    steps = []
    for i in range(int(100 * seconds)):
        right = 3 if (i // 100) % 2 == 0 else -3
        steps += ["mousemove_relative", "--", str(right), str((i // 50) % 2), "sleep", "0.01"]
    tool("mousedown", "1")
    for first in range(0, len(steps), 6 * 500):
        tool(*steps[first:first + 6 * 500])
    tool("mouseup", "1")
    time.sleep(0.5)
    tool("key", "Escape")


def run(arguments, environment):
    command = [arguments.burnish, "view", arguments.input, "--threads", str(arguments.threads),
               "--size", arguments.size, "-v"]
    with tempfile.TemporaryDirectory() as directory:
        viewer = subprocess.Popen(command, env=environment, cwd=directory, text=True,
                                  stdout=subprocess.PIPE)
        orbit(environment, arguments.seconds)
        output, _ = viewer.communicate(timeout=120)
    return json.loads(output.strip().split("\n")[-1])


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("burnish", nargs="?", default=root + "/build/release/bin/burnish")
    parser.add_argument("--input", default=root + "/meshes/brushed.toml")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--size", default="1280x720")
    arguments = parser.parse_args()
    arguments.burnish = os.path.abspath(arguments.burnish)
    arguments.input = os.path.abspath(arguments.input)
    server, name = display()
    environment = dict(os.environ, DISPLAY=name, SDL_VIDEODRIVER="x11")
    runs = []
    try:
        for number in range(arguments.runs):
            counted = run(arguments, environment)
            divisors = sorted(frame["divisor"] for frame in counted["last"])
            counted["divisor"] = divisors[len(divisors) // 2]
            runs.append(counted)
            print(f"run {number + 1}: {counted['frames']} frames, {counted['per_second']:.1f} a second, "
                  f"median {counted['median_ms']:.2f} ms, 99.5 % {counted['p99_5_ms']:.2f} ms, "
                  f"longest {counted['max_ms']:.1f} ms, sides divided by {counted['divisor']} "
                  f"(median of the last {len(divisors)})", flush=True)
    finally:
        server.terminate()
    print(f"median of {len(runs)}: {statistics.median(r['per_second'] for r in runs):.1f} frames a "
          f"second, 99.5 % {statistics.median(r['p99_5_ms'] for r in runs):.2f} ms")


if __name__ == "__main__":
    main()
