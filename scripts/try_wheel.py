"""Run by release_trials.sh where the wheel is installed and nothing else of Trueshade. Usage: try_wheel.py GOLDEN with|without

The last word says whether OpenImageIO is installed."""
import sys
from pathlib import Path

import numpy
import trueshade

golden, openimageio = sys.argv[1:]
flags = set(Path("/proc/cpuinfo").read_text().split("flags", 1)[1].split("\n", 1)[0].split())
targets = {"scalar": set(), "sse4": {"sse4_1"}, "avx2": {"avx2", "fma"}, "avx512": {"avx512f", "avx512bw", "avx512dq", "avx512vl"}}
drawn = [name for name, needs in targets.items() if needs <= flags]
scene = trueshade.load_scene("builtin:city")
for simd in drawn:
    frame = trueshade.render(scene, trueshade.Pipeline(size=(800, 800)), simd=simd)
    assert frame.hash == "sha256:" + golden, f"{simd}: {frame.hash}"
assert trueshade.validate  # the judge is linked in

frame.save("city.png")
assert trueshade.compare("city.png", frame.color)["pass"]
frame.save("city.exr")
try:
    planes = trueshade.read_planes("city.exr")
    assert openimageio == "with", "an EXR was read, though OpenImageIO is not there"
    assert numpy.array_equal(planes["color"].shape[:2], frame.color.shape[:2])
except trueshade.Error as error:
    assert openimageio == "without" and "trueshade_image_io.so" in str(error), error
print("drawn by " + ", ".join(drawn))
