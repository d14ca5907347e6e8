#!/usr/bin/env python3
"""Checks the layers of src/proofmass. They are defined in the modules' CMakeLists.txt: the modules that
a module may include are in its USES line, its public headers in its HEADERS line.

An offence is
  - an #include of a module that USES does not name, or a USES that no source needs;
  - a cycle among the USES lines;
  - a public header that includes anything but std, Eigen/Core and public headers of Proofmass;
  - another module's private header (tests may include its *_test_support.hpp), or a path that is not written "proofmass/module/file.hpp";
  - a listed header or source that does not exist, or one that exists and is not listed;
  - in the library (tests and *test_support* apart), output, exit, the environment or the process's locale.

Lists the offences and exits 1; otherwise prints the modules by layer, lowest first.
"""
import re
import sys
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIBRARY = ROOT / "src" / "proofmass"
PARSED = re.search(r'PARSE_ARGV 1 arg "TEXT" ""\s+"([A-Z_;]+)"', (ROOT / "cmake/ProofmassModule.cmake").read_text())
KEYWORDS = set(PARSED[1].split(";"))
TEST_LISTS = {"TESTS", "SLOW_TESTS"}
INCLUDE = re.compile(r'\s*#\s*include\s*(["<])([^">]+)[">]')
STD_HEADER = re.compile(r"[a-z_]+")
# A violated contract prints its location and aborts; nothing else in the library prints.
MAY_PRINT = {"core/contract.cpp"}
WORLD = re.compile(
    r"\b(std::c(out|err|log)|f?printf\s*\(|fmt::print|puts\s*\(|(std::)?(exit|abort|getenv|setlocale)\s*\("
    r"|std::locale::global)"
)


@dataclass
class Module:
    uses: set[str]
    headers: set[str]
    tests: set[str]
    listed: set[str]


def read_module(cmake: Path) -> tuple[str, Module]:
    text = re.sub(r"#.*", "", cmake.read_text())
    name, *words = re.search(r"proofmass_module\((.*?)\)", text, re.S)[1].split()
    lists = {keyword: set() for keyword in KEYWORDS}
    current = None
    for word in words:
        word = word.strip('"')
        if word in KEYWORDS:
            current = lists[word]
        elif word != "TEXT" and not word.endswith(":"):  # the name of a unit
            current.add(word)
    tests = set().union(*(lists[keyword] for keyword in TEST_LISTS))
    listed = set().union(*(lists[keyword] for keyword in ("HEADERS", "UNITS", "SOURCES", "KERNELS"))) | tests
    return name, Module(lists["USES"], lists["HEADERS"], tests, listed)


def files_offences(name: str, module: Module) -> list[str]:
    present = {path.name for path in (LIBRARY / name).glob("*.[ch]pp")}
    at = f"src/proofmass/{name}/CMakeLists.txt"
    gone = [f"{at}: lists {file}, which does not exist" for file in module.listed - present]
    # A private header need not be listed; a source or test that is not would silently not be built.
    forgotten = {file for file in present - module.listed if file.endswith(".cpp")}
    return sorted(gone) + [f"{at}: does not list {file}" for file in sorted(forgotten)]


def include_offence(source: Path, quote: str, target: str, modules: dict[str, Module]) -> str | None:
    own = source.parent.name
    public = source.name in modules[own].headers
    if ours := re.fullmatch(r"proofmass/(\w+)/(\w+\.hpp)", target):
        other, file = ours.groups()
        if other not in modules[own].uses | {own}:
            return f"{own} may not include {other}: its USES line does not name it"
        shared_by_tests = source.name in modules[own].tests and file.endswith("_test_support.hpp")
        private = file not in modules[other].headers and not shared_by_tests
        if private and other != own:
            return f"{target} is private to {other}"
        if private and public:
            return f"a public header shows {target}, which is private"
        return None
    if quote == '"':
        return f'write "{target}" as "proofmass/{own}/{target}"'
    if public and target != "Eigen/Core" and not STD_HEADER.fullmatch(target):
        return f"a public header shows <{target}>; only std, Eigen/Core and Proofmass may be seen"
    return None


def source_offences(source: Path, modules: dict[str, Module]) -> list[str]:
    found = []
    is_test = source.name in modules[source.parent.name].tests or "test_support" in source.name
    in_library = not is_test and source.relative_to(LIBRARY).as_posix() not in MAY_PRINT
    for number, line in enumerate(source.read_text().splitlines(), 1):
        at = f"{source.relative_to(ROOT)}:{number}"
        code = re.sub(r'//.*|"(\\.|[^"\\])*"', '""', line)
        if include := INCLUDE.match(line):
            if offence := include_offence(source, *include.groups(), modules):
                found.append(f"{at}: {offence}")
        elif in_library and (world := WORLD.search(code)):
            found.append(f"{at}: the library may not use {world[0].strip(' (')}")
    return found


def unneeded_uses(name: str, module: Module) -> list[str]:
    text = "".join(path.read_text() for path in (LIBRARY / name).glob("*.[ch]pp"))
    return [
        f"src/proofmass/{name}/CMakeLists.txt: USES {other}, but no source includes it"
        for other in sorted(module.uses)
        if f'"proofmass/{other}/' not in text
    ]


def main() -> int:
    modules = dict(read_module(cmake) for cmake in sorted(LIBRARY.glob("*/CMakeLists.txt")))
    order = TopologicalSorter({name: module.uses for name, module in modules.items()})
    try:
        order.prepare()
    except CycleError as error:
        print("cycle:", " -> ".join(error.args[1]))
        return 1
    found = []
    for name, module in modules.items():
        found += files_offences(name, module) + unneeded_uses(name, module)
        for source in sorted((LIBRARY / name).glob("*.[ch]pp")):
            found += source_offences(source, modules)
    if found:
        print("\n".join(found))
        return 1
    while order.is_active():
        layer = sorted(order.get_ready())
        print(" ".join(layer))
        order.done(*layer)
    return 0


if __name__ == "__main__":
    sys.exit(main())
