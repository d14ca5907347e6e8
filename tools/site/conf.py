"""Sphinx configuration of the site: pages in Markdown, no script, font or picture from another site."""
import re
from pathlib import Path

HERE = Path(__file__).resolve().parent

project = "Proofmass"
version = re.search(r"project\(proofmass VERSION ([\d.]+)", (HERE.parents[1] / "CMakeLists.txt").read_text())[1]
release = version
copyright = "the authors of Proofmass, Apache-2.0"

extensions = ["myst_parser"]
root_doc = "index"
myst_heading_anchors = 4
highlight_language = "none" # equations stand in plain blocks
suppress_warnings = ["misc.highlighting_failure", "myst.header"]

html_theme = "furo"
html_title = f"Proofmass {version}"
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": False}
