#!/usr/bin/env python3
"""Checks the layers of src/proofmass. They are defined in the modules' CMakeLists.txt: the modules that
a module may include are in its USES line, its public headers in its HEADERS line, and in ROOMS which of
its subfolders ("rooms") a subfolder may include. The sources at a module's root may include all its
rooms, and every room the headers at the root.

An offence is
  - an #include of a module that USES does not name, or a USES that no source needs;
  - a cycle among the USES lines, or among the rooms of a module;
  - an #include of a room that ROOMS does not allow, or an entry of ROOMS that no source needs;
  - a public header that includes anything but std, Eigen/Core and public headers of Proofmass;
  - another module's private header (tests may include its *_test_support.hpp), or a path that is not written from "proofmass/" on;
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
OWN = re.compile(r"proofmass/(\w+)/((?:\w+/)?\w+\.hpp)")
ROOM = re.compile(r'"(\w+):([a-z0-9_ ]+)"')  # no file name in it: not a unit
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
    rooms: dict[str, set[str]]  # the rooms that each may include
    headers: set[str]
    tests: set[str]
    listed: set[str]


def read_module(cmake: Path) -> tuple[str, Module]:
    text = re.sub(r"#.*", "", cmake.read_text())
    name, *words = re.search(r"proofmass_module\((.*?)\)", text, re.S)[1].split()
    lists = {keyword: set() for keyword in KEYWORDS}
    rooms = {room: set(below.split()) for room, below in ROOM.findall(text)}
    current = None
    for word in words:
        word = word.strip('"')
        if word in KEYWORDS:
            current = lists[word]
        elif word != "TEXT" and not word.endswith(":"):  # the name of a unit
            current.add(word)
    tests = set().union(*(lists[keyword] for keyword in TEST_LISTS))
    listed = set().union(*(lists[keyword] for keyword in ("HEADERS", "UNITS", "SOURCES", "KERNELS"))) | tests
    return name, Module(lists["USES"], rooms, lists["HEADERS"], tests, listed)


def sources_of(name: str) -> list[Path]:
    return sorted((LIBRARY / name).rglob("*.[ch]pp"))


def room_of(file: str) -> str | None:
    return file.rpartition("/")[0] or None


def in_module(source: Path) -> tuple[str, str]:
    """Module, and path in it."""
    module, _, file = source.relative_to(LIBRARY).as_posix().partition("/")
    return module, file


def is_test(source: Path, modules: dict[str, Module]) -> bool:
    module, file = in_module(source)
    return file in modules[module].tests or "test_support" in file or file.endswith("specimens.hpp")


def files_offences(name: str, module: Module) -> list[str]:
    present = {in_module(path)[1] for path in sources_of(name)}
    at = f"src/proofmass/{name}/CMakeLists.txt"
    gone = [f"{at}: lists {file}, which does not exist" for file in module.listed - present]
    # A private header need not be listed; a source or test that is not would silently not be built.
    forgotten = {file for file in present - module.listed if file.endswith(".cpp")}
    return sorted(gone) + [f"{at}: does not list {file}" for file in sorted(forgotten)]


def include_offence(source: Path, quote: str, target: str, modules: dict[str, Module]) -> str | None:
    own, own_file = in_module(source)
    public = own_file in modules[own].headers
    if ours := OWN.fullmatch(target):
        other, file = ours.groups()
        if other not in modules[own].uses | {own}:
            return f"{own} may not include {other}: its USES line does not name it"
        shared_by_tests = own_file in modules[own].tests and file.endswith("_test_support.hpp")
        private = file not in modules[other].headers and not shared_by_tests
        if private and other != own:
            return f"{target} is private to {other}"
        if private and public:
            return f"a public header shows {target}, which is private"
        from_room, to_room = room_of(own_file), room_of(file)
        within = other != own or None in (from_room, to_room) or from_room == to_room
        if not within and not is_test(source, modules) and to_room not in modules[own].rooms.get(from_room, set()):
            return f"the room {from_room} may not include {to_room}: ROOMS does not say so"
        return None
    if quote == '"':
        return f'write "{target}" as "proofmass/{own}/{target}"'
    if public and target != "Eigen/Core" and not STD_HEADER.fullmatch(target):
        return f"a public header shows <{target}>; only std, Eigen/Core and Proofmass may be seen"
    return None


def source_offences(source: Path, modules: dict[str, Module]) -> list[str]:
    found = []
    in_library = not is_test(source, modules) and source.relative_to(LIBRARY).as_posix() not in MAY_PRINT
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
    text = "".join(path.read_text() for path in sources_of(name))
    return [
        f"src/proofmass/{name}/CMakeLists.txt: USES {other}, but no source includes it"
        for other in sorted(module.uses)
        if f'"proofmass/{other}/' not in text
    ]


def unneeded_rooms(name: str, modules: dict[str, Module]) -> list[str]:
    used: dict[str, str] = {}
    for source in sources_of(name):
        if (room := room_of(in_module(source)[1])) and not is_test(source, modules):
            used[room] = used.get(room, "") + source.read_text()
    return [
        f"src/proofmass/{name}/CMakeLists.txt: ROOMS has {room}: {below}, but no source of {room} includes it"
        for room, rooms_below in modules[name].rooms.items()
        for below in sorted(rooms_below)
        if f'"proofmass/{name}/{below}/' not in used.get(room, "")
    ]


def cycle(graph: dict[str, set[str]]) -> list[str] | None:
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return None


def main() -> int:
    modules = dict(read_module(cmake) for cmake in sorted(LIBRARY.glob("*/CMakeLists.txt")))
    found = []
    for name, graph in [("modules", {name: module.uses for name, module in modules.items()})] + [
        (name, module.rooms) for name, module in modules.items()
    ]:
        if path := cycle(graph):
            print(f"cycle in {name}:", " -> ".join(path))
            return 1
    for name, module in modules.items():
        found += files_offences(name, module) + unneeded_uses(name, module) + unneeded_rooms(name, modules)
        for source in sources_of(name):
            found += source_offences(source, modules)
    if found:
        print("\n".join(found))
        return 1
    order = TopologicalSorter({name: module.uses for name, module in modules.items()})
    order.prepare()
    while order.is_active():
        layer = sorted(order.get_ready())
        print(" ".join(layer))
        order.done(*layer)
    return 0


if __name__ == "__main__":
    sys.exit(main())
