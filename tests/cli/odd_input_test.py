"""Streams without rows, names with control characters, and verbs on recordings of every magnitude."""
import gzip
import os
import unittest

from command import BAD_DATA, BAD_INPUT, DONE, FAILED, USAGE, CommandTest, parse_json, rest_csv, turning_csv
from odd_recordings import OddRecording

RECORDINGS = int(os.environ.get("PROOFMASS_ODD_RECORDINGS", "150"))


def has_control(text: str) -> bool:
    return any((ord(c) < 32 and c != "\n") or 127 <= ord(c) < 160 or c in "\u061c\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069" for c in text)


class Streams(CommandTest):
    def test_a_stream_without_a_row_is_an_error_and_no_crash(self):
        for content in ("2,3\n".encode("utf-16-le"), "2,\n".encode("utf-16-le"), b"t,a\n\0\0\0\0\n", b"1,2\n\0\0\0", b"\0\0,\0\n"):
            self.write("a.csv", content)
            self.write("a.csv.gz", gzip.compress(content))
            for arguments, stdin in ((["-"], content), (["a.csv.gz"], b""), (["a.csv"], b"")):
                ran = self.run_command("inspect", *arguments, stdin=stdin)
                self.assertIn(ran.returncode, (DONE, BAD_INPUT), (content, arguments, ran.stderr))
                self.assertEqual(len(ran.stderr.splitlines()), 1 if ran.returncode else 0, ran.stderr)

    def test_sixteen_bit_text_is_read_however_short_and_wherever_from(self):
        content = "2,3\n".encode("utf-16-le")
        self.write("a.csv", content)
        for document in (self.document("inspect", "-", stdin=content), self.document("inspect", "a.csv")):
            self.assertEqual(document["samples"], 1)

    def test_a_channel_whose_figures_cannot_be_read_fails_with_strict(self):
        self.write("a.csv", "t (s);ax (g);ay (g)\n" + "".join(f"0.{k};(0.5);1.{k}\n" for k in range(9)))
        self.assertIn("ax", "\n".join(self.document("inspect", "a.csv")["warnings"]))
        self.assertEqual(self.run_command("inspect", "a.csv", "--strict").returncode, BAD_DATA)

    def test_where_no_channel_can_be_analysed_the_input_is_bad(self):
        self.write("a.csv", "t (s),ax (g)\n" + "".join(f"0.{k},nan\n" for k in range(9)))
        for verb in ("noise", "drift"):
            self.refused_document(verb, "a.csv")


class Flags(CommandTest):
    """A flag that contradicts the file is not applied silently."""

    def test_of_a_rate_beside_stamps_are_warned_of(self):
        self.write("a.csv", turning_csv(seconds=4))
        warnings = "\n".join(self.document("inspect", "a.csv", "--rate", "50")["warnings"])
        self.assertIn("its stamps say 100 Hz and are not used", warnings)
        self.assertNotIn("its stamps", "\n".join(self.document("inspect", "a.csv", "--rate", "100")["warnings"]))

    def test_of_a_unit_that_gravity_contradicts_are_refused(self):
        self.write("a.csv", rest_csv(seconds=4))
        for verb in ("noise", "calibrate", "inspect", "track"):
            self.assertIn("contradicts the header's m/s^2", self.expect_failure(USAGE, verb, "a.csv", "--unit", "g"))
        # A header that is wrong, and one that cannot be checked, can be overruled.
        self.write("wrong.csv", rest_csv(seconds=4).replace("m/s^2", "g"))
        self.assertEqual(self.document("inspect", "wrong.csv", "--unit", "m/s2")["channels"][0]["unit"], "m/s^2")

    def test_of_a_radius_in_millimetres_are_refused(self):
        self.write("a.csv", turning_csv())
        self.assertIn("in metres", self.expect_failure(USAGE, "wheel", "a.csv", "--radius", "150"))
        self.succeed("wheel", "a.csv", "--radius", "0.15")

    def test_of_a_folder_with_several_recordings_name_the_one_that_is_read(self):
        (self.folder / "runs").mkdir()
        for name in ("one", "two"):
            self.write(f"runs/{name}.csv", turning_csv(seconds=5))
        warnings = "\n".join(self.document("inspect", "runs")["warnings"])
        self.assertRegex(warnings, "one is read, .*also holds two")


