"""proofmass fleet: a verb for many recordings."""
import datetime
import json
import os
import random
import signal
import subprocess
import time
import unittest

from command import BAD_DATA, BAD_INPUT, DONE, INTERRUPTED, PROGRAM, USAGE, CommandTest, parse_json

OUT_OF_FAMILY = ("S03", "S11", "S17")


class FleetTest(CommandTest):
    def recording(self, name, std=0.01, rows=400, seed=1):
        draw = random.Random(seed)
        self.write(name, "time (s),acc_z (m/s^2)\n" + "".join(f"{k / 100:.2f},{9.8 + draw.gauss(0, std):.6f}\n" for k in range(rows)))

    def fleet(self, sensors=20, files=5, broken=()):
        """A table of recordings: three sensors of twenty have half as much noise again as the others' scatter allows."""
        draw = random.Random(5)
        level = {f"S{k:02d}": 0.01 * (1 + 0.03 * draw.gauss(0, 1)) for k in range(sensors)}
        for name in OUT_OF_FAMILY:
            if name in level:
                level[name] *= 1.6
        lines = ["path,sensor,serial,temperature,date"]
        for k in range(sensors * files):
            sensor = f"S{k % sensors:02d}"
            if k in broken:
                self.write(f"r{k:04d}.csv", "this is\nno recording\n")
            else:
                self.recording(f"r{k:04d}.csv", level[sensor], seed=k)
            lines.append(f"r{k:04d}.csv,{sensor},{k % sensors:04d},{20 + draw.uniform(0, 10):.1f},2026-{1 + k % 12:02d}-{1 + k % 28:02d}")
        self.write("manifest.csv", "\n".join(lines) + "\n")

    def journal(self, folder="results"):
        return [json.loads(line) for path in sorted((self.folder / folder).glob("journal*.ndjson"))
                for line in path.read_text().splitlines()]

    def summary(self, *arguments):
        document = parse_json(self.succeed("fleet", "summary", *arguments, "--json", "-"))
        self.check_document("fleet_summary", document)
        return document

    def counts(self, document):
        return document["jobs"], document["done"], document["skipped"], len(document["failed"])


