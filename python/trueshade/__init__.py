"""Trueshade: a CPU renderer whose images have the same bits on every machine, and a judge of the images of GPUs.

    import trueshade
    scene = trueshade.load_scene("builtin:city")
    frame = trueshade.render(scene, trueshade.Pipeline(size=(320, 240)), planes=["depth", "normal"])
    frame.color            # numpy array (240, 320, 4) of uint8, rows from the top
    frame.hash             # what `trueshade render --hash` prints
    frame.save("city.png")

`help(trueshade.render)` and the like say what each function takes and gives. Arrays of pixels are (height, width,
channels) with rows from the top of the picture. Colours are linear light, positions and normals are in world space,
which is right-handed, lengths are the scene's own units, and angles end in `_deg`. What is wrong with an argument is a
`trueshade.Error` of one line.
"""

from . import _trueshade
from ._trueshade import Error, Frame, Pipeline, Scene, __version__
from ._wrong_calls import one_line, tell_in_one_line

for _kind in (Frame, Pipeline, Scene):
    tell_in_one_line(_kind)
compare = one_line(_trueshade.compare, "compare")
explain = one_line(_trueshade.explain, "explain")
image_hash = one_line(_trueshade.image_hash, "image_hash")
load_scene = one_line(_trueshade.load_scene, "load_scene")
presets = one_line(_trueshade.presets, "presets")
read_planes = one_line(_trueshade.read_planes, "read_planes")
render = one_line(_trueshade.render, "render")
shade = one_line(_trueshade.shade, "shade")
strategies = one_line(_trueshade.strategies, "strategies")
validate = one_line(_trueshade.validate, "validate")
write_image = one_line(_trueshade.write_image, "write_image")
del one_line, tell_in_one_line

__all__ = [
    "Error",
    "Frame",
    "Pipeline",
    "Scene",
    "__version__",
    "compare",
    "explain",
    "image_hash",
    "load_scene",
    "presets",
    "read_planes",
    "render",
    "shade",
    "strategies",
    "validate",
    "write_image",
]
