"""Every example in the pages prints the output shown there.

After a change, `PROOFMASS=build/release/proofmass python3 tests/docs/examples_test.py --write` replaces output
that no longer matches by the current one; review the difference before committing it.
"""
import os
import sys
import tempfile
import unittest
from pathlib import Path

from console_blocks import BLOCK, DOCS, ROOT, agrees, blocks_of, published, run, with_elisions

PROGRAM = os.path.abspath(os.environ["PROOFMASS"])
PAGES = [page for page in [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))] if BLOCK.search(page.read_text())]
CHAPTERS = "noise drift calibration estimation wheel acquisition formats".split()


class Examples(unittest.TestCase):
    maxDiff = None

    def check(self, block, folder: Path):
        for command in block.commands:
            printed = run(command, folder, PROGRAM)
            place = f"{block.page.name}, example at line {block.line}: {command.text}"
            if not agrees(command.output, printed):
                self.assertEqual("\n".join(command.output), "\n".join(printed), place)

    def test_what_the_pages_say_is_printed(self):
        for page in PAGES:
            with self.subTest(page=page.name), tempfile.TemporaryDirectory() as folder:
                for block in blocks_of(page):
                    if not block.recordings:
                        self.check(block, Path(folder))

    def test_every_chapter_has_an_example(self):
        self.assertLessEqual({f"{name}.md" for name in [*CHAPTERS, "index"]}, {page.name for page in PAGES if page.parent == DOCS})


class PublishedRecordings(Examples):
    test_what_the_pages_say_is_printed = None
    test_every_chapter_has_an_example = None

    def test_what_the_pages_say_of_recordings_of_others_is_printed(self):
        blocks = [block for page in PAGES for block in blocks_of(page) if block.recordings]
        self.assertTrue(blocks)
        missing = sorted({name for block in blocks for name in block.recordings if not published(name)})
        if missing:
            self.skipTest(f"SKIPPED, not in $PROOFMASS_DATA or ../shared/data: {', '.join(missing)}")
        for block in blocks:
            with self.subTest(page=block.page.name, line=block.line), tempfile.TemporaryDirectory() as folder:
                for name in block.recordings:
                    (Path(folder) / name).unlink(missing_ok=True)
                    (Path(folder) / name).symlink_to(published(name))
                self.check(block, Path(folder))


def write_outputs():
    """Replaces output in the pages that differs from the current one."""
    for page in PAGES:
        with tempfile.TemporaryDirectory() as folder:
            text = page.read_text()
            for block in blocks_of(page):
                if not all(published(name) for name in block.recordings):
                    continue
                for name in block.recordings:
                    link = Path(folder) / name
                    link.exists() or link.symlink_to(published(name))
                for command in block.commands:
                    printed = run(command, Path(folder), PROGRAM)
                    old = "".join(line + "\n" for line in [f"$ {command.text}", *command.output])
                    if not agrees(command.output, printed):
                        text = text.replace(old, "".join(line + "\n" for line in [f"$ {command.text}", *with_elisions(command.output, printed)]), 1)
                        print(f"{page.name}: {command.text}")
            page.write_text(text)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        write_outputs()
    else:
        unittest.main()