class Names(CommandTest):
    NASTY = "\x1b]0;pwned\x07a\x9bx\u202e"

    def outputs_of(self, *arguments):
        for extra in ([], ["-v"]):
            ran = self.run_command(*arguments, *extra)
            yield ran.stdout.decode() # raises an error unless UTF-8
            yield ran.stderr.decode()

    def test_never_carry_what_a_terminal_obeys(self):
        text = f"t,{self.NASTY},{self.NASTY} label\n" + "".join(f"{k},{k % 3},{self.NASTY}\n" for k in range(12))
        self.write("e.csv", text)
        self.write("latin.csv", b"t,a\xb0\x1b[2J (g)\n" + b"".join(b"%d,%d\n" % (k, k % 3) for k in range(12)))
        for name in ("e.csv", "latin.csv"):
            for arguments in (("inspect", name), ("noise", name), ("convert", name, "-o", "out.csv"), ("inspect", name, "--channel", "no")):
                for output in self.outputs_of(*arguments):
                    self.assertFalse(has_control(output), ascii(output))
        self.assertFalse(has_control((self.folder / "out.csv").read_text()))

    def test_of_arguments_stay_on_one_line(self):
        ran = self.run_command("inspect", "no\nsuch\x1b[31m file")
        self.assertEqual(ran.returncode, BAD_INPUT)
        self.assertEqual(len(ran.stderr.splitlines()), 1)
        self.assertFalse(has_control(ran.stderr.decode()))

    def test_are_no_formulas_in_what_is_written_and_come_back_as_they_were(self):
        names = ["=cmd|' /C calc'!A0", "+sum", "-x", "@a", "plain"]
        head = ",".join(["t (s)"] + [f'"{name}"' for name in names] + ["pose"])
        self.write("f.csv", head + "\n" + "".join(f"0.{k},1,2,3,4,5,{'-x' if k < 5 else '=1+1'}\n" for k in range(9)))
        self.succeed("convert", "f.csv", "-o", "out.csv")
        lines = (self.folder / "out.csv").read_text().splitlines()
        for field in lines[0].split(",") + [line.split(",")[1] for line in lines[1:]]:
            self.assertNotIn(field.strip('"')[0], "=+-@", lines)
        back = self.document("inspect", "out.csv")
        self.assertEqual([channel["name"] for channel in back["channels"]], [name.replace('"', "'") for name in names])
        self.assertNotIn("'=1+1", self.run_command("inspect", "out.csv", "-v").stderr.decode())


class Verbs(CommandTest):
    """For a recording of any magnitude: a document that matches its schema, or one line with the reason."""

    def test_end_with_a_document_or_one_line_on_any_recording(self):
        ends = {}
        for seed in range(RECORDINGS):
            recording = OddRecording(seed)
            self.write("r.csv", recording.text())
            verb, arguments = recording.command("r.csv")
            with self.subTest(seed=seed, verb=verb, arguments=arguments):
                ran = self.run_command(verb, *arguments, "--json", "d.json", "-q")
                error = ran.stderr.decode()
                ends[verb, ran.returncode] = ends.get((verb, ran.returncode), 0) + 1
                self.assertIn(ran.returncode, (DONE, FAILED, USAGE, BAD_INPUT), error)
                for foreign in ("boost", "Error in function", "contract broken", "std::", "bad_"):
                    self.assertNotIn(foreign, error)
                self.assertLess(len(error), 1000)
                if ran.returncode != DONE:
                    self.assertEqual(len(error.splitlines()), 1, error)
                    continue
                document = parse_json((self.folder / "d.json").read_text())
                self.check_document("tumble_rotating" if "--rotating" in arguments else verb, document)
        self.assertGreater(sum(count for (_, end), count in ends.items() if end == DONE), RECORDINGS // 10)

    def test_of_a_wheel_may_be_of_a_few_samples(self):
        self.succeed("simulate", "--rpm", "15", "--seed", "7", "--duration", "10", "-o", "w.csv")
        for window in ("1.05", "1.02", "1.2"):
            ran = self.run_command("wheel", "w.csv", "--from", "1", "--to", window)
            self.assertIn(ran.returncode, (DONE, FAILED, BAD_INPUT), ran.stderr)

    def test_of_a_drift_may_be_long_after_switching_on(self):
        self.write("rest.csv", rest_csv(seconds=30))
        for since in ("3600", "86400", "1e6"):
            document = self.document("drift", "rest.csv", "--since-switch-on", since)
            self.assertEqual({channel["verdict"] for channel in document["channels"]}, {"not_identified"})

    def test_of_noise_with_many_samples_missing_and_of_tilt_with_one_of_1e300(self):
        for seed in (3596, 4738):
            recording = OddRecording(seed)
            self.write("r.csv", recording.text())
            verb, arguments = recording.command("r.csv")
            self.document(verb, *arguments)

    def test_of_motion_take_stamps_that_repeat(self):
        rows = [(0.01 * (k - (k in (50, 120))), k) for k in range(300)]
        self.write("r.csv", "t (s),ax (m/s^2),ay (m/s^2),az (m/s^2)\n"
                   + "".join(f"{t:.2f},{0.01 * (k % 3)},{0.01 * (k % 5)},{9.8 + 0.01 * (k % 7)}\n" for t, k in rows))
        ran = self.run_command("track", "r.csv", "--axis", "x")
        self.assertNotIn("ascend", ran.stderr.decode())
        self.assertIn("2 samples that have the time of the sample before are left out", ran.stderr.decode())


if __name__ == "__main__":
    unittest.main()
