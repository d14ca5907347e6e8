"""proofmass sensor show, diff and export."""
import re
import shutil
import subprocess
import unittest

from command import BAD_DATA, BAD_INPUT, USAGE, CommandTest

G = 9.80665
SENSOR = """[sensor]
name = "ADXL335 */ at the rim"
[electrical]
reference_supply = { value = 3, unit = "V" }
supply = { value = 3.3, unit = "V" }
sensitivity = { value = 300, unit = "mV/g", origin = "datasheet" }
zero_g_fraction = { value = 0.5, unit = "1" }
lsb = { value = 0.305, unit = "mV" }
[calibration]
bias = { value = [0.1, -0.2, 0.3], std = 0.001, unit = "m/s^2", origin = "tumble" }
scale = { value = [2, 0.5, 1], unit = "1", origin = "tumble" }
misalignment = { value = [0.01, 0.02, 0.04], unit = "rad" }
[noise]
white = { value = [106, 106, 212], std = 2, unit = "ug/sqrt(Hz)", origin = "static.csv, 2 h" }
random_walk = [ { value = 1e-5, unit = "m/s^3/sqrt(Hz)" }, { value = 0, unit = "m/s^2/sqrt(s)", origin = "below 2e-6" }, {} ]
"""
PROBE = """#include <stdio.h>
#include "sensor.h"
int main(void) {
  const float reading[3] = {1.1f, 0.8f, -0.7f};
  int i, j;
  for (i = 0; i < 3; ++i) {
    float f = 0.0f;
    for (j = 0; j < 3; ++j)
      f += adxl335_at_the_rim_correction[i][j] * (reading[j] - adxl335_at_the_rim_bias_mps2[j]);
    printf("%.7g\\n", (double)f);
  }
  printf("%.7g\\n", (double)adxl335_at_the_rim_white_mps2_rthz[2]);
  printf("%.7g\\n", (double)adxl335_at_the_rim_lsb_v);
  return 0;
}
"""


CALIBRATION = """[sensor]
name = "s"
[electrical]
lsb = {{ value = 0.5, unit = "mV" }}
reference_supply = {{ value = 3.0, unit = "V" }}
supply = {{ value = 3.3, unit = "V" }}
[calibration]
bias = {{ value = [{bias}], std = {bias_std}, unit = "{unit}", origin = "{origin}" }}
scale = {{ value = [{scale}], std = {scale_std}, unit = "{unit}/(m/s^2)", origin = "{origin}" }}
misalignment = {{ value = [3.39, -9.17, 21.36], std = 0.2, unit = "mrad", origin = "{origin}" }}
"""
COUNTS = {"bias": "33123.83, 33275.16, 32364.49", "bias_std": 0.2, "scale": "414.422, 412.031, 414.62",
          "scale_std": 0.02, "unit": "counts", "origin": "poses.csv, 38 positions"}
VOLTS = {"bias": "1.501, 1.495, 1.52", "bias_std": 4e-4, "scale": "0.03061, 0.03055, 0.0302", "scale_std": 2e-5,
         "unit": "V", "origin": "poses.csv, 24 positions"}
CORRECT = """#include <stdio.h>
#include "sensor.h"
int main(void) {{
  const float reading[3] = {{{reading}}};
  int i, j;
  for (i = 0; i < 3; ++i) {{
    float f = 0.0f;
    for (j = 0; j < 3; ++j) f += s_correction[i][j] * (reading[j] - s_bias_{unit}[j]);
    printf("%.9g\\n", (double)f);
  }}
  return 0;
}}
"""


def yaml_entries(text) -> dict:
    """The entries of a flat YAML, numbers as in YAML 1.1 (with a point)."""
    entries = {}
    for line in text.splitlines():
        line = re.sub(r"\s+#.*", "", line)
        if line and not line.startswith("#"):
            key, value = line.split(": ", 1)
            number = re.fullmatch(r"\d+\.\d*(e[-+]\d+)?", value)
            entries[key] = float(value) if number else value.strip('"')
    return entries


