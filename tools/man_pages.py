#!/usr/bin/env python3
"""Makes the man pages, proofmass(1) and one per verb, from the program's own --help.

    tools/man_pages.py build/release/proofmass docs/cli.md OUT

docs/cli.md has what --help omits: the exit statuses, the environment, and a paragraph on each verb.
The pages are compressed, as Debian requires. Their date is that of $SOURCE_DATE_EPOCH, else today's.
"""
import gzip
import os
import re
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

COLUMN = 30  # where the help's descriptions begin, in bytes


@dataclass
class Help:
    description: str
    usage: str  # after the program's and the verb's name
    groups: dict[str, list[tuple[str, str]]] = field(default_factory=dict)  # names and descriptions
    footer: list[str] = field(default_factory=list)


def read_help(text: bytes) -> Help:
    """CLI11's layout: description, usage, groups of entries in two columns, and text after them."""
    lines = text.split(b"\n")
    start = next(k for k, line in enumerate(lines) if line.startswith(b"Usage: "))
    usage = re.sub(r"^Usage: proofmass( [a-z]+)? ?", "", lines[start].decode())
    found = Help(" ".join(line.decode().strip() for line in lines[:start]).strip(), usage)
    group = None
    for line in lines[start + 1 :]:
        text = line.decode(errors="replace").rstrip()
        if line.startswith(b"  ") and group is not None:
            name, what = line[:COLUMN].decode(errors="replace").strip(), line[COLUMN:].decode(errors="replace")
            if len(line) > COLUMN and line[COLUMN - 1 : COLUMN] != b" ":  # the description is below
                name, what = text.strip(), ""
            if name:
                group.append((name, what.strip()))
            else:
                group[-1] = (group[-1][0], f"{group[-1][1]} {what.strip()}".strip())
        elif re.fullmatch(r"[A-Z][a-z]+( [a-z]+)?:", text) and not text.startswith("Example"):
            group = found.groups.setdefault(text[:-1], [])
        elif text or found.footer:
            group = None
            found.footer.append(text)
    return found


def escaped(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in ".'" else text


def entry(name: str, what: str) -> tuple[str, str]:
    """"-o,--output FILE": literal text in bold, placeholders in italics."""
    names, _, kind = name.partition(" ")
    style = "B" if names.startswith("-") else "I"
    shown = ", ".join(f"\\f{style}{escaped(one)}\\fR" for one in names.split(","))
    if kind:
        shown += f" \\fI{escaped(kind)}\\fR"
    return shown, escaped(what)


def of_markdown(text: str) -> str:
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text)
    parts = re.split(r"(`[^`]*`)", text.replace("\n", " "))
    return "".join(f"\\fB{escaped(p[1:-1])}\\fR" if p.startswith("`") else escaped(p).removeprefix("\\&") for p in parts)


def sections(markdown: str) -> dict[str, str]:
    pieces = re.split(r"^## (.*)$", markdown, flags=re.M)
    return dict(zip((head.strip("` ") for head in pieces[1::2]), pieces[2::2]))


def table(markdown: str) -> list[list[str]]:
    """The rows of the first table, without its head."""
    rows = []
    for line in markdown.splitlines():
        if line.startswith("|"):
            rows.append([cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]])
        elif rows:
            break
    return rows[2:]


def entries(rows) -> list[str]:
    return [line for name, what in rows for line in (".TP", name, what) if line]


def head(name: str, version: str) -> list[str]:
    date = time.strftime("%Y-%m-%d", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))))
    title = escaped(name.upper())
    return [f'.TH {title} 1 "{date}" "Proofmass {version}" "User Commands"', ".nh", ".ad l"]


def synopsis(name: list[str], usage: str) -> list[str]:
    return [".SH SYNOPSIS", "\\fB" + escaped(" ".join(name)) + "\\fR " + escaped(usage).replace("OPTIONS", "\\fIOPTIONS\\fR")]


def options(groups: dict[str, list[tuple[str, str]]]) -> list[str]:
    lines = []
    for group, flags in groups.items():
        lines.append({"Positionals": ".SH ARGUMENTS", "Options": ".SH OPTIONS"}.get(group, f".SS {group}"))
        lines += entries(entry(name, what) for name, what in flags)
    return lines


