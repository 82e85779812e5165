"""Types and documentation of the module `trueshade`: what `help()` shows is made of this file.

Arrays of pixels have rows from the top of the picture. Colours are linear light. World space is right-handed, in scene
units. Wrong arguments raise `Error` with one line, `WHERE: REASON (REMEDY)`.
"""

import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

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

__version__: str

_Path = Union[str, "os.PathLike[str]"]
_Vector3 = Union[Sequence[float], npt.NDArray[Any]]
_Vector4 = Union[Sequence[float], npt.NDArray[Any]]
_Matrix = Union[Sequence[Sequence[float]], npt.NDArray[Any]]

class Error(ValueError):
    """What is wrong with an input, in one line: WHERE: REASON (REMEDY).

    A frame or a file that the machine's memory cannot hold is a MemoryError instead.
    """

    exit_code: int
    """The code that the command `trueshade` ends with for the same fault: 2 usage, 3 bad input, 4 over a limit,
    5 reading or writing failed."""

class Scene:
    """Meshes, materials, textures, instances, lights and a camera, as values.

    Made by load_scene(), or empty and then filled from arrays. Arrays are copied, so that they may be changed
    afterwards. A scene that another thread draws at the moment cannot be changed: that raises Error.
    """

    def __init__(self) -> None: ...
    @property
    def spec(self) -> str:
        """What the scene is called in errors and explanations; may be set."""
    @spec.setter
    def spec(self, value: str) -> None: ...
    def add_mesh(
        self,
        positions: npt.NDArray[np.float32],
        indices: npt.NDArray[Any],
        normals: Optional[npt.NDArray[np.float32]] = None,
        uv: Optional[npt.NDArray[np.float32]] = None,
        colors: Optional[npt.NDArray[np.float32]] = None,
        *,
        flat: bool = False,
        name: str = "",
    ) -> int:
        """Adds a mesh of triangles and returns its index, from 0. It is drawn where add_instance() places it.

        positions: (n, 3) of float32, object space, at most 1e18 from 0.
        indices: (t, 3) of uint32, int32, int64 or uint64, each from 0 to n - 1; front faces are counter-clockwise.
        normals: (n, 3) of float32, object space, of any length. Without them each vertex has the sum of the cross
            products of its triangles, or with flat=True each triangle has its own normal.
        uv: (n, 2) of float32, texture coordinates. colors: (n, 4) of float32, linear RGBA, times the material's colour.

        All arrays are C-contiguous and finite. Raises Error for an array that is not, naming the element, and for a
        list, which has no type: pass numpy.asarray(list, numpy.float32).
        """
    def add_texture(
        self,
        texels: npt.NDArray[Any],
        *,
        srgb: bool = True,
        mipmaps: bool = True,
        wrap: str = "repeat",
        filter: str = "linear",
        name: str = "",
    ) -> int:
        """Adds a texture and returns its index, from 0, for the maps of add_material().

        texels: (height, width, 4) of uint8, float16 or float32; of uint8 also (height, width, 3) and (height, width).
            Texel [0, 0] is at u = v = 0. At most 16384 texels a side.
        srgb: R, G and B of uint8 are sRGB codes; False for maps of anything but colours. Floats are linear.
        mipmaps: makes all smaller levels, and reads between them.
        wrap: repeat, mirrored_repeat, clamp_to_edge, clamp_to_border or mirror_clamp_to_edge. filter: nearest or linear.
        Raises Error for other arrays and names.
        """
    def add_material(
        self,
        base_color: _Vector4 = (1.0, 1.0, 1.0, 1.0),
        *,
        specular_color: _Vector3 = (0.25, 0.25, 0.25),
        shininess: float = 32.0,
        emission: _Vector3 = (0.0, 0.0, 0.0),
        metallic: float = 0.0,
        roughness: float = 1.0,
        color_map: Optional[int] = None,
        specular_map: Optional[int] = None,
        normal_map: Optional[int] = None,
        metallic_roughness_map: Optional[int] = None,
        emission_map: Optional[int] = None,
        occlusion_map: Optional[int] = None,
        normal_scale: float = 1.0,
        alpha_cutoff: float = 0.0,
        transparent: bool = False,
        double_sided: bool = False,
        unlit: bool = False,
        name: str = "",
    ) -> int:
        """Adds a material and returns its index, from 0. A light model reads the values it names (docs/presets.md).

        base_color: linear RGBA, each 0 or more. specular_color, emission: linear RGB, each 0 or more.
        shininess: a whole number from 0 to 8192. metallic, roughness: from 0 to 1.
        *_map: indices that add_texture() gave, each multiplying its value; normal_map is in tangent space, and
            normal_scale multiplies its x and y.
        alpha_cutoff: fragments with less alpha are not drawn; 0 draws all. transparent: blended by its alpha.
        double_sided: back faces are never culled, and lit with their normals turned round. unlit: lights change nothing.
        Raises Error for values outside these ranges and for indices of no texture.
        """
    def add_instance(self, mesh: int, material: int, world_from_object: Optional[_Matrix] = None) -> int:
        """Draws a mesh with a material and returns the instance's index, from 0.

        mesh, material: indices that add_mesh() and add_material() gave. world_from_object: (4, 4), or (3, 4) without
        the last row, which is 0, 0, 0, 1; multiplies columns, so that the translation is the last column; the identity
        without it. Instances are drawn in the order they were added. Raises Error for other shapes and indices.
        """
    def add_instances(self, mesh: int, material: int, world_from_objects: npt.NDArray[Any]) -> None:
        """Draws a mesh with a material many times: world_from_objects is (n, 4, 4) or (n, 3, 4), a matrix for each
        instance as add_instance() has it."""
    def add_light(
        self,
        type: str = "point",
        *,
        position: _Vector3 = (0.0, 0.0, 0.0),
        direction: _Vector3 = (0.0, 0.0, -1.0),
        color: _Vector3 = (1.0, 1.0, 1.0),
        intensity: float = 1.0,
        range: Optional[float] = None,
        attenuation: _Vector3 = (1.0, 0.0, 0.0),
        cone_deg: float = 180.0,
        penumbra_deg: float = 0.0,
        ambient: _Vector3 = (0.0, 0.0, 0.0),
        spot_exponent: float = 0.0,
        radius: float = 0.0,
        right: _Vector3 = (0.0, 0.0, 0.0),
        up: _Vector3 = (0.0, 0.0, 0.0),
    ) -> int:
        """Adds a light and returns its index, from 0. Lights are summed in this order.

        type: ambient, directional, point, spot, sphere, tube, rectangle or disk. position: world space.
        direction: the way the light travels, world space, of any length but 0.
        color: linear RGB, each 0 or more, times intensity. ambient: the light's share of ambient light, linear RGB.
        range: scene units, above 0, from which on there is no light; None is infinite.
        attenuation: k0, k1 [1/unit], k2 [1/unit^2] of presets that divide by k0 + k1 d + k2 d^2.
        cone_deg: half angle of the fully lit cone of a spot, 0 to 180; penumbra_deg: the angle beyond, over which the
            light fades to 0. spot_exponent: of the cosine to the axis, 0 to 8192.
        radius: of spheres and tubes, scene units, above 0. right: of tubes, half of the axis; of rectangles and disks,
            with up, half extents at right angles, world space. These shine to the side of cross(up, right), whatever
            direction says. Lights with an area need a light model that has them, as `area` and `area-lambert` do.
        Raises Error for values outside these ranges.
        """
    def add_point_lights(
        self,
        positions: npt.NDArray[np.float32],
        colors: npt.NDArray[np.float32],
        ranges: npt.NDArray[np.float32],
    ) -> None:
        """Adds a point light for each row: positions (n, 3) in world space, colors (n, 3) linear RGB times intensity,
        ranges (n, 1) in scene units, above 0. All are float32 and C-contiguous. Raises Error as add_mesh() does."""
    def set_camera(
        self,
        eye: _Vector3,
        target: Optional[_Vector3] = None,
        *,
        up: _Vector3 = (0.0, 1.0, 0.0),
        fov_deg: float = 45.0,
        fov_x_deg: Optional[float] = None,
        near: float = 0.1,
        far: float = 1000.0,
        clip_from_world: Optional[_Matrix] = None,
    ) -> None:
        """Sets the camera.

        eye, target, up: world space; without clip_from_world there has to be a target. fov_deg: the full vertical
            angle; fov_x_deg: the full horizontal one, in its place.
        near, far: distances in scene units, 0 < near < far.
        clip_from_world: an engine's own matrix, (4, 4), which multiplies columns and replaces all but the eye. Its clip
            space is OpenGL's, -w <= z <= w, unless the pipeline says otherwise.
        Raises Error for other shapes and values.
        """
    def set_orbit(
        self,
        azimuth_deg: float,
        elevation_deg: float,
        distance: Optional[float] = None,
        *,
        look_at: Optional[_Vector3] = None,
        fov_deg: Optional[float] = None,
        size: Sequence[int] = (1, 1),
    ) -> None:
        """Sets the camera that `trueshade render --orbit` has: it sees the scene from a side.

        azimuth_deg, elevation_deg: to the right of the scene's front, and above it.
        distance: scene units from the centre; without it the scene fills 85 % of the width or the height of a picture
            of the shape of `size`, width and height.
        look_at: world space, the place that is gone around, in place of the centre.
        fov_deg: the full vertical angle; without it the lens of the scene's camera stays.
        Raises Error for other values.
        """
    def set_clear(self, color: _Vector4) -> None:
        """Sets what the target holds where nothing is drawn: linear RGBA."""
    def set_time(self, time: float) -> None:
        """Moves what moves to a time in seconds, at most 1e6. Raises Error where what moves leaves its range."""
    @property
    def time(self) -> float:
        """The time that the scene stands at, in seconds."""
    @property
    def hash(self) -> str:
        """`sha256:` and the hash of all values, as `trueshade info` prints it."""
    @property
    def triangles(self) -> int:
        """How many triangles are drawn, over all instances."""
    @property
    def meshes(self) -> int:
        """How many meshes there are."""
    @property
    def materials(self) -> int:
        """How many materials there are."""
    @property
    def textures(self) -> int:
        """How many textures there are."""
    @property
    def instances(self) -> int:
        """How many instances there are."""
    @property
    def lights(self) -> int:
        """How many lights there are, ambient ones among them."""
    @property
    def notes(self) -> List[str]:
        """What of its file the scene leaves out, a sentence each."""

