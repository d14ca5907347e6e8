"""The site is built from the pages without a broken link; its checks can fail."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/site"))

from check_site import faults_of # noqa: E402
from stage import Stage # noqa: E402


class Site(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="proofmass-site-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def faults(self, **pages) -> list:
        for name, text in pages.items():
            (self.folder / f"{name}.html").write_text(text)
        return faults_of(self.folder)

    def test_it_is_built(self):
        if not shutil.which("sphinx-build"):
            self.skipTest("SKIPPED, no sphinx-build: python3-sphinx, python3-myst-parser and furo are missing")
        built = subprocess.run([ROOT / "tools/site.sh", self.folder / "site"], capture_output=True, text=True)
        self.assertEqual(built.returncode, 0, built.stderr)
        self.assertRegex(built.stdout, r"^\d+ pages, every link")
        for page in ["index.html", "docs/index.html", "docs/noise.html", "docs/methods/noise.html", "docs/errata.html"]:
            self.assertTrue((self.folder / "site" / page).is_file(), page)

    def test_a_link_an_anchor_and_a_picture_that_are_not_there_are_named(self):
        self.assertEqual(self.faults(a='<p id="x"><a href="b.html#y">b</a><a href="#x">up</a>', b='<p id="y">'), [])
        self.assertEqual(self.faults(a='<a href="c.html">'), ["a.html: c.html is not there"])
        self.assertEqual(self.faults(a='<a href="b.html#z">'), ["a.html: b.html#z has no such anchor"])
        self.assertEqual(self.faults(a='<img src="p.svg">'), ["a.html: p.svg is not there"])

    def test_what_would_be_fetched_from_elsewhere_is_named(self):
        self.assertEqual(self.faults(a='<a href="https://example.org/">to read</a>'), [])
        self.assertEqual(self.faults(a='<script src="https://example.org/s.js"></script>'), ["a.html: fetches https://example.org/s.js"])
        self.assertEqual(self.faults(a='<style>@import "//example.org/f.css";</style>'), ["a.html: fetches //example.org/f.css"])
        (self.folder / "s.css").write_text("p { background: url(https://example.org/p.png) }")
        self.assertEqual(self.faults(a="<p>"), ["s.css: fetches https://example.org/p.png"])

    def test_links_to_sources_and_folders_become_pages_and_code_stays(self):
        stage = Stage(self.folder)
        page = ROOT / "docs/methods/noise.md"
        text = stage.rewrite(page, "[a](../../examples/06_fit_a_curve.cpp) [b](../schema/) [c](../../README.md#what-it-does) `[d](e.md)`")
        self.assertEqual(text, "[a](../../examples/06_fit_a_curve.cpp.md) [b](../schema/index.md) [c](../../index.md#what-it-does) `[d](e.md)`")
        self.assertEqual(stage.broken, [])
        stage.rewrite(page, "[gone](../gone.md)")
        self.assertEqual(stage.broken, ["docs/methods/noise.md: ../gone.md"])


if __name__ == "__main__":
    unittest.main()
