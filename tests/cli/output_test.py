"""Where results go: standard output, --json, --report, --quiet."""
import hashlib
import platform
import unittest

from command import CommandTest, parse_json, turning_csv


class Output(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("a.csv", turning_csv(seconds=2))

    def test_json_to_standard_output_is_alone_there(self):
        for extra in ([], ["-v"], ["--report", "a.html"]):
            ran = self.run_command("inspect", "a.csv", "--json", "-", *extra)
            self.assertEqual(parse_json(ran.stdout.decode())["verb"], "inspect")

    def test_json_to_a_file_leaves_the_text_on_standard_output(self):
        text = self.succeed("inspect", "a.csv", "--json", "a.json")
        self.assertIn("acc_x", text)
        document = parse_json((self.folder / "a.json").read_text())
        self.check_document("inspect", document)
        self.assertEqual(self.leftovers(), [])

    def test_the_same_run_gives_the_same_bytes(self):
        made = []
        for _ in range(2):
            self.succeed("inspect", "a.csv", "--json", "a.json", "--report", "a.html",
                         environment={"SOURCE_DATE_EPOCH": "0"})
            made.append([(self.folder / name).read_bytes() for name in ("a.json", "a.html")])
        self.assertEqual(made[0], made[1])

    def test_documents_and_pages_say_what_is_needed_to_repeat_them(self):
        (self.folder / "set").mkdir()
        self.write("set/b.csv", turning_csv(seconds=3))
        self.write("flags.toml", 'unit = "m/s2"\n')
        document = self.document("inspect", "a.csv", "set", "--from", "0.5", "--config", "flags.toml",
                                 "--report", "my page.html", environment={"SOURCE_DATE_EPOCH": "86400"})
        said = document["provenance"]
        self.assertEqual(said["command"], "proofmass inspect a.csv set --from 0.5 --config flags.toml "
                                          "--report 'my page.html' --json -")
        self.assertEqual((said["options"]["--from"], said["options"]["--unit"]), ("0.5", "m/s2"))
        self.assertEqual(said["date"], "1970-01-02T00:00:00Z")
        self.assertEqual(said["version"], document["proofmass"])
        self.assertEqual(said["host"], platform.node())
        inputs = {one["path"]: (one["bytes"], one["sha256"]) for one in said["inputs"]}
        for name in ("a.csv", "set/b.csv", "flags.toml"):
            content = (self.folder / name).read_bytes()
            self.assertEqual(inputs.pop(name), (len(content), hashlib.sha256(content).hexdigest()))
        self.assertEqual(inputs, {})
        page = (self.folder / "my page.html").read_text()
        self.assertIn(hashlib.sha256((self.folder / "a.csv").read_bytes()).hexdigest(), page)
        self.assertIn("1970-01-02T00:00:00Z", page)

    def test_what_comes_on_standard_input_is_summed_while_it_is_read(self):
        content = (self.folder / "a.csv").read_bytes()
        long = content + b"".join(b"%d,1,2,3\n" % k for k in range(100, 200_000))
        for given in (content, long):
            document = self.document("inspect", "-", stdin=given)
            self.assertEqual(document["provenance"]["inputs"],
                             [{"path": "-", "bytes": len(given), "sha256": hashlib.sha256(given).hexdigest()}])

    def test_figures_are_written_as_other_programs_read_them(self):
        self.succeed("simulate", "--rpm", "30", "--duration", "60", "--seed", "1", "-o", "rig.csv")
        for arguments in (["inspect", "rig.csv"], ["wheel", "rig.csv"], ["noise", "rig.csv"], ["budget"]):
            ran = self.run_command(*arguments)
            text = (ran.stdout + ran.stderr).decode()
            self.assertNotIn("\u2212", text)
            self.assertNotIn("\u202f", text)
        self.assertIn("12000", self.succeed("inspect", "rig.csv"))
        page = self.succeed("inspect", "rig.csv", "--report", "rig.html") and (self.folder / "rig.html").read_text()
        self.assertIn("\u2212", page)

    def test_where_the_locale_is_not_utf_8_the_text_is_ascii(self):
        self.succeed("simulate", "--rpm", "30", "--duration", "60", "--seed", "1", "-o", "rig.csv")
        for arguments in (["inspect", "rig.csv"], ["wheel", "rig.csv"], ["noise", "rig.csv"], ["budget"], ["--help"],
                          ["calibrate", "--help"], ["wheel", "absent-\u00e4.csv"]):
            for locale in ("C", "POSIX", "de_DE.ISO-8859-1"):
                ran = self.run_command(*arguments, environment={"LC_ALL": locale})
                self.assertTrue((ran.stdout + ran.stderr).isascii(), arguments)
        ascii = self.succeed("wheel", "rig.csv", environment={"LC_ALL": "C"})
        self.assertIn("+-", ascii)
        self.assertIn("deg", ascii)
        # The columns are at the same positions as in UTF-8.
        rows = self.succeed("wheel", "rig.csv").splitlines()
        begin = [row.index("path of") for row in rows if "path of" in row]
        self.assertEqual(begin, [row.index("path of") for row in ascii.splitlines() if "path of" in row])

    def test_a_password_does_not_get_into_a_document(self):
        self.run_command("record", "mqtt://127.0.0.1:1/t?user=me&password=geheim", "-o", "r.mcap",
                         "--duration", "0.1", "--json", "r.json")
        document = self.document("record", "sim:?speed=max&seconds=1", "-o", "s.mcap")
        self.assertIn("sim:?speed=max&seconds=1", document["provenance"]["command"])
        for made in self.folder.iterdir():
            self.assertNotIn(b"geheim", made.read_bytes() if made.is_file() else b"")

    def test_quiet_says_nothing_on_standard_error(self):
        lines = turning_csv(seconds=4).splitlines()
        lines[100] = lines[100].split(",")[0] + ",3e34,nan,1"
        self.write("dirty.csv", "\n".join(lines) + "\n")
        ran = self.run_command("inspect", "dirty.csv", "--quiet")
        self.assertEqual(ran.stderr, b"")

    def test_verbose_adds_what_was_found_while_reading(self):
        plain = self.run_command("convert", "a.csv", "-o", "b.csv").stderr
        told = self.run_command("convert", "a.csv", "-o", "b.csv", "-v").stderr
        self.assertGreater(len(told), len(plain))

    def test_a_decimal_comma_locale_changes_nothing(self):
        epoch = {"SOURCE_DATE_EPOCH": "0"}
        here = self.succeed("inspect", "a.csv", "--json", "-", environment=epoch)
        there = self.succeed("inspect", "a.csv", "--json", "-",
                             environment={**epoch, "LC_ALL": "de_DE.UTF-8"})
        self.assertEqual(here, there)


if __name__ == "__main__":
    unittest.main()
