#!/usr/bin/env python3
"""Compile times by module and the slowest units, from the log that ninja keeps of a build.

  tools/build_times.py [FOLDER] [--slowest N]
  tools/build_times.py --tests [FOLDER]        the slowest tests, from CTest's record of their times

FOLDER defaults to build/release. The times are those of each object's last compilation, in parallel
with any other jobs: compare builds with the same number of jobs.
"""
import argparse
import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OBJECT = re.compile(r"\.(o|gch)$")


def module_of(output: str) -> str:
    """"src/proofmass/io/CMakeFiles/proofmass_io.dir/…" is io; for its tests "io tests"."""
    if found := re.match(r"src/proofmass/(\w+)/CMakeFiles/(\w+)\.dir/", output):
        return found[1] + (" tests" if found[2].endswith("_test") else "")
    if "precompiled" in output:
        return "precompiled headers"
    return re.sub(r"/?CMakeFiles/.*", "", output) or "."


def unit_of(output: str) -> str:
    name = re.sub(r"\.(o|gch)$", "", output.rsplit("/", 1)[1])
    if kind := re.search(r"proofmass_precompiled_(\w+)\.dir", output):
        return f"{kind[1]}/{name}"
    return f"{module_of(output)}/{name}"


def read_log(log: Path) -> dict[str, float]:
    """Seconds of each object's last compilation. A line of ninja's log, version 5: begin and end in
    ms, a time stamp, the output, a hash of the command."""
    header, *lines = log.read_text().splitlines()
    if header not in ("# ninja log v5", "# ninja log v6", "# ninja log v7"):
        raise SystemExit(f"{log}: expected a log of ninja, version 5 to 7, got '{header}'")
    seconds = {}
    for line in lines:
        begin, end, _, output, _ = line.split("\t")
        # If an object's path is absolute, another line of the same step has the relative one.
        if OBJECT.search(output) and not output.startswith("/"):
            seconds[output] = (int(end) - int(begin)) / 1000
    return {output: s for output, s in seconds.items() if (log.parent / output).exists()}


def show_tests(record: Path, count: int) -> None:
    """A line of the record: the test, how often it ran, its mean seconds; then "---" and failures."""
    times = []
    for line in record.read_text().split("---")[0].splitlines():
        name, _, seconds = line.rsplit(" ", 2)
        times.append((float(seconds), name))
    print(f"{len(times)} tests, {sum(seconds for seconds, _ in times):.0f} s one after the other\n\nslowest tests")
    for seconds, name in sorted(times, reverse=True)[:count]:
        print(f"{seconds:>8.1f}  {name}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", default="build/release", help="of the build")
    parser.add_argument("--slowest", type=int, default=10, metavar="N", help="how many to list")
    parser.add_argument("--tests", action="store_true", help="tests instead of units")
    wanted = parser.parse_args()
    if wanted.tests:
        show_tests(ROOT / wanted.folder / "Testing/Temporary/CTestCostData.txt", wanted.slowest)
        return 0
    log = ROOT / wanted.folder / ".ninja_log"
    if not log.exists():
        raise SystemExit(f"{log}: nothing has been built there")
    units = read_log(log)
    modules = defaultdict(list)
    for output, seconds in units.items():
        modules[module_of(output)].append(seconds)
    print(f"{'module':<28} {'units':>6} {'seconds':>8} {'longest':>8}")
    for name, times in sorted(modules.items(), key=lambda item: -sum(item[1])):
        print(f"{name:<28} {len(times):>6} {sum(times):>8.1f} {max(times):>8.1f}")
    print(f"{'all':<28} {len(units):>6} {sum(units.values()):>8.1f} {max(units.values()):>8.1f}\n")
    print("slowest units")
    for output, seconds in sorted(units.items(), key=lambda item: -item[1])[: wanted.slowest]:
        print(f"{seconds:>8.1f}  {unit_of(output)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
