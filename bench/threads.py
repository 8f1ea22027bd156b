#!/usr/bin/env python3
"""Does a second worker count, and do too many harm?

For each scene four processes, one with two workers, two with one worker each, one with eight, stay
alive and take turns, the two with one worker side by side as well. Throughput is frames per second;
of two processes that of both. Two workers should reach 95 % of two processes, which share the
memory system just as well; eight workers on two cores should take no more than 5 % longer than two.
Of a turn the median counts, since the kernel stops whoever has real-time priority for 50 ms now and
then; of the rounds the median of what one round's turns are beside each other.
"""

import argparse
import json
import pathlib
import subprocess
import sys

from samples import median, spread

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Process:
    """A scene in the memory of a renderer with so many workers, that draws when it is asked to."""

    def __init__(self, options, scene, threads):
        command = [str(options.program), "burnish", scene, "--turns", "--threads", str(threads),
                   "--width", str(options.size[0]), "--height", str(options.size[1])]
        if options.priority > 0:
            command = ["chrt", "-f", str(options.priority)] + command
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True)
        # Once it is warm:
        self.renderer = self._line().split(maxsplit=1)[1].strip()
        self.cpu = self._line().split(maxsplit=1)[1].strip()

    def _line(self):
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"threads: failed: {' '.join(self.process.args)}")
        return line

    def begin(self, seconds):
        self.process.stdin.write(f"{seconds}\n")
        self.process.stdin.flush()

    def end(self):
        """The turn's median frame, ms."""
        lines = list(iter(self._line, "turn\n"))
        return median([float(line.removeprefix("ms ")) for line in lines])

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def turn(seconds, *processes):
    """All side by side, from the same moment."""
    for process in processes:
        process.begin(seconds)
    return [process.end() for process in processes]


def measure(options, scene):
    """The rounds, and what rendered them where."""
    one, other, two, many = processes = [Process(options, scene, threads)
                                         for threads in (1, 1, 2, options.many)]
    rounds = []
    for _ in range(options.rounds):
        [alone], [both], apart, [crowd] = (turn(options.seconds, one), turn(options.seconds, two),
                                           turn(options.seconds, one, other),
                                           turn(options.seconds, many))
        rounds.append({"one": alone, "two": both, "apart": apart, "many": crowd,
                       "share": 1 / both / sum(1 / t for t in apart), "slower": crowd / both})
    for process in processes:
        process.close()
    return rounds, f"{one.cpu}. {one.renderer}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "build/release/bin/peer_frames")
    parser.add_argument("--scenes", default="S1c,S1a,S4c,S6", type=lambda text: text.split(","))
    parser.add_argument("--size", default="1920x1080",
                        type=lambda text: [int(side) for side in text.split("x")])
    parser.add_argument("--rounds", default=25, type=int)
    parser.add_argument("--seconds", default=0.1, type=float, help="of a turn")
    parser.add_argument("--many", default=8, type=int, help="workers, instead of eight")
    parser.add_argument("--priority", default=5, type=int, help="real-time; 0: ordinary")
    parser.add_argument("-o", "--output", help="JSON of all rounds")
    options = parser.parse_args()
    results, good = {}, True
    for scene in options.scenes:
        rounds, where = measure(options, scene)
        if not results:
            print(f"{where}, {'real-time' if options.priority > 0 else 'ordinary'} priority, rounds: "
                  f"{options.rounds}.\n\n| scene | 1 worker, ms | 2 workers, ms | 2 processes, ms "
                  f"| 2 workers reach | {options.many} workers take |\n|---|---|---|---|---|---|")
        results[scene] = rounds

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
