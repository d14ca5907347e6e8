#!/usr/bin/env python3
"""Makes corpus/verbs: for each command line of fuzz_verbs.cpp a rotating wheel, a rest, steps between
positions, and noise, at various scales."""
import random
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "corpus/verbs"
COMMANDS = 29
G, ONE = 247, 128 # the byte of 9.8 m/s², that of scale 1


def values(kind: str, rows: int, draw: random.Random) -> list:
    zero = 125
    positions = [(G, zero, zero), (zero, G, zero), (zero, zero, G), (3, zero, zero), (zero, 3, zero), (zero, zero, 3)]
    if kind == "wheel":
        return []
    if kind == "rest":
        return [byte for _ in range(rows) for byte in (zero, zero, G)]
    if kind == "steps":
        return [byte for row in range(rows) for byte in positions[6 * row // rows]]
    return [draw.randrange(256) for _ in range(3 * rows)]


def main():
    draw = random.Random(1)
    FOLDER.mkdir(parents=True, exist_ok=True)
    for command in range(COMMANDS):
        for kind in ("wheel", "rest", "steps", "noise"):
            rows = draw.choice([2, 8, 12, 40, 200])
            scale = draw.choice([ONE, ONE, ONE, 0, 72, 200, 255])
            rate = draw.choice([96, 128, 160, 192, 230])
            odd_step = draw.choice([255, 255, 5])
            head = [command, rows - 2, scale, rate, odd_step]
            (FOLDER / f"{command:02}-{kind}").write_bytes(bytes(head + values(kind, min(rows, 40), draw)))


if __name__ == "__main__":
    main()
