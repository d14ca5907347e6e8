"""Completion by the shells' scripts in completions/. They query the program, so no test may contain a list of
verbs or flags that the program does not print itself."""
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from command import PROGRAM, CommandTest

SCRIPTS = Path(__file__).resolve().parents[2] / "completions"


class CompletionTest(CommandTest):
    def setUp(self):
        super().setUp()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/proofmass").symlink_to(PROGRAM)
        self.write("rim.toml", "")
        self.write("ride.csv", "")
        (self.folder / "sensors").mkdir()

    def offered(self, line: str) -> list[str]:
        """The program's completions of the line up to the cursor."""
        return self.succeed("__complete", *line.split(" ")[1:]).splitlines()

    def words(self, line: str) -> list[str]:
        return [said.split("\t")[0] for said in self.offered(line) if not said.startswith(":")]


class TheProgram(CompletionTest):
    def test_offers_the_verbs_of_its_help(self):
        listed = re.findall(r"^  ([a-z]+) ", self.succeed("--help").split("Look:")[1], re.M)
        self.assertEqual(self.words("proofmass "), listed)
        self.assertEqual(self.words("proofmass ti"), ["tilt"])
        self.assertEqual(self.words("proofmass --v"), ["--version"])

    def test_offers_each_flag_of_each_verb(self):
        for verb in self.words("proofmass "):
            text = self.succeed(verb, "--help")
            if "--help-input" in text:
                text += self.succeed(verb, "--help-input")
            listed = set(re.findall(r"^  (?:-\w,)?(--[a-z-]+(?:,--[a-z-]+)*)", text, re.M))
            names = {name for names in listed for name in names.split(",")}
            self.assertEqual(set(self.words(f"proofmass {verb} -")), names, verb)

    def test_says_what_each_is(self):
        self.assertIn("--strict\texit with status 5 if the data are bad", self.offered("proofmass noise --st"))
        self.assertIn("tilt\troll and pitch from gravity, at rest and on a moving base", self.offered("proofmass t"))

    def test_offers_no_flag_twice_unless_it_may_be_repeated(self):
        self.assertNotIn("--rate", self.words("proofmass noise --rate 100 a.csv --r"))
        self.assertIn("--channel", self.words("proofmass noise --channel x --ch"))

    def test_offers_no_flag_that_another_excludes(self):
        self.assertNotIn("--gravity", self.words("proofmass noise --latitude 44 -"))
        self.assertNotIn("--latitude", self.words("proofmass noise --gravity=9.8 -"))

    def test_offers_the_values_of_a_flag(self):
        units = ["g", "mg", "m/s2", "V", "mV", "counts", "deg/s", "rad/s"]
        self.assertEqual(self.words("proofmass noise --unit "), units)
        self.assertEqual(self.words("proofmass noise --unit=m"), ["--unit=mg", "--unit=m/s2", "--unit=mV"])
        self.assertEqual(self.words("proofmass sensor "), ["show", "diff", "export"])

    def test_asks_for_files_where_files_are_taken(self):
        self.assertEqual(self.offered("proofmass wheel "), [":files"])
        self.assertEqual(self.offered("proofmass wheel a.csv "), [":files"])
        self.assertEqual(self.offered("proofmass sensor show "), [":files"])
        self.assertEqual(self.offered("proofmass wheel --sensor "), [":files", ":ending toml"])
        self.assertEqual(self.offered("proofmass wheel --json="), [":files", ":prefix --json="])
        self.assertEqual(self.offered("proofmass wheel -o "), [":files"], "its ending is the user's choice")

    def test_offers_flags_where_no_file_is_taken_any_more(self):
        self.assertIn("--gyro", self.words("proofmass tilt a.csv "))

    def test_says_what_only_the_user_knows(self):
        self.assertEqual(self.offered("proofmass wheel --from "), [":text S: start of the interval to use"])

    def test_offers_kinds_of_sources_and_what_is_there_of_one(self):
        kinds = self.words("proofmass record ")
        self.assertLessEqual({"sim:", "serial:", "udp:", "mqtt://", "replay:"}, set(kinds))
        self.assertLessEqual({"sim:wheel", "sim:static"}, set(self.words("proofmass record sim:")))
        self.assertEqual(self.offered("proofmass record replay:"), [":files", ":prefix replay:"])

    def test_is_silent_where_nothing_fits_and_never_fails(self):
        self.assertEqual(self.offered("proofmass nosuch "), self.offered("proofmass "))
        for line in ("proofmass x", "proofmass wheel --nosuch=", "proofmass wheel --nosuch", "proofmass wheel a b c"):
            self.assertEqual(self.offered(line), [], line)
        self.succeed("__complete")

    def test_is_no_verb_to_the_user(self):
        self.assertNotIn("__complete", self.succeed("--help"))