class Pipeline:
    """Everything that may change a pixel, beside the scene. Values; equal ones compare equal.

    preset: the row to start from, one of presets(); without it what the scene starts from, which for photometric glTF
        scenes is another than for others.
    size: (width, height) in pixels, 1 to 65536 each. strategy: one of strategies(). target: rgba8, srgb8_a8, rgb10_a2,
        rgba16, r11g11b10f, rgb16f, rgba16f or rgba32f.
    values: keys of the pipeline's JSON (scenes/schemas/pipeline.schema.json), as a mapping or as text, over the preset's
        and over those of the scene's file.
    light_shader: a light program in place of the preset's formula (docs/light_programs.md): a file of GLSL or SPIR-V, or
        the name of a model that ships. light_parameters: values for the members of its block Parameters, numbers or the
        components of vectors.
    scene: takes what the scene starts from now, so that the properties below have it; else that is done when a frame is
        drawn, as the options of the command do, and until then the properties are those for a scene that asks for nothing.
    Raises Error for names that do not exist, with those that do, and for values that do not go together.
    """

    def __init__(
        self,
        preset: Optional[str] = None,
        *,
        size: Optional[Tuple[int, int]] = None,
        strategy: Optional[str] = None,
        target: Optional[str] = None,
        values: Union[None, str, Mapping[str, Any]] = None,
        light_shader: Optional[_Path] = None,
        light_parameters: Optional[Mapping[str, Union[float, Sequence[float]]]] = None,
        scene: Optional[Scene] = None,
    ) -> None: ...
    @property
    def size(self) -> Tuple[int, int]:
        """(width, height) in pixels."""
    @property
    def preset(self) -> str:
        """The name of the row that the values started from."""
    @property
    def strategy(self) -> str:
        """How lights come to pixels (docs/strategies.md)."""
    @property
    def target(self) -> str:
        """The format that colours are stored in."""
    def to_json(self) -> str:
        """All values as JSON text, for `values` of another pipeline and for `trueshade render --pipeline`."""
    def to_dict(self) -> Dict[str, Any]:
        """All values as a dict, of which a part may be the `values` of another pipeline."""

