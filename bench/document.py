#!/usr/bin/env python3
"""Puts standard input between <!-- begin NAME --> and <!-- end NAME --> of a document.

usage: document.py FILE NAME < text
"""

import pathlib
import sys


def main():
    file, name = pathlib.Path(sys.argv[1]), sys.argv[2]
    text = file.read_text()
    begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
    if text.count(begin) != 1 or text.count(end) != 1:
        sys.exit(f"document: {file} has no section {name}")
    before, rest = text.split(begin)
    file.write_text(before + begin + "\n" + sys.stdin.read().strip() + "\n\n" + end
                    + rest.split(end)[1])


if __name__ == "__main__":
    main()
