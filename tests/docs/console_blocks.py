"""The examples in the pages: blocks marked console, with commands after "$ " and their output.

A line "…" matches any lines; "…" within a line matches any text. A command may continue in the next line
after a backslash. "$ cat FILE" shows a file written by the reader: it is written here. The blocks of one page
run in order in one folder, so that they can share files. A command on an .xz file uses a published recording,
which is stored beside the project, not in it.
"""
import difflib
import os
import re
import shlex
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.S | re.M)


@dataclass
class Command:
    text: str # as written, without "$ "
    output: list = field(default_factory=list)

    @property
    def words(self) -> list:
        return shlex.split(self.text.replace("\\\n", " "))


@dataclass
class Block:
    page: Path
    line: int # line of the first command in the page
    commands: list

    @property
    def recordings(self) -> list:
        """The published recordings that it reads."""
        return [word for command in self.commands for word in command.words if word.endswith(".xz")]


def commands_of(text: str) -> list:
    commands, unfinished = [], False
    for line in text.splitlines():
        if unfinished:
            commands[-1].text += "\n" + line
        elif line.startswith("$ "):
            commands.append(Command(line[2:]))
        else:
            commands[-1].output.append(line)
            continue
        unfinished = line.endswith("\\")
    return commands


def blocks_of(page: Path) -> list:
    text = page.read_text()
    return [Block(page, text.count("\n", 0, found.start(1)) + 1, commands_of(found[1])) for found in BLOCK.finditer(text)]


def pattern_of(lines: list) -> re.Pattern:
    """The pattern that the printed lines must match as a whole."""
    parts = []
    for line in lines:
        if line.strip() == "…":
            parts.append(r"(?:.*\n)*?")
        else:
            parts.append(".*?".join(re.escape(piece) for piece in line.rstrip().split("…")) + r"\n")
    return re.compile("".join(parts))


def with_elisions(written: list, printed: list) -> list:
    """The printed lines, with "…" where the page omits text between matching lines."""
    def place(line: str, first: int) -> int | None:
        alike = [(difflib.SequenceMatcher(None, line, one).ratio(), -k) for k, one in enumerate(printed) if k >= first]
        best = max(alike, default=(0.0, 0))
        return -best[1] if best[0] > 0.6 else None

    out, done = [], 0
    for k, line in enumerate(written):
        if line.strip() != "…":
            continue
        above = next((one for one in reversed(written[:k]) if one.strip()), None)
        below = next((one for one in written[k + 1 :] if one.strip()), None)
        before = place(above, done) if above is not None else done - 1
        after = place(below, done) if below is not None else len(printed)
        if before is None or after is None or after <= before + 1:
            continue
        blank = [""] if k > 0 and not written[k - 1].strip() else []
        out += [*printed[done : before + 1], *blank, line]
        done = after
    return out + printed[done:]


def agrees(written: list, printed: list) -> bool:
    """True if a command printed the output in the page; a narrow space in a number matches any space."""
    plain = [[line.replace("\u202f", " ") for line in lines] for lines in (written, printed)]
    return bool(pattern_of(plain[0]).fullmatch("".join(line + "\n" for line in plain[1])))


def published(name: str):
    """The path of a published recording, or None."""
    for place in (os.environ.get("PROOFMASS_DATA"), ROOT / "../shared/data"):
        found = sorted(Path(place).rglob(name)) if place else []
        if found:
            return found[0].resolve()
    return None


def run(command: Command, folder: Path, program: str) -> list:
    """Its output, by line without trailing blanks; a failure of the command is an error."""
    words = command.words
    if words[0] == "cat":
        (folder / words[1]).write_text("\n".join(command.output) + "\n")
        return command.output
    if words[0] != "proofmass":
        raise ValueError(f"only proofmass is run here: {command.text}")
    ran = subprocess.run([program, *words[1:]], cwd=folder, capture_output=True, text=True, timeout=120,
                         stdin=subprocess.DEVNULL, env={**os.environ, "NO_COLOR": "1"})
    if ran.returncode != 0:
        raise RuntimeError(f"{command.text}\nended with {ran.returncode}: {ran.stderr}")
    return [line.rstrip() for line in (ran.stdout + ran.stderr).splitlines()]
