"""Runs the built command and parses its output; shared by the tests of this folder."""
import json
import math
import os
import random
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import jsonschema

os.environ["LC_ALL"] = "C.UTF-8"
PROGRAM = os.environ["PROOFMASS"]
SCHEMAS = Path(os.environ["PROOFMASS_SCHEMAS"])

DONE, FAILED, USAGE, BAD_INPUT, BAD_DATA, INTERRUPTED = 0, 1, 2, 3, 5, 130


def refuse_constant(name: str):
    raise AssertionError(f"{name} is not JSON")


def parse_json(text: str) -> dict:
    """Like json.loads, but NaN and Infinity are errors, as in every other language."""
    return json.loads(text, parse_constant=refuse_constant)


def nulls(value, path=""):
    """Paths of all nulls in a document."""
    if value is None:
        yield path
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from nulls(item, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from nulls(item, f"{path}[{index}]")


class CommandTest(unittest.TestCase):
    """A test with a temporary folder, in which the command runs."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="proofmass-cli-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_command(self, *arguments, stdin=b"", environment=None) -> subprocess.CompletedProcess:
        return subprocess.run(
            [PROGRAM, *map(str, arguments)],
            cwd=self.folder,
            input=stdin,
            capture_output=True,
            timeout=600,
            env={**os.environ, **(environment or {})},
        )

    def succeed(self, *arguments, **how) -> str:
        """Standard output of a run that must exit with 0."""
        ran = self.run_command(*arguments, **how)
        self.assertEqual(ran.returncode, DONE, ran.stderr.decode())
        return ran.stdout.decode()

    def document(self, verb, *arguments, **how) -> dict:
        """The document of a run with `--json -`, which must match the verb's schema and have the common first keys."""
        document = parse_json(self.succeed(verb, *arguments, "--json", "-", **how))
        self.check_document(verb, document)
        return document

    @staticmethod
    def without_provenance(document) -> dict:
        """The results, without the command line and the time."""
        return {key: value for key, value in document.items() if key != "provenance"}

    def refused_document(self, verb, *arguments) -> dict:
        """The document of a run that could analyse no channel: it exits with BAD_INPUT and gives the reason."""
        ran = self.run_command(verb, *arguments, "--json", "-")
        self.assertEqual(ran.returncode, BAD_INPUT, ran.stderr.decode())
        self.assertIn("proofmass: no channel can be analysed: ", ran.stderr.decode())
        document = parse_json(ran.stdout.decode())
        self.check_document(verb, document)
        return document

    def check_document(self, verb, document):
        schema = json.loads((SCHEMAS / f"{verb}.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        jsonschema.Draft202012Validator(schema).validate(document)
        self.assertEqual(list(document)[:4], ["proofmass", "verb", "input", "warnings"])
        reasons = "\n".join(document["warnings"])
        for path in nulls(document):
            leaf = re.sub(r"\[\d+\]$", "", path.split(".")[-1])
            self.assertIn(leaf, reasons, f"{path} is null and no warning says why")

    def expect_failure(self, status, *arguments, **how) -> str:
        """The error line of a run that must exit with `status` and an empty standard output."""
        ran = self.run_command(*arguments, **how)
        error = ran.stderr.decode()
        self.assertEqual(ran.returncode, status, error)
        lines = [line for line in error.splitlines() if line.startswith("proofmass: ")]
        self.assertEqual(len(lines), 1, error)
        self.assertEqual(error.splitlines()[-1], lines[0], "the error is the last line")
        return lines[0]

    def write(self, name, text) -> Path:
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def leftovers(self) -> list:
        """Files that were started and not completed."""
        return [p.name for p in self.folder.iterdir() if "part" in p.name or "tmp" in p.name]


def rest_csv(seconds=30.0, rate_hz=100.0, seed=1) -> str:
    """Three axes at rest with white noise."""
    draw = random.Random(seed)
    rows = (f"{k / rate_hz:.4f}," + ",".join(f"{draw.gauss(mean, 0.01):.6f}" for mean in (0.1, -0.2, 9.8)) + "\n"
            for k in range(int(seconds * rate_hz)))
    return "time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2)\n" + "".join(rows)


def turning_csv(seconds=20.0, rate_hz=100.0, rpm=30.0, radius_m=0.15) -> str:
    """A noiseless two-axis sensor on a wheel at constant speed: gravity and ω²r only."""
    omega = rpm * 2.0 * math.pi / 60.0
    lines = ["time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2)"]
    for k in range(int(seconds * rate_hz)):
        t = k / rate_hz
        ripple = 0.02 * math.sin(7.0 * k) # so that the noise is not zero
        x = 9.80665 * math.sin(omega * t) - omega**2 * radius_m + ripple
        y = 9.80665 * math.cos(omega * t) + 0.02 * math.cos(5.0 * k)
        lines.append(f"{t:.4f},{x:.6f},{y:.6f},{0.01 * math.sin(3.0 * k):.6f}")
    return "\n".join(lines) + "\n"
