"""Runs the jobs of ``proofmass fleet --dask ADDRESS`` on the workers of a Dask cluster.

The command runs it as ``python3 -m proofmass._dask ADDRESS``. It reads one job per line from standard input and writes
one result per line to standard output as the jobs end; ``src/proofmass/fleet/driver.hpp`` describes both formats.
"""
from __future__ import annotations

import importlib
import json
import os
import queue
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import uuid
from typing import Any


def perform(job: dict[str, Any]) -> dict[str, Any]:
    """Run the verb with its files and flags in a separate process on a worker."""
    began = time.monotonic()
    result = {"job": job["job"], "status": 1, "signal": 0, "timed_out": False, "words": "", "document": ""}
    program = job["program"] or shutil.which("proofmass")
    if program is None:
        result["words"] = f"worker on {socket.gethostname()}: no proofmass on its PATH: give --program"
        return {**result, "seconds": time.monotonic() - began}
    with tempfile.TemporaryDirectory(prefix="proofmass-") as scratch:
        words, fetched = _local(job["arguments"], scratch)
        folder = job["folder"] if os.path.isdir(job["folder"]) else scratch
        process = subprocess.Popen([program, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, start_new_session=True)  # fmt: skip
        if job["memory_bytes"]:
            resource.prlimit(process.pid, resource.RLIMIT_DATA, (job["memory_bytes"],) * 2)
        try:
            out, errors = process.communicate(timeout=job["timeout_s"] or None)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            out, errors = process.communicate()
            result["timed_out"] = True
    texts = [out.decode(errors="replace"), errors.decode(errors="replace")]
    for path, url in fetched.items():
        texts = [text.replace(path, url) for text in texts]
    result["document"], result["words"] = texts
    result["status"], result["signal"] = max(process.returncode, 0), max(-process.returncode, 0)
    return {**result, "seconds": time.monotonic() - began}


def _local(arguments: list[str], scratch: str) -> tuple[list[str], dict[str, str]]:
    """Replace each URL among the arguments by a local copy; returns also the URL of each copy."""
    words: list[str] = []
    fetched: dict[str, str] = {}
    for word in arguments:
        if "://" in word and not word.startswith("-"):
            fsspec = importlib.import_module("fsspec")
            path = os.path.join(scratch, f"{len(fetched)}-{os.path.basename(word)}")
            with fsspec.open(word, "rb") as source, open(path, "wb") as copy:
                shutil.copyfileobj(source, copy)
            fetched[path] = word
            word = path
        words.append(word)
    return words, fetched


def _result_of(future: Any, job: int) -> dict[str, Any]:
    if future.status == "finished":
        return dict(future.result())
    problem = future.exception() if future.status == "error" else "cancelled by the scheduler"
    words = f"{type(problem).__name__}: {problem}" if isinstance(problem, BaseException) else str(problem)
    return {"job": job, "status": 1, "signal": 0, "timed_out": False, "seconds": 0.0, "words": words, "document": ""}


def main(address: str) -> None:
    # An import statement would make type checkers analyse the whole package.
    distributed = importlib.import_module("distributed")
    ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
    with distributed.Client(address, timeout=10, name="proofmass fleet") as client:

        def submit_all() -> None:
            for line in sys.stdin:
                job = json.loads(line)
                future = client.submit(perform, job, key=f"proofmass-{uuid.uuid4().hex}", pure=False)
                waiting[future.key] = (job["job"], future)
                future.add_done_callback(lambda done: ended.put(done.key))
            ended.put(None)

        waiting: dict[str, tuple[int, Any]] = {}
        threading.Thread(target=submit_all, daemon=True).start()
        is_open = True
        while is_open or waiting:
            key = ended.get()
            if key is None:
                is_open = False
                continue
            job, future = waiting.pop(key)
            print(json.dumps(_result_of(future, job)), flush=True)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the command ends this process
    try:
        main(sys.argv[1])
    except (OSError, ImportError) as problem:
        sys.exit(f"{type(problem).__name__}: {problem}")
