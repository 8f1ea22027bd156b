#!/usr/bin/env python3
"""Counts the instructions of the kernels in bench/instructions.txt and compares with what it says.

The times of a noisy machine hide a slow-down of a tenth; counts do not. Each kernel runs once on the
inputs of bench_kernels, stepped through instruction by instruction, on every instruction set of this
CPU. --callgrind has valgrind count the same for AVX2 and SSE4.2, which are all that it knows.
"""

import argparse
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = ROOT / "bench/instructions.txt"
TOLERANCE = 0.02
HEADER = """# Instructions of one call of a kernel on the inputs of its benchmark, at most 128 vertices or triangles of
# them, by instruction set. Checked by ./run instructions; after a kernel was changed:
# ./run instructions --update
"""
COLUMNS = ["avx512", "avx2", "sse42"]
SHORTENED = ["transform", "setup", "rasterize_tiny"]  # by the limit of 128, in steps only


def read_table():
    """The compiler, and {kernel: {instruction set: count}}."""
    compiler, counts = "", {}
    for line in TABLE.read_text().splitlines():
        if line.startswith("compiler: "):
            compiler = line[10:]
        elif line and not line.startswith(("#", "kernel ")):
            kernel, *numbers = line.split()
            counts[kernel] = {isa: int(n) for isa, n in zip(COLUMNS, numbers) if n != "-"}
    return compiler, counts


def write_table(compiler, counts):
    width = max(len(kernel) for kernel in counts)
    lines = [f"{'kernel':<{width}}" + "".join(f"{isa:>9}" for isa in COLUMNS)]
    for kernel, row in counts.items():
        lines.append(f"{kernel:<{width}}" + "".join(f"{row.get(isa, '-'):>9}" for isa in COLUMNS))
    TABLE.write_text(HEADER + f"compiler: {compiler}\n\n" + "\n".join(lines) + "\n")


def program(arguments):
    return [str(arguments.program), "--benchmark_filter=^stage/(" + "|".join(arguments.kernels) +
            ")/(" + "|".join(arguments.isas) + ")(/iterations:1)?$"]


def stepped(arguments):
    """The compiler, and counts as in the table."""
    output = subprocess.run(
        program(arguments) + ["--instructions", "--benchmark_format=json"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True, text=True).stdout
    report = json.loads(output)
    counts = {kernel: {} for kernel in arguments.kernels}
    for run in report["benchmarks"]:
        if "instructions" not in run:
            sys.exit(f"instructions: {run['name']}: {run.get('error_message', 'not counted')}")
        kernel, isa = re.fullmatch(r"stage/(.*)/(\w+)/iterations:1", run["name"]).groups()
        counts[kernel][isa] = int(run["instructions"])
    return report["context"]["compiler"], counts


def callgrind(arguments):
    """Counts as in the table, of AVX2 and SSE4.2: the mean over the calls of each kernel, inclusive.

    Two variants of one kernel cannot be told apart, so each runs in its own process."""
    counts = {}
    for kernel in arguments.kernels:
        counts[kernel] = {}
        if kernel.split("/")[0] in SHORTENED:
            continue
        with tempfile.NamedTemporaryFile() as profile:
            only = argparse.Namespace(program=arguments.program, kernels=[kernel],
                                      isas=["avx2", "sse42"])
            subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile.name}"]
                           + program(only) + ["--benchmark_min_time=0"],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
            function = kernel.split("/")[0]
            for isa, (calls, cost) in calls_of(pathlib.Path(profile.name), function).items():
                counts[kernel][isa] = round(cost / calls)
    return counts


def calls_of(profile, function):
    """{instruction set: [calls, inclusive cost]} of burnish::<set>::(anonymous)::<function>."""
    names, sums = {}, collections.defaultdict(lambda: [0, 0])
    callee, calls = "", 0
    pattern = re.compile(rf"burnish::(\w+)::\(anonymous namespace\)::{function}\(")
    for line in profile.read_text().splitlines():
        named = re.match(r"c?fn=(\(\d+\))(?: (.*))?$", line)
        if named:
            if named[2]:
                names[named[1]] = named[2]
            if line.startswith("cfn="):
                callee = names[named[1]]
        elif line.startswith("calls="):
            calls = int(line[6:].split()[0])
        elif calls:
            found = pattern.match(callee)
            if found:
                sums[found[1]][0] += calls
                sums[found[1]][1] += int(line.split()[1])
            calls = 0
    return sums


def compare(want, got):
    """Lines on what differs, and whether anything does so by more than the tolerance."""
    lines, bad = [], False
    for kernel, row in want.items():
        for isa, count in row.items():
            now = got[kernel].get(isa)
            if now is None or now == count:
                continue
            change = now / count - 1
            bad |= abs(change) > TOLERANCE
            lines.append(f"{kernel} {isa}: {count} -> {now} ({change:+.1%})")
    return lines, bad


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "build/release/bin/bench_kernels")
    parser.add_argument("--update", action="store_true", help="write the table")
    parser.add_argument("--callgrind", action="store_true",
                        help="have valgrind count, too, and compare the two")
    arguments = parser.parse_args()
    compiler, want = read_table()
    arguments.kernels, arguments.isas = list(want), COLUMNS
    this_compiler, got = stepped(arguments)
    missing = [kernel for kernel in want if not got[kernel]]
    if missing:
        sys.exit(f"instructions: bench_kernels has no {', '.join(missing)}")
    if arguments.callgrind:
        lines, bad = compare(callgrind(arguments), got)
        print("\n".join(lines + [f"valgrind {'disagrees' if bad else 'agrees'} within "
                                 f"{TOLERANCE:.0%}"]))
        return 1 if bad else 0
    lines, bad = compare(want, got)
    print("\n".join(lines + [f"{len(want)} kernels, {this_compiler}"]))
    if arguments.update:
        write_table(this_compiler, {kernel: {**want[kernel], **got[kernel]} for kernel in want})
        return 0
    for isa in COLUMNS:
        if not any(isa in row for row in got.values()):
            print(f"not counted: this CPU has no {isa}")
    if this_compiler != compiler:
        print(f"not checked: the counts are those of {compiler}")
        return 0
    if bad:
        print("instructions: more than 2 % off; if that is meant: ./run instructions --update")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
