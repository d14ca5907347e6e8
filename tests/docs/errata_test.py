"""docs/errata.md agrees with the tests that it names: each entry names a test, each named test is in
the sources, and each test of the errata is named."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "errata.md"
TEST = re.compile(r"^TEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.M)
NAMED = re.compile(r"`([A-Z]\w*\.[A-Z]\w*)`")


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def rows() -> list[list[str]]:
    """The entries of all tables, without their headings."""
    found, heading = [], None
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if not line.startswith("|"):
            heading = None
        elif heading is None:
            heading = cells(line)
        elif set(line) - set("|- "):
            found.append(cells(line))
    return found


def tests_of_the_sources() -> set[str]:
    found = set()
    for top in ("src", "tests"):
        for source in (ROOT / top).rglob("*_test.cpp"):
            found |= {".".join(name) for name in TEST.findall(source.read_text(encoding="utf-8"))}
    return found


class Errata(unittest.TestCase):
    def test_every_entry_is_whole_and_names_a_test(self):
        entries = rows()
        self.assertGreater(len(entries), 60)
        for entry in entries:
            with self.subTest(place=entry[0]):
                self.assertEqual(len(entry), 5)
                self.assertTrue(all(entry))
                self.assertTrue(NAMED.findall(entry[-1]))
                self.assertEqual(NAMED.sub("", entry[-1]).strip(", "), "")

    def test_every_test_that_is_named_exists(self):
        named = set(NAMED.findall(PAGE.read_text(encoding="utf-8")))
        self.assertEqual(sorted(named - tests_of_the_sources()), [])

    def test_every_test_of_the_errata_is_named(self):
        of_errata = {name for name in tests_of_the_sources() if name.startswith("Errata")}
        self.assertGreater(len(of_errata), 30)
        self.assertEqual(sorted(name for name in of_errata if f"`{name}`" not in PAGE.read_text(encoding="utf-8")), [])

    def test_no_entry_stands_twice(self):
        said = [tuple(entry[:2]) for entry in rows()]
        self.assertEqual(len(said), len(set(said)))


if __name__ == "__main__":
    unittest.main()
