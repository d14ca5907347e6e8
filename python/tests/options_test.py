"""Each function has the options of its verb, and each example in a docstring prints what it shows."""
import doctest
import importlib
import inspect
import re
import subprocess
import warnings

import pytest

import proofmass as pm
from conftest import COMMAND
from proofmass._options import NAMES

#: Flags for files, the terminal and the command itself.
OF_THE_COMMAND = {
    "help", "help-input", "json", "report", "page", "output", "quiet", "verbose", "strict", "config", "memory", "pyramid",
    "print-config", "dataset",
}  # fmt: skip


@pytest.mark.parametrize(
    "verb", ["inspect", "noise", "drift", "calibrate", "tumble", "wheel", "drive", "track", "tilt", "motor", "tune", "simulate"]
)
def test_options_are_the_flags(verb):
    text = "".join(
        subprocess.run([COMMAND, verb, *words], capture_output=True, text=True).stdout
        for words in (["--help"], ["--help-input"])
        if verb != "simulate" or words == ["--help"]
    )
    flags = {flag for line in re.findall(r"^  (-\S+)", text, re.M) for flag in re.findall(r"--([a-z0-9-]+)", line)}
    parameters = inspect.signature(getattr(pm, verb)).parameters.values()
    options = {p.name for p in parameters if p.kind is p.KEYWORD_ONLY} - {"progress"}
    assert {NAMES.get(name, name).replace("_", "-") for name in options} == flags - OF_THE_COMMAND
    documented = re.findall(r"^    (\w+) : ", getattr(pm, verb).__doc__, re.M)
    assert set(documented) - {"x", "rig", "progress"} == options


@pytest.mark.parametrize("name", ["", "._inspect", "._characterise", "._calibrate", "._estimate", "._drive", "._simulate", "._recording", "._results", "._sensor", "._options",
                                  "._allan", "._kalman", ".live"])
def test_examples_print_what_they_say(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pm.ProofmassWarning)
        outcome = doctest.testmod(importlib.import_module("proofmass" + name))
    assert outcome.attempted > 0 and outcome.failed == 0
