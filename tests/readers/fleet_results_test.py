"""The queries and the Kubernetes Job of docs/fleet.md: by DuckDB, and against the schema of Kubernetes."""
import json
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE.parent / "cli"), str(HERE.parent / "fleet")]
import page  # noqa: E402
from duckdb_sql import LIBRARY, query  # noqa: E402
from fleet_test import FleetTest  # noqa: E402

MODELS = HERE / "node_modules" / "kubernetes-models"


class DuckDb(FleetTest):
    @unittest.skipUnless(LIBRARY.is_file(), f"SKIPPED, THE QUERIES ARE NOT RUN: {LIBRARY.name} is missing: tools/setup.sh test installs it")
    def test_the_queries_of_the_page_find_the_noisiest_sensors_and_the_reasons(self):
        self.fleet(sensors=8, files=2)
        self.succeed("fleet", "noise", "manifest.csv", "--into", "results")
        ask = lambda word: query(page.script("sql", word).replace("'results/", f"'{self.folder}/results/"))
        noisiest = ask("ORDER BY white")
        self.assertEqual(len(noisiest), 5)
        self.assertEqual((noisiest[0]["sensor"], noisiest[0]["channel"], noisiest[0]["recordings"]), ("S03", "acc_z", "2"))
        unknown = ask("flicker_verdict")
        entries = {entry["path"]: entry["rows"][0] for entry in self.journal()}
        self.assertEqual({row["file"] for row in unknown}, {path for path, row in entries.items() if row["flicker_verdict"] != "identified"})
        self.assertTrue(unknown)
        for row in unknown:
            self.assertAlmostEqual(float(row["flicker_upper_95"]), entries[row["file"]]["flicker_upper_95"], delta=1e-12)


class Kubernetes(FleetTest):
    def job(self, text):
        self.write("job.yaml", text)
        return subprocess.run(["node", HERE / "check_job.mjs", self.folder / "job.yaml"], capture_output=True, text=True, timeout=100)

    @unittest.skipUnless(shutil.which("node") and MODELS.is_dir(), "SKIPPED, THE JOB IS NOT HELD AGAINST ITS SCHEMA: node or kubernetes-models is missing: tools/setup.sh test installs them")
    def test_the_job_of_the_page_fits_the_schema_and_its_pods_do_all_recordings(self):
        text = page.script("yaml", "completionMode")
        self.assertNotEqual(self.job(text.replace("completions: 4", "completions: four")).returncode, 0)
        checked = self.job(text)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        spec = json.loads(checked.stdout)["spec"]
        (container,) = spec["template"]["spec"]["containers"]
        self.fleet(sensors=5, files=3, broken=(4,))
        self.succeed("fleet", "noise", "manifest.csv", "--into", "one")
        self.assertEqual(container["command"][0], "proofmass")
        for index in range(spec["completions"]):
            self.succeed(*container["command"][1:], environment={"JOB_COMPLETION_INDEX": str(index)})
        self.summary("results")
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "results" / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()
