#!/usr/bin/env python3
"""Collects the sources of the site: README, CHANGELOG, CONTRIBUTING and docs/, with the repository's layout.

    tools/site/stage.py build/site-source

Links are unchanged, so that the same pages work in the repository. A link target that is not a page gets
its own page: a source file as a listing, a folder as a list of its files. The README is the front page. A
broken link is an error.
"""
import os
import re
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROJECT = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"]
CHAPTERS = "noise drift calibration estimation wheel acquisition fleet formats python".split()
METHODS = """wheel drive track tilt motor servo estimation models smoothers steady_state tuning consistency noise drift budget calibration gyroscope encoder
  tumble rotation_test model_equation fit record live guided iio daqmx framing phones""".split()
LISTED = {".cpp": "cpp", ".hpp": "cpp", ".json": "json", ".toml": "toml", ".py": "python", ".sh": "bash"}
FOLDERS = {"docs/schema": "Schemas of the JSON documents", "examples": "Programs that use the library"}
PICTURES = {".svg", ".png", ".jpg"}
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")


def target_page(path: Path) -> Path:
    """The page of a file or folder of the repository on the site."""
    if path == ROOT / "README.md":
        return ROOT / "index.md"
    if path.is_dir():
        return path / "index.md"
    if path.suffix == ".md" or path.suffix in PICTURES:
        return path
    return path.with_name(path.name + ".md")


class Stage:
    def __init__(self, folder: Path):
        self.folder = folder
        self.linked = set() # linked files and folders that are not pages
        self.broken = []

    def rewrite(self, page: Path, text: str) -> str:
        """The text of a page with links to the site's pages instead of the repository's files."""

        def link(match) -> str:
            before, target, anchor, after = match.groups()
            if "://" in target or target.startswith("mailto:"):
                return match[0]
            path = Path(os.path.normpath(page.parent / target))
            if not path.exists():
                self.broken.append(f"{page.relative_to(ROOT)}: {target}")
                return match[0]
            there = target_page(path)
            if there != path and path != ROOT / "README.md":
                self.linked.add(path)
            return f"{before}{os.path.relpath(there, page.parent)}{anchor or ''}{after}"

        pieces = re.split(r"(^```.*?^```|`[^`\n]*`)", text, flags=re.S | re.M) # code is unchanged
        return "".join(p if p.startswith("`") else LINK.sub(link, p) for p in pieces)

    def write(self, page: Path, text: str):
        out = self.folder / page.relative_to(ROOT)
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text)

    def page(self, path: Path):
        self.write(target_page(path), self.rewrite(path, path.read_text()))

    def listing(self, path: Path):
        name = path.relative_to(ROOT)
        language = LISTED.get(path.suffix, "text")
        self.write(target_page(path), f"# {path.name}\n\n`{name}`\n\n````{language}\n{path.read_text()}````\n")

    def folder_page(self, path: Path):
        files = sorted(p for p in path.iterdir() if p.suffix in LISTED)
        name = str(path.relative_to(ROOT))
        lines = [f"# {FOLDERS.get(name, name + '/')}", ""]
        for file in files:
            first = re.match(r"(?:///?|#) (.*)", file.read_text())
            lines.append(f"- [{file.name}]({file.name}.md)" + (f": {first[1]}" if first else ""))
            self.listing(file)
        self.write(path / "index.md", "\n".join(lines) + "\n\n" + toctree("", [file.name for file in files]))


def toctree(caption: str, pages: list) -> str:
    head = "```{toctree}\n:hidden:\n" + (f":caption: {caption}\n" if caption else "")
    return head + "\n" + "\n".join(pages) + "\n```\n\n"


def contents(others: list, listings: list) -> str:
    """The site's contents; a page of docs/ that is in no list is under Reference."""
    return "".join([
        toctree("Begin", ["docs/index"]),
        toctree("Chapters", [f"docs/{name}" for name in CHAPTERS]),
        toctree("Reference", ["docs/cli", "docs/symbols", "docs/errata", *others, "docs/schema/index"]),
        toctree("Methods", [f"docs/methods/{name}" for name in METHODS]),
        toctree("Project", ["examples/index", "CHANGELOG", "CONTRIBUTING", *listings]),
    ])


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    stage = Stage(Path(sys.argv[1]).resolve())
    shutil.rmtree(stage.folder, ignore_errors=True)
    docs = sorted((ROOT / "docs").rglob("*.md"))
    for path in [*docs, *(ROOT / name for name in PROJECT)]:
        stage.page(path)
    folders = {p for p in stage.linked if p.is_dir()} | {ROOT / name for name in FOLDERS}
    for path in folders:
        stage.folder_page(path)
    listings = sorted(p for p in stage.linked - folders if p.parent not in folders)
    for path in listings:
        stage.listing(path)
    named = {"index", "cli", "symbols", "errata", *CHAPTERS}
    others = [f"docs/{p.stem}" for p in docs if p.parent == ROOT / "docs" and p.stem not in named]
    with open(stage.folder / "index.md", "a") as front:
        front.write("\n" + contents(others, [str(p.relative_to(ROOT)) for p in listings]))
    shutil.copytree(ROOT / "docs/images", stage.folder / "docs/images")
    for line in stage.broken:
        print(f"broken link in {line}", file=sys.stderr)
    return 1 if stage.broken else 0


if __name__ == "__main__":
    sys.exit(main())
