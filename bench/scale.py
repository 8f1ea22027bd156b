#!/usr/bin/env python3
"""How time and memory grow with triangles, pixels, texture size, layers and the memory cap.

Prints a table for each with the exponent k of time = c * size^k over its largest sizes, writes
scale.json and scale.md, and draws each with gnuplot, if it is there.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys

from samples import fit_exponent, median, spread

ROOT = pathlib.Path(__file__).resolve().parent.parent
MB = 1 << 20


class Axis:
    """One of the sizes: its points are (size, arguments of scale_frames)."""

    def __init__(self, name, title, unit, points, fitted=3):
        self.name, self.title, self.unit, self.points = name, title, unit, points
        self.fitted = fitted  # of the largest points, for the exponent


def axes():
    def triangles(*more):
        return [(n, ["ellipsoid", "--triangles", str(n), *more])
                for n in (1000, 10000, 100000, 1000000, 10000000)]

    sides = [(640, 480), (1280, 720), (1920, 1080), (3840, 2160), (7680, 4320)]
    layers = (1, 2, 4, 8, 16, 32, 64)
    return [
        Axis("triangles", "S1c with more triangles, 1920 x 1080", "triangles", triangles()),
        Axis("triangles_capped", "The same with a memory cap of 16 MB", "triangles",
             triangles("--memory-cap", "16")),
        Axis("pixels", "S1c with more pixels", "pixels",
             [(w * h, ["ellipsoid", "--triangles", "20448", "--width", str(w), "--height", str(h)])
              for w, h in sides]),
        Axis("texels", "One layer, a texture of so many texels a side at a texel for each pixel, "
             "turned by 30 degrees", "texels a side",
             [(side, ["layers", "--texture", str(side)])
              for side in (256, 512, 1024, 2048, 4096, 8192)]),
        Axis("layers", "Opaque layers over the whole frame, back to front", "layers",
             [(n, ["layers", "--layers", str(n)]) for n in layers]),
        Axis("blended", "Blended layers", "layers",
             [(n, ["blended", "--layers", str(n)]) for n in layers]),
    ]


def run_point(options, arguments):
    """Numbers of scale_frames, with the list of frame times as "ms"."""
    command = [str(options.program), *arguments, "--threads", str(options.threads),
               "--seconds", str(options.seconds)]
    if options.priority > 0:
        command = ["chrt", "-f", str(options.priority)] + command
    output = subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout
    numbers = {"ms": []}
    for line in output.splitlines():
        key, value = line.split()
        if key == "ms":
            numbers["ms"].append(float(value))
        else:
            numbers[key] = int(value)
    return numbers


def measure(options, axis):
    points = []
    for size, arguments in axis.points:
        if options.largest and size > options.largest:
            continue
        numbers = run_point(options, arguments)
        points.append({"size": size, "ms": median(numbers["ms"]), "spread": spread(numbers["ms"]),
                       **{k: numbers[k] for k in ("flushes", "scene_bytes", "render_bytes")}})
    last = points[-axis.fitted:]
    exponent = fit_exponent([p["size"] for p in last], [p["ms"] for p in last])
    return {"name": axis.name, "title": axis.title, "unit": axis.unit, "points": points,
            "exponent": exponent, "fitted": len(last)}


def table(result):
    lines = [f"{result['title']}; exponent {result['exponent']:.2f} over the last "
             f"{result['fitted']}:\n",
             f"| {result['unit']} | ms | spread | scene and frame, MB | renderer, MB | flushes |",
             "|---|---|---|---|---|---|"]
    for p in result["points"]:
        lines.append(f"| {p['size']:,} | {p['ms']:.2f} | {p['spread']:.1%} | "
                     f"{p['scene_bytes'] / MB:.0f} | {p['render_bytes'] / MB:.0f} | {p['flushes']} |")
    return "\n".join(lines) + "\n"


def plot(results, directory):
    """One SVG for each axis: time to the left, memory of the renderer to the right."""
    for result in results:
        data = "\n".join(f"{p['size']} {p['ms']} {p['render_bytes'] / MB}" for p in result["points"])
        name = directory / f"{result['name']}.svg"
        last = result["points"][-1]
        fit = "\n".join(f"{size} {last['ms'] * (size / last['size']) ** result['exponent']}"
                        for size in (p["size"] for p in result["points"][-result["fitted"]:]))
        script = f"""set terminal svg size 560,380 font "sans-serif,12" background "white"
set output "{name}"
set logscale xy
set key top left
set grid
set xlabel "{result['unit']}"
set ylabel "ms"
set y2label "MB"
set ytics nomirror
set y2tics
set logscale y2
set format x "10^{{%L}}"
{'set format x "%g"' if last['size'] < 1e5 else ''}
$points << END
{data}
END
$fit << END
{fit}
END
plot $points using 1:2 with linespoints pointtype 7 title "ms", \\
     $fit with lines dashtype 2 title "exponent {result['exponent']:.2f}", \\
     $points using 1:3 axes x1y2 with linespoints pointtype 4 title "renderer, MB"
"""
        subprocess.run(["gnuplot"], input=script, text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=ROOT / "build/release/bin/scale_frames")
    parser.add_argument("--axes", type=lambda text: text.split(","), help="of "
                        + ", ".join(axis.name for axis in axes()))
    parser.add_argument("--largest", type=float, help="leave out larger sizes")
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--seconds", default=0.3, type=float, help="of frames for each size")
    parser.add_argument("--priority", default=5, type=int, help="real-time; 0: ordinary")
    parser.add_argument("-o", "--output", default=ROOT / "out/scale", type=pathlib.Path)
    options = parser.parse_args()
    chosen = [axis for axis in axes() if not options.axes or axis.name in options.axes]
    options.output.mkdir(parents=True, exist_ok=True)
    results, text = [], ""
    for axis in chosen:
        results.append(measure(options, axis))
        text += table(results[-1]) + "\n"
        print(table(results[-1]), flush=True)
    (options.output / "scale.json").write_text(json.dumps(results, indent=1) + "\n")
    (options.output / "scale.md").write_text(text)
    if shutil.which("gnuplot"):
        plot(results, options.output)
    else:
        print("scale: no plots without gnuplot")


if __name__ == "__main__":
    sys.exit(main())
