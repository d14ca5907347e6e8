"""Where results go: standard output, --json, --report, --quiet."""
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
        for name in ("1", "2"):
            self.succeed("inspect", "a.csv", "--json", f"{name}.json", "--report", f"{name}.html")
        for kind in ("json", "html"):
            self.assertEqual((self.folder / f"1.{kind}").read_bytes(),
                             (self.folder / f"2.{kind}").read_bytes())

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
        here = self.succeed("inspect", "a.csv", "--json", "-")
        there = self.succeed("inspect", "a.csv", "--json", "-", environment={"LC_ALL": "de_DE.UTF-8"})
        self.assertEqual(here, there)


if __name__ == "__main__":
    unittest.main()
