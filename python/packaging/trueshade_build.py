"""The backend (PEP 517, PEP 660) by which pip builds the module: CMake, and nothing to download.

`pip install .` configures and builds the target `trueshade_python` in build/wheel, with kernels for all SIMD targets, as
a wheel runs on other CPUs than the one that built it. `--config-settings build-dir=FOLDER` takes another build folder,
as it is where it is configured already. `--config-settings cmake-args="-DA=B ..."` adds settings.
"""

import base64
import hashlib
import itertools
import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INSTALLED = "lib/python3/dist-packages"  # TRUESHADE_PYTHON_DIR of python/CMakeLists.txt
LEFT_OUT_OF_SDIST = ("build", "out", "tests", "docs", ".git", ".ci")
ERA = (1980, 1, 1, 0, 0, 0)  # the time of every file in a wheel: equal builds are equal files


def fail(reason):
    sys.exit(f"trueshade: error: {reason}")


def advice(packages):
    return f"on Debian: apt-get install --no-install-recommends {' '.join(packages)}"


def packages_needed():
    """The Debian packages that the module is built with: scripts/packages.txt as far as `tests`, and two more."""
    lines = (ROOT / "scripts" / "packages.txt").read_text(encoding="utf-8").split("# tests:")[0].splitlines()
    return [line for line in lines if line and not line.startswith("#")] + ["pybind11-dev", "python3-dev"]


def missing_packages():
    """Those that Debian's package manager does not have installed; all of them where there is none."""
    if shutil.which("dpkg-query") is None:
        return packages_needed()
    shown = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n"], capture_output=True, text=True, check=False
    ).stdout
    installed = {line.split()[0] for line in shown.splitlines() if line.endswith(" installed")}
    return [package for package in packages_needed() if package not in installed]


def check_tools():
    """Ends the build in one line where what it cannot begin without is missing."""
    compilers = [os.environ["CXX"].split()[0]] if os.environ.get("CXX") else ["c++", "g++", "clang++"]
    missing = []
    if shutil.which("cmake") is None:
        missing.append(("CMake", "cmake"))
    if not any(map(shutil.which, compilers)):
        missing.append(("a C++ compiler", "g++"))
    if shutil.which("ninja") is None:
        missing.append(("Ninja", "ninja-build"))
    if not (Path(sysconfig.get_path("include")) / "Python.h").exists():
        missing.append((f"Python.h of {sys.executable}", "python3-dev"))
    if missing:
        packages = [package for _, package in missing]
        packages += [package for package in missing_packages() if package not in packages]
        fail(f"{', '.join(name for name, _ in missing)} not found; {advice(packages)}")


def run(command, what):
    print("+", shlex.join(map(str, command)), flush=True)
    if subprocess.run(list(map(str, command)), check=False).returncode == 0:
        return
    if what == "configuring":
        packages = missing_packages()
        if packages:
            fail(f"CMake does not find all that the module is built with; {advice(packages)}")
    fail(f"{what} failed; what was printed above says why")


def settings_of(config_settings):
    settings = dict(config_settings or {})
    folder = Path(settings.pop("build-dir", ROOT / "build" / "wheel"))
    arguments = settings.pop("cmake-args", "")
    if settings:
        fail(f"there is no setting '{next(iter(settings))}' (one of: build-dir, cmake-args)")
    return folder if folder.is_absolute() else ROOT / folder, shlex.split(arguments)


def is_configured(folder):
    cache = folder / "CMakeCache.txt"
    return cache.exists() and "TRUESHADE_PYTHON:BOOL=ON" in cache.read_text(encoding="utf-8")


def configure_command(folder, arguments):
    command = ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"]
    command += ["-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG", "-DTRUESHADE_PYTHON=ON", "-DTRUESHADE_TESTS=OFF"]
    command += ["-DTRUESHADE_SIMD=avx512;avx2;sse4;scalar", f"-DPython_EXECUTABLE={sys.executable}"]
    if shutil.which("ccache"):
        command.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    return command + arguments


