"""Types and documentation of the module `trueshade`.

Arrays of pixels have rows from the top of the picture. Colours are linear light. World space is right-handed, in scene
units. Wrong arguments raise `Error` with one line, `WHERE: REASON (REMEDY)`.
"""

import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

Vector3 = Union[Sequence[float], npt.NDArray[Any]]
Vector4 = Union[Sequence[float], npt.NDArray[Any]]
Matrix = Union[Sequence[Sequence[float]], npt.NDArray[Any]]

class Error(ValueError):
    """What is wrong with an input. `exit_code` is the one that the command ends with for the same fault."""

    exit_code: int

class Scene:
    """Meshes, materials, textures, instances, lights and a camera, as values."""

    spec: str
    """What the scene is called in errors and explanations."""
    def __init__(self) -> None: ...
    def add_mesh(
        self,
        positions: npt.NDArray[np.float32],
        indices: npt.NDArray[Any],
        normals: Optional[npt.NDArray[np.float32]] = None,
        uv: Optional[npt.NDArray[np.float32]] = None,
        colors: Optional[npt.NDArray[np.float32]] = None,
        *,
        name: str = "",
    ) -> int:
        """Adds a mesh and returns its index.

        positions: (n, 3), object space. indices: (t, 3), whole numbers below n; front faces are counter-clockwise.
        normals: (n, 3), of any length; without them each vertex has the sum of its faces' normals.
        uv: (n, 2). colors: (n, 4), linear RGBA. All but the indices are float32 and C-contiguous, and are copied.
        """
    def add_texture(self, texels: npt.NDArray[Any], *, srgb: bool = True, mipmaps: bool = True, name: str = "") -> int:
        """Adds a texture and returns its index.

        texels: (height, width, 4) of uint8, float16 or float32; texel [0, 0] is at u = v = 0.
        srgb: RGB of uint8 are sRGB codes. mipmaps: makes all smaller levels.
        """
    def add_material(
        self,
        base_color: Vector4 = (1.0, 1.0, 1.0, 1.0),
        *,
        specular_color: Vector3 = (0.25, 0.25, 0.25),
        shininess: float = 32.0,
        emission: Vector3 = (0.0, 0.0, 0.0),
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
        """Adds a material and returns its index. Maps are indices that add_texture() gave. A light model reads the
        values it names (docs/presets.md). shininess: a whole number from 0 to 8192; metallic, roughness: in [0, 1]."""
    def add_instance(self, mesh: int, material: int, world_from_object: Optional[Matrix] = None) -> int:
        """Draws a mesh with a material and returns the instance's index. world_from_object: (3, 4) or (4, 4), affine,
        multiplies columns; the identity without it. Instances are drawn in the order they were added."""
    def add_light(
        self,
        type: str = "point",
        *,
        position: Vector3 = (0.0, 0.0, 0.0),
        direction: Vector3 = (0.0, 0.0, -1.0),
        color: Vector3 = (1.0, 1.0, 1.0),
        intensity: float = 1.0,
        range: float = ...,
        attenuation: Vector3 = (1.0, 0.0, 0.0),
        cone_deg: float = 180.0,
        penumbra_deg: float = 0.0,
        ambient: Vector3 = (0.0, 0.0, 0.0),
        spot_exponent: float = 0.0,
    ) -> int:
        """Adds a light of the type ambient, directional, point or spot, and returns its index.

        position: world. direction: the way the light travels, of any length. range: scene units, infinite by default.
        attenuation: k0, k1 [1/unit], k2 [1/unit^2]. cone_deg: half angle of the fully lit cone; penumbra_deg: the angle
        beyond, over which the light fades to 0.
        """
    def add_point_lights(
        self,
        positions: npt.NDArray[np.float32],
        colors: npt.NDArray[np.float32],
        ranges: npt.NDArray[np.float32],
    ) -> None:
        """Adds a point light a row: positions (n, 3) in the world, colors (n, 3) times their intensity, ranges (n, 1)."""
    def set_camera(
        self,
        eye: Vector3,
        target: Vector3,
        *,
        up: Vector3 = (0.0, 1.0, 0.0),
        fov_deg: float = 45.0,
        near: float = 0.1,
        far: float = 1000.0,
        clip_from_world: Optional[Matrix] = None,
    ) -> None:
        """Sets the camera. fov_deg: the full vertical angle. clip_from_world: an engine's own matrix (4, 4), which
        multiplies columns and replaces all but the eye."""
    def set_clear(self, color: Vector4) -> None:
        """Sets what the target holds where nothing is drawn: linear RGBA."""
    def set_time(self, time: float) -> None:
        """Moves what moves to a time in seconds."""
    @property
    def hash(self) -> str:
        """`sha256:` and the hash of all values, as `trueshade info` prints it."""
    @property
    def triangles(self) -> int: ...
    @property
    def meshes(self) -> int: ...
    @property
    def materials(self) -> int: ...
    @property
    def textures(self) -> int: ...
    @property
    def instances(self) -> int: ...
    @property
    def lights(self) -> int: ...
    @property
    def notes(self) -> List[str]:
        """What of its file the scene leaves out."""

class Pipeline:
    """Everything that may change a pixel, beside the scene."""

    def __init__(
        self,
        preset: Optional[str] = None,
        *,
        size: Optional[Tuple[int, int]] = None,
        strategy: Optional[str] = None,
        target: Optional[str] = None,
        values: Union[None, str, Mapping[str, Any]] = None,
        scene: Optional[Scene] = None,
    ) -> None:
        """preset: the row to start from; without it what `scene` starts from, or the first preset. size: (width,
        height) in pixels. values: keys of the pipeline's JSON (scenes/schemas/pipeline.schema.json), as text or as a
        mapping, over the preset's."""
    @property
    def size(self) -> Tuple[int, int]: ...
    @property
    def preset(self) -> str: ...
    @property
    def strategy(self) -> str: ...
    @property
    def target(self) -> str: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> Dict[str, Any]: ...

class Frame:
    """A drawn picture with its planes. Arrays share its memory, cannot be written to, and keep it alive."""

    @property
    def color(self) -> npt.NDArray[Any]:
        """(height, width, channels) of uint8, uint16, float16 or float32; (height, width) of uint32 where the target is
        packed."""
    @property
    def planes(self) -> Dict[str, npt.NDArray[Any]]:
        """The planes asked for, by name."""
    @property
    def format(self) -> str: ...
    @property
    def hash(self) -> str:
        """`sha256:` and the hash of the stored bytes, as `trueshade render --hash` prints it."""
    @property
    def stats(self) -> Dict[str, float]: ...

def load_scene(spec: str, time: float = 0.0) -> Scene:
    """Loads `builtin:NAME[,KEY=VALUE...]` or a file: .json, .gltf, .glb, .obj, .ply. time: seconds."""

def render(
    scene: Scene,
    pipeline: Optional[Pipeline] = None,
    *,
    planes: Sequence[str] = (),
    threads: int = 0,
    simd: str = "best",
) -> Frame:
    """Draws a frame; other Python threads run meanwhile, and Ctrl-C ends it.

    planes: depth, position, normal, albedo, ... as `--aov` names them. threads: 0 for one a core; simd: best, scalar,
    sse4, avx2 or avx512. Neither changes a pixel.
    """

def shade(
    scene: Scene,
    planes: Mapping[str, npt.NDArray[Any]],
    pipeline: Optional[Pipeline] = None,
    *,
    threads: int = 0,
    simd: str = "best",
) -> Frame:
    """Lights a G-buffer by the scene's lights and camera. planes: normal and albedo, position or depth, id.object or
    depth; of the types that render() gives."""

def validate(
    scene: Scene,
    image: npt.NDArray[Any],
    planes: Mapping[str, npt.NDArray[Any]],
    pipeline: Optional[Pipeline] = None,
    *,
    profile: str = "unknown",
    significance: float = 1e-6,
) -> Dict[str, Any]:
    """Judges a picture and its planes by what OpenGL allows: the verdict as `trueshade validate --json` has it, `pass`
    among its keys."""

def explain(
    scene: Scene, x: int, y: int, pipeline: Optional[Pipeline] = None, *, everything: bool = False
) -> Dict[str, Any]:
    """How a pixel got its value, as `trueshade explain --json` prints it. x, y: column and row from the top left."""

def compare(
    reference: Union[str, "os.PathLike[str]", npt.NDArray[Any]],
    test: Union[str, "os.PathLike[str]", npt.NDArray[Any]],
    *,
    max_difference: Optional[float] = None,
    max_ulp: Optional[float] = None,
    pixels: Optional[float] = None,
    delta: Optional[float] = None,
    psnr: Optional[float] = None,
    flip: Optional[float] = None,
    allow_nonfinite: bool = False,
) -> Dict[str, Any]:
    """Compares two pictures, each a file of any kind that `trueshade compare` reads or an array. `pass`: whether all
    criteria hold; without any, every stored value has to be equal. What is not finite, and sizes and channels that do
    not fit together, fail always. docs/compare.md says what each criterion means. `first` and `worst` are pixels with
    both values of every channel."""

def write_image(path: str, image: npt.NDArray[Any], format: str = "") -> None:
    """Writes an array as .png or .exr, whole or not at all."""

def image_hash(image: npt.NDArray[Any], format: str = "") -> str:
    """`sha256:` and the hash of an image's bytes. format: of packed words and sRGB codes, which an array does not tell."""

def presets() -> List[str]: ...
def strategies() -> List[str]: ...
