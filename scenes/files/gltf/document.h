#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/baked_uv.h"
#include "scenes/files/content/faults.h"
#include "scenes/files/gltf/glb.h"
#include "scenes/json/json_value.h"
#include "scenes/light.h"
#include "scenes/placement.h"
#include "scenes/scene_parts.h"
#include "scenes/texture.h"
#include "scenes/timeline.h"

// A glTF 2.0 document as plain values. Names and defaults are the format's; indices are in range, kNone where absent.
namespace trueshade::gltf {

inline constexpr uint32_t kNone = UINT32_MAX;

// --- Data ----------------------------------------------------------------------------------------------------------

enum class Component : uint8_t { int8, uint8, int16, uint16, uint32, float32 };
enum class Shape : uint8_t { scalar, vec2, vec3, vec4, mat2, mat3, mat4, unknown };

constexpr uint32_t bytes_of(Component c) {
  return c == Component::int8 || c == Component::uint8 ? 1 : c == Component::int16 || c == Component::uint16 ? 2 : 4;
}

constexpr uint32_t components_of(Shape shape) {
  switch (shape) {
    case Shape::vec2:
      return 2;
    case Shape::vec3:
      return 3;
    case Shape::vec4:
    case Shape::mat2:
      return 4;
    case Shape::mat3:
      return 9;
    case Shape::mat4:
      return 16;
    case Shape::scalar:
    case Shape::unknown:
      return 1;
  }
  return 0;  // unreachable: every enumerator returns above
}

/// Rows, and columns, of a matrix.
constexpr uint32_t rows_of(Shape shape) { return shape == Shape::mat2 ? 2 : shape == Shape::mat3 ? 3 : 4; }

/// Bytes from an element to the next one beside it, and to the end of its last component. They differ where the columns
/// of a matrix, each of which starts on a multiple of 4, leave a gap behind the last.
uint64_t element_bytes(Component type, Shape shape);
uint64_t element_end(Component type, Shape shape);

struct Buffer {
  std::optional<std::string> uri;
  uint64_t bytes = 0;
  bool fallback = false;  ///< EXT_meshopt_compression: stands for what is unpacked, and has no data
};

/// EXT_meshopt_compression.
struct Packing {
  enum class Mode : uint8_t { attributes, triangles, indices };
  enum class Filter : uint8_t { none, octahedral, quaternion, exponential };
  uint32_t buffer = 0;
  uint64_t offset = 0, bytes = 0;
  uint32_t stride = 0;
  uint64_t count = 0;
  Mode mode = Mode::attributes;
  Filter filter = Filter::none;
};

struct BufferView {
  uint32_t buffer = 0;
  uint64_t offset = 0, bytes = 0;
  uint32_t stride = 0;  ///< 0: elements lie side by side
  std::optional<Packing> packing;
};

struct Sparse {
  uint64_t count = 0;
  uint32_t indices_view = 0, values_view = 0;
  uint64_t indices_offset = 0, values_offset = 0;
  Component index_type = Component::uint32;
};

struct Accessor {
  uint32_t view = kNone;  ///< kNone: zeros
  uint64_t offset = 0, count = 0;
  Component type = Component::float32;
  Shape shape = Shape::scalar;
  bool normalized = false;
  std::optional<double> largest;  ///< of a scalar's elements, as the file says
  std::optional<Sparse> sparse;
};

// --- Surfaces ------------------------------------------------------------------------------------------------------

struct ImageSource {
  std::optional<std::string> uri;
  uint32_t view = kNone;
  std::string mime;  ///< empty where absent
};

struct TextureSource {
  uint32_t image = kNone;
  Sampler sampler;
  std::string other_image;  ///< the extension that names an image of another format, empty where there is none
};

struct TextureInfo {
  uint32_t texture = kNone;
  UvSource uv{};
};

enum class AlphaMode : uint8_t { opaque, mask, blend, unknown };

struct MaterialSource {
  std::string name;
  glm::vec4 base_color{1.0f};
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emission{0.0f};
  float emission_strength = 1.0f;
  TextureInfo base_color_map, metallic_roughness_map, normal_map, occlusion_map, emission_map;
  float normal_scale = 1.0f, occlusion_strength = 1.0f;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false, unlit = false;
};

// --- Shapes --------------------------------------------------------------------------------------------------------

/// Attributes that are read, by accessor.
struct Attributes {
  uint32_t position = kNone, normal = kNone, tangent = kNone, color = kNone;
  std::vector<uint32_t> uv;               ///< sets from 0 on, kNone where one is not there
  std::vector<uint32_t> joints, weights;  ///< sets from 0 on

