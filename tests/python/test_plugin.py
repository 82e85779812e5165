"""The pytest plugin, tried by pytest's own tester: a picture passes, fails with its pixel, and is accepted."""

import numpy as np
import pytest
import trueshade

pytest_plugins = ["pytester"]

SUITE = """
import numpy as np
import trueshade

def test_picture(assert_image_matches):
    frame = trueshade.render(trueshade.load_scene("builtin:cornell"), trueshade.Pipeline(size=(32, 24)))
    picture = frame.color.copy()
    picture[5, 7, 1] ^= CHANGE
    assert_image_matches(picture, "cornell.png")
"""


def suite(pytester, change):
    pytester.makepyfile(test_suite=SUITE.replace("CHANGE", str(change)))


def test_a_golden_image_is_accepted_held_and_missed(pytester):
    suite(pytester, 0)
    missing = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    missing.assert_outcomes(failed=1)
    missing.stdout.fnmatch_lines(["*is not there; look at failed/cornell.png, and pytest --accept-images accepts it*"])
    pytester.runpytest_subprocess("-p", "no:cacheprovider", "--accept-images").assert_outcomes(passed=1)
    golden = pytester.path / "golden" / "cornell.png"
    assert golden.exists()
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=1)
    assert not (pytester.path / "failed" / "cornell.png").exists()
    suite(pytester, 4)
    before = golden.read_bytes()
    failed = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    failed.assert_outcomes(failed=1)
    failed.stdout.fnmatch_lines(["*first pixel 7,5 (golden / drawn)*"])
    assert golden.read_bytes() == before
    assert (pytester.path / "failed" / "cornell.png").exists()
    page = (pytester.path / "failed" / "cornell.png.html").read_text()
    assert "golden/cornell.png" in page and "trueshade compare" in page
    pytester.runpytest_subprocess("-p", "no:cacheprovider", "--accept-images").assert_outcomes(passed=1)
    assert golden.read_bytes() != before
    assert not (pytester.path / "failed").exists()


def test_a_test_that_passes_keeps_what_another_of_the_same_image_has_left(pytester):
    trueshade.write_image(pytester.path / "a.png", np.zeros((2, 2, 4), np.uint8))
    (pytester.path / "golden").mkdir()
    (pytester.path / "a.png").rename(pytester.path / "golden" / "a.png")
    pytester.makepyfile(
        test_suite="""
        import numpy as np
        def test_exact(assert_image_matches):
            assert_image_matches(np.ones((2, 2, 4), np.uint8), "a.png")
        def test_lenient(assert_image_matches):
            assert_image_matches(np.ones((2, 2, 4), np.uint8), "a.png", max_difference=0.1)
        """
    )
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(failed=1, passed=1)
    assert (pytester.path / "failed" / "a.png.html").exists()


def test_the_plugin_is_found_once_however_it_is_named(pytester):
    suite(pytester, 0)
    for arguments in ([], ["-p", "trueshade.pytest_plugin"]):
        pytester.runpytest_subprocess("-p", "no:cacheprovider", "--accept-images", *arguments).assert_outcomes(passed=1)
    pytester.makeconftest('pytest_plugins = ["trueshade.pytest_plugin"]')
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=1)


def test_golden_images_elsewhere_are_never_written_by_a_failure(pytester):
    """A path that leaves the folder `golden` names the golden image, and not where a failure is left."""
    golden = pytester.path / "shared" / "a.exr"
    golden.parent.mkdir()
    trueshade.write_image(golden, np.zeros((2, 2, 4), np.float32))
    before = golden.read_bytes()
    pytester.makepyfile(
        test_suite=f"""
        import numpy as np
        def test_one(assert_image_matches):
            assert_image_matches(np.ones((2, 2, 4), np.float32), {str(golden)!r})
        def test_two(assert_image_matches):
            assert_image_matches(np.full((2, 2, 4), np.nan, np.float32), {str(golden)!r})
        def test_three(assert_image_matches):
            assert_image_matches(np.ones((2, 3, 4), np.float32), "../shared/a.exr")
        def test_four(assert_image_matches):
            assert_image_matches(np.zeros((2, 2, 4), np.float32), "a.jpg")
        """
    )
    done = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    done.assert_outcomes(failed=4)
    done.stdout.fnmatch_lines(["*16 values are not finite, the first at pixel 0,0*"])
    assert golden.read_bytes() == before
    assert (pytester.path / "failed" / "a.exr.html").exists()


def picture():
    return trueshade.render(trueshade.load_scene("builtin:cornell"), trueshade.Pipeline(size=(32, 24))).color.copy()


def test_compare_measures_arrays_and_files(tmp_path, command):
    one = picture()
    two = one.copy()
    two[3, 4, 2] += 5
    assert trueshade.compare(one, one.copy())["outcome"] == "same"
    result = trueshade.compare(one, two)
    assert not result["pass"] and result["unequal_pixels"] == 1
    assert (result["worst"]["x"], result["worst"]["y"]) == (4, 3)
    blue = [channel for channel in result["channels"] if channel["name"] == "B"][0]
    assert blue["largest"] == pytest.approx(5 / 255)
    assert trueshade.compare(one, two, max_difference=5 / 255)["outcome"] == "within"
    assert not trueshade.compare(one, two, max_difference=4 / 255)["pass"]
    assert trueshade.compare(one, two, pixels=1, delta=1 / 255)["pass"]
    path = tmp_path / "one.png"
    trueshade.write_image(str(path), one)
    assert trueshade.compare(path, one)["pass"]
    command("render", "builtin:cornell", "--size", "32x24", "-o", "theirs.png", "-q")
    assert trueshade.compare(command.folder / "theirs.png", one)["pass"]


def test_compare_refuses_what_is_not_finite_and_other_sizes():
    one = picture().astype(np.float32)
    nan = one.copy()
    nan[1, 2, 0] = np.nan
    assert not trueshade.compare(nan, nan.copy())["pass"]
    assert trueshade.compare(nan, nan.copy(), allow_nonfinite=True)["pass"]
    assert trueshade.compare(one, one[:20].copy())["outcome"] == "mismatched"
    with pytest.raises(trueshade.Error, match="go together"):
        trueshade.compare(one, one.copy(), pixels=3)
    with pytest.raises(trueshade.Error, match="nowhere.png"):
        trueshade.compare("nowhere.png", one)
