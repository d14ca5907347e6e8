"""Analysis of many recordings with a summary: the command ``proofmass fleet`` from Python.

Each recording is analysed in its own process, or with ``dask`` on the workers of a Dask cluster. Completed results are
kept in the folder of results, so that the same call continues after an interruption.
"""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path as _File
from typing import Any, Optional, Sequence

from . import _options
from ._core import DataError, Error, FileError
from ._recording import Path
from ._results import Result


def run(
    verb: str,
    manifest: Path,
    into: Path,
    *,
    jobs: Optional[int] = None,
    memory: Optional[float] = None,
    timeout: Optional[float] = None,
    force: bool = False,
    reports: bool = False,
    by: Optional[str] = None,
    shard: Optional[str] = None,
    dask: Optional[str] = None,
    program: Optional[Path] = None,
    **options: Any,
) -> Result:
    """Run a verb on every recording of a manifest or folder.

    Parameters
    ----------
    verb : str
        inspect, noise, drift, calibrate, wheel, track or tilt.
    manifest : path
        A table of recordings (.csv, .ndjson or .parquet) or a folder of them.
    into : path
        The folder of the results.
    jobs : int, optional
        Number of processes (default: the number of processors).
    memory : float, optional
        Memory in MB for all processes together; with dask, for each job.
    timeout : float, optional
        Time limit for each recording, in seconds.
    force : bool
        Repeat completed recordings.
    reports : bool
        Also write a page for each recording.
    by : str, optional
        For noise, column by which recordings are combined into one: "sensor".
    shard : str, optional
        "I/N": every N-th recording, from the I-th on.
    dask : str, optional
        Address of a Dask scheduler.
    program : path, optional
        Path of proofmass on the workers.
    **options
        Options of the verb, for every recording.

    Returns
    -------
    Result
        jobs, done, skipped, waiting, failed and results.
    """
    own = dict(jobs=jobs, memory=memory, timeout=timeout, force=force, reports=reports, by=by, shard=shard, dask=dask,
               program=None if program is None else os.fspath(program))  # fmt: skip
    return _run(["fleet", verb, os.fspath(manifest), "--into", os.fspath(into), *_options.words({**own, **options})])


def summary(results: Path, *, limit: Optional[Sequence[str]] = None, false_share: Optional[float] = None) -> Result:
    """Summary of the results: distributions, sensors out of family, scatter, trends, yield.

    Parameters
    ----------
    results : path
        The folder of the results.
    limit : list of str, optional
        Limits for the yield: "white<2e-3".
    false_share : float, optional
        Expected fraction of false alarms among the sensors reported as out of family (default 0.05).
    """
    words = _options.words({"limit": None if limit is None else list(limit), "false_share": false_share})
    return _run(["fleet", "summary", os.fspath(results), *words])


def _run(words: list[str]) -> Result:
    program = os.environ.get("PROOFMASS") or shutil.which("proofmass")
    if program is None:
        raise Error("no command proofmass on the PATH: install the program, or name it in PROOFMASS")
    here = str(_File(__file__).resolve().parents[1])
    paths = os.pathsep.join(filter(None, [here, os.environ.get("PYTHONPATH")]))
    environment = {**os.environ, "PROOFMASS_PYTHON": sys.executable, "PYTHONPATH": paths}
    with tempfile.TemporaryDirectory(prefix="proofmass-") as folder:
        files = [_File(folder) / name for name in ("found.json", "found.html")]
        command = [program, *words, "--json", str(files[0]), "--report", str(files[1])]
        ran = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, env=environment)
        if ran.returncode != 0:
            line = ran.stderr.strip().rpartition("\n")[2].removeprefix("proofmass: ")
            kinds = {3: FileError, 5: DataError}
            raise kinds.get(ran.returncode, Error)(_options.with_option_names(line))
        document, html = json.loads(files[0].read_text()), files[1].read_text()
    del document["provenance"]
    return Result({"json": json.dumps(document), "text": ran.stdout, "html": html, "notes": [], "series": [], "texts": []})
