#!/usr/bin/env python3
"""Draws the modules of src/proofmass with their rooms, from the #include lines, for docs/architecture.md.

    tools/draw_architecture.py            writes docs/images/architecture.dot, and .svg with graphviz's dot
    tools/draw_architecture.py --check    exits 1 if the .dot is not what the sources say

An arrow points from what includes to what is included; one that follows from others is left out.
"""
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from check_layers import LIBRARY, ROOT, in_module, is_test, read_module, room_of, sources_of  # noqa: E402

DOT = ROOT / "docs/images/architecture.dot"


def reduced(graph: dict[str, set[str]]) -> dict[str, set[str]]:
    """The fewest arrows from which the others follow. The graph has no cycle."""

    def below(node: str) -> set[str]:
        return set().union(*({n} | below(n) for n in graph.get(node, set())))

    return {
        node: {n for n in targets if not any(n in below(other) for other in targets - {n})}
        for node, targets in graph.items()
    }


def drawing() -> str:
    modules = dict(read_module(cmake) for cmake in sorted(LIBRARY.glob("*/CMakeLists.txt")))
    lines = [
        "digraph architecture {",
        '  rankdir=TB; compound=true; nodesep=0.12; ranksep=0.45; fontname="sans-serif"; fontsize=15;',
        '  node [shape=box, style="rounded,filled", fillcolor=white, color="#7d8c99", fontname="sans-serif", fontsize=11, '
        'height=0.28, margin="0.09,0.03"];',
        '  edge [color="#7d8c99", arrowsize=0.6];',
    ]
    for name, module in modules.items():
        sources = [p for p in sources_of(name) if not is_test(p, modules)]
        rooms = sorted({room for p in sources if (room := room_of(in_module(p)[1]))})
        lines += [
            f"  subgraph cluster_{name} {{",
            f'    label="{name}"; style="rounded,filled"; fillcolor="#eef3f6"; color="#b8c4cd";',
            f'    {name} [label="public headers", fillcolor="#d3e3ec"];',
        ]
        lines += [f'    {name}_{room} [label="{room}"];' for room in rooms]
        arrows = reduced({room: module.rooms.get(room, set()) for room in rooms})
        lines += [f"    {name}_{a} -> {name}_{b};" for a in rooms for b in sorted(arrows[a])]
        tops = [room for room in rooms if not any(room in below for below in arrows.values())]
        lines += [f"    {name} -> {name}_{room} [style=invis];" for room in tops]
        lines.append("  }")
    arrows = reduced({name: module.uses for name, module in modules.items()})
    lines += [
        f'  {a} -> {b} [ltail=cluster_{a}, lhead=cluster_{b}, color="#2f6f8f", penwidth=1.4];'
        for a in sorted(arrows)
        for b in sorted(arrows[a])
    ]
    return "\n".join([*lines, "}", ""])


def main() -> int:
    if sys.argv[1:] == ["--check"]:
        if DOT.read_text() == drawing():
            return 0
        print("docs/images/architecture.dot is not what the sources say: run tools/draw_architecture.py")
        return 1
    DOT.write_text(drawing())
    subprocess.run(["dot", "-Tsvg", "-o", DOT.with_suffix(".svg"), DOT], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
