"""Runs the commands that guides show in the middle of a sentence, `trueshade render SCENE --json`, in a scratch folder.

A command in capitals, as SCENE, is run with what PLACEHOLDERS has for it. One that lacks an argument that it requires, as
`trueshade glsl --api vulkan`, is spoken of and not shown; then the command and its options have to exist. What needs a
driver that is not there is passed over. A mode of `./check` has to be one, and a script has to be there. Commands that are
not run stand in tests/docs/inline_not_run.txt: PAGE|COMMAND|REASON. Blocks are left to tests/docs/page.sh.

Usage: inline_commands.py COMMAND SOURCE_FOLDER
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PLACEHOLDERS = {"SCENE": "scene.json", "FILE.exr": "capture.exr", "FILE": "mine.glsl", "JOBS.json": "jobs.json", "X,Y": "3,4",
                "REFERENCE": "golden", "TEST": "drawn", "P": "punctual", "DIR": "folder", "N": "20", "...": "scene.json"}
PLANES = "depth,position,normal,albedo,id.object"
NO_DRIVER = 7


def inline_commands(text):
    """The commands between backticks, outside of blocks; one may go on in the next line."""
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    for paragraph in re.split(r"\n\s*\n", prose):
        for code in re.findall(r"`([^`]+)`", paragraph):
            command = " ".join(code.split())
            if re.match(r"(trueshade|\./check|scripts/\S+|tests/\S+\.sh) ", command) and not command.startswith("trueshade: "):
                yield command


def make_files(source, run):
    """What commands name, in the present folder: a small scene, its capture, a model, two folders of pictures, jobs."""
    shutil.copytree(source / "tests/docs/files", ".", dirs_exist_ok=True)
    scene = json.loads(Path("scene.json").read_text())
    scene["pipeline"] = {**scene.get("pipeline", {}), "width": 64, "height": 48}
    Path("scene.json").write_text(json.dumps(scene))
    Path("jobs.json").write_text('{"jobs": [{"name": "a", "run": ["info", "scene.json"]}]}')
    for folder in ("golden", "drawn"):
        Path(folder).mkdir()
        run(f"trueshade render scene.json -q -o {folder}/a.png")
    for command in ("trueshade list many-lights --text >mine.glsl", "trueshade export builtin:cornell -q -o model.glb",
                    f"trueshade render scene.json -q -o capture.exr --aov {PLANES}"):
        done = run(command)
        assert done.returncode == 0, f"{command}: {done.stderr}"


def filled_in(command):
    return " ".join(PLACEHOLDERS.get(word, word) for word in command.split(" "))


def what_is_wrong(command, run):
    """What is wrong with a command of trueshade, or nothing; and whether it was run."""
    if len(command.split()) == 2:  # its name alone
        return None if run(f"{command} --help").returncode == 0 else "there is no such command", False
    done = run(filled_in(command))
    if done.returncode in (0, NO_DRIVER):
        return None, done.returncode == 0
    if done.returncode == 2 and ("it is required" in done.stderr or "its value is missing" in done.stderr):
        helped = any(run(f"{filled_in(command)}{more} --help").returncode == 0 for more in ("", " x"))
        return (None if helped else f"it names what there is not: {done.stderr}"), False
    return f"exit {done.returncode}: {done.stderr or done.stdout}", True


def is_there(command, source):
    """Whether ./check has the mode, or the script is there."""
    first, second = command.split()[:2]
    if first != "./check":
        return (source / first).is_file()
    modes = re.findall(r"^  ([a-z][a-z0-9 |-]*)\)", (source / "check").read_text().split("case $mode in\n")[-1], re.M)
    return second in {mode for names in modes for mode in names.split(" | ")}


def main():
    trueshade, source = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    rows = [line.split("|") for line in (source / "tests/docs/inline_not_run.txt").read_text().splitlines()]
    left_out = {(row[0], row[1]): row[2] for row in rows if not row[0].startswith("#")}
    pages = [source / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")] + sorted((source / "docs").glob("*.md"))
    found = {(str(page.relative_to(source)), command) for page in pages for command in inline_commands(page.read_text("utf-8"))}
    failures = [f"tests/docs/inline_not_run.txt: {page} has no `{command}`" for page, command in left_out.keys() - found]
    ran = spoken_of = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.mkdir("bin")
        os.symlink(trueshade, "bin/trueshade")
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "LC_ALL": "C.UTF-8"}

        def run(command):
            return subprocess.run(["timeout", "30", "bash", "-c", command], capture_output=True, text=True, env=environment,
                                  stdin=subprocess.DEVNULL)

        make_files(source, run)
        for page, command in sorted(found - left_out.keys()):
            if command.startswith("trueshade "):
                wrong, was_run = what_is_wrong(command, run)
            else:
                wrong, was_run = None if is_there(command, source) else "it is not there", False
            ran, spoken_of = ran + was_run, spoken_of + (not was_run)
            if wrong:
                failures.append(f"{page}: `{command}`: {wrong.strip()}")
        os.chdir("/")
    print("\n".join(failures))
    print(f"{ran} commands ran, of {spoken_of} the words are right, {len(left_out)} are left out, {len(failures)} are wrong")
    return 1 if failures or ran == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