class BySensor(FleetTest):
    """Recordings of a sensor that follow each other are analysed as one with gaps."""

    HOURS, RATE_HZ = 24, 12.5

    def day(self, samples, missing, own_clock=True, hours=HOURS):
        """`hours` files of equal length, each followed by missing samples; and all of them in one file. A walk and white noise."""
        draw = random.Random(11)
        level, whole = 0.0, []
        lines = ["path,sensor,date"]
        for k in range(hours):
            rows = []
            for n in range(samples + missing):
                level += draw.gauss(0, 0.002)
                if n < samples:
                    time_s = (k * (samples + missing) + n) / self.RATE_HZ
                    rows.append((time_s, f"{9.8 + level + draw.gauss(0, 0.01):.6f}"))
            whole += rows
            start_s = rows[0][0]
            self.write(f"h{k:02d}.csv", "time (s),acc_z (m/s^2)\n" + "".join(
                f"{time_s if own_clock else time_s - start_s:.2f},{value}\n" for time_s, value in rows))
            date = datetime.datetime(2026, 5, 1, tzinfo=datetime.timezone.utc) + datetime.timedelta(seconds=start_s)
            lines.append(f"h{k:02d}.csv,S1,{date.isoformat(timespec='milliseconds').replace('+00:00', 'Z')}")
        self.write("day.csv", "time (s),acc_z (m/s^2)\n" + "".join(f"{t:.2f},{value}\n" for t, value in whole))
        self.write("manifest.csv", "\n".join([lines[0], *reversed(lines[1:])]) + "\n")

    def assert_same(self, joined, whole):
        points, others = (one["channels"][0]["deviation"]["points"] for one in (joined, whole))
        self.assertEqual(len(points), len(others))
        self.assertGreater(len(points), 20)
        for point, other in zip(points, others):
            self.assertAlmostEqual(point["tau_s"] / other["tau_s"], 1.0, delta=1e-12)
            self.assertAlmostEqual(point["value"] / other["value"], 1.0, delta=1e-12)
        found, other = (one["channels"][0]["parameters"] for one in (joined, whole))
        for name in ("white", "random_walk"):
            self.assertEqual(found[name]["verdict"], "identified")
            self.assertAlmostEqual(found[name]["value"] / other[name]["value"], 1.0, delta=1e-6)

    def sums(self, folder="results"):
        return sorted((self.folder / folder / "sums").glob("*.sums"))

    def join(self, *sums):
        return self.document("noise", *map(str, sums), "--as-one")

    def joined(self, *flags):
        document = self.document("fleet", "noise", "manifest.csv", "--by", "sensor", "--into", "results", *flags)
        self.assertEqual(self.counts(document), (1, 1, 0, 0))
        (path,) = (self.folder / "results/documents").glob("S1-*.json")
        return parse_json(path.read_text())

    def test_files_of_an_hour_are_the_recording_of_the_day(self):
        self.day(samples=400, missing=0)
        self.assert_same(self.joined(), self.document("noise", "day.csv"))

    def test_with_gaps_between_them_they_are_the_recording_with_these_gaps(self):
        self.day(samples=380, missing=7)
        self.assert_same(self.joined(), self.document("noise", "day.csv"))

    def test_where_each_file_begins_at_zero_the_dates_say_when_it_does(self):
        self.day(samples=380, missing=7, own_clock=False)
        self.assert_same(self.joined(), self.document("noise", "day.csv"))
        self.write("manifest.csv", (self.folder / "manifest.csv").read_text().replace("T", " at "))
        error = self.expect_failure(BAD_INPUT, "fleet", "noise", "manifest.csv", "--by", "sensor", "--into", "other")
        self.assertIn("before the end of the recording before it", error)

    def test_one_more_file_is_a_new_result_in_the_place_of_the_old_one(self):
        self.day(samples=400, missing=0, hours=3)
        flags = ("noise", "manifest.csv", "--by", "sensor", "--into", "results")
        self.write("manifest.csv", "path,sensor\nh00.csv,S1\nh01.csv,S1\n")
        self.assertEqual(self.counts(self.document("fleet", *flags)), (1, 1, 0, 0))
        self.write("manifest.csv", "path,sensor\nh00.csv,S1\nh01.csv,S1\nh02.csv,S1\n")
        self.assertEqual(self.counts(self.document("fleet", *flags)), (1, 1, 0, 0))
        self.assertEqual(self.counts(self.document("fleet", *flags)), (1, 0, 1, 0))
        self.assertEqual([entry["rows"][0]["deviation_statistic"] for entry in self.journal()][-1], "oadev")
        self.assertEqual(self.summary("results")["recordings"], 1)

    def test_what_does_not_fit_together_is_refused_with_the_reason(self):
        self.day(samples=400, missing=0, hours=3)
        self.write("other.csv", "time (s),acc_x (m/s^2)\n" + "".join(f"{100 + k / 10:.2f},{9.8 + k % 3}\n" for k in range(400)))
        self.write("fast.csv", "time (s),acc_z (m/s^2)\n" + "".join(f"{200 + k / 50:.2f},{9.8 + k % 3}\n" for k in range(400)))
        refusal = lambda *files: self.expect_failure(USAGE, "noise", *files, "--as-one")
        self.assertIn("it has no channel acc_z", refusal("h00.csv", "other.csv"))
        self.assertIn("it has 50 Hz", refusal("h00.csv", "fast.csv"))
        self.assertIn("before the end of the recording before it", refusal("h01.csv", "h00.csv"))
        self.assertIn("1 times for 2 files", self.expect_failure(USAGE, "noise", "h00.csv", "h01.csv", "--as-one", "--starts", "0"))
        self.assertIn("of noise alone", self.expect_failure(USAGE, "fleet", "inspect", "manifest.csv", "--by", "sensor", "--into", "r"))
        self.assertIn("has no batch", self.expect_failure(USAGE, "fleet", "noise", "manifest.csv", "--by", "batch", "--into", "r"))

    def test_shards_that_share_one_sensor_make_the_table_that_one_process_makes(self):
        self.day(samples=380, missing=7)
        flags = ("noise", "manifest.csv", "--by", "sensor", "--quiet")
        self.document("fleet", *flags, "--into", "one")
        for i in range(4):
            document = self.document("fleet", *flags, "--into", "four", "--shard", f"{i}/4")
            self.assertEqual((document["done"], document["waiting"]), (0, 1) if i < 3 else (1, 0))
        self.assertEqual(len(self.sums("four")), self.HOURS)
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "four" / name).read_bytes(), name)
        self.assertEqual(self.counts(self.document("fleet", *flags, "--into", "four", "--shard", "2/4")), (1, 0, 1, 0))

    def test_a_shard_that_was_killed_leaves_whole_sums_and_goes_on_from_them(self):
        self.day(samples=3000, missing=7, hours=12)
        flags = ("noise", "manifest.csv", "--by", "sensor", "--quiet", "-j", "1")
        self.document("fleet", *flags, "--into", "one")
        self.document("fleet", *flags, "--into", "two", "--shard", "0/2")
        kept = len(self.sums("two"))
        self.assertEqual(kept, 6)
        running = subprocess.Popen([PROGRAM, "fleet", *flags, "--into", "two", "--shard", "1/2"], cwd=self.folder, stdout=subprocess.DEVNULL)
        while len(self.sums("two")) < kept + 2 and running.poll() is None:
            time.sleep(0.005)
        running.send_signal(signal.SIGKILL)
        running.wait()
        for sums in self.sums("two"):
            head, rest = sums.read_bytes().split(b"\n", 1)
            self.assertEqual(len(rest), int(head.split()[5]), sums.name)
        self.document("fleet", *flags, "--into", "two", "--shard", "1/2")
        self.assertEqual((self.folder / "one/results.parquet").read_bytes(), (self.folder / "two/results.parquet").read_bytes())

    def test_the_order_of_the_sums_does_not_matter_and_missing_ones_are_a_gap(self):
        self.day(samples=380, missing=7)
        self.joined()
        whole = self.document("noise", "day.csv")
        sums = self.sums()
        random.Random(3).shuffle(sums)
        joined = self.join(*sums)
        self.assert_same(joined, whole)
        self.assertEqual(joined["input"], [f"h{k:02d}.csv" for k in range(self.HOURS)])
        self.assertEqual([one["path"] for one in joined["provenance"]["inputs"]], joined["input"])
        self.assertEqual(joined["channels"], self.join(*reversed(sums))["channels"])
        # Hours that are not in the manifest.
        (self.folder / "manifest.csv").write_text("".join(
            line for line in (self.folder / "manifest.csv").read_text().splitlines(True) if not line.startswith(("h07", "h15"))))
        shorter = self.document("fleet", "noise", "manifest.csv", "--by", "sensor", "--into", "results")
        self.assertEqual(self.counts(shorter), (1, 1, 0, 0))
        rows = (self.folder / "day.csv").read_text().splitlines(True)
        self.write("gappy.csv", "".join(rows[:1] + [row for k, row in enumerate(rows[1:]) if k // 380 not in (7, 15)]))
        (path,) = (self.folder / "results/documents").glob("S1-*.json")
        self.assert_same(parse_json(path.read_text()), self.document("noise", "gappy.csv"))

    def test_sums_that_are_not_whole_are_refused_in_one_line(self):
        self.day(samples=400, missing=0, hours=3)
        self.joined()
        first, second, third = self.sums()
        refusal = lambda *files, status=BAD_INPUT: self.expect_failure(status, "noise", *map(str, files), "--as-one")
        text = second.read_text()
        for length in (40, 200, len(text) // 2, len(text) - 1):
            second.write_text(text[:length])
            error = refusal(first, second, third)
            self.assertIn(second.name + ": sums of noise: ", error)
            self.assertEqual(error.strip().count("\n"), 0)
        second.write_text(text[:-20] + ("A" if text[-20] != "A" else "B") + text[-19:])
        self.assertIn("its checksum does not match", refusal(first, second, third))
        second.write_text(text)
        self.assertIn("of the recordings before it are not there", refusal(second, third))
        self.assertIn("were made with --statistic oadev", self.expect_failure(BAD_INPUT, "noise", str(first), "--as-one", "--statistic", "mdev"))
        cards = sorted((self.folder / "results/sums").glob("*.card"))
        self.assertIn("it has no sums yet", refusal(cards[0]))
        # The fleet makes what is cut off again.
        second.write_text(text[:100])
        flags = ("noise", "manifest.csv", "--by", "sensor", "--into", "results")
        self.assertEqual(self.counts(self.document("fleet", *flags, "--force")), (1, 1, 0, 0))
        self.assertEqual(second.read_text(), text)

    def test_a_recording_that_cannot_be_read_fails_its_sensor_by_name(self):
        self.day(samples=400, missing=0, hours=3)
        self.write("h01.csv", "the disk was full\n")
        ran = self.run_command("fleet", "noise", "manifest.csv", "--by", "sensor", "--into", "results", "--json", "-")
        self.assertEqual(ran.returncode, BAD_INPUT)
        document = parse_json(ran.stdout.decode())
        self.assertEqual(self.counts(document), (1, 0, 0, 1))
        self.assertIn("h01.csv: no row of numbers", document["failed"][0]["reason"])

    def test_the_share_at_rest_is_not_that_of_the_first_file(self):
        self.day(samples=1000, missing=0, hours=2)
        rest = lambda *words: self.document("noise", *words)["channels"][0]["rest"]
        self.assertIsNotNone(rest("h00.csv"))
        self.assertIsNone(rest("h00.csv", "h01.csv", "--as-one", "--starts", "0,3600"))

    def test_weeks_between_recordings_take_no_time(self):
        self.day(samples=400, missing=0, hours=2)
        starts = "0,6e5"  # a week; 7.5 million samples at this rate
        begun = time.monotonic()
        document = self.document("noise", "h00.csv", "h01.csv", "--as-one", "--starts", starts)
        self.assertLess(time.monotonic() - begun, 5.0)
        points = document["channels"][0]["deviation"]["points"]
        # Of terms within a recording, of whose samples one in sixteen may be missing.
        self.assertLessEqual(points[-1]["tau_s"], 17 / 16 * 400 / self.RATE_HZ / 2)


class Fleet(FleetTest):
    def test_every_recording_is_done_the_broken_are_named_and_the_odd_sensors_stand_out(self):
        broken = (7, 18, 33, 54, 91)
        self.fleet(broken=broken)
        document = self.document("fleet", "noise", "manifest.csv", "--into", "results")
        self.assertEqual(self.counts(document), (100, 95, 0, 5))
        self.assertEqual([job["file"] for job in document["failed"]], [f"r{k:04d}.csv" for k in broken])
        for job in document["failed"]:
            self.assertIn("no row of numbers", job["reason"])
        failures = [json.loads(line) for line in (self.folder / "results/failures.ndjson").read_text().splitlines()]
        self.assertEqual([job["file"] for job in failures], [f"r{k:04d}.csv" for k in broken])
        self.assertEqual(failures[0]["serial"], "0007")
        self.assertEqual(len(list((self.folder / "results/documents").iterdir())), 95)
        summary = self.summary("results", "--limit", "white<1.2e-3", "--report", "summary.html")
        self.assertEqual({one["sensor"] for one in summary["out_of_family"]}, set(OUT_OF_FAMILY))
        white = next(figure for figure in summary["figures"] if figure["name"] == "white")
        self.assertEqual((white["yield"][0]["within"], white["yield"][0]["sensors"]), (17, 20))
        low, high = white["type"]["mean"]["interval_95"]
        self.assertTrue(low < 0.01 / 100**0.5 < high)  # std / √rate
        page = (self.folder / "summary.html").read_text()
        links = {part.split('"')[0] for part in page.split('<a href="')[1:]}
        files = [link for link in links if not link.startswith("#")]
        self.assertEqual(len(files), 15 - 1)  # of three sensors with five recordings, one of which is broken
        for link in files:
            self.assertTrue((self.folder / link).exists(), link)

    def test_what_is_done_is_not_done_again_unless_something_changed(self):
        self.fleet(sensors=4, files=2)
        flags = ("noise", "manifest.csv", "--into", "results")
        self.assertEqual(self.counts(self.document("fleet", *flags)), (8, 8, 0, 0))
        self.assertEqual(self.counts(self.document("fleet", *flags)), (8, 0, 8, 0))
        self.recording("r0003.csv", seed=99)
        self.assertEqual(self.counts(self.document("fleet", *flags)), (8, 1, 7, 0))
        self.assertEqual(self.counts(self.document("fleet", *flags, "--taus", "octave")), (8, 8, 0, 0))
        self.assertEqual(self.counts(self.document("fleet", *flags, "--taus", "octave", "--force")), (8, 8, 0, 0))
        text = (self.folder / "manifest.csv").read_text().replace("S03", "S99")
        self.write("manifest.csv", text)
        self.assertEqual(self.counts(self.document("fleet", *flags, "--taus", "octave")), (8, 0, 8, 0))
        self.assertIn("S99", self.summary("results")["sensors"])

    def test_a_recording_has_its_own_flags(self):
        self.write("a.csv", "acc_x\n" + "".join(f"{random.Random(k).gauss(0, 1):.4f}\n" for k in range(500)))
        self.write("b.csv", "acc_x\n" + "".join(f"{random.Random(k).gauss(0, 1):.4f}\n" for k in range(500)))
        self.write("m.ndjson", '{"path": "a.csv", "flags": "--rate 50"}\n{"path": "b.csv"}\n')
        self.document("fleet", "inspect", "m.ndjson", "--rate", "200", "--unit", "g", "--into", "results")
        rates = {entry["path"]: entry["rows"][0]["rate_hz"] for entry in self.journal()}
        self.assertEqual(rates, {"a.csv": 50.0, "b.csv": 200.0})

    def test_a_folder_is_a_manifest_and_reports_are_written_where_they_are_asked_for(self):
        (self.folder / "in").mkdir()
        self.recording("in/a.csv")
        self.recording("in/b.csv", seed=2)
        self.document("fleet", "noise", "in", "--into", "results", "--reports")
        self.assertEqual(len(list((self.folder / "results/reports").glob("*.html"))), 2)

    def test_killed_at_any_moment_it_goes_on_and_has_every_result_once(self):
        self.fleet(sensors=10, files=3)
        command = [PROGRAM, "fleet", "noise", "manifest.csv", "--into", "results", "-q"]
        for delay in (0.15, 0.4, 0.7):
            running = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL)
            time.sleep(delay)
            running.send_signal(signal.SIGKILL)
            running.wait()
        document = self.document("fleet", "noise", "manifest.csv", "--into", "results")
        self.assertEqual(document["done"] + document["skipped"], 30)
        paths = [entry["path"] for entry in self.journal()]
        self.assertEqual(sorted(paths), [f"r{k:04d}.csv" for k in range(30)])
        self.assertFalse(list((self.folder / "results/documents").glob("*.part*")))

    def test_interrupted_it_leaves_what_is_done_in_the_tables(self):
        self.fleet(sensors=10, files=6)
        running = subprocess.Popen([PROGRAM, "fleet", "noise", "manifest.csv", "--into", "results"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        journal = self.folder / "results/journal.ndjson"
        while not (journal.exists() and journal.stat().st_size > 0):
            time.sleep(0.02)
        running.send_signal(signal.SIGINT)
        error = running.communicate(timeout=60)[1].decode()
        self.assertEqual(running.returncode, INTERRUPTED, error)
        self.assertIn("the same command goes on from there", error)
        self.assertTrue((self.folder / "results/results.parquet").exists())

    def test_shards_make_the_table_that_one_process_makes(self):
        self.fleet(sensors=5, files=3, broken=(4,))
        self.document("fleet", "noise", "manifest.csv", "--into", "one")
        for i in range(2):
            self.succeed("fleet", "noise", "manifest.csv", "--into", "four", "--shard", f"{i}/4")
        self.succeed("fleet", "noise", "manifest.csv", "--into", "four", "--shard", "4", environment={"JOB_COMPLETION_INDEX": "2"})
        self.succeed("fleet", "noise", "manifest.csv", "--into", "four",
                     environment={"SLURM_ARRAY_TASK_ID": "8", "SLURM_ARRAY_TASK_MIN": "5", "SLURM_ARRAY_TASK_COUNT": "4"})
        for name in ("results.parquet", "failures.ndjson"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "four" / name).read_bytes(), name)
        one, four = (self.summary(folder) for folder in ("one", "four"))
        self.assertEqual(one["figures"], four["figures"])

    def test_one_that_takes_too_long_is_named_and_the_others_are_done(self):
        self.recording("a.csv")
        os.mkfifo(self.folder / "b.csv")  # nobody writes into it
        self.write("m.csv", "path\na.csv\nb.csv\n")
        document = self.document("fleet", "inspect", "m.csv", "--into", "results", "--timeout", "4")
        self.assertEqual(self.counts(document), (2, 1, 0, 1))
        self.assertIn("took longer than 4 s", document["failed"][0]["reason"])

    def test_status_and_words_of_what_cannot_be(self):
        self.fleet(sensors=1, files=2, broken=(0,))
        self.assertIn("--rate", self.expect_failure(USAGE, "fleet", "noise", "manifest.csv", "--into", "r", "--rate", "x"))
        self.assertIn("--into", self.expect_failure(USAGE, "fleet", "noise", "manifest.csv"))
        self.assertIn("VERB", self.expect_failure(USAGE, "fleet", "simulate", "manifest.csv", "--into", "r"))
        self.assertIn("one file for all", self.expect_failure(USAGE, "fleet", "noise", "manifest.csv", "--into", "r", "-o", "x.csv"))
        self.assertIn("I below N", self.expect_failure(USAGE, "fleet", "noise", "manifest.csv", "--into", "r", "--shard", "4/4"))
        self.assertIn("cannot be opened", self.expect_failure(BAD_INPUT, "fleet", "noise", "nothing.csv", "--into", "r"))
        self.assertIn("holds no results", self.expect_failure(BAD_INPUT, "fleet", "summary", "nothing"))
        self.assertFalse((self.folder / "r").exists())
        self.assertEqual(self.run_command("fleet", "noise", "manifest.csv", "--into", "r", "--strict").returncode, BAD_DATA)
        self.write("m.csv", "path\nr0000.csv\n")
        ran = self.run_command("fleet", "noise", "m.csv", "--into", "s")
        self.assertEqual(ran.returncode, BAD_INPUT)
        self.assertIn("no recording could be analysed", ran.stderr.decode())


OF_THE_LONG_RUN = "SKIPPED, of the long run: PROOFMASS_FLEET_RECORDINGS is not set"


@unittest.skipUnless("PROOFMASS_FLEET_RECORDINGS" in os.environ, OF_THE_LONG_RUN)
class WholeDay(BySensor):
    def test_files_of_an_hour_are_the_recording_of_the_day(self):
        hour = int(3600 * self.RATE_HZ)
        self.day(samples=hour - 50, missing=50)
        self.assert_same(self.joined(), self.document("noise", "day.csv"))

    def test_files_of_an_hour_through_shards_are_the_recording_of_the_day(self):
        hour = int(3600 * self.RATE_HZ)
        self.day(samples=hour - 50, missing=50)
        for i in range(4):
            self.document("fleet", "noise", "manifest.csv", "--by", "sensor", "--into", "four", "--shard", f"{i}/4")
        (path,) = (self.folder / "four/documents").glob("S1-*.json")
        self.assert_same(parse_json(path.read_text()), self.document("noise", "day.csv"))
        sizes = [sums.stat().st_size for sums in self.sums("four")]
        print(f"sums of an hour at {self.RATE_HZ} Hz: {min(sizes)} to {max(sizes)} bytes")


@unittest.skipUnless("PROOFMASS_FLEET_RECORDINGS" in os.environ, OF_THE_LONG_RUN)
class ManyRecordings(FleetTest):
    def test_a_thousand_give_the_same_with_one_process_and_with_two(self):
        count = int(os.environ["PROOFMASS_FLEET_RECORDINGS"])
        self.fleet(files=count // 20, broken=(7, 118, 333, 554, 891))
        self.document("fleet", "noise", "manifest.csv", "--into", "one", "-j", "1")
        two = self.document("fleet", "noise", "manifest.csv", "--into", "two", "-j", "2")
        self.assertEqual(self.counts(two), (count, count - 5, 0, 5))
        self.assertEqual((self.folder / "one/results.parquet").read_bytes(), (self.folder / "two/results.parquet").read_bytes())
        summary = self.summary("two")
        self.assertEqual({one["sensor"] for one in summary["out_of_family"]}, set(OUT_OF_FAMILY))


if __name__ == "__main__":
    unittest.main()
