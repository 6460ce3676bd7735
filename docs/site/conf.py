"""Settings of Sphinx. Sources of the site are what `docs.site.sources` makes of the documents."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

from npchip import __version__
from npchip.editors.pygments import NpchipLexer

_STUDIO = Path(__file__).parents[2] / "src" / "npchip" / "studio"

project = "npchip"
author = "The npchip developers"
version = release = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["files/**"]  # downloads
suppress_warnings = ["misc.highlighting_failure"]  # documents show broken sources and cut JSON
smartquotes_action = "D"  # dashes only: the documents have the quotes that they mean

myst_heading_anchors = 4  # links to headings are written as for GitHub

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
default_role = "py:obj"  # a name in single backquotes leads to it where the reference has it
napoleon_attr_annotations = False  # signatures have the types; as text, `bool_` is a reference
napoleon_numpy_docstring = False
napoleon_use_ivar = True  # attributes stand in the description of their class
python_use_unqualified_type_names = True

html_theme = "furo"
html_title = f"npchip {__version__}"
html_favicon = str(_STUDIO / "page" / "shell" / "icon.svg")
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False


def setup(app: Sphinx) -> None:
    """Colour npchip's assembly, and leave out what says nothing."""
    app.add_lexer("asm", NpchipLexer)
    app.connect("autodoc-skip-member", _skipped)


def _skipped(*arguments: Any) -> bool | None:
    """Skip the fields of named tuples: the class describes them; None leaves it to Sphinx."""
    member = arguments[3]
    return True if type(member).__name__ == "_tuplegetter" else None