class Frame:
    """A drawn picture with its planes. Arrays share its memory, cannot be written to, and keep it alive."""

    @property
    def color(self) -> npt.NDArray[Any]:
        """The target, rows from the top, not copied: (height, width, 4) of uint8, uint16, float16 or float32,
        (height, width, 3) of float16 for rgb16f, (height, width) of uint32 for the packed targets rgb10_a2 and
        r11g11b10f. Codes are as they are stored; floats are linear light."""
    @property
    def planes(self) -> Dict[str, npt.NDArray[Any]]:
        """The planes asked for, by name, in that order; not copied. docs/python.md lists shapes, types and spaces."""
    @property
    def format(self) -> str:
        """The target's format, such as rgba8."""
    @property
    def hash(self) -> str:
        """`sha256:` and the hash of the stored bytes, as `trueshade render --hash` prints it."""
    @property
    def stats(self) -> Dict[str, float]:
        """Counts: pixels, covered_pixels, lit_pixel_lights (pairs of a pixel and a light that reaches it), triangles,
        lights, fragments; and total_ms, the time of the frame in milliseconds."""
    @property
    def pipeline(self) -> Pipeline:
        """The pipeline that the frame was drawn by, whole."""
    def save(self, path: _Path) -> None:
        """Writes the frame as .png, or as .exr with its planes: the file that `trueshade render -o` writes, with the
        pipeline, the scene's hash and the image's hash in it. The file appears whole or not at all. Raises Error for
        other endings and where writing fails."""

