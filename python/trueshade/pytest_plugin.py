"""Golden images for pytest: the fixture `assert_image_matches`.

    def test_the_city(assert_image_matches):
        frame = trueshade.render(trueshade.load_scene("builtin:city"))
        assert_image_matches(frame.color, "city.png")

Names are relative to the folder `golden` beside the test's file. `pytest --accept-images` writes what a test draws over
its golden image, or as a new one. A failure leaves the drawn picture in the folder `failed` beside `golden`, and says
which command shows the difference. Activate it by `-p trueshade.pytest_plugin`, or in the conftest.py of the top folder:
`pytest_plugins = ["trueshade.pytest_plugin"]`.
"""

import os
from pathlib import Path

import numpy as np
import pytest

import trueshade


def pytest_addoption(parser):
    parser.getgroup("trueshade").addoption(
        "--accept-images",
        action="store_true",
        help="write what tests draw over their golden images, where these differ or are not there",
    )


class ImageMismatch(AssertionError):
    """A picture is not its golden image."""


def _described(result):
    lines = list(result["failures"])
    for name in ("first_not_finite", "first", "worst"):
        if name in result:
            pixel = result[name]
            values = ", ".join(f"{channel} {a} / {b}" for channel, (a, b) in pixel["values"].items())
            lines.append(f"{name.replace('_', ' ')} pixel {pixel['x']},{pixel['y']} (golden / drawn): {values}")
    return "\n".join(lines)


@pytest.fixture
def assert_image_matches(request):
    """Compares an array, or a Frame, with a golden image. Criteria are those of trueshade.compare()."""
    folder = Path(str(request.path)).parent
    accepts = request.config.getoption("--accept-images")

    def check(image, name, **criteria):
        golden = folder / "golden" / name
        pixels = getattr(image, "color", image)
        format = getattr(image, "format", "")
        if np.issubdtype(np.asarray(pixels).dtype, np.floating) and not np.isfinite(pixels).all():
            if not criteria.get("allow_nonfinite"):
                raise ImageMismatch(f"{name}: a value is not finite")
        if not golden.exists():
            if not accepts:
                raise ImageMismatch(f"{golden} is not there; pytest --accept-images writes it")
            golden.parent.mkdir(parents=True, exist_ok=True)
            trueshade.write_image(os.fspath(golden), pixels, format)
            return
        failed = folder / "failed" / name
        failed.parent.mkdir(parents=True, exist_ok=True)
        trueshade.write_image(os.fspath(failed), pixels, format)
        result = trueshade.compare(golden, failed, **criteria)
        if result["pass"]:
            failed.unlink()
            return
        if accepts:
            os.replace(failed, golden)
            return
        raise ImageMismatch(
            f"{name} is not its golden image: {_described(result)}\n"
            f"trueshade compare {golden} {failed} -o difference.html shows the difference"
        )

    return check
