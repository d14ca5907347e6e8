#!/usr/bin/env python3
"""Extracts one figure from a report as a standalone SVG file with light and dark modes.

    tools/report_figure.py out/report.html 2 docs/images/wheel.svg

Figures count from 1, in the order of the page. The pictures of docs/ are made this way from ./run.
"""
import re
import sys
from pathlib import Path


def main() -> int:
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    page, number, out = Path(sys.argv[1]).read_text(), int(sys.argv[2]), Path(sys.argv[3])
    figures = re.findall(r"<svg class=\"pm-figure\".*?</svg>", page, re.S)
    if not 1 <= number <= len(figures):
        print(f"{sys.argv[1]} has {len(figures)} figures", file=sys.stderr)
        return 1
    style = re.search(r"<style>(.*?)</style>", page, re.S)[1]
    opening, rest = figures[number - 1].split(">", 1)
    width, height = re.search(r'viewBox="0 0 (\d+) (\d+)"', opening).groups()
    # Includes the page's background, for which its figures are drawn.
    ground = '<rect width="100%" height="100%" fill="var(--paper)"/>'
    out.write_text(f'{opening} width="{width}" height="{height}"><style>{style}</style>{ground}{rest}\n')
    return 0


if __name__ == "__main__":
    sys.exit(main())
