"""Golden images for pytest: the fixture `assert_image_matches`.

    def test_the_city(assert_image_matches):
        frame = trueshade.render(trueshade.load_scene("builtin:city"))
        assert_image_matches(frame, "city.png")

Names are relative to the folder `golden` beside the test's file. `pytest --accept-images` writes what a test draws over
its golden image, or as a new one. A failure leaves the drawn picture and a page of HTML with both pictures in the folder
`failed` beside `golden`. pytest finds the plugin where the module is installed by pip or as a package; elsewhere name it
by `-p trueshade.pytest_plugin`.
"""

import os
import shutil
import tempfile
from pathlib import Path

import pytest


def pytest_addoption(parser):
    parser.getgroup("trueshade").addoption(
        "--accept-images",
        action="store_true",
        help="write what tests draw over their golden images, where these differ or are not there",
    )


_FAILED = pytest.StashKey()


class ImageMismatch(AssertionError):
    """A picture is not its golden image."""


def _described(result):
    """The failures of a comparison and two pixels, a line each."""
    lines, shown = [*result["failures"]], []
    for name in ("first_not_finite", "first", "worst"):
        pixel = result.get(name)
        if pixel is not None and pixel not in shown:
            shown.append(pixel)
            values = ", ".join(f"{channel} {a} / {b}" for channel, (a, b) in pixel["values"].items())
            lines.append(f"{name.replace('_', ' ')} pixel {pixel['x']},{pixel['y']} (golden / drawn): {values}")
    return "\n".join(lines)


def _folders(test_file, name):
    """The golden image of a name, and where its failure is left. A name may be a path to a file elsewhere."""
    here, path = Path(test_file).parent, Path(name)
    if path.suffix.lower() not in (".png", ".exr"):
        raise ValueError(f"{name}: golden images end in .png or .exr")
    is_elsewhere = path.is_absolute() or ".." in path.parts
    return here / "golden" / path, here / "failed" / (path.name if is_elsewhere else path)


def _shown(path):
    """A path as short as it can be said from here."""
    return min(str(path), os.path.relpath(path), key=len)


def _write(image, path):
    import trueshade

    path.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(image, trueshade.Frame):
        image.save(path)
    else:
        trueshade.write_image(path, image)


def _check_finite(image, name, criteria):
    import numpy
    import trueshade

    pixels = image.color if isinstance(image, trueshade.Frame) else image
    if isinstance(pixels, numpy.ndarray) and pixels.dtype.kind == "f" and not criteria.get("allow_nonfinite"):
        places = numpy.argwhere(~numpy.isfinite(pixels))
        if len(places) > 0:
            y, x = places[0][:2]
            raise ImageMismatch(f"{name}: {len(places)} values are not finite, the first at pixel {x},{y}")


def _leave(drawn, failed, golden, criteria):
    """Leaves the drawn picture and the page in the folder of failures."""
    import trueshade

    failed.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(drawn, failed)
    page = failed.with_name(failed.name + ".html")
    trueshade.compare(_shown(golden), _shown(failed), page=_shown(page), **criteria)
    return page


def _clear(failed):
    """Takes away what a failure of an earlier run has left, and the folders with the last of it."""
    for path in (failed, failed.with_name(failed.name + ".html")):
        path.unlink(missing_ok=True)
    for folder in failed.parents:
        if "failed" not in folder.parts or not folder.is_dir() or any(folder.iterdir()):
            break
        folder.rmdir()


@pytest.fixture
def assert_image_matches(request):
    """A function (image, name, **criteria) that fails the test unless the image is its golden image.

    image: a trueshade.Frame, or an array that trueshade.write_image() takes. name: of the golden image, .png or .exr, in
    the folder `golden` beside the test's file. criteria: those of trueshade.compare(), such as max_difference=2/255;
    without any every stored value has to be equal.
    """
    import trueshade

    accepts = request.config.getoption("--accept-images")
    of_this_run = request.config.stash.setdefault(_FAILED, set())  # files that another test of this run has left

    def clear(failed):
        if failed not in of_this_run:
            _clear(failed)

    def check(image, name, **criteria):
        __tracebackhide__ = True  # a failure shows the test's own line
        golden, failed = _folders(request.path, os.fspath(name))
        _check_finite(image, name, criteria)
        if not golden.exists():
            if not accepts:
                of_this_run.add(failed)
                _write(image, failed)
                raise ImageMismatch(
                    f"{_shown(golden)} is not there; look at {_shown(failed)}, and pytest --accept-images accepts it"
                )
            _write(image, golden)
            return clear(failed)
        with tempfile.TemporaryDirectory() as folder:
            drawn = Path(folder) / golden.name
            _write(image, drawn)
            result = trueshade.compare(golden, drawn, **criteria)
            if result["pass"]:
                return clear(failed)
            if accepts:
                _write(image, golden)
                return clear(failed)
            of_this_run.add(failed)
            page = _leave(drawn, failed, golden, criteria)
        raise ImageMismatch(
            f"{name} is not its golden image: {_described(result)}\n"
            f"{_shown(page)} shows both; pytest --accept-images accepts what was drawn"
        )

    return check