class Bash(CompletionTest):
    def reply(self, line: str) -> set[str]:
        """Completions of the function that bash calls, with the words split as by bash."""
        words = re.findall(r"[^\s:=]+|[:=]+", line) + ([""] if line.endswith(" ") else [])
        script = f"""
            source {SCRIPTS}/proofmass.bash
            PATH={self.folder}/bin:$PATH
            COMP_LINE=$1 COMP_POINT=${{#1}} COMP_WORDS=("${{@:2}}") COMP_CWORD=$(($# - 2))
            _proofmass
            printf '%s\\n' "${{COMPREPLY[@]}}" """
        ran = subprocess.run(
            ["bash", "--norc", "-c", script, "bash", line, *words], cwd=self.folder, capture_output=True, text=True
        )
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        return set(ran.stdout.split())

    def test_offers_verbs_flags_and_values(self):
        self.assertEqual(self.reply("proofmass ti"), {"tilt"})
        self.assertEqual(self.reply("proofmass noise --uni"), {"--unit"})
        self.assertEqual(self.reply("proofmass noise --unit m"), {"mg", "m/s2", "mV"})

    def test_offers_what_goes_behind_a_sign_at_which_it_cuts_words(self):
        self.assertEqual(self.reply("proofmass noise --unit=m"), {"mg", "m/s2", "mV"})
        self.assertIn("wheel", self.reply("proofmass record sim:wh"))
        self.assertIn("static", self.reply("proofmass record sim:"))
        self.assertEqual(self.reply("proofmass record sim: --estimate t"), {"tilt", "track"})

    def test_offers_files(self):
        self.assertEqual(self.reply("proofmass wheel ri"), {"rim.toml", "ride.csv"})
        self.assertEqual(self.reply("proofmass wheel --sensor "), {"rim.toml", "sensors", "bin"})
        self.assertEqual(self.reply("proofmass record replay:rid"), {"ride.csv"})
        self.assertEqual(self.reply("proofmass wheel --json=ri"), {"rim.toml", "ride.csv"})


class OtherShells(CompletionTest):
    def need(self, shell: str):
        if not shutil.which(shell):
            self.skipTest(f"{shell} is missing")

    def test_zsh_can_read_its_script(self):
        self.need("zsh")
        subprocess.run(["zsh", "-n", SCRIPTS / "_proofmass"], check=True)

    def test_fish_offers_the_same(self):
        self.need("fish")
        script = f"source {SCRIPTS}/proofmass.fish; set -p PATH {self.folder}/bin; complete -C $argv[1]"

        def reply(line: str) -> set[str]:
            ran = subprocess.run(
                ["fish", "--no-config", "-c", script, line], cwd=self.folder, capture_output=True, text=True
            )
            self.assertEqual((ran.returncode, ran.stderr), (0, ""))
            return {said.split("\t")[0] for said in ran.stdout.splitlines()}

        self.assertEqual(reply("proofmass ti"), {"tilt"})
        self.assertEqual(reply("proofmass noise --unit m"), {"mg", "m/s2", "mV"})
        self.assertEqual(reply("proofmass record replay:rid"), {"replay:ride.csv"})
        self.assertEqual(reply("proofmass wheel ri"), {"rim.toml", "ride.csv"})
        self.assertIn("rim.toml", reply("proofmass wheel --sensor "))


if __name__ == "__main__":
    unittest.main()