def load_scene(
    spec: _Path,
    time: float = 0.0,
    *,
    camera: Union[int, str, None] = None,
    animation: Union[int, str, None] = None,
    lenient: bool = False,
    trust_paths: bool = False,
) -> Scene:
    """Loads a scene: `builtin:NAME[,KEY=VALUE...]`, or a file that ends in .json, .gltf, .glb, .obj or .ply.

    time: seconds, at most 1e6, that what moves is moved to. `trueshade list` and docs/scenes.md have the built-in
    scenes. camera, animation: which of a glTF file's, by number from 0 or by name; the animation may be "all"; without
    them the first. lenient: faults of a file that harm its looks alone are passed over, and `notes` says which; such a
    scene is no reference. trust_paths: the file may name others anywhere, by absolute paths and links, too. Raises
    Error with the file and the place in it.
    """

def render(
    scene: Scene,
    pipeline: Optional[Pipeline] = None,
    *,
    planes: Sequence[str] = (),
    threads: int = 0,
    simd: str = "best",
) -> Frame:
    """Draws a frame. Other Python threads run meanwhile, and Ctrl-C ends it.

    pipeline: without it what the scene starts from. planes: names such as depth, position, normal, albedo, id.object,
    light.count, light.0; docs/views.md has them all. threads: 0 for one a core, at most 1024. simd: best, scalar, sse4,
    avx2 or avx512. Neither threads nor simd changes a bit.

    The first frame of a scene prepares its meshes; the next are faster. Raises Error for names that do not exist and
    scenes that are out of range, MemoryError for a frame that memory cannot hold.
    """

def shade(
    scene: Scene,
    planes: Mapping[str, npt.NDArray[Any]],
    pipeline: Optional[Pipeline] = None,
    *,
    threads: int = 0,
    simd: str = "best",
) -> Frame:
    """Lights a G-buffer by the scene's lights and camera; the scene's objects are not drawn.

    planes: arrays of one size, as render() gives them: normal and albedo (height, width, 4) of float32 and what the
    preset reads of position or depth, specular, emission; id.object (height, width) of uint32 is 0 where there is no
    surface, and without it the depth tells. The planes of a frame give the same frame. threads, simd: as render() has
    them. Raises Error for a plane that is missing or of another size or type.
    """

def validate(
    scene: Scene,
    image: Optional[npt.NDArray[Any]],
    planes: Mapping[str, npt.NDArray[Any]],
    pipeline: Optional[Pipeline] = None,
    *,
    profile: str = "unknown",
    subpixel_bits: Optional[int] = None,
    significance: float = 1e-6,
    mask: Optional[Union[_Path, npt.NDArray[Any]]] = None,
    allow_mask: bool = False,
) -> Dict[str, Any]:
    """Judges a picture and its planes by what OpenGL allows, without a tolerance.

    image: (height, width, 4), codes or floats of the pipeline's target; of uint8 and uint16 also (height, width, 3),
        whose alpha is not judged; None judges the planes alone. planes: what the renderer read back, by the names that
        render() has: depth, position, normal, albedo, id.object, ... Their size is the pipeline's.
    profile: unknown, vulkan, webgpu, d3d-class, mesa-llvmpipe-22.3 or ideal: what the device promises. subpixel_bits:
        of its window coordinates, 4 to 16, if it is known. significance: how many legal images may fail the tests of
        the whole image. mask, allow_mask: as compare() has them.

    Returns the verdict of `trueshade validate --json`: `pass` says that no pixel is in violation, `stages` holds for
    each stage the counts of pixels by class and the worst pixels, `evidence` what convicts the image as a whole.
    Raises Error for planes that are missing, of another size, or that hold what their format cannot.
    """

