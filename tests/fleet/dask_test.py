"""proofmass fleet --dask on a Dask cluster of two workers, and the same from Python."""
import ast
import importlib.util
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest
from contextlib import contextmanager

import page
from command import FAILED, INTERRUPTED, PROGRAM
import fleet_test
from fleet_test import FleetTest

MISSING = [name for name in ("distributed", "proofmass") if importlib.util.find_spec(name) is None]
os.environ["PROOFMASS_PYTHON"] = sys.executable


@unittest.skipIf(MISSING, f"SKIPPED, of python3-distributed and our own module: no {', '.join(MISSING)}")
class Dask(FleetTest):
    @contextmanager
    def cluster(self):
        """Address of a scheduler on loopback, and the processes of its two workers."""
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            port = one.getsockname()[1]
        address = f"tcp://127.0.0.1:{port}"
        scheduler = ["distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show"]
        worker = ["distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(self.folder)]
        running = []
        try:
            for words in (scheduler, worker, worker):
                running.append(subprocess.Popen([sys.executable, "-m", *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True))
            yield address, running[1:]
        finally:
            for process in reversed(running):
                process.terminate()
            for process in reversed(running):
                process.wait(timeout=60)

    def flags(self, address):
        return "fleet", "noise", "manifest.csv", "--into", "results", "--dask", address, "--program", PROGRAM

    def started(self, address):
        """The command, once it has its first result."""
        running = subprocess.Popen([PROGRAM, *self.flags(address)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(running.stdout.close)
        self.addCleanup(running.stderr.close)
        journal = self.folder / "results/journal.ndjson"
        while not (journal.exists() and journal.stat().st_size > 0):
            self.assertIsNone(running.poll(), running.stderr.read() if running.poll() is not None else "")
            time.sleep(0.02)
        return running

    def assert_as_local(self):
        self.succeed("fleet", "noise", "manifest.csv", "--into", "one")
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "results" / name).read_bytes(), name)
        paths = [entry["path"] for entry in self.journal()]
        self.assertEqual(len(paths), len(set(paths)))

    def test_with_a_worker_killed_in_the_middle_the_tables_are_the_local_ones(self):
        self.fleet(sensors=10, files=6, broken=(4, 13))
        with self.cluster() as (address, workers):
            running = self.started(address)
            workers[0].send_signal(signal.SIGKILL)
            out, error = running.communicate(timeout=300)
        self.assertEqual(running.returncode, 0, error)
        self.assertIn("58 done, 0 skipped, 2 failed", out.decode())
        self.assert_as_local()

    def test_one_sensors_recordings_on_two_workers_one_of_them_killed_make_the_local_table(self):
        fleet_test.BySensor.day(self, samples=3000, missing=7)
        by_sensor = ("--by", "sensor")
        self.succeed("fleet", "noise", "manifest.csv", "--into", "one", *by_sensor)
        with self.cluster() as (address, workers):
            running = subprocess.Popen([PROGRAM, *self.flags(address), *by_sensor], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            while len(list((self.folder / "results").glob("sums/*.card"))) < 5:
                self.assertIsNone(running.poll())
                time.sleep(0.02)
            workers[0].send_signal(signal.SIGKILL)
            out, error = running.communicate(timeout=300)
        self.assertEqual(running.returncode, 0, error)
        self.assertIn("1 done, 0 skipped, 0 failed", out.decode())
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "results" / name).read_bytes(), name)

    HOURS, RATE_HZ = fleet_test.BySensor.HOURS, fleet_test.BySensor.RATE_HZ

    def test_interrupted_it_leaves_what_is_done_and_goes_on_from_there(self):
        self.fleet(sensors=10, files=6)
        with self.cluster() as (address, _):
            running = self.started(address)
            running.send_signal(signal.SIGINT)
            self.assertEqual(running.wait(timeout=60), INTERRUPTED)
            done = len(self.journal())
            self.assertLess(done, 60)
            document = self.document(*self.flags(address))
        self.assertEqual(self.counts(document), (60, 60 - done, done, 0))
        self.assert_as_local()

    def test_what_a_url_names_the_worker_fetches(self):
        self.fleet(sensors=2, files=1)
        manifest = self.folder / "manifest.csv"
        manifest.write_text(manifest.read_text().replace("\nr", f"\nfile://{self.folder}/r"))
        with self.cluster() as (address, _):
            document = self.document(*self.flags(address))
            self.assertEqual(self.counts(document), (2, 2, 0, 0))
            self.assertEqual(self.counts(self.document(*self.flags(address))), (2, 0, 2, 0))
        self.assertEqual(sorted(entry["inputs"][0]["path"] for entry in self.journal()), [f"file://{self.folder}/r000{k}.csv" for k in (0, 1)])

    def test_one_that_takes_too_long_or_has_no_program_is_named(self):
        self.recording("a.csv")
        os.mkfifo(self.folder / "b.csv")  # nobody writes into it
        self.write("manifest.csv", "path\na.csv\nb.csv\n")
        with self.cluster() as (address, _):
            document = self.document(*self.flags(address), "--timeout", "2")
            self.assertEqual(self.counts(document), (2, 1, 0, 1))
            self.assertIn("took longer than 2 s", document["failed"][0]["reason"])
            error = self.expect_failure(3, *self.flags(address)[:-1], "/nowhere/proofmass", "--force", "--timeout", "2")
            self.assertIn("/nowhere/proofmass", error)

    def test_the_notebook_of_the_page_does_the_same(self):
        self.fleet(sensors=8, files=2, broken=(3,))
        shutil.rmtree(self.folder / "results", ignore_errors=True)
        with self.cluster() as (address, _):
            code = page.script("python", "pm.fleet.run").replace("tcp://127.0.0.1:8786", address)
            environment = {**os.environ, "PROOFMASS": PROGRAM, "PATH": f"{os.path.dirname(PROGRAM)}:{os.environ['PATH']}"}
            code = code.replace("gravity=9.80665", f"program={PROGRAM!r}")
            ran = subprocess.run([sys.executable, "-c", code], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=300)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        counts, outliers = ran.stdout.splitlines()
        self.assertTrue(counts.startswith("16 15 [('r0003.csv', "), counts)
        self.assertEqual({sensor for sensor, figure in ast.literal_eval(outliers)}, {"S03"})
        self.assertIn("Out of family", (self.folder / "summary.html").read_text())

    def test_no_scheduler_is_said_in_one_line(self):
        self.fleet(sensors=1, files=1)
        error = self.expect_failure(FAILED, *self.flags("tcp://127.0.0.1:9"))
        self.assertIn("--dask: the driver ended before its jobs", error)
        self.assertIn("127.0.0.1:9", error)


if __name__ == "__main__":
    unittest.main()
