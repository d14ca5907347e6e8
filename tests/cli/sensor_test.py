"""proofmass sensor export."""
import re
import shutil
import subprocess
import unittest

from command import BAD_INPUT, USAGE, CommandTest

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


def yaml_entries(text) -> dict:
    """The entries of a flat YAML, numbers as YAML 1.1 knows them (with a point)."""
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
                          ("export", "s.toml", "--format", "pdf"),
                          ("export", "s.toml", "--format", "imu-yaml", "--rate", "0"),
                          ("export", "s.toml", "--format", "imu-yaml", "-o", "-", "--json", "-")):
            self.expect_failure(USAGE, "sensor", *arguments)
        self.expect_failure(BAD_INPUT, "sensor", "export", "absent.toml", "--format", "imu-yaml")

    def test_help_shows_an_example(self):
        self.assertIn("proofmass sensor export", self.succeed("sensor", "--help"))


if __name__ == "__main__":
    unittest.main()
