#!/usr/bin/env python3
"""Does a second worker count, and do too many harm?

For each scene, in turns: one process with two workers, two processes with one worker each side by
side, one process with eight workers. Throughput is frames per second; of two processes that of
both. Two workers should reach 95 % of two processes, which share the memory system just as well;
eight workers on two cores should take no more than 5 % longer than two.
"""

import argparse
import json
import pathlib
import subprocess
import sys
from statistics import fmean

from samples import median, spread

ROOT = pathlib.Path(__file__).resolve().parent.parent


def command(options, scene, threads):
    frames = [str(options.program), "burnish", scene, "--wait", "--threads", str(threads),
              "--width", str(options.size[0]), "--height", str(options.size[1]),
              "--seconds", str(options.seconds)]
    return ["chrt", "-f", str(options.priority)] + frames if options.priority > 0 else frames


def frame_times(commands):
    """Runs all side by side, from the same moment; the mean frame of each, ms: what it reaches in
    the end, whatever stops one of the cores now and then."""
    running = [subprocess.Popen(c, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
               for c in commands]
    for process in running:
        process.stdout.readline()  # the renderer's name, once it is warm
    for process in running:
        process.stdin.write("\n")
        process.stdin.flush()
    times = []
    for process in running:
        output, _ = process.communicate()
        if process.returncode != 0:
            sys.exit(f"threads: failed: {' '.join(process.args)}")
        times.append(fmean(float(line[3:]) for line in output.splitlines() if line.startswith("ms ")))
    return times


def measure(options, scene):
    rounds = []
    for _ in range(options.rounds):
        one = frame_times([command(options, scene, 1)])[0]
        two = frame_times([command(options, scene, 2)])[0]
        apart = frame_times([command(options, scene, 1)] * 2)
        many = frame_times([command(options, scene, options.many)])[0]
        rounds.append({"one": one, "two": two, "apart": apart, "many": many,
                       "share": 1 / two / sum(1 / t for t in apart), "slower": many / two})
    return rounds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "build/release/bin/peer_frames")
    parser.add_argument("--scenes", default="S1c,S1a,S4c,S6", type=lambda text: text.split(","))
    parser.add_argument("--size", default="1920x1080",
                        type=lambda text: [int(side) for side in text.split("x")])
    parser.add_argument("--rounds", default=5, type=int)
    parser.add_argument("--seconds", default=0.5, type=float, help="of frames in every process")
    parser.add_argument("--many", default=8, type=int, help="workers, instead of eight")
    parser.add_argument("--priority", default=5, type=int, help="real-time; 0: ordinary")
    parser.add_argument("-o", "--output", help="JSON of all rounds")
    options = parser.parse_args()
    print(f"| scene | 1 worker, ms | 2 workers, ms | 2 processes, ms | 2 workers reach | {options.many}"
          " workers take |\n|---|---|---|---|---|---|")
    results, good = {}, True
    for scene in options.scenes:
        rounds = results[scene] = measure(options, scene)

        def cell(key, unit):
            values = [r[key] for r in rounds]
            return f"{unit(median(values))} (± {100 * spread(values):.1f} %)"

        print(f"| {scene} | {cell('one', '{:.2f}'.format)} | {cell('two', '{:.2f}'.format)} "
              f"| {median([max(r['apart']) for r in rounds]):.2f} | {cell('share', '{:.1%}'.format)} "
              f"| {cell('slower', '{:.3f} x'.format)} |", flush=True)
        good &= median([r["share"] for r in rounds]) >= 0.95
        good &= median([r["slower"] for r in rounds]) <= 1.05
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps(results, indent=1) + "\n")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