  uint32_t uv_set(size_t set) const { return set < uv.size() ? uv[set] : kNone; }
  bool operator==(const Attributes&) const = default;
};

enum class Mode : uint8_t { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

struct Primitive {
  Attributes attributes;
  uint32_t indices = kNone, material = kNone;
  Mode mode = Mode::triangles;
  std::vector<Attributes> targets;
};

struct MeshSource {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<double> weights;  ///< of the targets; empty where absent: 0 each
  bool has_joints = false;      ///< of one primitive at least
};

// --- Scene ---------------------------------------------------------------------------------------------------------

/// EXT_mesh_gpu_instancing, by accessor.
struct Copies {
  uint32_t translation = kNone, rotation = kNone, scale = kNone;
};

struct NodeSource {
  std::string name;
  std::vector<uint32_t> children;
  uint32_t parent = kNone;
  uint32_t mesh = kNone, skin = kNone, camera = kNone, light = kNone;
  Placement placement;
  std::optional<glm::dmat4x3> matrix;  ///< instead of the placement
  std::vector<double> weights;         ///< empty where absent: the mesh's
  std::optional<Copies> copies;
};

struct SkinSource {
  std::vector<uint32_t> joints;
  uint32_t inverse_bind = kNone, skeleton = kNone;
};

struct CameraSource {
  enum class Type : uint8_t { perspective, orthographic, unknown };
  std::string name;
  Type type = Type::unknown;
  double fov_y_rad = 0.0, near = 0.0, x_mag = 0.0, y_mag = 0.0;
  std::optional<double> far;  ///< absent: infinite
};

struct LightSource {
  std::optional<LightType> type;  ///< absent: one that KHR_lights_punctual does not define
  glm::vec3 color{1.0f};
  double intensity = 1.0;
  float range = kUnbounded;
  double inner_rad = 0.0, outer_rad = 0.78539816339744830962;
  static constexpr float kUnbounded = std::numeric_limits<float>::infinity();
};

enum class Path : uint8_t { translation, rotation, scale, weights, unknown };

struct AnimationSampler {
  uint32_t input = 0, output = 0;
  Between between = Between::linear;
};

struct Channel {
  uint32_t sampler = 0, node = kNone;
  Path path = Path::unknown;
};

struct AnimationSource {
  std::string name;
  std::vector<Channel> channels;
  std::vector<AnimationSampler> samplers;
};

/// Whether a quaternion's length is within 0.00769 of 1, as far as normalized bytes may miss it.
bool is_nearly_unit(const glm::dvec4& q);

struct Document {
  std::string file;  ///< stands in errors
  bool is_glb = false;
  std::vector<SceneExtension> extensions;  ///< that are used
  bool quantized = false;                  ///< KHR_mesh_quantization is among the extensions used
  std::vector<Buffer> buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<ImageSource> images;
  std::vector<TextureSource> textures;
  std::vector<MaterialSource> materials;
  std::vector<MeshSource> meshes;
  std::vector<NodeSource> nodes;
  std::vector<SkinSource> skins;
  std::vector<CameraSource> cameras;
  std::vector<LightSource> lights;
  std::vector<AnimationSource> animations;
  std::vector<std::vector<uint32_t>> scenes;  ///< root nodes of each
  uint32_t scene = kNone;
  std::optional<json::Value> extras;  ///< of the root
  Faults faults{Leniency::refused};

  /// Throws `FILE: POINTER: reason (remedy)`.
  [[noreturn]] void fail(const std::string& pointer, const std::string& reason, const std::string& remedy) const;

  /// Throws the same, or passes the fault over.
  void pass(Fault fault, const std::string& pointer, const std::string& reason, const std::string& remedy);
};

/// JSON pointer of an element: pointer_to("meshes", 3, "primitives", 0) is `/meshes/3/primitives/0`.
template <typename... Steps>
std::string pointer_to(const Steps&... steps) {
  std::string pointer;
  const auto add = [&pointer](const auto& step) {
    if constexpr (std::is_integral_v<std::decay_t<decltype(step)>>)
      pointer += '/' + std::to_string(step);
    else
      pointer += '/' + std::string(step);
  };
  (add(steps), ...);
  return pointer;
}

}  // namespace trueshade::gltf
