#!/usr/bin/env python3
"""new_field.py COPY, which is ./check new-field: what a new field of a light takes.

COPY is a copy of the tree, with its own build/release. The field `glow`, a number that light programs read, is added
there as CONTRIBUTING.md says; the command and the Python module are built, and the field is used in all the ways that
users have. Prints the files that were changed. Fails where a way does not work, or where more than six files of C++ and
GLSL were changed.
"""
import json
import re
import subprocess
import sys
from pathlib import Path

MOST = 6  # files of C++ and GLSL

# Of a file, what stands before the new text, and the new text.
ADDITIONS = {
    "scenes/light.h": [(r"  float spot_exponent = 0\.0f;[^\n]*\n", "  float glow = 0.0f;  ///< for programs; in [0, 10]\n")],
    "scenes/light_fields.h": [
        (r"  right,\n  up", ",\n  glow"),
        (r"light_sets::kFlat,\s+true,\s+LightHash::area\}", """,
    {LightProperty::glow, "glow", "glow", "glow", &Light::glow, LightValueKind::number, 0.0, 10.0,
     light_sets::kPointLike, false, LightHash::later}"""),
    ],
    "programs/light_interface.glsl": [(r"  vec3 right, up;[^\n]*\n", "  float glow;\n")],
    "gl/emit/light_record.h": [(r'\{"right", 7, "xyz"\},', '{"glow", 7, "w"},')],
    "judge/bounds/program_fields.cpp": [
        (r"constexpr Row<LightField> kLight\[\] = \{",
         '{"glow", [](L l, uint32_t, size_t) { return Interval::of(double(l.glow)); }},')],
    "python/binding/scene_binding.cpp": [
        (r"double spot_exponent, double radius, const py::object& right, const py::object& up", ", double glow"),
        (r"  light\.spot_exponent = [^\n]*\n", '  light.glow = float(number_within(glow, "glow", 0, 10));\n'),
        (r'"right"_a = zero, "up"_a = zero', ', "glow"_a = 0.0'),
    ],
    "python/trueshade/__init__.pyi": [(r"        up: _Vector3 = \(0\.0, 0\.0, 0\.0\),\n", "        glow: float = 0.0,\n")],
}
SCHEMA = "scenes/schemas/scene.schema.json"
PROGRAM = "vec3 light(Surface s, Light l, View v) { return s.albedo.rgb * l.color * l.glow; }\n"


def add_field(root):
    """Returns the names of the files that changed."""
    for name, additions in ADDITIONS.items():
        text = (root / name).read_text()
        for before, new in additions:
            found = re.search(before, text)
            if not found:
                sys.exit(f"new-field: {name} has no '{before}'")
            text = text[:found.end()] + new + text[found.end():]
        (root / name).write_text(text)
    schema = json.loads((root / SCHEMA).read_text())
    for kind in ("point", "spot", "point_step", "spot_step"):
        schema["$defs"][kind]["properties"]["glow"] = {"type": "number", "minimum": 0, "maximum": 10}
    (root / SCHEMA).write_text(json.dumps(schema))
    return [*ADDITIONS, SCHEMA]


def scene_file(folder, name, **light):
    path = folder / name
    path.write_text(json.dumps({
        "version": 1,
        "camera": {"eye": [0, 0, 4], "target": [0, 0, 0]},
        "objects": [{"mesh": "sphere", "color": [0.5, 0.5, 0.5]}],
        "lights": [{"type": "point", "position": [1, 2, 3], **light}]}))
    return path


class Command:
    def __init__(self, root, folder):
        self.program = root / "build/release/cli/trueshade"
        self.shader = folder / "glow.glsl"
        self.shader.write_text(PROGRAM)

    def run(self, *arguments, status=0):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != status:
            sys.exit(f"new-field: trueshade {' '.join(map(str, arguments))} ends with {done.returncode}:\n"
                     f"{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def picture(self, scene, *more):
        return self.run("render", scene, "--light-shader", self.shader, "--size", "64x64", "--hash", *more).split()[0]

    def scene_hash(self, scene):
        return json.loads(self.run("info", scene, "--json"))["hash"]


def require(holds, what):
    if not holds:
        sys.exit(f"new-field: {what}")


def use_field(root, folder):
    command = Command(root, folder)
    absent, default = scene_file(folder, "absent.json"), scene_file(folder, "default.json", glow=0)
    dim, bright = scene_file(folder, "dim.json", glow=0.25), scene_file(folder, "bright.json", glow=0.5)
    moving = scene_file(folder, "moving.json", steps=[{"time": 0, "glow": 0.25}, {"time": 1, "glow": 0.5}])
    require(command.scene_hash(absent) == command.scene_hash(default), "the default changes the scene's hash")
    require(command.scene_hash(absent) != command.scene_hash(dim), "the scene's hash does not know the field")
    require(command.picture(dim) != command.picture(bright), "a light program does not read the field")
    require(command.picture(moving, "--time", 1) == command.picture(bright), "the field does not move")
    command.run("export", moving, "-o", folder / "moving.glb")
    require(command.picture(folder / "moving.glb", "--time", 1) == command.picture(bright), "export loses the field")
    require('"glow":0.5' in command.run("info", bright, "--resolved").replace(" ", ""), "--resolved lacks the field")
    for driver in ("llvmpipe", "lavapipe"):
        command.run("validate", bright, "--light-shader", command.shader, "--size", "64x64", "--driver", driver)
    refused = command.run("render", scene_file(folder, "wrong.json", glow=11), "--hash", status=3)
    require("glow" in refused, f"a value out of range is refused so: {refused}")
    python = ("import trueshade; s = trueshade.Scene(); s.add_light('point', glow=0.5);"
              "t = trueshade.Scene(); t.add_light('point'); assert s.hash != t.hash")
    subprocess.run(["/usr/bin/python3", "-c", python], check=True, env={"PYTHONPATH": str(root / "build/release/python")})


def main():
    root = Path(sys.argv[1]).resolve()
    changed = add_field(root)
    subprocess.run(["cmake", "--build", root / "build/release", "--target", "trueshade", "trueshade_python"], check=True,
                   stdout=subprocess.DEVNULL)
    folder = root / "build/glow"
    folder.mkdir(exist_ok=True)
    use_field(root, folder)
    code = [name for name in changed if name.endswith((".h", ".cpp", ".glsl"))]
    print(*changed, sep="\n")
    require(len(code) <= MOST, f"{len(code)} files of C++ and GLSL, over {MOST}")
    print(f"trueshade: a field of a light is {len(code)} files of C++ and GLSL, and {len(changed) - len(code)} others")


main()