class ImuYaml(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SENSOR)

    def export(self, *flags) -> str:
        return self.succeed("sensor", "export", "s.toml", "--format", "imu-yaml", *flags)

    def test_it_holds_the_worst_axis_and_what_the_user_said(self):
        entries = yaml_entries(self.export("--rate", "100", "--rostopic", "/rim/imu"))
        self.assertAlmostEqual(entries.pop("accelerometer_noise_density"), 212e-6 * G, places=15)
        self.assertEqual(entries, {"accelerometer_random_walk": 1e-5, "rostopic": "/rim/imu",
                                   "update_rate": 100.0})

    def test_a_yaml_library_reads_the_same(self):
        try:
            import yaml
        except ImportError:
            self.skipTest("no yaml library")
        text = self.export("--rate", "1e-7")
        self.assertEqual(yaml.safe_load(text), yaml_entries(text))

    def test_it_says_what_has_to_be_filled_in(self):
        text = self.export()
        for key in ("gyroscope_noise_density", "gyroscope_random_walk", "update_rate"):
            self.assertRegex(text, rf"(?m)^# {key}:")
        self.assertIn("below 2e-6", text)
        self.assertIn("z: not in the sensor file", text)

    def test_without_white_noise_it_says_how_to_get_it(self):
        self.write("s.toml", '[sensor]\nname = "s"\n')
        line = self.expect_failure(BAD_INPUT, "sensor", "export", "s.toml", "--format", "imu-yaml")
        for words in ("s.toml", "noise.white", "axis x, y, z", "--update-sensor"):
            self.assertIn(words, line)


