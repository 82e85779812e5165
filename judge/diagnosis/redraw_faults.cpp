#include <algorithm>
#include <cmath>

#include "judge/diagnosis/plane_faults.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

bool cull(Scene&, Pipeline& p, double face) {
  if (p.geometry.cull_face == CullFace(int(face))) return false;
  p.geometry.cull_face = CullFace(int(face));
  return true;
}
bool turn_front(Scene&, Pipeline& p, double) {
  if (p.geometry.cull_face == CullFace::none) return false;
  p.geometry.front_face = p.geometry.front_face == FrontFace::ccw ? FrontFace::cw : FrontFace::ccw;
  return true;
}
bool compare(Scene&, Pipeline& p, double func) {
  if (p.geometry.depth_func == DepthFunc(int(func))) return false;
  p.geometry.depth_func = DepthFunc(int(func));
  if (p.geometry.depth_func == DepthFunc::greater || p.geometry.depth_func == DepthFunc::gequal)
    p.geometry.clear_depth = 0;
  return true;
}
bool hold_depth(Scene&, Pipeline& p, double format) {
  if (p.geometry.depth_format == Format(int(format))) return false;
  p.geometry.depth_format = Format(int(format));
  return true;
}
bool clip_depth(Scene& s, Pipeline& p, double) {
  if (s.camera.clip_from_world) return false;
  // The matrix stays as it is, and the range is taken for the other one.
  const Matrix4 m = projection_of(s.camera, p.geometry, p.width, p.height);
  s.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(m[i]);
  p.geometry.clip_depth =
      p.geometry.clip_depth == ClipDepth::zero_to_one ? ClipDepth::negative_one_to_one : ClipDepth::zero_to_one;
  return true;
}
bool clamp_depth(Scene&, Pipeline& p, double) {
  p.geometry.depth_clamp = !p.geometry.depth_clamp;
  return true;
}
bool offset_depth(Scene&, Pipeline& p, double factor) {
  p.geometry.polygon_offset_factor += float(factor), p.geometry.polygon_offset_units += float(factor);
  return true;
}
bool draw_upside_down(Scene&, Pipeline& p, double) {
  p.geometry.clip_origin =
      p.geometry.clip_origin == ClipOrigin::lower_left ? ClipOrigin::upper_left : ClipOrigin::lower_left;
  return true;
}
template <class Change>
bool change_matrix(Scene& s, const Pipeline& p, const Change& change) {
  Matrix4 m = projection_of(s.camera, p.geometry, p.width, p.height);
  change(m);
  s.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(m[i]);
  s.camera.matrix_has_gl_range = false;
  return true;
}
/// Half pixels to the right and up: the parameter counts eight directions, counter-clockwise from the right.
constexpr int kDirections[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
bool half_a_pixel(Scene& s, Pipeline& p, double direction) {
  const int* d = kDirections[std::clamp(int(direction), 0, 7)];
  return change_matrix(s, p, [&](Matrix4& m) {
    for (size_t c = 0; c < 4; ++c)
      m[4 * c] += m[4 * c + 3] * d[0] / p.width, m[4 * c + 1] += m[4 * c + 3] * d[1] / p.height;
  });
}
bool left_handed(Scene& s, Pipeline& p, double) {
  return change_matrix(s, p, [](Matrix4& m) {
    for (size_t c = 0; c < 4; ++c) m[4 * c] = -m[4 * c];
  });
}
bool interpolate(Scene&, Pipeline& p, double how) {
  GBufferState& g = p.gbuffer;
  for (PlaneState* plane : {&g.position, &g.normal, &g.albedo, &g.uv}) plane->interpolation = Interpolation(int(how));
  return true;
}
bool flat_normals(Scene&, Pipeline& p, double) {
  p.gbuffer.normal.interpolation =
      p.gbuffer.normal.interpolation == Interpolation::flat ? Interpolation::smooth : Interpolation::flat;
  return true;
}
float inner_product(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// A rotation, and one scale: normals keep one length.
bool keeps_angles(const glm::mat4x3& m) {
  const float size = inner_product(m[0], m[0]);
  const auto near = [size](float a, float b) { return std::fabs(a - b) <= 1e-5f * size; };
  return near(inner_product(m[1], m[1]), size) && near(inner_product(m[2], m[2]), size) &&
         near(inner_product(m[0], m[1]), 0) && near(inner_product(m[0], m[2]), 0) && near(inner_product(m[1], m[2]), 0);
}
/// Normals of one length that the fragment shader makes unit are `normal-unit`, which says more.
bool make_unit_at(Scene& s, Pipeline& p, double shader) {
  const UnitNormals made = p.gbuffer.unit_normals, asked = UnitNormals(int(shader));
  const bool any_stretched = std::any_of(s.instances.begin(), s.instances.end(),
                                         [](const Instance& i) { return !keeps_angles(i.world_from_object); });
  if (made == asked || (made == UnitNormals::vertex && (asked == UnitNormals::both || !any_stretched))) return false;
  p.gbuffer.unit_normals = asked;
  return true;
}
bool provoke(Scene&, Pipeline& p, double) {
  p.geometry.provoking = p.geometry.provoking == Provoking::last ? Provoking::first : Provoking::last;
  const GBufferState& g = p.gbuffer;
  return g.position.interpolation == Interpolation::flat || g.normal.interpolation == Interpolation::flat ||
         g.albedo.interpolation == Interpolation::flat;
}
template <class Change>
bool change_slots(Scene& s, const Change& change) {
  bool any = false;
  for (Material& m : s.materials)
    for (TextureSlot* slot : maps_of(m))
      if (slot->used()) change(*slot), any = true;
  return any;
}
template <class Change>
bool change_samplers(Scene& s, const Change& change) {
  return change_slots(s, [&change](TextureSlot& slot) { change(slot.sampler); });
}
/// Filters that textures are read with by mistake. `nearest_mipmap_linear` is what OpenGL has where nobody sets one.
struct TextureFilter {
  const char* name;
  Filter mag, min;
  MipFilter mip;
};
constexpr TextureFilter kTextureFilters[] = {
    {"nearest", Filter::nearest, Filter::nearest, MipFilter::none},
    {"linear", Filter::linear, Filter::linear, MipFilter::none},
    {"linear_mipmap_nearest", Filter::linear, Filter::linear, MipFilter::nearest},
    {"linear_mipmap_linear", Filter::linear, Filter::linear, MipFilter::linear},
    {"nearest_mipmap_nearest", Filter::nearest, Filter::nearest, MipFilter::nearest},
    {"nearest_mipmap_linear", Filter::linear, Filter::nearest, MipFilter::linear},
    {"nearest_magnified", Filter::nearest, Filter::linear, MipFilter::linear},
};
constexpr int kMostFilters = int(std::size(kTextureFilters)) - 1;

bool filter(Scene& s, Pipeline&, double way) {
  const TextureFilter& f = kTextureFilters[std::clamp(int(way), 0, kMostFilters)];
  return change_samplers(s, [&f](Sampler& sampler) {
    sampler.mag_filter = f.mag, sampler.min_filter = f.min, sampler.mip_filter = f.mip;
  });
}
bool turn_textures(Scene& s, Pipeline&, double) {
  for (Texture& texture : s.textures)
    for (TextureLevel& level : texture.levels) {
      const auto row = ptrdiff_t(level.width) * bytes_per_texel(texture.format);
      for (int top = 0, bottom = level.height - 1; top < bottom; ++top, --bottom)
        std::swap_ranges(level.bytes.begin() + top * row, level.bytes.begin() + (top + 1) * row,
                         level.bytes.begin() + bottom * row);
    }
  return !s.textures.empty();
}
/// Colour maps alone: others hold numbers.
bool recode_textures(Scene& s, Pipeline&, double) {
  bool any = false;
  std::vector<uint8_t> done(s.textures.size());
  for (const Material& m : s.materials) {
    if (!m.color_map.used() || done[size_t(m.color_map.texture)] != 0) continue;
    done[size_t(m.color_map.texture)] = 1;
    TextureFormat& format = s.textures[size_t(m.color_map.texture)].format;
    if (format != TextureFormat::rgba8 && format != TextureFormat::srgb8_a8) continue;
    format = format == TextureFormat::rgba8 ? TextureFormat::srgb8_a8 : TextureFormat::rgba8;
    any = true;
  }
  return any;
}
bool bias_lod(Scene& s, Pipeline&, double bias) {
  return change_samplers(s, [bias](Sampler& sampler) { sampler.lod_bias += float(bias); });
}
/// Lets filters read `most` places along the longer axis of a pixel. False where no colour map has levels.
bool filter_anisotropically(const Scene& s, Sampling& rules, double most) {
  rules.anisotropy = int(most);
  return std::any_of(s.materials.begin(), s.materials.end(), [](const Material& m) {
    return m.color_map.used() && m.color_map.sampler.mip_filter != MipFilter::none;
  });
}
bool wrap(Scene& s, Pipeline&, double way) {
  return change_samplers(s, [way](Sampler& sampler) { sampler.wrap = {Wrap(int(way)), Wrap(int(way))}; });
}
bool no_textures(Scene& s, Pipeline&, double) {
  bool any = false;
  for (Material& m : s.materials) any = any || m.color_map.used(), m.color_map.texture = -1;
  return any;
}
bool no_base_color(Scene& s, Pipeline&, double) {
  for (Material& m : s.materials) m.base_color = glm::vec4(1.0f);
  return true;
}
/// The object keeps its number and draws nothing.
bool leave_out(Scene& s, Pipeline&, double object) {
  const auto at = size_t(object);
  if (at >= s.instances.size()) return false;
  s.instances[at].mesh = uint32_t(s.meshes.size());
  s.meshes.emplace_back();
  return true;
}
bool no_vertex_colors(Scene& s, Pipeline&, double) {
  bool any = false;
  for (Mesh& m : s.meshes)
    for (FloatStream& stream : m.color) any = any || !stream.empty(), stream = {};
  return any;
}
bool other_sides(Scene& s, Pipeline&, double) {
  for (Material& m : s.materials) m.double_sided = !m.double_sided;
  return !s.materials.empty();
}
bool other_uv_set(Scene& s, Pipeline&, double) {
  if (std::all_of(s.meshes.begin(), s.meshes.end(), [](const Mesh& m) { return m.more_uv.empty(); })) return false;
  return change_slots(s, [](TextureSlot& slot) { slot.uv_set = slot.uv_set == 0 ? 1 : 0; });
}
bool no_transforms(Scene& s, Pipeline&, double) {
  for (Instance& i : s.instances) i.world_from_object = glm::mat4x3(1.0f);
  return true;
}

/// M n for M^-T n: the object's normals become M^T M n, which its own matrix takes there. Each object has a mesh then.
bool normals_by_matrix(Scene& s, Pipeline&, double) {
  bool any = false;
  for (Instance& instance : s.instances) {
    const glm::mat4x3& m = instance.world_from_object;
    if (s.meshes[instance.mesh].normal[0].empty()) continue;
    if (keeps_angles(m)) continue;
    any = true;
    Mesh mesh = s.meshes[instance.mesh];
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      const glm::vec3 n(mesh.normal[0][i], mesh.normal[1][i], mesh.normal[2][i]);
      const glm::vec3 world = m[0] * n.x + m[1] * n.y + m[2] * n.z;
      for (size_t k = 0; k < 3; ++k) mesh.normal[k][i] = inner_product(m[int(k)], world);
    }
    instance.mesh = uint32_t(s.meshes.size());
    s.meshes.push_back(std::move(mesh));
  }
  return any;
}

std::string face_name(double face) {
  constexpr const char* kNames[] = {"none", "front", "back"};
  return kNames[std::clamp(int(face), 0, 2)];
}
std::string func_name(double func) {
  constexpr const char* kNames[] = {"never", "less", "equal", "lequal", "greater", "notequal", "gequal", "always"};
  return kNames[std::clamp(int(func), 0, 7)];
}
std::string format_name(double format) { return std::string(info(Format(int(format))).name); }
std::string direction_name(double direction) {
  constexpr const char* kNames[] = {"to the right", "up and to the right",  "up",   "up and to the left",
                                    "to the left",  "down and to the left", "down", "down and to the right"};
  return kNames[std::clamp(int(direction), 0, 7)];
}
std::string way_name(double way) {
  constexpr const char* kNames[] = {"smooth", "flat", "noperspective"};
  return kNames[std::clamp(int(way), 0, 2)];
}
std::string shader_name(double shader) {
  constexpr const char* kNames[] = {"the vertex shader alone", "the fragment shader alone", "both shaders"};
  return kNames[std::clamp(int(shader), 0, 2)];
}
std::string filter_name(double way) { return kTextureFilters[std::clamp(int(way), 0, kMostFilters)].name; }
std::string wrap_name(double way) {
  return std::string(kWrapNames[size_t(std::clamp(int(way), 0, int(std::size(kWrapNames)) - 1))]);
}

constexpr double kFaces[] = {0, 1, 2}, kFuncs[] = {1, 3, 4, 6, 7},
                 kDepthFormatNumbers[] = {double(Format::d16), double(Format::d24), double(Format::d32f)},
                 kDirectionNumbers[] = {0, 1, 2, 3, 4, 5, 6, 7}, kFilters[] = {0, 1, 2, 3, 4, 5, 6},
                 kBiases[] = {-2, -1, -0.5, 0.5, 1, 2}, kWraps[] = {0, 1, 2}, kPolygonOffsets[] = {-2, -1, 1, 2},
                 kNoPerspective[] = {2}, kShaders[] = {0, 1, 2}, kAnisotropies[] = {2, 4, 8, 16};

// name, text, plane, change, redraw, move, search, starts, doubt, reach, says
constexpr PlaneFault kRedrawFaults[] = {
    {"cull-face", "the face culled is `%s`", Plane::all, nullptr, cull, nullptr, kOneOf, kFaces, 0, 0, face_name},
    {"front-face", "the front is taken for the back", Plane::all, nullptr, turn_front},
    {"depth-func", "the depth test is `%s`", Plane::all, nullptr, compare, nullptr, kOneOf, kFuncs, 0, 0, func_name},
    {"depth-format", "the depth buffer is %s", Plane::all, nullptr, hold_depth, nullptr, kOneOf, kDepthFormatNumbers, 0,
     0, format_name},
    {"half-pixel", "the picture is drawn half a pixel %s", Plane::all, nullptr, half_a_pixel, nullptr, kOneOf,
     kDirectionNumbers, 0, 0, direction_name},
    {"left-handed", "the camera is left-handed: x runs to the left", Plane::all, nullptr, left_handed},
    {"upside-down",
     "the window's y runs downward",
     Plane::all,
     nullptr,
     draw_upside_down,
     nullptr,
     PlaneFault::Search::none,
     {},
     0.01},
    {"clip-depth", "clip space is taken for the other range of z", Plane::all, nullptr, clip_depth},
    {"depth-clamp", "near and far clip where they should not, or do not where they should", Plane::all, nullptr,
     clamp_depth},
    {"polygon-offset", "a polygon offset of %s is on", Plane::all, nullptr, offset_depth, nullptr, kOneOf,
     kPolygonOffsets},
    {"interpolation", "attributes are interpolated `%s`", Plane::all, nullptr, interpolate, nullptr, kOneOf,
     kNoPerspective, 0, 0, way_name},
    {"normal-flat", "normals are flat where smooth ones are due, or smooth where flat ones are", Plane::all, nullptr,
     flat_normals},
    {"normal-unit-shader", "normals are made unit length by %s", Plane::normal, nullptr, make_unit_at, nullptr, kOneOf,
     kShaders, 0, 0, shader_name},
    {"provoking-vertex", "the other vertex provokes", Plane::all, nullptr, provoke},
    {"texture-filter", "textures are filtered `%s`", Plane::all, nullptr, filter, nullptr, kOneOf, kFilters, 0, 0,
     filter_name},
    {"texture-lod-bias", "the textures' level of detail is off by %s", Plane::all, nullptr, bias_lod, nullptr, kOneOf,
     kBiases},
    {.name = "texture-anisotropy",
     .text = "an anisotropic filter of up to %s lookups is on",
     .search = kOneOf,
     .starts = kAnisotropies,
     .sample = filter_anisotropically},
    {"texture-wrap", "textures wrap by `%s`", Plane::all, nullptr, wrap, nullptr, kOneOf, kWraps, 0, 0, wrap_name},
    {"texture-flip-v", "the textures are upside down", Plane::all, nullptr, turn_textures},
    {"texture-srgb", "colour maps are decoded as sRGB where they are linear, or taken as linear where they are sRGB",
     Plane::all, nullptr, recode_textures},
    {"texture-missing", "the colour maps are not read", Plane::all, nullptr, no_textures},
    {"base-color-missing", "the materials' base colours are not applied", Plane::all, nullptr, no_base_color},
    {"vertex-colors-missing", "the vertices' colours are not applied", Plane::all, nullptr, no_vertex_colors},
    {"double-sided", "materials are of two sides that should be of one, or of one that should be of two", Plane::all,
     nullptr, other_sides},
    {"texture-uv-set", "maps are read by the other set of texture coordinates", Plane::all, nullptr, other_uv_set},
    {"object-missing", "object %s is not drawn", Plane::all, nullptr, leave_out, nullptr, PlaneFault::Search::object},
    {"normal-matrix", "the normals went through the object's matrix, not through the transpose of its inverse",
     Plane::normal, nullptr, normals_by_matrix},
    {.name = "edges-averaged",
     .text = "edges hold averages of the surfaces at them, as a resolve of samples makes them",
     .doubt = 0.08,
     .averages = true},
    {"transforms-missing", "the objects' matrices are not applied", Plane::all, nullptr, no_transforms},
};

}  // namespace

std::span<const PlaneFault> redraw_faults() { return kRedrawFaults; }

}  // namespace trueshade::oracle
