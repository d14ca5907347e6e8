#!/usr/bin/env python3
"""Checks a built site: every internal link, anchor and picture exists, and nothing is loaded from another site.

    tools/site/check_site.py build/site
"""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

FETCHED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src", "object": "data", "embed": "src"}
CSS_FETCH = re.compile(r"""(?:url\(\s*["']?|@import\s+["'])((?:https?:)?//[^"')]+)""")


class Page(HTMLParser):
    """The references of one page, and its anchors."""

    def __init__(self, text: str):
        super().__init__()
        self.links, self.fetched, self.anchors, self.style = [], [], set(), []
        self.in_style = False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        elif tag == "link" and given.get("href") and "canonical" not in given.get("rel", ""):
            self.fetched.append(given["href"])
        elif given.get(FETCHED.get(tag, "")):
            self.fetched.append(given[FETCHED[tag]])
        self.style.append(given.get("style") or "")
        self.in_style = tag == "style"

    def handle_data(self, data):
        if self.in_style:
            self.style.append(data)


def is_outside(reference: str) -> bool:
    return bool(urlsplit(reference).scheme) or reference.startswith("//")


def faults_of(site: Path) -> list:
    pages = {path: Page(path.read_text()) for path in sorted(site.rglob("*.html"))}
    faults = [] if pages else [f"{site}: no page"]
    for path, page in pages.items():
        name = path.relative_to(site)
        for reference in page.links + page.fetched:
            if is_outside(reference):
                if reference in page.fetched and not reference.startswith("data:"):
                    faults.append(f"{name}: fetches {reference}")
                continue
            file, anchor = urldefrag(reference)
            there = (path.parent / unquote(file.split("?")[0])).resolve() if file else path
            if there.is_dir():
                there /= "index.html"
            if not there.is_file():
                faults.append(f"{name}: {reference} is not there")
            elif anchor and there in pages and unquote(anchor) not in pages[there].anchors:
                faults.append(f"{name}: {reference} has no such anchor")
        faults += [f"{name}: fetches {url}" for url in CSS_FETCH.findall("\n".join(page.style))]
    for path in sorted(site.rglob("*.css")):
        faults += [f"{path.relative_to(site)}: fetches {url}" for url in CSS_FETCH.findall(path.read_text())]
    return faults


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    site = Path(sys.argv[1]).resolve()
    faults = faults_of(site)
    for fault in faults:
        print(fault, file=sys.stderr)
    if not faults:
        pages = list(site.rglob("*.html"))
        print(f"{len(pages)} pages, every link inside them leads somewhere")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