def explain(
    scene: Scene, x: int, y: int, pipeline: Optional[Pipeline] = None, *, everything: bool = False
) -> Dict[str, Any]:
    """How a pixel got its value: triangles, surface, lights and draws, as `trueshade explain --json` prints them.

    x, y: column and row from the top left, from 0. everything: all lights and triangles, not the 64 that add most.
    `["values"]["stored"]` is the pixel of render(). Raises Error for a pixel that is not in the picture.
    """

def compare(
    reference: Union[_Path, npt.NDArray[Any]],
    test: Union[_Path, npt.NDArray[Any]],
    *,
    max_difference: Optional[float] = None,
    max_ulp: Optional[float] = None,
    pixels: Optional[float] = None,
    delta: Optional[float] = None,
    psnr: Optional[float] = None,
    flip: Optional[float] = None,
    allow_nonfinite: bool = False,
    page: Optional[_Path] = None,
    window: Optional[Tuple[int, float]] = None,
    mask: Optional[Union[_Path, npt.NDArray[Any]]] = None,
    allow_mask: bool = False,
) -> Dict[str, Any]:
    """Compares two pictures, each a file (EXR, PNG, TIFF, HDR, DDS, .npy, JPEG) or an array.

    Arrays: (height, width, 3 or 4) or (height, width) of uint8, uint16, float16 or float32; codes are sRGB, floats are
    linear light. A picture without alpha is opaque where the other one has alpha.

    Criteria, all of which must hold; without any, every stored value has to be equal:
    max_difference: of any channel, 1 for the whole range of codes. max_ulp: of any channel, in codes or steps of
    floats. pixels and delta: at most so many pixels that differ by more than delta. psnr: at least so many dB.
    flip: mean of the FLIP metric, 0 to 1, at most. What is not finite, and sizes and channels that do not fit, fail
    always; allow_nonfinite lets pass what is not finite in both. docs/compare.md says more.

    window: a side of 8, 16, 32, 64 or 128 pixels, and the largest share of the pixels of such a window that may differ
    by more than delta.

    page: a file .html that is written, with both pictures to look into.
    mask: a picture or an array of bool or codes. Where it is 0 or False pixels are left out, where it is 1, True or the
    largest code they are looked at. More than a tenth may be left out with allow_mask alone.

    Returns `pass`, `outcome` (same, within, different, mismatched), `verdict` in one line, `failures`, `notes`,
    `unequal_pixels`, `left_out_pixels`, `channels`, `criteria`, `windows`, and `first` and `worst`: pixels with both values of every channel.
    Raises Error for arrays that are no picture, for two of which one alone has colours, for files that cannot be read
    and for a page that does not end in .html.
    """

def write_image(
    path: _Path, image: npt.NDArray[Any], format: str = "", *, planes: Mapping[str, npt.NDArray[Any]] = {}
) -> None:
    """Writes an array as .png or .exr, whole or not at all.

    image: (height, width, 4) of uint8, uint16, float16 or float32, (height, width, 3) of these, (height, width) of
    uint8 or uint16 for grey. format: the name of a target's format where the array does not tell, such as rgb10_a2.
    planes: of an EXR, by the names that render() has. A PNG holds codes as they are, and floats, which are linear
    light, as sRGB codes. Raises Error for other endings and arrays, and where writing fails.
    """

def read_planes(path: _Path) -> Dict[str, npt.NDArray[Any]]:
    """Reads a .png or .exr: `color`, and of an EXR the planes that are in it, by the names that render() has.

    A PNG is (height, width, 4) of uint8 or uint16, its codes as they are. Planes of an EXR are float16, float32 or
    uint32, as the file has them. Raises Error for a file that is torn or neither.
    """

def image_hash(image: npt.NDArray[Any], format: str = "") -> str:
    """`sha256:` and the hash of an image's bytes, as `trueshade render --hash` prints it.

    image: (height, width, 4) of uint8, uint16, float16 or float32, or another array that Frame.color has. format: of
    packed words and sRGB codes, which an array does not tell. Raises Error for arrays that no format has.
    """

def presets() -> List[str]:
    """The names of the presets (docs/presets.md), the first of which is where a pipeline starts."""

def strategies() -> List[str]:
    """The names of the strategies by which lights come to pixels (docs/strategies.md)."""