def built(config_settings):
    """Builds the module, and returns the build folder."""
    check_tools()
    folder, arguments = settings_of(config_settings)
    if not (config_settings or {}).get("build-dir") or not is_configured(folder):
        run(configure_command(folder, arguments), "configuring")
    run(["cmake", "--build", folder, "--target", "trueshade_python"], "the build")
    return folder


def own_tag():
    """Of a wheel for this Python on this machine."""
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{platform}"


def single_tags(tag):
    """The tags that one with points in it stands for: `cp311.cp313-none-any` is two."""
    return ["-".join(parts) for parts in itertools.product(*(part.split(".") for part in tag.split("-")))]


def hash_of(content):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()


def write_wheel(folder, files, tag=None):
    """files: (path, content, mode), those of the .dist-info last. Returns the wheel's name."""
    tag = tag or own_tag()
    info = next(path.split("/")[0] for path, _, _ in files if ".dist-info/" in path)
    about = "Wheel-Version: 1.0\nGenerator: trueshade_build\nRoot-Is-Purelib: false\n"
    about += "".join(f"Tag: {single}\n" for single in single_tags(tag))
    files = [*files, (f"{info}/WHEEL", about.encode(), 0o644)]
    record = "".join(f"{path},{hash_of(content)},{len(content)}\n" for path, content, _ in files)
    files.append((f"{info}/RECORD", (record + f"{info}/RECORD,,\n").encode(), 0o644))
    name = f"{info.removesuffix('.dist-info')}-{tag}.whl"
    with zipfile.ZipFile(Path(folder) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content, mode in files:
            entry = zipfile.ZipInfo(path, ERA)
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, content)
    return name


def installed_files(build_folder):
    """What `cmake --install` installs of the module, as write_wheel() takes it."""
    with tempfile.TemporaryDirectory() as stage:
        run(["cmake", "--install", build_folder, "--component", "python", "--prefix", stage, "--strip"], "installing")
        top = Path(stage) / INSTALLED
        paths = sorted((p for p in top.rglob("*") if p.is_file()), key=lambda p: (".dist-info" in str(p), str(p)))
        return [(p.relative_to(top).as_posix(), p.read_bytes(), p.stat().st_mode & 0o777) for p in paths]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return write_wheel(wheel_directory, installed_files(built(config_settings)))


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """A wheel that leads to the package in the build folder, whose Python files are links to the sources."""
    folder = built(config_settings)
    info = [row for row in installed_files(folder) if ".dist-info/" in row[0]]
    return write_wheel(wheel_directory, [("trueshade.pth", f"{folder / 'python'}\n".encode(), 0o644), *info])


def version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return text.split("project(trueshade VERSION ")[1].split()[0]


def source_paths():
    """All files that git does not ignore, or all where it does not know; without tests and guides, which the build
    does not read."""
    paths = []
    if shutil.which("git") and (ROOT / ".git").exists():
        command = ["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
        paths = [path for path in listed.split("\0") if path]
    if not paths:
        paths = [p.relative_to(ROOT).as_posix() for p in ROOT.rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return sorted(p for p in paths if p.split("/")[0] not in LEFT_OUT_OF_SDIST and (ROOT / p).is_file())


def build_sdist(sdist_directory, config_settings=None):
    top = f"trueshade-{version()}"
    metadata = (ROOT / "python" / "packaging" / "METADATA.in").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as stage:
        about = Path(stage) / "PKG-INFO"
        about.write_text(metadata.replace("@PROJECT_VERSION@", version()), encoding="utf-8")
        with tarfile.open(Path(sdist_directory) / f"{top}.tar.gz", "w:gz", format=tarfile.PAX_FORMAT) as archive:
            archive.add(about, f"{top}/PKG-INFO")
            for path in source_paths():
                archive.add(ROOT / path, f"{top}/{path}", recursive=False)
    return f"{top}.tar.gz"


def get_requires_for_build_wheel(config_settings=None):
    return []


get_requires_for_build_editable = get_requires_for_build_sdist = get_requires_for_build_wheel
