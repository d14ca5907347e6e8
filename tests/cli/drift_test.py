"""proofmass drift, on synthetic recordings with known drift."""
import csv
import math
import random
import statistics
import tomllib
import unittest

from command import BAD_DATA, BAD_INPUT, USAGE, CommandTest

G = 9.80665
HOURS_2 = 7200


def white(samples, sigma, seed):
    draw = random.Random(seed)
    return [draw.gauss(0.0, sigma) for _ in range(samples)]


def random_walk(samples, step, seed):
    values, out = white(samples, step, seed), []
    level = 0.0
    for value in values:
        level += value
        out.append(level)
    return out


def warm_up(samples, a1, a2, time_constant, rate_hz=1.0, on_s=0.0):
    return [a2 + a1 * -math.expm1(-(k / rate_hz + on_s) / time_constant) for k in range(samples)]


def total(*series):
    return [sum(values) for values in zip(*series)]


def table(columns, rate_hz=1.0, without=()):
    """CSV of {heading: values} with a time column; rows in `without` are omitted."""
    lines = [",".join(["time (s)", *columns])]
    for k, row in enumerate(zip(*columns.values())):
        if k not in without:
            lines.append(f"{k / rate_hz:.5f}," + ",".join(f"{value:.9g}" for value in row))
    return "\n".join(lines) + "\n"


