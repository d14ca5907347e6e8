"""proofmass noise, on synthetic recordings with known noise."""
import csv
import math
import random
import unittest

from command import BAD_DATA, BAD_INPUT, USAGE, CommandTest, parse_json

G = 9.80665


def white(samples, sigma, seed, mean=0.0):
    draw = random.Random(seed)
    return [mean + draw.gauss(0.0, sigma) for _ in range(samples)]


def table(columns, rate_hz=None):
    """CSV of {heading: values}, with a time column if a rate is given."""
    head = (["time (s)"] if rate_hz else []) + list(columns)
    lines = [",".join(head)]
    for k, row in enumerate(zip(*columns.values())):
        cells = ([f"{k / rate_hz:.5f}"] if rate_hz else []) + [f"{value:.9g}" for value in row]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"


def nbs14(count=1000):
    """The thousand-point test set of NIST SP 1065, section 12.4."""
    n, out = 1234567890, []
    for _ in range(count):
        n = 16807 * n % 2147483647
        out.append(n / 2147483647)
    # The set begins with the seed itself.
    return [1234567890 / 2147483647] + out[:-1]


class Noise(CommandTest):
    def rest(self, samples=20000, rate_hz=100.0, name="rest.csv"):
        """Three axes in g with 100, 200 and 400 µg/√Hz of white noise."""
        sigma = math.sqrt(rate_hz) * 1e-6
        axes = {f"acc_{axis} (g)": white(samples, density * sigma, seed, mean)
                for axis, density, seed, mean in (("x", 100, 1, 0.0), ("y", 200, 2, 0.0), ("z", 400, 3, 1.0))}
        return self.write(name, table(axes, rate_hz))

    def test_times_that_no_record_has_are_the_user_s_to_mend(self):
        self.rest()
        line = self.expect_failure(USAGE, "noise", "rest.csv", "--taus", "0.00001")
        self.assertIn("acc_x: no averaging time fits", line)

    def test_a_logger_that_repeats_its_last_row_adds_no_noise(self):
        values = white(20000, 1e-3, 5)
        for first in range(500, 20000, 2000):
            values[first:first + 200] = [values[first]] * 200
        self.write("stuck.csv", table({"acc_x (g)": values}, 100.0))
        channel = self.document("noise", "stuck.csv")["channels"][0]
        found = channel["parameters"]["white"]
        self.assertEqual(channel["missing"], 10 * 199)
        self.assertAlmostEqual(found["value"], 1e-4 * G, delta=3 * found["std"])
        self.assertEqual(channel["parameters"]["flicker"]["verdict"], "not_observable")

    def test_rows_written_twice_count_once(self):
        text = table({"acc_x (g)": white(5000, 1e-3, 6)}, 100.0).splitlines(keepends=True)
        self.write("twice.csv", "".join(line * (1 + (k % 50 == 49)) for k, line in enumerate(text)))
        document = self.document("noise", "twice.csv")
        self.assertEqual(document["channels"][0]["samples"], 5000)
        self.assertEqual(document["channels"][0]["rate_hz"], 100.0)
        self.assertTrue(any("rows repeat the one before" in note for note in document["warnings"]))

    def test_white_noise_is_found_in_si_within_its_std(self):
        self.rest()
        document = self.document("noise", "rest.csv")
        self.assertEqual([c["name"] for c in document["channels"]], ["acc_x", "acc_y", "acc_z"])
        for channel, density in zip(document["channels"], (100e-6, 200e-6, 400e-6)):
            found = channel["parameters"]["white"]
            self.assertEqual(channel["unit"], "m/s^2")
            self.assertEqual(found["unit"], "m/s^2/sqrt(Hz)")
            self.assertEqual(found["verdict"], "identified")
            self.assertAlmostEqual(found["value"], density * G, delta=4 * found["std"])
            self.assertLess(found["std"], 0.05 * found["value"])
            self.assertAlmostEqual(found["one_sided_density"], found["value"] * math.sqrt(2))
            floor = channel["spectrum_floor"]
            one_sided = density * G * math.sqrt(2)
            self.assertAlmostEqual(floor["value"], one_sided, delta=0.12 * one_sided)
            self.assertEqual(channel["parameters"]["random_walk"]["verdict"], "not_observable")
            self.assertEqual(channel["parameters"]["random_walk"]["value"], 0.0)
            self.assertGreater(channel["parameters"]["random_walk"]["upper_95"], 0.0)
            variance = channel["filter"]["sample_variance"]["value"]
            self.assertAlmostEqual(variance, found["value"] ** 2 * 100.0, delta=1e-9)
        self.assertAlmostEqual(document["channels"][2]["mean"], G, delta=1e-3)

    def test_the_curve_is_within_its_limits_and_the_table_has_it(self):
        self.rest()
        document = self.document("noise", "rest.csv", "--taus", "octave", "--output", "curve.csv")
        with open(self.folder / "curve.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0][0], "tau_s")
        self.assertEqual(len(rows[0]), 10)
        points = document["channels"][0]["deviation"]["points"]
        self.assertEqual(len(rows) - 1, len(points))
        for row, point in zip(rows[1:], points):
            self.assertAlmostEqual(float(row[0]), point["tau_s"])
            self.assertAlmostEqual(float(row[1]), point["value"])
            self.assertLess(point["lower"], point["value"])
            self.assertLess(point["value"], point["upper"])

    def test_a_channel_can_be_chosen_and_a_config_can_hold_the_flags(self):
        self.rest()
        self.write("c.toml", '[noise]\ntaus = "1,2,10"\nstatistic = "mdev"\n')
        document = self.document("noise", "rest.csv", "--channel", "acc_y", "--config", "c.toml")
        self.assertEqual([c["name"] for c in document["channels"]], ["acc_y"])
        curve = document["channels"][0]["deviation"]
        self.assertEqual(curve["statistic"], "mdev")
        self.assertEqual([round(p["tau_s"], 6) for p in curve["points"]], [1, 2, 10])

    def test_one_bare_column_needs_a_rate_and_no_name(self):
        self.write("nbs14.dat", "# NBS14\n" + "\n".join(repr(y) for y in nbs14()) + "\n")
        line = self.expect_failure(USAGE, "noise", "nbs14.dat")
        self.assertIn("--rate", line)
        for statistic, expected in (("adev", (2.922319e-1, 9.965736e-2, 3.897804e-2)),
                                    ("oadev", (2.922319e-1, 9.159953e-2, 3.241343e-2)),
                                    ("mdev", (2.922319e-1, 6.172376e-2, 2.170921e-2)),
                                    ("ohdev", (2.943883e-1, 9.581083e-2, 3.237638e-2))):
            document = self.document("noise", "nbs14.dat", "--rate", "1", "--taus", "1,10,100",
                                     "--statistic", statistic)
            points = document["channels"][0]["deviation"]["points"]
            self.assertEqual(document["channels"][0]["unit"], "1")
            for point, value in zip(points, expected):
                self.assertAlmostEqual(point["uncorrected"], value, delta=1e-6 * value + 1e-8)

    def test_phase_is_the_sum_of_the_rate(self):
        rate = nbs14()
        phase = [0.0]
        for y in rate:
            phase.append(phase[-1] + y)
        self.write("rate.dat", "\n".join(map(repr, rate)) + "\n")
        self.write("phase.dat", "\n".join(map(repr, phase)) + "\n")
        a = self.document("noise", "rate.dat", "--rate", "1", "--taus", "octave")
        b = self.document("noise", "phase.dat", "--rate", "1", "--taus", "octave", "--data", "phase")
        for one, other in zip(a["channels"][0]["deviation"]["points"],
                              b["channels"][0]["deviation"]["points"]):
            self.assertAlmostEqual(one["value"], other["value"], places=9)

    def test_missing_samples_and_gaps_change_little_and_are_counted(self):
        rows = table({"acc_x (g)": white(20000, 1e-3, 5)}, 100.0).splitlines()
        for k in range(5000, 5020):
            rows[k] = rows[k].split(",")[0] + ",nan"
        rows[7000] = rows[7000].split(",")[0] + ",3e34"
        del rows[9000:9100]
        self.write("a.csv", "\n".join(rows) + "\n")
        channel = self.document("noise", "a.csv")["channels"][0]
        self.assertEqual(channel["missing"], 121)
        self.assertEqual(channel["samples"], 20000)
        found = channel["parameters"]["white"]
        self.assertAlmostEqual(found["value"], 1e-4 * G, delta=4 * found["std"])

    def test_a_line_is_named_and_kept_out_of_the_white_noise(self):
        values = [y + 1e-3 * math.sin(2 * math.pi * 0.7 * k / 100)
                  for k, y in enumerate(white(40000, 2e-3, 6))]
        self.write("a.csv", table({"acc_x (g)": values}, 100.0))
        channel = self.document("noise", "a.csv")["channels"][0]
        self.assertEqual(len(channel["lines"]), 1)
        self.assertAlmostEqual(channel["lines"][0]["frequency_hz"], 0.7, delta=0.02)
        self.assertAlmostEqual(channel["lines"][0]["amplitude"], 1e-3 * G, delta=0.05e-3 * G)
        found = channel["parameters"]["white"]
        self.assertAlmostEqual(found["value"], 2e-4 * G, delta=4 * found["std"])
        self.assertIn("Hz raises the deviation near 0.5", self.succeed("noise", "a.csv"))

    def test_a_temperature_is_taken_out(self):
        samples = 20000
        warm = [25.0 + 5.0 * (1.0 - math.exp(-k / 5000)) for k in range(samples)]
        values = [y + 2e-3 * (t - 25.0) for y, t in zip(white(samples, 1e-3, 7), warm)]
        self.write("a.csv", table({"acc_x (g)": values, "temp (degC)": warm}, 100.0))
        channel = self.document("noise", "a.csv", "--temperature", "temp")["channels"][0]
        effect = channel["temperature"]
        self.assertEqual(effect["coefficient"]["unit"], "m/s^2/K")
        self.assertAlmostEqual(effect["coefficient"]["value"], 2e-3 * G,
                               delta=5 * effect["coefficient"]["std"])
        self.assertEqual(channel["parameters"]["ramp"]["verdict"], "not_observable")
        without = self.document("noise", "a.csv")["channels"]
        self.assertEqual([c["name"] for c in without], ["acc_x"])

    def test_a_channel_that_cannot_be_judged_says_why_and_the_others_go_on(self):
        values = white(20000, 1e-3, 8)
        self.write("a.csv", table({"acc_x (g)": values, "acc_y (g)": [0.01] * len(values)}, 100.0))
        ran = self.run_command("noise", "a.csv", "--json", "-")
        self.assertEqual(ran.returncode, 0)
        document = parse_json(ran.stdout.decode())
        self.check_document("noise", document)
        self.assertEqual(document["channels"][0]["parameters"]["white"]["verdict"], "identified")
        self.assertIsNone(document["channels"][1]["deviation"])
        self.assertIsNone(document["channels"][1]["parameters"])
        self.assertEqual(self.run_command("noise", "a.csv", "--strict").returncode, BAD_DATA)

    def test_coarse_steps_and_rails_are_refused(self):
        coarse = [round(y / 0.01) * 0.01 for y in white(20000, 0.0022, 9)]
        clipped = [max(-5e-4, min(5e-4, y)) for y in white(20000, 1e-3, 10)]
        self.write("a.csv", table({"acc_x (g)": coarse, "acc_y (g)": clipped}, 100.0))
        document = self.refused_document("noise", "a.csv")
        for channel in document["channels"]:
            self.assertIsNone(channel["deviation"])
        reasons = "\n".join(document["warnings"])
        self.assertIn("step", reasons)
        self.assertIn("rails", reasons)

    def test_a_sensor_file_takes_the_figures(self):
        self.rest()
        self.succeed("noise", "rest.csv", "--update-sensor", "mine.toml")
        text = (self.folder / "mine.toml").read_text()
        self.assertIn("[noise]", text)
        self.assertIn("proofmass noise rest.csv", text)
        self.assertEqual(self.leftovers(), [])
        self.write("bare.dat", "\n".join(map(repr, nbs14())) + "\n")
        self.expect_failure(USAGE, "noise", "bare.dat", "--rate", "1", "--update-sensor", "b.toml")

    def test_the_page_has_two_figures_for_each_channel(self):
        self.rest(samples=5000)
        text = self.succeed("noise", "rest.csv", "--report", "r.html")
        self.assertIn("White noise", text)
        page = (self.folder / "r.html").read_text()
        self.assertEqual(page.count("</svg>"), 6)
        self.assertIn("White noise: acc_x", page)

    def test_the_same_recording_gives_the_same_bytes(self):
        self.rest(samples=5000)
        def digits():
            text = self.succeed("noise", "rest.csv", "--json", "-")
            return text[:text.index('"provenance"')]  # which contains the time of day

        self.assertEqual(digits(), digits())

    def test_the_limits_hang_on_the_noise_type_that_was_asked_for(self):
        self.rest(samples=5000)
        flags = ("--channel", "acc_x", "--taus", "octave")
        fixed = self.document("noise", "rest.csv", *flags, "--noise-type", "-2")
        points = fixed["channels"][0]["deviation"]["points"]
        self.assertEqual({p["alpha"] for p in points}, {-2})
        lag1 = self.document("noise", "rest.csv", *flags, "--noise-type", "lag1")
        self.assertEqual(lag1["channels"][0]["deviation"]["points"][0]["alpha_lag1"], 0)
        wide = self.document("noise", "rest.csv", *flags, "--confidence", "0.95")
        narrow = self.document("noise", "rest.csv", *flags)
        for a, b in zip(wide["channels"][0]["deviation"]["points"],
                        narrow["channels"][0]["deviation"]["points"]):
            self.assertGreater(a["upper"], b["upper"])

    def test_flags_that_make_no_sense_are_refused(self):
        self.rest(samples=500)
        for flags in (("--taus", "sometimes"), ("--taus", "1,,2"), ("--taus", "0-per-decade"),
                      ("--taus", "-1"), ("--statistic", "nodev"), ("--noise-type", "3"),
                      ("--data", "both"), ("--confidence", "1.5"), ("--stop-ratio", "0.5"),
                      ("--temperature", "none"), ("--channel", "acc_q")):
            self.expect_failure(USAGE, "noise", "rest.csv", *flags)

    def test_no_recording_is_no_crash(self):
        self.expect_failure(BAD_INPUT, "noise", "nowhere.csv")
        self.write("tiny.csv", "acc_x (g)\n0.1\n0.2\n")
        document = self.refused_document("noise", "tiny.csv", "--rate", "10")
        self.assertIsNone(document["channels"][0]["deviation"])


if __name__ == "__main__":
    unittest.main()
