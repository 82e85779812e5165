"""pip installs the module without a network: wheel, editable, source distribution; and says what is missing."""

import base64
import hashlib
import os
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ["TRUESHADE_COMMAND"]).parents[1]
BACKEND = ROOT / "python" / "packaging"
PROGRAM = """
import trueshade
frame = trueshade.render(trueshade.load_scene("builtin:cornell"), trueshade.Pipeline(size=(32, 24)))
frame.save("a.exr")
assert trueshade.compare("a.exr", "a.exr")["pass"]
print(trueshade.__version__, frame.hash, trueshade.__file__)
"""
SUITE = """
import trueshade
def test_picture(assert_image_matches):
    scene = trueshade.load_scene("builtin:cornell")
    assert_image_matches(trueshade.render(scene, trueshade.Pipeline(size=(32, 24))), "a.png")
"""


def run(*command, cwd, code=0, **environment):
    """Runs a command without this build's module on the path, and returns what it prints."""
    plain = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        list(map(str, command)), cwd=cwd, env={**plain, **environment},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert done.returncode == code, done.stdout
    return done.stdout


@pytest.fixture(scope="module")
def python(tmp_path_factory):
    """The interpreter of a virtual environment that sees the system's NumPy and pytest."""
    folder = tmp_path_factory.mktemp("venv")
    run(sys.executable, "-m", "venv", "--system-site-packages", folder, cwd=folder)
    return folder / "bin" / "python"


def pip_install(python, cwd, *arguments):
    options = ["--no-index", "--no-build-isolation", "--no-cache-dir", "--config-settings", f"build-dir={BUILD}"]
    return run(python, "-m", "pip", "install", "-q", *options, *arguments, cwd=cwd)


def test_a_wheel_is_installed_and_works_from_another_folder(python, tmp_path):
    pip_install(python, tmp_path, ROOT)
    version, _, where = run(python, "-c", PROGRAM, cwd=tmp_path).split()
    assert Path(where).is_relative_to(python.parents[1])
    assert version in (ROOT / "CMakeLists.txt").read_text()
    (tmp_path / "test_suite.py").write_text(SUITE)
    pytest_command = [python, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    run(*pytest_command, cwd=tmp_path, code=1)
    assert "1 passed" in run(*pytest_command, "--accept-images", cwd=tmp_path)
    assert "1 passed" in run(*pytest_command, cwd=tmp_path)
    package = Path(where).parent
    info = package.parent / f"trueshade-{version}.dist-info"
    recorded = {}
    for line in (info / "RECORD").read_text().splitlines():
        name, digest, size = line.rsplit(",", 2)
        recorded[name] = (digest, size)
    for path in (*package.glob("*.*"), info / "METADATA", info / "entry_points.txt", info / "WHEEL"):
        content = path.read_bytes()
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        assert recorded[path.relative_to(package.parent).as_posix()] == ("sha256=" + digest, str(len(content)))
    assert {"__init__.pyi", "py.typed", "trueshade_image_io.so"} <= {path.name for path in package.iterdir()}
    assert f"Tag: cp{sys.version_info.major}{sys.version_info.minor}-" in (info / "WHEEL").read_text()
    run(python, "-m", "pip", "uninstall", "-y", "trueshade", cwd=tmp_path)
    assert not package.exists() and not info.exists()


def test_an_editable_install_reads_the_sources(python, tmp_path):
    pip_install(python, tmp_path, "-e", ROOT)
    where = run(python, "-c", PROGRAM, cwd=tmp_path).split()[-1]
    assert Path(where).resolve() == (ROOT / "python/trueshade/__init__.py").resolve()
    run(python, "-m", "pip", "uninstall", "-y", "trueshade", cwd=tmp_path)


def backend(code, tmp_path, expected=0, **environment):
    program = f"import sys; sys.path.insert(0, {str(BACKEND)!r}); import trueshade_build; {code}"
    return run(sys.executable, "-B", "-c", program, cwd=tmp_path, code=expected, **environment)


def test_a_source_distribution_has_all_that_the_module_is_built_of(tmp_path):
    backend("print(trueshade_build.build_sdist('.'))", tmp_path)
    (archive,) = tmp_path.glob("trueshade-*.tar.gz")
    with tarfile.open(archive) as sdist:
        sdist.extractall(tmp_path)
    top = tmp_path / archive.name.removesuffix(".tar.gz")
    assert (top / "PKG-INFO").read_text().startswith("Metadata-Version")
    assert not (top / "tests").exists() and not (top / "build").exists()
    configure = "trueshade_build.run(trueshade_build.configure_command('b', []), 'configuring')"
    code = f"trueshade_build.ROOT = __import__('pathlib').Path({str(top)!r}); {configure}"
    assert "Generating done" in backend(code, tmp_path)


def test_a_wheel_has_kernels_for_all_cpus(tmp_path):
    assert "avx512;avx2;sse4;scalar" in backend("print(trueshade_build.configure_command('b', []))", tmp_path)


def test_what_is_missing_is_one_line_with_debians_packages(tmp_path):
    text = backend("trueshade_build.build_wheel('.')", tmp_path, expected=1, PATH="/nowhere", CXX="")
    (line,) = text.splitlines()
    assert line.startswith("trueshade: error: CMake, a C++ compiler, Ninja not found; on Debian: apt-get install")
    for package in ("cmake", "g++", "ninja-build", "pybind11-dev", "libhwy-dev"):
        assert f" {package}" in line


def test_a_wrong_setting_is_one_line(tmp_path):
    text = backend("trueshade_build.build_wheel('.', {'colour': 'red'})", tmp_path, expected=1)
    assert text.splitlines() == ["trueshade: error: there is no setting 'colour' (one of: build-dir, cmake-args)"]
