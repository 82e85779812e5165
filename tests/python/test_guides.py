"""What the guides show for Python runs, tables are right, and the example project does what its page says."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import trueshade

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "docs" / "examples" / "python_golden"


@pytest.mark.parametrize("page", ["docs/python.md", "docs/tutorial.md"])
def test_what_a_page_shows_runs(page):
    done = subprocess.run(
        [sys.executable, ROOT / "tests/docs/python_page.py", ROOT / page], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_table_of_planes_is_that_of_the_module():
    rows = re.findall(r"^\| `([\w.]+)` \| \((.*?)\) \| (\w+) \|", (ROOT / "docs/python.md").read_text(), re.MULTILINE)
    assert len(rows) > 10
    scene = trueshade.load_scene("builtin:cornell")
    frame = trueshade.render(scene, trueshade.Pipeline(size=(8, 6)), planes=[name for name, _, _ in rows])
    for name, shape, dtype in rows:
        plane = frame.planes[name]
        assert (str(plane.shape)[1:-1], str(plane.dtype)) == (shape.replace("h", "6").replace("w", "8"), dtype), name


def test_the_example_project_passes_fails_and_is_accepted(tmp_path):
    project = tmp_path / "project"
    shutil.copytree(EXAMPLE, project, ignore=shutil.ignore_patterns("__pycache__", "failed"))
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}

    def tests(*arguments):
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments]
        done = subprocess.run(command, cwd=project, env=environment, capture_output=True, text=True)
        return done.returncode, done.stdout

    code, text = tests()
    assert code == 0 and "3 passed" in text, text
    renderer = project / "renderer.py"
    assert renderer.read_text().count("np.float32(20)") == 1
    renderer.write_text(renderer.read_text().replace("np.float32(20)", "np.float32(21)"))
    golden = {path: path.read_bytes() for path in (project / "tests/golden").rglob("*.*")}
    code, text = tests()
    assert code == 1 and "3 failed" in text
    assert "tests/failed/ball.exr.html shows both" in text and "worst pixel" in text
    page = (project / "tests/failed/ball.exr.html").read_text()
    assert "the pictures differ" in page and "tests/golden/ball.exr" in page
    assert all(path.read_bytes() == content for path, content in golden.items())
    code, text = tests("--accept-images")
    assert code == 0 and not (project / "tests/failed").exists()
    assert all(path.read_bytes() != content for path, content in golden.items())
    assert tests()[0] == 0