def footer(found: Help) -> list[str]:
    start = next((k for k, line in enumerate(found.footer) if line.startswith("Example")), None)
    if start is None:
        return []
    text = [line for line in found.footer[start + 1 :] if line]
    return [".SH EXAMPLES", ".EX", *(escaped(line.strip()) for line in text), ".EE"]


def exit_status(cli: dict[str, str]) -> list[str]:
    rows = table(cli["Streams and exit status"])
    return [".SH EXIT STATUS", *entries((f"\\fB{status}\\fR", of_markdown(what)) for status, what in rows)]


def environment(cli: dict[str, str]) -> list[str]:
    rows = table(cli["Environment"])
    return [".SH ENVIRONMENT", *entries((of_markdown(name), of_markdown(what)) for name, what in rows)]


def opening(verb: str, cli: dict[str, str]) -> list[str]:
    """The beginning of the verb's section in docs/cli.md, after its usage: a paragraph, and a list if one follows."""
    first, *others = cli.get(verb, "").strip().split("\n\n")
    text = of_markdown(re.sub(r"^`proofmass [^`]*`: *", "", first))
    items = re.split(r"^- ", others[0], flags=re.M)[1:] if others and others[0].startswith("- ") else []
    return [text[:1].upper() + text[1:], *(line for item in items for line in (".IP \\(bu 3", of_markdown(item.strip())))]


def verbs_of(top: Help) -> list[tuple[str, str]]:
    return [verb for group, verbs in top.groups.items() if group != "Options" for verb in verbs]


def main_page(found: Help, version: str, cli: dict[str, str]) -> list[str]:
    verbs = verbs_of(found)
    name = found.description.split(":")[0]
    return [
        *head("proofmass", version),
        ".SH NAME",
        f"proofmass \\- {escaped(name[0].lower() + name[1:])}",
        *synopsis(["proofmass"], "VERB [OPTIONS] [FILE...]"),
        ".SH DESCRIPTION",
        escaped(found.description),
        ".SH VERBS",
        *entries((f"\\fBproofmass\\-{verb}\\fR(1)", escaped(what)) for verb, what in verbs),
        *options({"Options": found.groups["Options"]}),
        *exit_status(cli),
        *environment(cli),
        ".SH SEE ALSO",
        see_also([verb for verb, _ in verbs]),
    ]


def see_also(verbs: list[str]) -> str:
    return ",\n".join(f".BR proofmass\\-{verb} (1)" for verb in verbs).replace("(1),", "(1) ,")


def verb_page(verb: str, found: Help, version: str, cli: dict[str, str]) -> list[str]:
    return [
        *head(f"proofmass-{verb}", version),
        ".SH NAME",
        f"proofmass\\-{verb} \\- {escaped(found.description)}",
        *synopsis(["proofmass", verb], found.usage),
        ".SH DESCRIPTION",
        *(opening(verb, cli) if verb in cli else [escaped(found.description)]),
        *options(found.groups),
        *footer(found),
        *exit_status(cli),
        ".SH SEE ALSO",
        ".BR proofmass (1)",
        ".PP",
        "Pages of the documentation that are named here lie in share/doc/proofmass/docs,",
        "below /usr or where else Proofmass was installed.",
    ]


def write(folder: Path, name: str, lines: list[str]):
    with open(folder / f"{name}.1.gz", "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as page:
        page.write(("\n".join(lines) + "\n").encode())


def main() -> int:
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    program, cli, folder = Path(sys.argv[1]).resolve(), sections(Path(sys.argv[2]).read_text()), Path(sys.argv[3])

    def says(*words: str) -> bytes:
        return subprocess.run([program, *words], stdout=subprocess.PIPE, check=True).stdout

    version = says("--version").decode().split()[-1]
    top = read_help(says("--help"))
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.1.gz"):
        old.unlink()
    write(folder, "proofmass", main_page(top, version, cli))
    for verb, _ in verbs_of(top):
        found = read_help(says(verb, "--help"))
        if any("--help-input" in name for name, _ in found.groups["Options"]):
            found.groups |= read_help(says(verb, "--help-input")).groups
        write(folder, f"proofmass-{verb}", verb_page(verb, found, version, cli))
    return 0


if __name__ == "__main__":
    sys.exit(main())
