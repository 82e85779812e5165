#!/usr/bin/env python3
"""The wheel of a release: the module for two versions of Python, with the libraries that it needs inside.

Usage: wheel.py BUILD_FOLDER OUT_FOLDER IMAGE_IO
BUILD_FOLDER is configured with TRUESHADE_PYTHON and TRUESHADE_OTHER_PYTHON, and built. IMAGE_IO is trueshade_image_io.so for
the OpenImageIO of the other version's Debian. OpenImageIO itself, of 230 packages, is loaded where it is installed. Prints
the wheel's name. Needs patchelf and readelf."""
import hashlib
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python" / "packaging"))
import trueshade_build  # noqa: E402

# What reads EXR and JPEG is left as it is: the libraries of the system's OpenImageIO bring what it needs besides.
# What every Linux with Python has, of that version or a later one (PEP 600).
OF_THE_SYSTEM = re.compile(r"(lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s|z)|ld-linux-x86-64)\.so\.\d+")
MODULE = "trueshade_image_io.so"


def output_of(*command):
    return subprocess.run(list(map(str, command)), check=True, stdout=subprocess.PIPE, text=True).stdout


def needed(path):
    return output_of("patchelf", "--print-needed", path).split()


def where(library):
    for line in output_of("/sbin/ldconfig", "-p").splitlines():
        if line.split()[0] == library and "x86-64" in line:
            return Path(line.split(" => ")[1])
    sys.exit(f"trueshade: error: {library} is not installed")


def bundle(modules, folder):
    """Copies what the modules need into `folder`, under names that no other library of the process has."""
    names = {}  # of the system: of the copy
    open_files = list(modules)
    while open_files:
        file = open_files.pop()
        for library in needed(file):
            if OF_THE_SYSTEM.fullmatch(library):
                continue
            if library not in names:
                source = where(library)
                stem, _, ending = library.partition(".")
                digest = hashlib.sha256(source.read_bytes()).hexdigest()[:8]
                names[library] = f"{stem}-{digest}.{ending}"
                copy = folder / names[library]
                folder.mkdir(exist_ok=True)
                shutil.copy(source, copy)
                copy.chmod(0o644)
                subprocess.run(["patchelf", "--set-soname", copy.name, copy], check=True)
                open_files.append(copy)
            subprocess.run(["patchelf", "--replace-needed", library, names[library], file], check=True)
        home = "$ORIGIN" if file.parent == folder else f"$ORIGIN/{folder.name}"
        subprocess.run(["patchelf", "--force-rpath", "--set-rpath", home, file], check=True)


def least_glibc(files):
    """The version of glibc whose symbols the files need, as (2, 34)."""
    versions = re.findall(r"\bGLIBC_(\d+)\.(\d+)", output_of("readelf", "--version-info", "--wide", *files))
    return max((int(major), int(minor)) for major, minor in versions)


def main():
    build, out, image_io = map(Path, sys.argv[1:])
    with tempfile.TemporaryDirectory() as stage:
        for component in ("python", "other_python"):
            subprocess.run(["cmake", "--install", build, "--component", component, "--prefix", stage, "--strip"],
                           check=True, stdout=subprocess.DEVNULL)
        top = Path(stage) / trueshade_build.INSTALLED
        package = top / "trueshade"
        modules = sorted(package.glob("_trueshade.cpython-*.so"))
        bundle(modules, package / "libs")
        for own in (MODULE, *(f"libs/{path.name}" for path in (package / "libs").iterdir())):
            (package / own).chmod(0o644)
        glibc = least_glibc([*modules, package / MODULE, *(package / "libs").iterdir()])
        (package / "image_io").mkdir()
        shutil.copyfile(image_io, package / "image_io" / MODULE)

        pythons = ".".join("cp" + re.search(r"cpython-(\d+)", path.name).group(1) for path in modules)
        files = [path for path in top.rglob("*") if path.is_file()]
        files.sort(key=lambda path: (".dist-info" in str(path), str(path)))
        rows = [(path.relative_to(top).as_posix(), path.read_bytes(), path.stat().st_mode & 0o777) for path in files]
    tag = f"{pythons}-{pythons}-manylinux_{glibc[0]}_{glibc[1]}_x86_64"
    print(trueshade_build.write_wheel(out, rows, tag))


main()
