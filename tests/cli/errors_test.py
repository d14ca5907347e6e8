"""Errors give the documented exit status and one helpful line."""
import fcntl
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import time
import unittest

from command import BAD_INPUT, DONE, FAILED, INTERRUPTED, PROGRAM, USAGE, CommandTest, turning_csv


class Usage(CommandTest):
    def test_no_verb_shows_the_help(self):
        self.assertEqual(self.succeed(), self.succeed("--help"))

    def test_help_and_version_are_understood_as_verbs(self):
        self.assertEqual(self.succeed("help"), self.succeed("--help"))
        self.assertEqual(self.succeed("help", "wheel"), self.succeed("wheel", "--help"))
        for version in ("version", "-V"):
            self.assertEqual(self.succeed(version), self.succeed("--version"))

    def test_an_unknown_verb_is_a_usage_error_that_names_the_one_that_was_meant(self):
        for typed, meant in (("weel", "wheel"), ("wheal", "wheel"), ("noize", "noise"), ("Track", "track"),
                             ("calibrat", "calibrate"), ("simluate", "simulate")):
            self.assertIn(f"'{typed}': did you mean {meant}?", self.expect_failure(USAGE, typed, "a.csv"))
        self.assertNotIn("did you mean", self.expect_failure(USAGE, "frobnicate"))

    def test_an_unknown_flag_is_a_usage_error_that_names_the_one_that_was_meant(self):
        for arguments, meant in ((("wheel", "a.csv", "--raduis", "0.1"), "--radius"),
                                 (("wheel", "--raduis=0.1", "a.csv"), "--radius"),
                                 (("wheel", "--raduis", "0.1"), "--radius"),
                                 (("noise", "a.csv", "--taus", "all", "--stop-ration", "2"), "--stop-ratio")):
            self.assertIn(f"did you mean {meant}?", self.expect_failure(USAGE, *arguments))

    def test_a_file_in_the_place_of_an_output_is_answered_with_the_flag(self):
        for arguments in (("convert", "a.csv", "b.csv"), ("convert", "a.csv", "b.csv", "-q")):
            self.assertIn("-o b.csv", self.expect_failure(USAGE, *arguments))

    def test_a_value_that_is_not_there_is_answered_with_those_that_are(self):
        line = self.expect_failure(USAGE, "noise", "a.csv", "--statistic", "oadve")
        for statistic in ("adev", "theo1", "pdev", "did you mean oadev?"):
            self.assertIn(statistic, line)
        self.assertIn("did you mean g?", self.expect_failure(USAGE, "noise", "a.csv", "--unit", "G"))

    def test_units_are_understood_as_the_program_prints_them(self):
        self.write("a.csv", turning_csv(seconds=2).replace(" (m/s^2)", ""))
        for unit in ("m/s2", "m/s^2", "m/s\u00b2", "ms-2"):
            channels = self.document("inspect", "a.csv", "--unit", unit)["channels"]
            self.assertEqual({channel["unit"] for channel in channels}, {"m/s^2"}, unit)

    def test_a_list_may_be_given_in_words_or_with_commas(self):
        self.assertEqual(self.succeed("budget", "--times", "1", "2", "3"),
                         self.succeed("budget", "--times", "1,2,3"))

    def test_an_unknown_flag_is_named_and_the_help_is_pointed_to(self):
        line = self.expect_failure(USAGE, "wheel", "a.csv", "--spin-axes", "z")
        self.assertIn("--spin-axes", line)
        self.assertIn("proofmass wheel --help", line)

    def test_a_missing_file_argument_is_a_usage_error(self):
        for verb in ("inspect", "convert", "wheel", "noise"):
            self.expect_failure(USAGE, verb)

    def test_numbers_that_make_no_sense_are_refused_in_plain_words(self):
        for flags in (["--rate", "0"], ["--rate", "-5"], ["--rate", "nan"], ["--rate", "fast"],
                      ["--gravity", "inf"], ["--latitude", "91"], ["--from", "1e999"],
                      ["--rate", "100Hz"]):
            line = self.expect_failure(USAGE, "wheel", "a.csv", *flags)
            self.assertIn(flags[1], line)
            self.assertIn("expected", line)

    def test_an_unknown_unit_is_refused_before_the_file_is_read(self):
        self.assertIn("furlong", self.expect_failure(USAGE, "inspect", "absent.csv", "--unit", "furlong"))

    def test_gravity_and_latitude_exclude_each_other_and_height_needs_latitude(self):
        self.expect_failure(USAGE, "wheel", "a.csv", "--gravity", "9.8", "--latitude", "45")
        self.expect_failure(USAGE, "wheel", "a.csv", "--height", "300")

    def test_a_window_that_ends_before_it_begins_is_a_usage_error(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.expect_failure(USAGE, "inspect", "a.csv", "--from", "1", "--to", "0.5")

    def test_a_channel_that_is_not_there_is_named(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.assertIn("gyro_q", self.expect_failure(USAGE, "inspect", "a.csv", "--channel", "gyro_q"))

    def test_a_spin_axis_of_no_length_or_no_meaning_is_refused(self):
        self.write("a.csv", turning_csv(seconds=2))
        for axis in ("w", "0,0,0", "1,2", "1,2,3,4", "1;2;3", "nan,0,1"):
            self.assertIn("--spin-axis", self.expect_failure(USAGE, "wheel", "a.csv", "--spin-axis", axis))

    def test_a_recording_without_any_rate_asks_for_one(self):
        rows = "\n".join("0.1,9.8" for _ in range(100))
        self.write("a.csv", "acc_x (m/s^2),acc_y (m/s^2)\n" + rows + "\n")
        line = self.expect_failure(USAGE, "wheel", "a.csv")
        self.assertIn("no time column and no --rate", line)

    def test_a_channel_without_a_unit_asks_for_one(self):
        # 300 is not gravity in g, m/s^2 or any other unit.
        rows = "\n".join(f"{k / 100},120.5,275.25" for k in range(100))
        self.write("a.csv", "time (s),acc_x,acc_y\n" + rows + "\n")
        self.assertIn("--unit", self.expect_failure(USAGE, "wheel", "a.csv"))

    def test_three_files_are_one_too_many(self):
        line = self.expect_failure(USAGE, "wheel", "a.csv", "b.csv", "c.csv")
        self.assertIn("wheel takes at most 2 of FILE, not 3", line)


class Input(CommandTest):
    VERBS = (["inspect"], ["wheel"], ["noise"], ["convert", "-o", "out.csv"])

    def refused(self, name, **how):
        for verb in self.VERBS:
            line = self.expect_failure(BAD_INPUT, *verb, name, **how)
            self.assertLess(len(line), 400)
        self.assertFalse((self.folder / "out.csv").exists())
        self.assertEqual(self.leftovers(), [])

    def test_a_missing_file(self):
        self.refused("absent.csv")
        self.assertIn("absent.csv", self.expect_failure(BAD_INPUT, "inspect", "absent.csv"))

    def test_a_directory(self):
        (self.folder / "folder.csv").mkdir()
        self.refused("folder.csv")

    def test_an_empty_file(self):
        self.write("empty.csv", "")
        self.refused("empty.csv")

    def test_nothing_on_standard_input(self):
        self.refused("-")

    def test_a_header_and_nothing_else(self):
        self.write("head.csv", "time (s),acc_x (g)\n")
        self.refused("head.csv")

    def test_bytes_that_are_no_table(self):
        self.write("garbage.csv", bytes((k * 7919 + 13) % 251 for k in range(20_000)))
        self.refused("garbage.csv")

    def test_prose(self):
        self.write("prose.csv", "It was a dark and stormy night;\nthe rain fell in torrents.\n" * 40)
        self.refused("prose.csv")

    def test_a_compressed_file_that_is_none(self):
        self.write("broken.csv.gz", b"\x1f\x8b\x08\x00" + bytes(range(200)))
        self.refused("broken.csv.gz")

    def test_a_sensor_file_that_is_absent_or_no_toml(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.expect_failure(BAD_INPUT, "inspect", "a.csv", "--sensor", "absent.toml")
        self.write("bad.toml", "[sensor\n")
        self.expect_failure(BAD_INPUT, "inspect", "a.csv", "--sensor", "bad.toml")

    def test_a_wheel_of_nothing_but_nan_has_no_answer(self):
        rows = "\n".join(f"{k / 100},nan,nan" for k in range(500))
        self.write("nan.csv", "time (s),acc_x (m/s^2),acc_y (m/s^2)\n" + rows + "\n")
        ran = self.run_command("wheel", "nan.csv")
        self.assertIn(ran.returncode, (FAILED, BAD_INPUT))
        self.assertEqual(ran.stdout, b"")


class Output(CommandTest):
    def test_a_folder_that_is_not_there_is_a_failure_that_leaves_nothing(self):
        self.write("a.csv", turning_csv(seconds=2))
        for flags in (["--json", "no/such/a.json"], ["--report", "no/such/a.html"]):
            self.assertIn("no/such", self.expect_failure(FAILED, "inspect", "a.csv", *flags))
        self.expect_failure(FAILED, "convert", "a.csv", "-o", "no/such/b.csv")
        self.assertEqual(self.leftovers(), [])

    def test_a_full_disk_is_a_failure(self):
        self.write("a.csv", turning_csv(seconds=2))
        with open("/dev/full", "wb") as full:
            ran = subprocess.run([PROGRAM, "inspect", "a.csv"], cwd=self.folder, stdout=full,
                                 stderr=subprocess.PIPE, timeout=60)
        self.assertEqual(ran.returncode, FAILED)
        self.assertIn(b"standard output", ran.stderr)

    def test_a_format_that_cannot_be_written_is_named(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.assertIn(".csv", self.expect_failure(USAGE, "convert", "a.csv", "-o", "b.docx"))

    def test_a_file_that_stands_is_kept_if_the_run_fails(self):
        self.write("out.csv", "mine\n")
        self.expect_failure(BAD_INPUT, "convert", "absent.csv", "-o", "out.csv")
        self.assertEqual((self.folder / "out.csv").read_text(), "mine\n")


class Interrupt(CommandTest):
    def test_ctrl_c_while_waiting_for_input_ends_with_130(self):
        process = subprocess.Popen([PROGRAM, "inspect", "-"], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=self.folder)
        process.stdin.write(b"time (s),acc_x (g)\n0,1\n")
        process.stdin.flush()
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        try:
            process.wait(timeout=20)
        finally:
            process.kill()
        out, error = process.stdout.read(), process.stderr.read()
        for stream in (process.stdin, process.stdout, process.stderr):
            stream.close()
        self.assertEqual(process.returncode, INTERRUPTED, error)
        self.assertEqual(out, b"")
        self.assertIn(b"interrupted", error)


class Help(CommandTest):
    def test_every_verb_shows_an_example(self):
        for verb in ("inspect", "convert", "wheel", "simulate", "budget"):
            text = self.succeed(verb, "--help")
            self.assertIn("Example", text)
            self.assertIn(f"proofmass {verb}", text)

    def test_the_version_is_a_number(self):
        self.assertRegex(self.succeed("--version"), r"^proofmass \d+\.\d+\.\d+\n$")

    def test_help_lists_the_verbs_and_goes_to_standard_output(self):
        text = self.succeed("--help")
        for verb in ("inspect", "convert", "wheel", "simulate", "budget"):
            self.assertIn(verb, text)

    def test_all_reading_verbs_have_all_input_flags(self):
        for verb in ("inspect", "convert", "wheel"):
            for flag in ("--rate", "--unit", "--channel", "--time", "--from", "--to", "--sensor",
                         "--gravity", "--latitude", "--height"):
                self.assertIn(flag, self.succeed(verb, "--help-input"), verb)
            for flag in ("--help-input", "--json", "--config", "--quiet", "--strict", "-v"):
                self.assertIn(flag, self.succeed(verb, "--help"), verb)

    def test_help_fits_a_terminal_of_80_columns(self):
        verbs = re.findall(r"^  ([a-z]+) ", self.succeed("--help"), re.M)
        self.assertEqual(len(verbs), 20)
        for verb in verbs:
            for flag in ("--help", "--help-input"):
                ran = self.run_command(verb, flag)
                for line in ran.stdout.decode().split("Example")[0].splitlines():
                    self.assertLessEqual(len(line), 80, f"{verb} {flag}: {line}")


class Terminal(CommandTest):
    def test_what_is_longer_than_the_terminal_is_wide_is_wrapped_at_words(self):
        self.succeed("simulate", "--rpm", "15", "--duration", "20", "--seed", "3", "-o", "rig.csv")
        plain = self.succeed("wheel", "rig.csv")
        self.assertGreater(max(map(len, plain.splitlines())), 100)
        for width in (60, 80):
            ours, theirs = pty.openpty()
            fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
            process = subprocess.Popen([PROGRAM, "wheel", "rig.csv"], cwd=self.folder, stdout=theirs,
                                       stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
            os.close(theirs)
            shown = b""
            try:
                while piece := os.read(ours, 65536):
                    shown += piece
            except OSError: # the other end is closed
                pass
            process.wait(timeout=60)
            os.close(ours)
            lines = shown.decode().replace("\r", "").splitlines()
            self.assertLessEqual(max(map(len, lines)), width, shown.decode())
            self.assertEqual(" ".join(lines).split(), plain.split())

    def test_no_escape_sequence_leaves_the_program_where_no_terminal_is(self):
        self.write("a.csv", turning_csv(seconds=2))
        ran = self.run_command("inspect", "a.csv", "-v")
        self.assertEqual(ran.returncode, DONE)
        self.assertNotIn(b"\x1b", ran.stdout + ran.stderr)
        self.assertNotIn(b"\r", ran.stdout + ran.stderr)

    def test_on_a_terminal_no_color_is_obeyed(self):
        pid_out, pty_out = os.openpty()
        subprocess.run([PROGRAM, "inspect", "absent.csv"], cwd=self.folder, stderr=pty_out,
                       env={**os.environ, "TERM": "xterm"}, timeout=60)
        coloured = os.read(pid_out, 4096)
        subprocess.run([PROGRAM, "inspect", "absent.csv"], cwd=self.folder, stderr=pty_out,
                       env={**os.environ, "TERM": "xterm", "NO_COLOR": "1"}, timeout=60)
        plain = os.read(pid_out, 4096)
        os.close(pid_out)
        os.close(pty_out)
        self.assertIn(b"\x1b[31m", coloured)
        self.assertNotIn(b"\x1b[31m", plain)


if __name__ == "__main__":
    unittest.main()
