"""Pictures of the renderer, held to golden images in the folder `golden` beside this file."""

import renderer


def test_the_light_is_what_it_was(assert_image_matches):
    """Every bit of the linear light."""
    assert_image_matches(renderer.draw(), "ball.exr")


def test_the_stored_picture_is_what_it_was(assert_image_matches):
    """Codes of 8 bits may differ by one, as they would on a GPU."""
    assert_image_matches(renderer.to_bytes(renderer.draw()), "ball.png", max_difference=1 / 255)


def test_a_small_picture_shows_the_same(assert_image_matches):
    """A picture of another size has a golden image of its own; a name may have a folder."""
    assert_image_matches(renderer.to_bytes(renderer.draw(32, 24)), "small/ball.png", max_difference=1 / 255)
