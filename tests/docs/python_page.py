"""Runs what a page of the guides shows for Python, in the page's order, in a scratch folder. Of the blocks of the page:

    python      with a name in `backticks`, such as `test_x.py`, at the end of the line before: that file; else it is
                executed, all such blocks in one namespace
    sh python   commands, a line each; `# exit 3` states another exit code than 0
    text        after one of these: lines that it prints, in this order; `...` stands for any text
Other blocks are left to tests/docs/page.sh. Usage: python_page.py PAGE
"""

import contextlib
import io
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path


def blocks_of(text):
    """(line number, language, line before, content) of each fenced block."""
    before, language, content, first = "", None, [], 0
    for number, line in enumerate(text.splitlines(), 1):
        if language is None and line.startswith("```"):
            language, content, first = line[3:], [], number + 1
        elif language is None:
            before = line if line.strip() else before
        elif line == "```":
            yield first, language, before, "\n".join(content) + "\n"
            language = None
        else:
            content.append(line)


def is_line_of(pattern, line):
    return re.fullmatch(".*".join(map(re.escape, pattern.split("..."))), line) is not None


def missing_line(expected, printed):
    """The first expected line that was not printed in its place."""
    lines = iter(printed.splitlines())
    return next((e for e in expected.splitlines() if not any(is_line_of(e, line) for line in lines)), None)


def run_commands(content):
    """What the commands print. AssertionError for another exit code than the one stated."""
    printed = ""
    for command in content.replace("\\\n", "").splitlines():
        stated = re.search(r"#.*exit (\d+)", command)
        done = subprocess.run(["bash", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        printed += done.stdout
        assert done.returncode == int(stated.group(1) if stated else 0), f"{command}: {done.returncode}\n{done.stdout}"
    return printed


def run_page(page):
    """Runs the page in the present folder, and returns how many blocks ran."""
    namespace, printed, ran = {"__name__": "page"}, None, 0
    for number, language, before, content in blocks_of(page.read_text(encoding="utf-8")):
        named = re.search(r"`([\w./-]+\.\w+)`:?$", before)
        if language == "text" and printed is not None:
            missing = missing_line(content, printed)
            assert missing is None, f"{page}:{number}: not printed: {missing}\n{printed}"
        printed = None
        if language == "python" and named:
            Path(named.group(1)).parent.mkdir(parents=True, exist_ok=True)
            Path(named.group(1)).write_text(content, encoding="utf-8")
        elif language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile("\n" * (number - 1) + content, str(page), "exec"), namespace)
            printed, ran = output.getvalue(), ran + 1
        elif language == "sh python":
            printed, ran = run_commands(content), ran + 1
    return ran


def main():
    page = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.environ["PATH"] = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
        ran = run_page(page)
        os.chdir("/")
    print(f"{page}: {ran} blocks ran")
    return 0 if ran > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
