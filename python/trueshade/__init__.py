"""Trueshade: a CPU renderer whose images have the same bits on every machine.

    import trueshade
    scene = trueshade.load_scene("builtin:city")
    frame = trueshade.render(scene, trueshade.Pipeline(size=(320, 240)), planes=["depth", "normal"])
    frame.color            # numpy array (240, 320, 4) of uint8, rows from the top
    frame.hash             # what `trueshade render --hash` prints

What each function takes and gives stands in `__init__.pyi`, and in `help(trueshade.render)`.
"""

from ._trueshade import (
    Error,
    Frame,
    Pipeline,
    Scene,
    compare,
    explain,
    image_hash,
    load_scene,
    presets,
    render,
    shade,
    strategies,
    validate,
    write_image,
)

__all__ = [
    "Error",
    "Frame",
    "Pipeline",
    "Scene",
    "compare",
    "explain",
    "image_hash",
    "load_scene",
    "presets",
    "render",
    "shade",
    "strategies",
    "validate",
    "write_image",
]