class Drift(CommandTest):
    def warming(self, name="warm.csv", samples=HOURS_2, seed=1, **how):
        """x: 5 mg over 900 s on 1.5 mg, in 1 mg of white noise."""
        x = total(warm_up(samples, 5e-3, 1.5e-3, 900.0), white(samples, 1e-3, seed))
        return self.write(name, table({"acc_x (g)": x}, **how))

    def wandering(self, name="walk.csv"):
        walk = total(random_walk(HOURS_2, 5e-5, 4), white(HOURS_2, 1e-3, 5))
        return self.write(name, table({"acc_x (g)": walk}))

    def expect_inside(self, channel, key, truth):
        lower, upper = channel["interval_95"][key]
        self.assertLess(lower, truth)
        self.assertLess(truth, upper)
        self.assertAlmostEqual(channel[key]["value"], truth, delta=4 * channel[key]["std"])

    def test_a_sensor_that_moves_is_said_before_any_figure(self):
        swing = [0.2 * math.sin(0.8 * k) if k > 2000 else 0.0 for k in range(6000)]
        self.write("swing.csv", table({"acc_x (g)": total(swing, white(6000, 1e-3, 2))}, rate_hz=10.0))
        text = self.succeed("drift", "swing.csv")
        self.assertLess(text.index("Not at rest"), text.index("a2"))
        self.assertEqual(self.run_command("drift", "swing.csv", "--strict").returncode, BAD_DATA)
        rest = self.document("drift", "swing.csv")["channels"][0]["rest"]
        self.assertFalse(rest["at_rest"])
        self.assertAlmostEqual(rest["longest"]["end_s"], 200.0, delta=2.0)

    def test_a_strong_warm_up_is_no_motion(self):
        x = total(warm_up(6000, 0.05, 0.0, 60.0, rate_hz=10.0), white(6000, 3e-4, 3))
        self.write("strong.csv", table({"acc_x (g)": x}, rate_hz=10.0))
        channel = self.document("drift", "strong.csv")["channels"][0]
        self.assertEqual(channel["verdict"], "identified")
        self.assertTrue(channel["rest"]["at_rest"])

    def test_a_warm_up_is_identified_in_si_with_the_truth_inside_the_intervals(self):
        self.warming()
        channel = self.document("drift", "warm.csv")["channels"][0]
        self.assertEqual(channel["name"], "acc_x")
        self.assertEqual(channel["unit"], "m/s^2")
        self.assertEqual(channel["model"], "exponential")
        self.assertEqual(channel["verdict"], "identified")
        self.expect_inside(channel, "a1", 5e-3 * G)
        self.expect_inside(channel, "a2", 1.5e-3 * G)
        self.expect_inside(channel, "time_constant_s", 900.0)
        self.assertEqual(channel["a1"]["unit"], "m/s^2")
        self.assertEqual(channel["time_constant_s"]["unit"], "s")
        self.assertLess(channel["time_constant_s"]["std"], 60.0)
        self.assertAlmostEqual(channel["residual_rms"], 1e-3 * G, delta=0.03e-3 * G)
        self.assertEqual([w["scale_s"] for w in channel["whiteness"]][:2], [1, 10])
        for test in channel["whiteness"]:
            self.assertGreater(test["ljung_box_p"], 1e-3)
            self.assertGreater(test["inside_bounds"], 0.8)

    def test_a_wander_is_no_warm_up_and_nothing_is_foretold_from_it(self):
        self.wandering()
        document = self.document("drift", "walk.csv", "--forecast", "10000")
        channel = document["channels"][0]
        self.assertEqual(channel["verdict"], "not_identified")
        self.assertNotEqual(channel["reason"], "")
        self.assertNotIn("exponential", channel["model"])
        for key in ("a1", "time_constant_s"):
            self.assertIsNone(channel[key])
            self.assertIsNone(channel["interval_95"][key])
        self.assertIsNone(channel["forecast"])
        warnings = "\n".join(document["warnings"])
        self.assertIn("a1", warnings)
        self.assertIn("forecast", warnings)

    def test_what_is_not_identified_is_no_failure_even_where_it_is_strict(self):
        self.wandering()
        self.succeed("drift", "walk.csv", "--strict")

    def test_a_forecast_holds_the_truth_inside_its_band(self):
        self.warming()
        forecast = self.document("drift", "warm.csv", "--forecast", "20000")["channels"][0]["forecast"]
        self.assertEqual(forecast["t_s"], 20000)
        truth = (1.5e-3 + 5e-3) * G
        self.assertLess(forecast["interval_95"][0], truth)
        self.assertLess(truth, forecast["interval_95"][1])
        line = self.expect_failure(USAGE, "drift", "warm.csv", "--forecast", "7000")
        self.assertIn("7200 s", line)

    def test_time_counts_from_switching_on_whatever_was_cut_off_before(self):
        x = total(warm_up(HOURS_2, 5e-3, 1.5e-3, 900.0, on_s=300.0), white(HOURS_2, 1e-3, 1))
        self.write("late.csv", table({"acc_x (g)": x}))
        channel = self.document("drift", "late.csv", "--since-switch-on", "300")["channels"][0]
        self.expect_inside(channel, "a1", 5e-3 * G)
        self.expect_inside(channel, "a2", 1.5e-3 * G)
        self.assertAlmostEqual(channel["start_s"], 300.0, delta=1.0)
        cut = self.document("drift", "late.csv", "--since-switch-on", "300", "--from", "200")
        self.assertAlmostEqual(cut["channels"][0]["start_s"], 500.0, delta=1.0)
        self.expect_inside(cut["channels"][0], "a2", 1.5e-3 * G)

    def test_stamps_with_a_gap_change_little_and_the_gap_is_counted(self):
        self.warming(without=range(3000, 3200))
        document = self.document("drift", "warm.csv")
        channel = document["channels"][0]
        self.assertEqual(channel["missing"], 200)
        self.assertEqual(channel["verdict"], "identified")
        self.expect_inside(channel, "time_constant_s", 900.0)
        self.assertIn("200 samples missing", "\n".join(document["warnings"]))

    def test_a_rate_stands_for_a_time_column(self):
        x = total(warm_up(4 * HOURS_2, 5e-3, 1.5e-3, 900.0, rate_hz=4.0), white(4 * HOURS_2, 2e-3, 2))
        self.write("bare.csv", "acc_x\n" + "\n".join(f"{1e3 * value:.6g}" for value in x) + "\n")
        self.expect_failure(USAGE, "drift", "bare.csv")
        channel = self.document("drift", "bare.csv", "--rate", "4", "--unit", "mg")["channels"][0]
        self.expect_inside(channel, "time_constant_s", 900.0)
        self.assertAlmostEqual(channel["duration_s"], HOURS_2, delta=1.0)

    def runs_that_warm_up(self, count=40):
        """run1.csv …: means that follow −2 mg (1 − e^(−n/5)) in 0.1 mg of scatter; in the shell's sort order."""
        scatter = white(count, 1e-4, 3)
        for k in range(count):
            level = -2e-3 * -math.expm1(-k / 5.0) + scatter[k]
            self.write(f"run{k + 1}.csv", table({"acc_x (g)": total([level] * 300, white(300, 5e-4, 100 + k))}))
        return sorted(f"run{k + 1}.csv" for k in range(count))

    def test_files_are_taken_by_the_numbers_in_their_names_and_show_the_warm_up_over_the_runs(self):
        names = self.runs_that_warm_up()
        document = self.document("drift", *names)
        runs = document["runs"][0]
        self.assertEqual([level["name"] for level in runs["levels"]], [f"run{k + 1}.csv" for k in range(40)])
        self.assertIn("not in the order given", "\n".join(document["notes"]))
        curve = runs["level_curve"]
        self.assertEqual(curve["verdict"], "identified", curve["reason"])
        for key, truth in (("a1", -2e-3 * G), ("a2", 0.0), ("time_constant_runs", 5.0)):
            self.assertAlmostEqual(curve[key]["value"], truth, delta=4 * curve[key]["std"])
            lower, upper = curve["interval_95"][key]
            self.assertLess(lower, upper)
        self.assertLess(curve["time_constant_runs"]["std"], 1.0)
        self.assertLess(runs["trend_p"], 1e-3)
        given = self.document("drift", *names, "--order", "given")
        self.assertEqual([level["name"] for level in given["runs"][0]["levels"]], names)

    def test_of_many_files_the_summary_comes_first_and_each_run_on_request(self):
        names = self.runs_that_warm_up(14)
        text = self.succeed("drift", *names)
        self.assertTrue(text.startswith("acc_x over 14 runs"), text)
        self.assertLess(len(text.splitlines()), 20)
        self.assertIn("-v prints each", text)
        self.assertIn("run14.csv: acc_x:\n", self.succeed("drift", *names, "-v"))

    def test_a_table_of_means_is_a_record(self):
        means = total(warm_up(30, 5e-3, 1e-3, 4.0), white(30, 1e-4, 8))
        self.write("means.csv", table({"acc_x (g)": means}))
        channel = self.document("drift", "means.csv")["channels"][0]
        self.assertEqual(channel["verdict"], "identified", channel["reason"])
        self.expect_inside(channel, "time_constant_s", 4.0)
        self.write("short.csv", table({"acc_x (g)": means[:11]}))
        self.assertIn("at least 12", self.refused_document("drift", "short.csv")["channels"][0]["reason"])

    def test_one_period_of_a_sine_is_a_swing_and_no_warm_up(self):
        for seed in range(3):
            sine = [5e-3 * math.sin(2.0 * math.pi * k / 3600) for k in range(3600)]
            self.write("sine.csv", table({"acc_x (g)": total(sine, white(3600, 3e-4, seed))}))
            channel = self.document("drift", "sine.csv")["channels"][0]
            self.assertEqual((channel["verdict"], channel["reason_code"]), ("not_identified", "swing"))
            self.assertIsNone(channel["a1"])

    def test_where_another_shape_fits_as_well_none_is_claimed_and_a_forecast_covers_them(self):
        shape = [5e-3 * math.log1p(k / 60.0) / math.log1p(HOURS_2 / 60.0) for k in range(HOURS_2)]
        self.write("log.csv", table({"acc_x (g)": total(shape, white(HOURS_2, 1e-3, 9))}))
        document = self.document("drift", "log.csv", "--forecast", "9000")
        channel = document["channels"][0]
        self.assertEqual(channel["verdict"], "not_identified")
        self.assertEqual(channel["reason_code"], "shape_undetermined")
        self.assertIn("its shape cannot be determined from this recording", channel["reason"])
        self.assertIsNone(channel["a1"])
        self.assertIsNone(channel["time_constant_s"])
        self.assertIn("logarithm", [item["model"] for item in channel["possible_models"]])
        lower, upper = channel["forecast"]["interval_95"]
        truth = 5e-3 * G * math.log1p(9000 / 60.0) / math.log1p(HOURS_2 / 60.0)
        self.assertLess(lower, truth)
        self.assertLess(truth, upper)
        self.assertIn("its shape cannot be determined", self.succeed("drift", "log.csv"))

    def test_the_bias_of_an_axis_that_bears_gravity_is_a_level(self):
        up = total([1.0] * HOURS_2, warm_up(HOURS_2, 5e-3, 0.0, 900.0), white(HOURS_2, 1e-3, 1))
        self.write("up.csv", table({"acc_z (g)": up}))
        text = self.succeed("drift", "up.csv", "--forecast", "10000")
        self.assertIn("Level at power-on a2", text)
        self.assertNotIn("ias at power-on", text)
        self.assertIn("after power-on: level", text)
        self.assertTrue(self.document("drift", "up.csv")["channels"][0]["bears_gravity"])

    def test_power_ups_are_compared_as_a_set(self):
        samples, names = 600, [f"run{k}.csv" for k in range(6)]
        levels = white(6, 5e-3, 7)
        for k, level in enumerate(levels):
            x = total([level] * samples, white(samples, 1e-3, 20 + k))
            y = total(warm_up(samples, 2e-3, 0.0, 60.0), white(samples, 1e-3, 40 + k))
            self.write(names[k], table({"acc_x (g)": x, "acc_y (g)": y}))
        document = self.document("drift", *names)
        self.assertEqual(len(document["channels"]), 12)
        self.assertEqual([(r["name"], r["count"]) for r in document["runs"]], [("acc_x", 6), ("acc_y", 6)])
        x, y = document["runs"]
        self.assertEqual([level["name"] for level in x["levels"]], names)
        for level, truth in zip(x["levels"], levels):
            self.assertAlmostEqual(level["mean"]["value"], truth * G, delta=0.15e-3 * G)
        scatter = G * statistics.stdev(levels)
        self.assertAlmostEqual(x["level"]["between_std"]["value"], scatter, delta=0.05 * scatter)
        self.assertLess(x["level"]["interval_95"][0], scatter)
        self.assertLess(scatter, x["level"]["interval_95"][1])
        self.assertLess(x["level"]["p"], 0.02)
        self.assertEqual(x["warm_up"]["verdict"], "not_identified")
        self.assertGreater(y["level"]["p"], 1e-3)
        self.assertEqual(y["warm_up"]["verdict"], "identified")
        self.expect_inside(y["warm_up"], "time_constant_s", 60.0)
        self.expect_inside(y["warm_up"], "a1", 2e-3 * G)
        two = self.document("drift", *names[:2])
        self.assertEqual(len(two["channels"]), 4)
        self.assertEqual(two["runs"], [])
        self.assertIn("three or more", "\n".join(two["warnings"]))

    def test_runs_of_other_channels_are_no_set(self):
        for k, heading in enumerate(("acc_x (g)", "acc_x (g)", "acc_z (g)")):
            self.write(f"run{k}.csv", table({heading: white(600, 1e-3, k)}))
        document = self.document("drift", "run0.csv", "run1.csv", "run2.csv")
        self.assertEqual(document["runs"], [])
        self.assertIn("run2.csv does not have it", "\n".join(document["warnings"]))

    def test_a_sensor_file_takes_what_is_identified_and_keeps_the_rest(self):
        x = total(warm_up(HOURS_2, 5e-3, 1.5e-3, 900.0), white(HOURS_2, 1e-3, 1))
        y = total(random_walk(HOURS_2, 5e-5, 4), white(HOURS_2, 1e-3, 5))
        self.write("a.csv", table({"acc_x (g)": x, "acc_y (g)": y}))
        self.write("mine.toml", '[sensor]\nname = "mine"\n[drift]\n'
                   'T = [ {}, { value = 77.0, std = 1.0, unit = "s", origin = "by hand" }, {} ]\n')
        found = self.document("drift", "a.csv", "--update-sensor", "mine.toml")
        with open(self.folder / "mine.toml", "rb") as file:
            sensor = tomllib.load(file)
        self.assertEqual(sensor["sensor"]["name"], "mine")
        for key, entry in (("a1", "a1"), ("a2", "a2"), ("time_constant_s", "T")):
            figure, written = found["channels"][0][key], sensor["drift"][entry][0]
            self.assertAlmostEqual(written["value"], figure["value"], places=9)
            self.assertAlmostEqual(written["std"], figure["std"], places=9)
            self.assertEqual(written["unit"], figure["unit"])
            self.assertIn("proofmass drift a.csv, 2 h at 1 Hz", written["origin"])
        self.assertEqual(sensor["drift"]["T"][1]["value"], 77.0)
        self.assertEqual(sensor["drift"]["T"][1]["origin"], "by hand")
        self.assertIn("acc_y: no warm-up is identified", "\n".join(found["warnings"]))
        self.assertEqual(self.leftovers(), [])
        self.succeed("drift", "a.csv", "--sensor", "mine.toml")

    def test_a_sensor_file_is_not_made_of_nothing(self):
        self.wandering()
        self.succeed("drift", "walk.csv", "--update-sensor", "new.toml")
        self.assertFalse((self.folder / "new.toml").exists())
        for arguments in (("walk.csv", "walk.csv"), ("walk.csv", "--unit", "V")):
            line = self.expect_failure(USAGE, "drift", *arguments, "--update-sensor", "new.toml")
            self.assertIn("--update-sensor", line)

    def thermal(self, heading="temp (degC)", name="hot.csv"):
        warm = [25.0 + 10.0 * math.sin(2.0 * math.pi * k / HOURS_2) for k in range(HOURS_2)]
        x = total([2e-4 * (t - 25.0) for t in warm], white(HOURS_2, 1e-3, 9))
        return self.write(name, table({"acc_x (g)": x, heading: warm}))

    def test_the_only_temperature_is_fitted_against_unless_it_is_left(self):
        self.thermal()
        document = self.document("drift", "hot.csv")
        self.assertEqual([c["name"] for c in document["channels"]], ["acc_x"])
        found = document["channels"][0]["temperature"]
        self.assertEqual(found["channel"], "temp")
        self.assertEqual(found["verdict"], "identified")
        self.assertEqual(found["degree"], 1)
        self.assertAlmostEqual(found["lowest_k"], 288.15, delta=0.3)
        self.assertAlmostEqual(found["coefficients"][1]["value"], 2e-4 * G,
                               delta=4 * found["coefficients"][1]["std"])
        named = self.document("drift", "hot.csv", "--channel", "acc_x", "--temperature", "temp")
        self.assertEqual(named["channels"][0]["temperature"]["degree"], 1)
        left = self.document("drift", "hot.csv", "--temperature", "none")["channels"][0]
        self.assertFalse(left.get("temperature"))

    def test_of_two_temperatures_one_has_to_be_named(self):
        x = white(2000, 1e-3, 3)
        warm = [25.0 + 1e-3 * k for k in range(2000)]
        self.write("two.csv", table({"acc_x (g)": x, "die (degC)": warm, "room (degC)": warm}))
        document = self.document("drift", "two.csv")
        self.assertFalse(document["channels"][0].get("temperature"))
        self.assertIn("die and room both hold temperatures", "\n".join(document["warnings"]))
        named = self.document("drift", "two.csv", "--temperature", "room")["channels"]
        self.assertEqual([c["name"] for c in named], ["acc_x"])
        self.assertEqual(named[0]["temperature"]["channel"], "room")

    def test_a_temperature_without_its_unit_is_the_user_s_to_mend(self):
        self.thermal(heading="temp")
        line = self.expect_failure(USAGE, "drift", "hot.csv", "--temperature", "temp")
        self.assertIn("temp (degC)", line)
        self.expect_failure(USAGE, "drift", "hot.csv", "--temperature", "oven")

    def test_a_clipped_channel_is_refused_and_the_others_go_on(self):
        clipped = [max(-5e-4, min(5e-4, y)) for y in white(HOURS_2, 1e-3, 10)]
        x = total(warm_up(HOURS_2, 5e-3, 1.5e-3, 900.0), white(HOURS_2, 1e-3, 1))
        self.write("a.csv", table({"acc_x (g)": x, "acc_y (g)": clipped}))
        document = self.document("drift", "a.csv")
        self.assertEqual(document["channels"][0]["verdict"], "identified")
        self.assertIsNone(document["channels"][1]["a2"])
        self.assertIn("rails", "\n".join(document["warnings"]))
        self.assertEqual(self.run_command("drift", "a.csv", "--strict").returncode, BAD_DATA)

    def test_the_table_has_means_curve_and_its_std(self):
        self.warming()
        self.succeed("drift", "warm.csv", "--output", "curve.csv")
        with open(self.folder / "curve.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.assertGreaterEqual(len(rows[0]), 4)
        self.assertGreater(len(rows), 64)

    def test_the_page_and_the_text_begin_with_what_was_found(self):
        self.warming()
        text = self.succeed("drift", "warm.csv", "--report", "r.html")
        self.assertIn("Warm-up of", text)
        page = (self.folder / "r.html").read_text()
        self.assertIn("warm-up of", page.lower())
        self.assertGreaterEqual(page.count("</svg>"), 3)

    def test_the_same_recording_gives_the_same_bytes(self):
        self.warming(samples=3600)
        epoch = {"SOURCE_DATE_EPOCH": "0"}
        self.assertEqual(self.succeed("drift", "warm.csv", "--json", "-", environment=epoch),
                         self.succeed("drift", "warm.csv", "--json", "-", environment=epoch))

    def test_flags_that_make_no_sense_are_refused(self):
        self.warming(samples=500)
        for flags in (("--since-switch-on", "-1"), ("--since-switch-on", "soon"), ("--forecast", "1 h"),
                      ("--temperature", "acc_q"), ("--channel", "acc_q"), ("--output", "-", "--json", "-")):
            self.expect_failure(USAGE, "drift", "warm.csv", *flags)
        self.expect_failure(USAGE, "drift")

    def test_no_recording_is_no_crash(self):
        self.expect_failure(BAD_INPUT, "drift", "nowhere.csv")
        self.write("tiny.csv", "acc_x (g)\n0.1\n0.2\n")
        document = self.refused_document("drift", "tiny.csv", "--rate", "10")
        self.assertIsNone(document["channels"][0]["a1"])
        self.assertIsNone(document["channels"][0]["a2"])


if __name__ == "__main__":
    unittest.main()
