"""--config: any flag from a file."""
import unittest

from command import BAD_INPUT, USAGE, CommandTest, turning_csv


class Config(CommandTest):
    def test_flags_come_from_the_file_and_the_command_line_wins(self):
        self.write("a.csv", turning_csv())
        self.write("c.toml", "from = 5\nto = 15\n")
        self.assertEqual(self.document("inspect", "a.csv", "--config", "c.toml")["samples"], 1000)
        document = self.document("inspect", "a.csv", "--config", "c.toml", "--to", "7")
        self.assertEqual(document["samples"], 200)

    def test_a_table_holds_for_its_verb_alone(self):
        self.write("a.csv", turning_csv(seconds=4))
        self.write("c.toml", "[inspect]\nto = 1\n[budget]\ntimes = [1, 2]\n")
        self.assertEqual(self.document("inspect", "a.csv", "--config=c.toml")["samples"], 100)
        rows = self.document("budget", "--config", "c.toml")["rows"]
        self.assertEqual([error["t_s"] for error in rows[0]["error_m"]], [1, 2])

    def test_lists_repeat_a_flag_and_switches_are_true_or_false(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.write("c.toml", 'channel = ["acc_x", "acc_y"]\nquiet = true\nverbose = false\n')
        document = self.document("inspect", "a.csv", "--config", "c.toml")
        self.assertEqual([c["name"] for c in document["channels"]], ["acc_x", "acc_y"])

    def test_underscores_are_as_good_as_dashes(self):
        self.write("c.toml", "bias_mg = 2\n")
        self.assertEqual(len(self.document("budget", "--config", "c.toml")["rows"]), 1)

    def test_a_flag_of_another_verb_at_the_top_is_skipped(self):
        self.write("c.toml", "spin_axis = 'z'\n")
        self.succeed("budget", "--config", "c.toml")

    def test_a_flag_that_no_verb_has_is_named_with_its_line(self):
        self.write("c.toml", "quiet = true\nspim_axis = 'z'\n")
        line = self.expect_failure(USAGE, "budget", "--config", "c.toml")
        self.assertIn("c.toml: line 2", line)
        self.assertIn("spim-axis", line)

    def test_a_table_that_is_no_verb_is_named(self):
        self.write("c.toml", "[weel]\nfrom = 1\n")
        self.assertIn("weel", self.expect_failure(USAGE, "budget", "--config", "c.toml"))

    def test_a_file_that_is_absent_or_no_toml_is_bad_input(self):
        self.expect_failure(BAD_INPUT, "budget", "--config", "absent.toml")
        self.write("c.toml", "a = = 1\n")
        self.assertIn("line 1", self.expect_failure(BAD_INPUT, "budget", "--config", "c.toml"))

    def test_a_value_that_makes_no_sense_is_a_usage_error(self):
        self.write("c.toml", "rate = 'fast'\n")
        self.write("a.csv", turning_csv(seconds=1))
        self.expect_failure(USAGE, "inspect", "a.csv", "--config", "c.toml")
        self.write("c.toml", "quiet = 3\n")
        self.expect_failure(USAGE, "inspect", "a.csv", "--config", "c.toml")


if __name__ == "__main__":
    unittest.main()
