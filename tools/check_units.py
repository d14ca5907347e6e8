#!/usr/bin/env python3
"""Checks the requirements of units, sources that are compiled as one (cmake/ProofmassUnits.cmake).

The anonymous namespace of a source is visible to the other sources of its unit. The compiler would
mostly reject equal names; but it would accept overloads, and a call in one source could then refer to
the function of another. So a name must be unique to one source of the same namespace, or of one
within the other, unless
  - it is an alias or a using-declaration, which may be repeated;
  - it is a function whose first parameter is of a class of ours in each source, and of a different
    one in each: no implicit conversion applies.
A using-directive at file scope, and a macro that is not undefined again, are rejected as well.

Lists the offences and exits 1.
"""
import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
UNIT = re.compile(r'"([a-z0-9_]+):\s+([a-z0-9_./\s]+\.cpp)"')
OWN_CLASS = re.compile(r"(?:const )?(?:\w+::)*[A-Z]\w+(?:<[^(),]*>)?(?: ?[&*])?(?= )")


def units():
    """Folder, name and sources of every unit."""
    for cmake in sorted([*ROOT.glob("src/proofmass/*/CMakeLists.txt"), ROOT / "apps/proofmass/CMakeLists.txt"]):
        for name, sources in UNIT.findall(cmake.read_text()):
            yield cmake.parent, name, sources.split()


def declared(line: str) -> tuple[str, str] | None:
    """Name and first parameter (of a function) declared by a line at the left margin."""
    line = re.sub(r"//.*|\[\[.*?\]\] ?", "", line).strip()
    if line.startswith(("using ", "namespace ", "extern ", "static_assert")):
        return None
    if line.startswith("template") and (line := re.sub(r"^template <.*> ?(?=\w)", "", line)).startswith("template"):
        return None
    if tag := re.match(r"(?:enum class|enum|struct|class|union|concept) (\w+)", line):
        return tag[1], ""
    depth = 0
    for at, c in enumerate(line):
        depth += (c == "<") - (c == ">")
        if depth == 0 and c in "(={;[":
            name = re.search(r"(?<!::)\b(\w+)$", line[:at].rstrip())
            return (name[1], line[at + 1 :] if c == "(" else "") if name else None
    return None


def local_names(source: Path):
    """Namespace, name and first parameter of the declarations in its anonymous namespaces."""
    inside = False
    namespace = ""
    for line in source.read_text().splitlines():
        if named := re.match(r"namespace ([\w:]+) \{", line):
            namespace = named[1]
        if line == "namespace {":
            inside = True
        elif line == "}  // namespace":
            inside = False
        elif inside and re.match(r"[A-Za-z_\[]", line) and (found := declared(line)):
            yield namespace, *found


def unit_offences(folder: Path, unit: str, sources: list[str]) -> list[str]:
    found = []
    seen: dict[tuple[str, str], dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    local = [(source, *declaration) for source in sources for declaration in local_names(folder / source)]
    for around, name in {(namespace, name) for _, namespace, name, _ in local}:
        for source, namespace, other, parameter in local:
            if other == name and (namespace + "::").startswith(around + "::"):
                seen[around, name][source].add(parameter)
    for source in sources:
        for number, line in enumerate((folder / source).read_text().splitlines(), 1):
            at = f"{(folder / source).relative_to(ROOT)}:{number}"
            if line.startswith("using namespace"):
                found.append(f"{at}: a using-directive, which reaches the other sources of the unit {unit}")
            if (macro := re.match(r"#define (\w+)", line)) and f"#undef {macro[1]}" not in (folder / source).read_text():
                found.append(f"{at}: {macro[1]} is not undefined again, and reaches the other sources of the unit {unit}")
    for (_, name), by_source in seen.items():
        if len(by_source) < 2:
            continue
        firsts = [{OWN_CLASS.match(p)[0] if OWN_CLASS.match(p) else None for p in ps} for ps in by_source.values()]
        types = [t for ts in firsts for t in ts]
        if None in types or len(set(types)) < len(types):
            where = ", ".join(sorted(by_source))
            found.append(f"{folder.relative_to(ROOT)}: {name} in each of {where}, which are one unit, {unit}")
    return sorted(set(found))


def main() -> int:
    found = [offence for folder, name, sources in units() for offence in unit_offences(folder, name, sources)]
    print("\n".join(found) if found else f"{sum(1 for _ in units())} units, no name twice in one")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
