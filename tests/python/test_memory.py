"""No plane is copied, and nothing is kept that nobody holds."""

import gc
import resource

import numpy as np
import trueshade


def address(array):
    return array.__array_interface__["data"][0]


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def test_arrays_share_the_frames_memory_and_keep_it_alive():
    frame = trueshade.render(
        trueshade.load_scene("builtin:cornell"), trueshade.Pipeline(size=(64, 48)), planes=["depth", "normal"]
    )
    color, again, depth = frame.color, frame.color, frame.planes["depth"]
    assert address(color) == address(again)
    assert address(depth) == address(frame.planes["depth"])
    assert not color.flags.owndata and not color.flags.writeable
    before = color.copy()
    del frame
    gc.collect()
    for _ in range(20):
        trueshade.render(trueshade.load_scene("builtin:cornell"), trueshade.Pipeline(size=(64, 48)))
    assert np.array_equal(color, before)


def test_ten_thousand_frames_leave_no_memory_behind():
    scene = trueshade.load_scene("builtin:cornell")
    pipeline = trueshade.Pipeline(size=(32, 24))

    def draw(frames):
        for _ in range(frames):
            frame = trueshade.render(scene, pipeline, planes=["depth"])
            assert frame.color.shape == (24, 32, 4)

    draw(500)
    before = resident()
    draw(10000)
    assert resident() - before < 8 << 20
