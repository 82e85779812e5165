"""Masks and windows: what they leave out and find, and masks that are none."""

import numpy as np
import pytest
import trueshade

HEIGHT, WIDTH = 48, 64
MASK = np.ones((HEIGHT, WIDTH), bool)
MASK[4:16, 8:24] = False


def pictures():
    one = np.full((HEIGHT, WIDTH, 3), 100, np.uint8)
    two = one.copy()
    two[~MASK] = 200
    return one, two


@pytest.mark.parametrize("mask", [MASK, MASK.astype(np.uint8), MASK.astype(np.uint8) * 255, np.dstack([MASK] * 3).astype(np.uint8)])
def test_what_is_left_out_is_no_difference(mask, tmp_path):
    one, two = pictures()
    assert trueshade.compare(one, two)["outcome"] == "different"
    result = trueshade.compare(one, two, mask=mask, page=tmp_path / "page.html")
    assert result["outcome"] == "same"
    assert result["left_out_pixels"] == 192
    np.save(tmp_path / "mask.npy", mask)
    assert trueshade.compare(one, two, mask=tmp_path / "mask.npy")["outcome"] == "same"
    assert "pixels left out" in (tmp_path / "page.html").read_text()


def test_windows_are_told_and_fail():
    one, two = pictures()
    result = trueshade.compare(one, two, window=(16, 0.5))
    assert not result["pass"] and "0.75" in result["failures"][0]
    assert {"side": 16, "x": 8, "y": 0, "pixels_beyond": 192}.items() <= result["windows"][0].items()
    assert trueshade.compare(one, two, window=(16, 0.75))["pass"]
    assert trueshade.compare(one, two, window=(16, 0), delta=100 / 255)["pass"]


@pytest.mark.parametrize(
    "options, about",
    [
        ({"mask": np.zeros((HEIGHT, WIDTH), bool)}, "all 3072 pixels are left out"),
        ({"mask": np.ones((HEIGHT, WIDTH - 1), bool)}, "the mask is 63x48"),
        ({"mask": np.full((HEIGHT, WIDTH), 7, np.uint8)}, "of the mask is 7"),
        ({"mask": np.full((HEIGHT, WIDTH), np.nan, np.float32)}, "mask"),
        ({"mask": np.arange(HEIGHT)[:, None] > np.full(WIDTH, 10)}, "at most 10 % may be"),
        ({"mask": [[True]]}, "mask"),
        ({"window": (17, 0.5)}, "window"),
        ({"window": (16, 2)}, "window"),
        ({"delta": 0.1}, "delta"),
    ],
)
def test_masks_that_are_none_are_one_clear_error(options, about):
    one, two = pictures()
    with pytest.raises(trueshade.Error) as error:
        trueshade.compare(one, two, **options)
    assert about in str(error.value) and "\n" not in str(error.value) and "--" not in str(error.value)


def test_much_is_left_out_with_leave():
    one, two = pictures()
    mask = MASK.copy()
    mask[:30] = False
    assert trueshade.compare(one, two, mask=mask, allow_mask=True)["outcome"] == "same"


def test_validate_judges_nothing_of_what_is_left_out():
    scene = trueshade.load_scene("builtin:cornell")
    pipeline = trueshade.Pipeline("light-volumes", size=(WIDTH, HEIGHT))
    frame = trueshade.render(scene, pipeline, planes=["depth", "position", "normal", "albedo", "id.object"])
    picture = frame.color.copy()
    picture[~MASK] ^= 64
    assert not trueshade.validate(scene, picture, frame.planes, pipeline)["pass"]
    verdict = trueshade.validate(scene, picture, frame.planes, pipeline, mask=MASK)
    assert verdict["pass"]
    assert [stage["left_out"] for stage in verdict["stages"]] == [192, 192]
    with pytest.raises(trueshade.Error):
        trueshade.validate(scene, picture, frame.planes, pipeline, mask=np.zeros((HEIGHT, WIDTH), bool))
