"""Sphinx's configuration of the site that ./check site makes of the guides (scripts/site.sh).

The pages are the Markdown files as they stand in the repository, and README.md is the front page. Two things are added
while a page is read: on the front page the list beside all pages, whose headings are those of docs/README.md, and, where a
link leads to a folder, the folder's README.md.
"""

import re
from pathlib import Path

from pygments.lexers.special import TextLexer

ROOT = Path(__file__).resolve().parents[2]
PAGE_LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#:]+)(#[^)]*)?\)")

project = "Trueshade"
html_title = "Trueshade"
extensions = ["myst_parser"]
root_doc = "README"
include_patterns = ["*.md", "docs/**.md", "docs/**/*.md", "python/README.md", "tests/consumer/README.md"]
exclude_patterns = ["build", "out"]
myst_heading_anchors = 4
suppress_warnings = ["misc.highlighting_failure"]  # blocks may leave parts out, by `...`
html_theme = "furo"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_use_index = False
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False


def page_of(link, folder):
    """The path, from the root, of what a link of a page in the folder leads to; None outside the repository."""
    target = (ROOT / folder / link).resolve()
    return target.relative_to(ROOT) if target.is_relative_to(ROOT) else None


def with_pages_of_folders(text, folder):
    """The text whose links to folders lead to their README.md, and are plain words where there is none."""

    def replaced(match):
        words, link, anchor = match.group(1), match.group(2), match.group(3) or ""
        target = page_of(link, folder)
        if target is None or not (ROOT / target).is_dir():
            return match.group(0)
        return f"[{words}]({link.rstrip('/')}/README.md{anchor})" if (ROOT / target / "README.md").is_file() else words

    return PAGE_LINK.sub(replaced, text)


def contents():
    """The pages beside all pages: a list under each heading of docs/README.md."""
    text = ""
    for section in re.split(r"^## ", (ROOT / "docs/README.md").read_text(encoding="utf-8"), flags=re.M)[1:]:
        pages = [page_of(match.group(2), "docs") for match in PAGE_LINK.finditer(section)]
        names = [str(page.with_suffix("")) for page in pages if page.suffix == ".md" and str(page) != f"{root_doc}.md"]
        text += "\n".join(["", "```{toctree}", ":hidden:", ":maxdepth: 1", f":caption: {section.splitlines()[0]}", ""])
        text += "\n".join(["", *("/" + name for name in dict.fromkeys(names)), "```", ""])
    return text


def read_page(app, name, source):
    listed = contents()
    source[0] = with_pages_of_folders(source[0], Path(name).parent)
    if name == root_doc:
        source[0] += listed
    elif f"/{name}\n" not in listed:
        source[0] = "---\norphan: true\n---\n" + source[0]


def setup(app):
    app.connect("source-read", read_page)
    for language in ("ply", "csv"):
        app.add_lexer(language, TextLexer)
