#!/usr/bin/env python3
"""size_table.py FOLDER [--check]: how large the project is, as docs/data/size.md shows it.

Counts files under version control. Without --check it writes the page anew: that is how growth is stated. With it, as a
test of ./check, it fails where a count is above the page's by more than one in fifty.
"""
import re
import subprocess
import sys
from pathlib import Path

HEAD = """# How large the house is

What a maintainer has to know, counted by `scripts/size_table.py .`, which writes this page. A test fails where a count
has grown by more than one in fifty since it was written: growth is stated, not found later. *at first* is what stood
before light was a program and before lights had areas; *goal* is where it is to go.

| count | at first | now | goal |
|---|---|---|---|
"""


def tracked(root):
    names = subprocess.run(["git", "ls-files", "-z"], cwd=root, check=True, capture_output=True).stdout.decode()
    return [root / name for name in names.split("\0") if name and (root / name).is_file()]


def lines(files):
    return sum(file.read_bytes().count(b"\n") for file in files)


def words(files):
    return sum(len(file.read_text(encoding="utf-8").split()) for file in files)


def counts(root):
    """Rows of a name, the count at first, the count now and the goal; an empty text where there is none."""
    files = tracked(root)
    relative = {file: file.relative_to(root).as_posix() for file in files}
    code = [file for file in files if file.suffix in (".cpp", ".h")]
    tests = [file for file in code if relative[file].startswith("tests/")]
    source = [file for file in code if file not in set(tests)]
    text = {file: file.read_text(encoding="utf-8") for file in source}
    guides = [file for file in files if file.suffix == ".md" and file.parent == root / "docs"]
    tables = [file for file in files
              if file.suffix == ".md" and relative[file].startswith(("docs/journal/", "docs/data/"))]
    schemas = [file for file in files if file.name.endswith(".schema.json")]
    included = {}
    for name in re.findall(r'#include "([^"]+)"', "\n".join(text.values())):
        included[name] = included.get(name, 0) + 1

    def naming(word):
        return sum(bool(re.search(rf"\b{word}\b", body)) for body in text.values())

    return [
        ("lines of C++ without tests", 107900, lines(source), 95000),
        ("lines of tests", 52200, lines(tests), 46000),
        ("files of C++ without tests", 1153, len(source), 800),
        ("of these of 30 lines or fewer", 271, sum(body.count("\n") <= 30 for body in text.values()), ""),
        ("headers that one file includes", "", sum(
            file.suffix == ".h" and included.get(relative[file], 0) == 1 for file in source), ""),
        ("files that name `LightType`", 39, naming("LightType"), 9),
        ("files that name `Format::`", "", sum("Format::" in body for body in text.values()), ""),
        ("words of guides", 70400, words(guides), 45000),
        ("words of journal and tables", 28000, words(tables), ""),
        ("links of README, pictures left out", "", len(re.findall(r"(?<!!)\[[^]]*\]\(", (root / "README.md").read_text(encoding="utf-8"))), 15),
        ("lines of schemas", 1967, lines(schemas), ""),
    ]


def page_of(rows):
    shown = lambda number: f"{number:,}" if number != "" else ""
    return HEAD + "".join(f"| {name} | {shown(first)} | {shown(now)} | {shown(goal)} |\n" for name, first, now, goal in rows)


def main():
    root = Path(sys.argv[1]).resolve()
    page = root / "docs/data/size.md"
    rows = counts(root)
    if "--check" not in sys.argv:
        page.write_text(page_of(rows), encoding="utf-8")
        return 0
    stated = dict(re.findall(r"^\| (.+?) \| [\d,]* \| ([\d,]+) \|", page.read_text(encoding="utf-8"), re.M))
    wrong = 0
    for name, _, now, _ in rows:
        if name not in stated:
            print(f"docs/data/size.md has no row '{name}': run scripts/size_table.py .")
            wrong = 1
        elif now > int(stated[name].replace(",", "")) * 1.02:
            print(f"{name}: {now}, and docs/data/size.md says {stated[name]}: take back what is not needed, or run "
                  "scripts/size_table.py . and say in the commit what was grown for")
            wrong = 1
    return wrong


if __name__ == "__main__":
    sys.exit(main())
