#!/usr/bin/env python3
"""Times `proofmass fleet noise` on small recordings, from 10 to 10 000 of them, and prints a table.

    PROOFMASS=build/release/proofmass python3 bench/fleet_bench.py [--counts 10 100 1000 10000] [--jobs 2]

Each recording is a file of its own with 20 s of one axis at 100 Hz, of 20 sensors. Beside the run the summary and a
second run, which finds everything done, are timed; the memory is the most that the parent process takes.
"""
import argparse
import json
import os
import random
import subprocess
import tempfile
import time
from pathlib import Path


def write_recordings(folder: Path, count: int) -> None:
    draw = random.Random(1)
    noise = [f"{9.8 + draw.gauss(0, 0.01):.6f}" for _ in range(40000)]
    lines = ["path,sensor"]
    for k in range(count):
        from_row = draw.randrange(len(noise) - 2000)
        rows = (f"{n / 100:.2f},{noise[from_row + n]}\n" for n in range(2000))
        (folder / f"r{k}.csv").write_text("time (s),acc_z (m/s^2)\n" + "".join(rows))
        lines.append(f"r{k}.csv,S{k % 20}")
    (folder / "manifest.csv").write_text("\n".join(lines) + "\n")


def timed(folder: Path, *words) -> tuple[float, float, dict]:
    """Seconds, the most memory in MB, and the document."""
    begun = time.perf_counter()
    process = subprocess.Popen([os.path.abspath(os.environ["PROOFMASS"]), "fleet", *words, "--json", "found.json"],
                               cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{words} ended with {process.returncode}")
    return time.perf_counter() - begun, usage.ru_maxrss / 1024, json.loads((folder / "found.json").read_text())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--counts", type=int, nargs="+", default=[10, 100, 1000, 10000])
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    given = parser.parse_args()
    print("recordings  run s  ms each  of that beside the verbs, ms  memory MB  again s  summary s  its memory MB")
    for count in given.counts:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write_recordings(folder, count)
            run_s, run_mb, found = timed(folder, "noise", "manifest.csv", "--into", "results", "--jobs", str(given.jobs))
            again_s, _, _ = timed(folder, "noise", "manifest.csv", "--into", "results")
            summary_s, summary_mb, _ = timed(folder, "summary", "results")
        beside_ms = 1000 * (found["elapsed_s"] - found["busy_s"] / given.jobs) / count
        print(f"{count:10d} {run_s:6.2f} {1000 * run_s / count:8.2f} {beside_ms:28.2f} {run_mb:10.1f} {again_s:8.2f} {summary_s:10.2f} {summary_mb:14.1f}", flush=True)


if __name__ == "__main__":
    main()
