#!/usr/bin/env python3
"""Tables of an experiment's results.csv in Markdown, to standard output.

usage: pivot.py CSV ROWS COLUMNS VALUE... [--by AXIS...]

A table for each value of the axes after --by and for each VALUE, with a row for each value of ROWS and a
column for each of COLUMNS, in the order of the file.
"""

import argparse
import csv
import itertools


def distinct(cells, axis):
    return list(dict.fromkeys(cell[axis] for cell in cells))


def number(text):
    if not text or text == "nan":
        return ""
    value = float(text)
    return f"{value:.2g}" if abs(value) < 0.001 else f"{value:.4f}".lstrip("0")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("csv")
    parser.add_argument("rows")
    parser.add_argument("columns")
    parser.add_argument("values", nargs="+")
    parser.add_argument("--by", nargs="+", default=[])
    arguments = parser.parse_args()
    with open(arguments.csv, newline="") as file:
        cells = list(csv.DictReader(file))
    for name in [arguments.rows, arguments.columns, *arguments.values, *arguments.by]:
        if name not in cells[0]:
            parser.error(f"no column '{name}' in {arguments.csv}, expected one of "
                         f"{', '.join(cells[0])}")
    columns = distinct(cells, arguments.columns)
    panels = itertools.product(*(distinct(cells, axis) for axis in arguments.by))
    for panel, value in itertools.product(list(panels), arguments.values):
        here = [cell for cell in cells
                if all(cell[axis] == at for axis, at in zip(arguments.by, panel))]
        print(f"{', '.join([*panel, value])}:\n")
        print(f"| {arguments.rows} \\ {arguments.columns} | {' | '.join(columns)} |")
        print("|---" * (len(columns) + 1) + "|")
        for row in distinct(here, arguments.rows):
            found = {cell[arguments.columns]: cell[value] for cell in here
                     if cell[arguments.rows] == row}
            print(f"| {row} | {' | '.join(number(found.get(c, '')) for c in columns)} |")
        print()


if __name__ == "__main__":
    main()
