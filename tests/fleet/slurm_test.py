"""The array script of docs/fleet.md on a SLURM cluster."""
import os
import unittest
from pathlib import Path

import page
import slurm
from command import PROGRAM
import fleet_test
from fleet_test import FleetTest


@unittest.skipIf(slurm.missing(), f"SKIPPED, of the packages slurmctld, slurmd, slurm-client and munge: no {', '.join(slurm.missing())}")
class Slurm(FleetTest):
    def test_an_array_of_four_makes_the_tables_that_one_process_makes(self):
        self.fleet(sensors=6, files=4, broken=(4, 13))
        self.succeed("fleet", "noise", "manifest.csv", "--into", "one")
        self.write("fleet.sbatch", page.script("sh", "#SBATCH --array"))
        with slurm.Cluster(self.folder / "cluster") as cluster:
            cluster.environment["PATH"] = f"{Path(PROGRAM).parent}:{os.environ['PATH']}"
            cluster.call("sbatch", "--wait", "fleet.sbatch", cwd=self.folder)
        self.assertEqual(len(list((self.folder / "results").glob("journal-?-of-4.ndjson"))), 4)
        self.summary("results")
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "results" / name).read_bytes(), name)

    def test_an_array_of_four_that_shares_one_sensor_makes_the_table_of_one_process(self):
        fleet_test.BySensor.day(self, samples=380, missing=7)
        self.succeed("fleet", "noise", "manifest.csv", "--by", "sensor", "--into", "one")
        self.write("fleet.sbatch", page.script("sh", "#SBATCH --array").replace("manifest.csv", "manifest.csv --by sensor"))
        with slurm.Cluster(self.folder / "cluster") as cluster:
            cluster.environment["PATH"] = f"{Path(PROGRAM).parent}:{os.environ['PATH']}"
            cluster.call("sbatch", "--wait", "fleet.sbatch", cwd=self.folder)
        self.summary("results")
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "results" / name).read_bytes(), name)

    HOURS, RATE_HZ = fleet_test.BySensor.HOURS, fleet_test.BySensor.RATE_HZ


if __name__ == "__main__":
    unittest.main()