class CHeader(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SENSOR)

    def build_and_run(self, compiler, *flags) -> list:
        if shutil.which(compiler) is None:
            self.skipTest(f"no {compiler}")
        self.succeed("sensor", "export", "s.toml", "--format", "c-header", "-o", "sensor.h")
        self.write("probe.c", PROBE)
        built = subprocess.run([compiler, *flags, "-Wall", "-Wextra", "-pedantic", "-Wdouble-promotion",
                                "-Werror", "probe.c", "-o", "probe"],
                               cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(built.returncode, 0, built.stderr)
        ran = subprocess.run([self.folder / "probe"], capture_output=True, text=True, timeout=20)
        return [float(line) for line in ran.stdout.split()]

    def check(self, values):
        # T diag(1/scale) (reading - bias) by hand: (1, 1, -1) after the bias, (0.5, 2, -1) scaled.
        x, y, z = 0.5, 2.0, -1.0
        expected = [x - 0.01 * y + 0.02 * z, y - 0.04 * z, z, 212e-6 * G, 0.305e-3]
        for value, wanted in zip(values, expected, strict=True):
            self.assertAlmostEqual(value / wanted, 1.0, places=5)

    def test_it_compiles_as_c99_and_corrects_a_reading(self):
        self.check(self.build_and_run("gcc", "-std=c99"))

    def test_it_compiles_as_cxx_and_corrects_a_reading(self):
        self.check(self.build_and_run("g++", "-x", "c++", "-std=c++11"))

    def corrects_as_the_program_does(self, calibration, reading, channel_unit, firmware_reading):
        """A reading through the compiled header and through --sensor."""
        if shutil.which("gcc") is None:
            self.skipTest("no gcc")
        self.write("s.toml", CALIBRATION.format(**calibration))
        self.succeed("sensor", "export", "s.toml", "--format", "c-header", "-o", "sensor.h")
        self.write("probe.c", CORRECT.format(reading=", ".join(f"{r!r}f" for r in firmware_reading),
                                             unit=calibration["unit"].lower()))
        built = subprocess.run(["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "probe.c", "-o", "probe"],
                               cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(built.returncode, 0, built.stderr)
        ran = subprocess.run([self.folder / "probe"], capture_output=True, text=True, timeout=20)
        row = ",".join(map(str, reading))
        self.write("r.csv", ",".join(f"acc_{axis} ({channel_unit})" for axis in "xyz") + f"\n{row}\n{row}\n")
        applied = self.succeed("convert", "r.csv", "--rate", "1", "--unit", channel_unit, "--sensor", "s.toml",
                               "-o", "-", "-q")
        wanted = [float(cell) for cell in applied.splitlines()[1].split(",")[-3:]]
        for value, expected in zip(map(float, ran.stdout.split()), wanted, strict=True):
            # A float of 33123.83 counts is accurate to 0.004 counts, 1e-5 m/s².
            self.assertAlmostEqual(value, expected, delta=2e-5)
        self.assertGreater(max(map(abs, wanted)), 5.0)

    def test_it_corrects_counts_as_the_program_does(self):
        reading = (36000.0, 33000.0, 31000.0)
        self.corrects_as_the_program_does(COUNTS, reading, "counts", reading)

    def test_it_corrects_volts_as_the_program_does(self):
        reading = (1.75, 1.6, 1.9)
        at_reference = tuple(r * 3.0 / 3.3 for r in reading)
        self.corrects_as_the_program_does(VOLTS, reading, "V", at_reference)

    def test_a_calibration_whose_units_disagree_is_bad_input(self):
        self.write("s.toml", '[calibration]\nbias = { value = 1, unit = "V" }\n')
        line = self.expect_failure(BAD_INPUT, "sensor", "export", "s.toml", "--format", "c-header")
        self.assertIn("calibration.bias", line)

    def test_flags_that_it_has_no_place_for_are_mentioned(self):
        document = self.document("sensor", "export", "s.toml", "--format", "c-header", "--rate", "5")
        self.assertIn("--rate", document["warnings"][0])


class Export(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SENSOR)

    def test_a_file_and_standard_output_get_the_same(self):
        for name in ("imu-yaml", "c-header"):
            text = self.succeed("sensor", "export", "s.toml", "--format", name)
            said = self.succeed("sensor", "export", "s.toml", "--format", name, "-o", "out")
            self.assertIn("out", said)
            self.assertEqual((self.folder / "out").read_text(), text)
            self.assertEqual(
                self.succeed("sensor", "export", "s.toml", "--format", name, "-o", "-"), text)
        self.assertEqual(self.leftovers(), [])

    def test_the_document_names_the_file_and_holds_the_text(self):
        arguments = ("export", "s.toml", "--format", "imu-yaml")
        document = self.document("sensor", *arguments, "-o", "imu.yaml")
        self.assertEqual((document["output"], document["format"]), ("imu.yaml", "imu-yaml"))
        self.assertEqual(document["input"], ["s.toml"])
        self.assertEqual(document["text"], (self.folder / "imu.yaml").read_text())
        self.assertIsNone(self.document("sensor", *arguments)["output"])
        text = self.succeed("sensor", *arguments, "--json", "d.json")
        self.assertEqual(text, document["text"])

    def test_flags_may_stand_in_a_configuration_file(self):
        self.write("c.toml", '[sensor]\nformat = "imu-yaml"\nrate = 50\n')
        text = self.succeed("sensor", "export", "s.toml", "--config", "c.toml")
        self.assertEqual(yaml_entries(text)["update_rate"], 50.0)

    def test_entries_that_are_not_known_are_warned_of_unless_quiet(self):
        self.write("s.toml", SENSOR + "spectrum = 3\n")
        arguments = ("sensor", "export", "s.toml", "--format", "c-header")
        self.assertIn(b"noise.spectrum", self.run_command(*arguments).stderr)
        self.assertEqual(self.run_command(*arguments, "--quiet").stderr, b"")

    def test_what_makes_no_sense_is_refused(self):
        for arguments in (("show", "s.toml", "--format", "c-header"), ("export", "s.toml"),
                          ("export", "s.toml", "s.toml", "--format", "imu-yaml"), ("diff", "s.toml"),
                          ("show", "s.toml", "s.toml"), ("show", "s.toml", "-o", "x"),
                          ("diff", "s.toml", "s.toml", "--rate", "5"), ("change", "s.toml"),
                          ("export", "s.toml", "--format", "imu-yaml", "--report", "r.html"),
                          ("export", "s.toml", "--format", "pdf"),
                          ("export", "s.toml", "--format", "imu-yaml", "--rate", "0"),
                          ("export", "s.toml", "--format", "imu-yaml", "-o", "-", "--json", "-")):
            self.expect_failure(USAGE, "sensor", *arguments)
        self.expect_failure(BAD_INPUT, "sensor", "export", "absent.toml", "--format", "imu-yaml")

    def test_help_shows_an_example(self):
        self.assertIn("proofmass sensor export", self.succeed("sensor", "--help"))


class Show(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SENSOR)

    def test_it_prints_every_figure_with_unit_and_origin(self):
        text = self.succeed("sensor", "show", "s.toml")
        for words in ("ADXL335", "bias y", "-0.2000 ± 0.0010", "tumble", "static.csv, 2 h", "below 2e-6"):
            self.assertIn(words, text)

    def test_its_document_is_in_si(self):
        document = self.document("sensor", "show", "s.toml")
        white = [f for f in document["figures"] if f["key"] == "white"]
        self.assertEqual([f["axis"] for f in white], ["x", "y", "z"])
        self.assertAlmostEqual(white[2]["value"], 212e-6 * G, places=15)
        self.assertEqual((white[2]["written_value"], white[2]["written_unit"]), (212, "ug/sqrt(Hz)"))

    def test_an_empty_file_has_nothing_to_show(self):
        self.write("e.toml", "")
        self.assertIn("no figures", self.succeed("sensor", "show", "e.toml"))
        self.assertEqual(self.document("sensor", "show", "e.toml")["figures"], [])

    def test_it_writes_a_page(self):
        self.succeed("sensor", "show", "s.toml", "--report", "s.html")
        page = (self.folder / "s.html").read_text()
        self.assertIn("ADXL335 */ at the rim", page)
        self.assertNotIn("http", page.replace("http://www.w3.org/2000/svg", ""))


class Diff(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("old.toml", CALIBRATION.format(**VOLTS))

    def write_new(self, **changes):
        self.write("new.toml", CALIBRATION.format(**{**VOLTS, "origin": "poses-2.csv, 24 positions", **changes}))

    def test_it_finds_the_bias_that_changed_whatever_the_unit(self):
        text = CALIBRATION.format(**{**VOLTS, "origin": "again"})
        self.write("new.toml", text.replace("[1.501, 1.495, 1.52], std = 0.0004, unit = \"V\"",
                                            "[1503.5, 1495.2, 1519.8], std = 0.4, unit = \"mV\""))
        document = self.document("sensor", "diff", "old.toml", "new.toml")
        self.assertEqual(document["verdict"], "changed")
        changed = [f for f in document["figures"] if f["verdict"] == "changed"]
        self.assertEqual([(f["key"], f["axis"]) for f in changed], [("bias", "x")])
        self.assertAlmostEqual(changed[0]["change"]["value"], 2.5e-3, places=9)
        self.assertAlmostEqual(changed[0]["in_std"], 2.5 / (0.4 * 2 ** 0.5), places=6)
        error = document["effect"]["error_mg"]
        # 2.5 mV over 30.61 mV/(m/s²) are 8.33 mg; the other two axes add little.
        self.assertAlmostEqual(error["value"], 8.4, delta=0.1)
        self.assertGreater(error["value"], error["by_chance_95"])

    def test_calibrations_that_agree_do_not_alarm(self):
        self.write_new(bias="1.5014, 1.4947, 1.5203")
        text = self.succeed("sensor", "diff", "old.toml", "new.toml", "--strict")
        self.assertIn("The calibration is the same within its uncertainty", text)
        self.assertRegex(text, r"bias x +same +V")

    def test_strict_ends_with_bad_data_where_something_changed(self):
        self.write_new(bias="1.51, 1.495, 1.52")
        self.succeed("sensor", "diff", "old.toml", "new.toml")
        ran = self.run_command("sensor", "diff", "old.toml", "new.toml", "--strict")
        self.assertEqual(ran.returncode, BAD_DATA)
        self.assertIn("new.toml has changed", ran.stderr.decode())
        self.assertIn("calibration.bias x", ran.stdout.decode())

    def test_a_file_is_the_same_as_itself(self):
        document = self.document("sensor", "diff", "old.toml", "old.toml")
        self.assertEqual((document["verdict"], document["tests"]), ("unchanged", 0))
        self.assertEqual(document["effect"]["error"]["value"], 0)

    def test_without_uncertainty_it_says_what_is_undetermined(self):
        self.write("old.toml", CALIBRATION.format(**VOLTS).replace(", std = 0.0004", ""))
        self.write_new(bias="1.51, 1.495, 1.52")
        text = self.succeed("sensor", "diff", "old.toml", "new.toml", "--strict")
        self.assertIn("undetermined: no uncertainty in OLD", text)
        document = self.document("sensor", "diff", "old.toml", "new.toml")
        self.assertIsNone(document["effect"]["error"]["std"])

    def test_readings_that_have_no_unit_in_common_cannot_be_compared(self):
        self.write_new(unit="counts")
        for name in ("old.toml", "new.toml"):
            text = (self.folder / name).read_text()
            self.write(name, text.replace('lsb = { value = 0.5, unit = "mV" }\n', ""))
        document = self.document("sensor", "diff", "old.toml", "new.toml")
        self.assertIsNone(document["effect"])
        self.assertEqual({f["verdict"] for f in document["figures"] if f["key"] == "bias"}, {"cannot_be_told"})

    def test_it_writes_a_page_with_a_figure(self):
        self.write_new(bias="1.51, 1.495, 1.52")
        self.succeed("sensor", "diff", "old.toml", "new.toml", "--report", "d.html")
        page = (self.folder / "d.html").read_text()
        for words in ("<svg", "Changes in units of their standard deviation", "mg"):
            self.assertIn(words, page)

    def test_a_file_that_is_not_there_is_bad_input(self):
        self.expect_failure(BAD_INPUT, "sensor", "diff", "old.toml", "absent.toml")


if __name__ == "__main__":
    unittest.main()
