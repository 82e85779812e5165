"""Follows every link of a folder of pages of HTML that stays inside, and fails where one leads to no file or, behind a #,
to no place of its page. Usage: follow_links.py FOLDER
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page links to, by line, and the places that it has."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src"):
                self.links.append((self.getpos()[0], value))
            elif name in ("id", "name"):
                self.places.add(value)


def broken_links(folder):
    """`page:line: link` of each link that leads nowhere, and how many were followed."""
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    followed, broken = 0, []
    for path, page in pages.items():
        for line, link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            followed += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            place = unquote(parts.fragment)
            if not target.is_file() or (place and target in pages and place not in pages[target].places):
                broken.append(f"{path.relative_to(folder)}:{line}: {link}")
    return broken, followed


def main():
    broken, followed = broken_links(Path(sys.argv[1]).resolve())
    for link in broken:
        print(f"{link} leads nowhere")
    print(f"{followed} links were followed, {len(broken)} lead nowhere")
    return 1 if broken or followed == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
