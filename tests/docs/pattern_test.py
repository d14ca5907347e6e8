"""The comparison of the examples can fail."""
import unittest

from console_blocks import agrees, commands_of


class Pattern(unittest.TestCase):
    def test_the_same_lines_match_and_one_digit_does_not(self):
        self.assertTrue(agrees(["turns 11.0", ""], ["turns 11.0", ""]))
        self.assertFalse(agrees(["turns 11.0"], ["turns 11.1"]))
        self.assertFalse(agrees(["turns 11.0"], ["turns 1150"]))

    def test_a_line_too_few_or_too_many_does_not_match(self):
        self.assertFalse(agrees(["a"], ["a", "b"]))
        self.assertFalse(agrees(["a", "b"], ["a"]))
        self.assertFalse(agrees([], ["a"]))

    def test_an_ellipsis_alone_stands_for_lines_and_within_a_line_for_text(self):
        self.assertTrue(agrees(["a", "…", "d"], ["a", "b", "c", "d"]))
        self.assertTrue(agrees(["a", "…"], ["a"]))
        self.assertTrue(agrees(["at … Hz"], ["at 200.1 ± 0.2 Hz"]))
        self.assertFalse(agrees(["at … Hz"], ["at 200.1", "Hz"]))
        self.assertFalse(agrees(["a", "…", "d"], ["a", "b"]))

    def test_a_narrow_space_may_be_written_as_any(self):
        self.assertTrue(agrees(["12 000 rows"], ["12\u202f000 rows"]))
        self.assertFalse(agrees(["12 000 rows"], ["12000 rows"]))

    def test_commands_go_on_behind_a_backslash(self):
        first, second = commands_of("$ proofmass a \\\n    --b c\nout\n\nput\n$ proofmass d\n")
        self.assertEqual(first.words, ["proofmass", "a", "--b", "c"])
        self.assertEqual(first.output, ["out", "", "put"])
        self.assertEqual(second.output, [])


if __name__ == "__main__":
    unittest.main()
