"""proofmass thesis: fully simulated, and on recordings of the twin."""
import html.parser
import itertools
import math
import random
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from command import BAD_INPUT, PROGRAM, USAGE, CommandTest, parse_json

G = 9.80665
IDS = ["table 2.1", "figure 4.3", "figure 4.5", "table 4.1", "figure 4.6", "figure 5.2", "figure 5.3", "figure 5.4", "figure 5.5",
       "figure 5.6", "table 5.1", "figure 5.7", "figure 5.8", "figure 5.9", "figure 5.10", "figure 5.12", "figure 5.13",
       "figure 5.14", "figure 5.15", "figure 5.16", "figure 5.17", "figure 5.18", "figure 5.19", "section 6.1", "section 6.2",
       "table A.1", "section A.2"]
QUICK = ("--runs", "2", "--static-hours", "0.2")


class Links(html.parser.HTMLParser):
    """Ids, links to them, and resources that would be fetched."""

    def __init__(self):
        super().__init__()
        self.ids, self.targets, self.fetched = [], [], []

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.ids += [found["id"]] if "id" in found else []
        if tag == "a":
            self.targets.append(found["href"])
        if tag in ("link", "img", "iframe") or "src" in found:
            self.fetched.append(tag)


def tumble_table():
    """Volts of two axes at 0 to 270 degrees: 20 mg of bias and a scale factor of 0.33 V/g on x."""
    rows = ["angle_deg,x (V),y (V)"]
    for degrees in (0, 90, 180, 270):
        phi = math.radians(degrees)
        rows.append(f"{degrees},{1.65 + 0.33 * (0.02 + math.sin(phi)):.6f},{1.65 - 0.331 * (math.cos(phi) - 0.01):.6f}")
    return "\n".join(rows) + "\n"


def rest(seconds=600, rate_hz=20):
    """Two level axes in m/s2 with white noise and the warm-up of table 4.1."""
    draw = random.Random(4)
    rows = ["time (s),acc_x (m/s2),acc_y (m/s2)"]
    for k in range(seconds * rate_hz):
        bias = -0.21 + 0.25 * (1.0 - math.exp(-k / rate_hz / 70.0))
        rows.append(f"{k / rate_hz:.3f},{bias + draw.gauss(0.0, 0.01):.6f},{bias + draw.gauss(0.0, 0.01):.6f}")
    return "\n".join(rows) + "\n"


class Thesis(CommandTest):
    @classmethod
    def setUpClass(cls):
        """One run for all tests of its output."""
        cls.shared = Path(tempfile.mkdtemp(prefix="proofmass-cli-"))
        cls.addClassCleanup(shutil.rmtree, cls.shared)
        files = {"--json": cls.shared / "t.json", "--report": cls.shared / "t.html"}
        cls.ran = subprocess.run([PROGRAM, "thesis", *QUICK, *itertools.chain(*files.items())], capture_output=True, timeout=250)
        cls.text = cls.ran.stdout.decode()

    def setUp(self):
        super().setUp()
        self.assertEqual(self.ran.returncode, 0, self.ran.stderr.decode())

    def test_every_table_and_figure_is_there_with_all_three_texts(self):
        document = parse_json((self.shared / "t.json").read_text())
        self.check_document("thesis", document)
        self.assertEqual([item["id"] for item in document["items"]], IDS)
        self.assertEqual(document["simulated"], ["static", "tumble", "wheel"])
        for item in document["items"]:
            self.assertLessEqual(set(item["thesis"]["values"]), set(item["ours"]["values"]), item["id"])

    def test_the_page_leads_to_each_of_them_and_fetches_nothing(self):
        page = (self.shared / "t.html").read_text()
        links = Links()
        links.feed(page)
        self.assertEqual(len(links.ids), len(set(links.ids)))
        self.assertLessEqual({target.removeprefix("#") for target in links.targets}, set(links.ids))
        self.assertLessEqual({identity.replace(" ", "-") for identity in IDS}, set(links.ids))
        self.assertEqual(links.fetched, [])
        self.assertLess(len(page.encode()), 2_000_000)

    def test_the_text_is_short_enough_to_read(self):
        lines = self.text.splitlines()
        self.assertLessEqual(len(lines), 90)
        for chapter in ("Chapter 2.", "Chapter 4.", "Chapter 5.", "Chapter 6.", "Appendix A"):
            self.assertTrue(any(line.startswith(chapter) for line in lines), chapter)

    def test_table_2_1_is_half_b_t_squared_in_all_sixteen_cells(self):
        items = {item["id"]: item for item in parse_json((self.shared / "t.json").read_text())["items"]}
        errors = sorted(cell["value"] for cell in items["table 2.1"]["ours"]["values"].values() if cell["unit"] == "m")
        expected = sorted(0.5 * mg * 1e-3 * G * t**2 for mg in (0.025, 0.3, 3.0, 125.0) for t in (1, 10, 60, 3600))
        self.assertEqual(len(errors), 16)
        for error, right in zip(errors, expected, strict=True):
            self.assertAlmostEqual(error / right, 1.0, places=9)

    def test_the_same_seed_gives_the_same_document(self):
        shared = self.without_provenance(parse_json((self.shared / "t.json").read_text()))
        again = parse_json(self.succeed("thesis", *QUICK, "--seed", "1", "--json", "-"))
        self.assertEqual(self.without_provenance(again), shared)
        other = self.document("thesis", *QUICK, "--seed", "2")
        self.assertNotEqual(other["items"], shared["items"])

    def test_recordings_of_ones_own_take_the_place_of_simulated_ones(self):
        self.succeed("simulate", "--rpm", "11", "--duration", "30", "--seed", "3", "-o", "11.csv")
        self.write("rest.csv", rest())
        self.write("positions.csv", tumble_table())
        document = self.document("thesis", *QUICK, "--static", "rest.csv", "--tumble", "positions.csv", "--wheel", "11.csv",
                                 "--radius", "0.1")
        self.assertEqual(document["input"], ["rest.csv", "positions.csv", "11.csv"])
        self.assertEqual(document["simulated"], [])
        self.assertEqual([item["id"] for item in document["items"]], IDS)
        values = {item["id"]: item["ours"]["values"] for item in document["items"]}
        warm_up = values["table 4.1"]
        for name, truth in (("a1", 0.25), ("a2", -0.21), ("time_constant", 70.0)):
            self.assertAlmostEqual(warm_up[name]["value"], truth, delta=4.0 * warm_up[name]["std"])

    def test_a_file_that_is_not_there_is_named(self):
        for flag in ("--static", "--tumble", "--wheel"):
            self.assertIn("missing.csv", self.expect_failure(BAD_INPUT, "thesis", *QUICK, flag, "missing.csv"))

    def test_readings_in_volts_at_rest_need_a_sensor_file(self):
        self.write("volts.csv", "time (s),acc_x (V)\n" + "".join(f"{k / 10},{1.65 + 0.001 * (k % 7)}\n" for k in range(600)))
        error = self.expect_failure(USAGE, "thesis", *QUICK, "--static", "volts.csv")
        for word in ("volts.csv", "acc_x", "--sensor"):
            self.assertIn(word, error)

    def test_usage_is_held_to(self):
        for wrong in (("--runs", "1"), ("--runs", "2.5"), ("--static-hours", "0"), ("--radius", "-1"), ("--angles", "0,90"), ("a.csv",),
                      ("--static", "-", "--tumble", "-")):
            self.expect_failure(USAGE, "thesis", *wrong)


if __name__ == "__main__":
    unittest.main()
