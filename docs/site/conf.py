"""How Sphinx builds the site; docs/build_site.sh calls it on what stage.py has laid out."""
import inspect
import pathlib
import re

import eigengrain

ROOT = pathlib.Path(__file__).resolve().parents[2]

project = "Eigengrain"
author = "the authors of Eigengrain"
release = version = eigengrain.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["extra"]
root_doc = "index"
source_suffix = {".md": "markdown"}
highlight_language = "none"
smartquotes = False

myst_enable_extensions = ["deflist"]
myst_heading_anchors = 4

html_theme = "furo"
html_title = "Eigengrain"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_last_updated_fmt = None
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0a4f8a", "color-brand-content": "#0a5c9e"},
    "dark_css_variables": {"color-brand-primary": "#8ec5f0", "color-brand-content": "#8ec5f0"},
}
pygments_style = "default"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_class_signature = "mixed"
python_use_unqualified_type_names = True


def setup(app):
    app.config.html_extra_path = [str(pathlib.Path(app.srcdir) / "extra")]
    app.connect("autodoc-process-docstring", as_restructured_text)


def as_restructured_text(app, what, name, object, options, lines):
    """Docstrings are plain text: marks of reStructuredText in them mean themselves, `names` are code, and paragraphs
    that begin with the name of a parameter say what it is."""
    parameters = set()
    if what in ("function", "method", "class"):
        try:
            parameters = set(inspect.signature(object).parameters)
        except (TypeError, ValueError):
            pass
    result, code = [], False
    for line in lines:
        if line.startswith("    ") and not code and (not result or not result[-1]):
            result += ["::", ""]
            code = True
        elif line and not line.startswith("    "):
            code = False
        if code:
            result.append(line)
            continue
        # "steps: so many. time: so much." are two parameters in one line.
        line = "".join(part if k % 2 else re.sub(r"([*|\\])", r"\\\1", re.sub(r"(?<=\w)_(?=\W|$)", r"\\_", part))
                       for k, part in enumerate(re.split(r"(`[^`]*`)", line)))
        line = re.sub(r"`([^`]*)`", r"``\1``", line)
        pieces = [line]
        if parameters:
            pieces = re.split(r"(?:(?<=^)|(?<=\. ))(?=(?:%s)(?:, \w+)*: )" % "|".join(map(re.escape, sorted(parameters))), line)
        for piece in filter(None, pieces) if line else [""]:
            field = re.match(r"(\w+(?:, \w+)*): (.*)", piece)
            if field and parameters.issuperset(field[1].split(", ")):
                if result and result[-1] and not result[-1].startswith((":param", "    ")):
                    result.append("")
                for one in field[1].split(", "):
                    result.append(f":param {one}: {field[2].strip()}")
            elif result and result[-1].startswith((":param", "    ")) and piece:
                result.append("    " + piece.strip())
            else:
                result.append(piece)
    lines[:] = result
