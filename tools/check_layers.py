#!/usr/bin/env python3
"""Holds every #include in src/proofmass to the USES lines of the modules' CMakeLists.txt.

Exits 1 and lists the offending lines when a module includes one it does not name, or when the
USES lines form a cycle; otherwise prints the modules by layer, lowest first.
"""
import re
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent / "src" / "proofmass"
KEYWORDS = {"USES", "HEADERS", "SOURCES", "TESTS", "LINKS", "USES_PRIVATELY"}


def declared_uses() -> dict[str, set[str]]:
    uses = {}
    for cmake in ROOT.glob("*/CMakeLists.txt"):
        words = re.search(r"proofmass_module\((.*?)\)", cmake.read_text(), re.S)[1].split()
        name, *rest = words
        after = rest[rest.index("USES") + 1 :] if "USES" in rest else []
        stop = next((i for i, word in enumerate(after) if word in KEYWORDS), len(after))
        uses[name] = set(after[:stop])
    return uses


def offences(uses: dict[str, set[str]]) -> list[str]:
    found = []
    for source in sorted(ROOT.glob("*/*.[ch]pp")):
        module = source.parent.name
        for number, line in enumerate(source.read_text().splitlines(), 1):
            include = re.match(r'\s*#\s*include\s*["<]proofmass/(\w+)/', line)
            if include and include[1] not in uses[module] | {module}:
                found.append(f"{source}:{number}: {module} may not include {include[1]}")
    return found


def main() -> int:
    uses = declared_uses()
    try:
        order = TopologicalSorter(uses)
        order.prepare()
    except CycleError as error:
        print("cycle:", " -> ".join(error.args[1]))
        return 1
    if found := offences(uses):
        print("\n".join(found))
        return 1
    while order.is_active():
        layer = sorted(order.get_ready())
        print(" ".join(layer))
        order.done(*layer)
    return 0


if __name__ == "__main__":
    sys.exit(main())
