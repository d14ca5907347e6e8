"""The scripts that docs/fleet.md shows, which the tests of this folder run as they stand there."""
import re
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "fleet.md"


def script(language: str, word: str) -> str:
    """The only block in this language that has the word in it."""
    (found,) = [text for text in re.findall(rf"^```{language}\n(.*?)^```$", PAGE.read_text(), re.S | re.M) if word in text]
    return found
