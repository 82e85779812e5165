#include "judge/bounds/program_fields.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "oracle/matrices.h"
#include "scenes/pipeline/program_inputs.h"

namespace trueshade::oracle {

namespace {

/// "surface.position.x": the part between the dots.
std::string_view field_of(std::string_view name) {
  const std::string_view rest = name.substr(name.find('.') + 1);
  return rest.substr(0, rest.find_first_of(".["));
}

template <class Field>
struct Row {
  std::string_view name;
  decltype(Field::of) of;
};

using S = const ShadedSurface&;
constexpr Row<SurfaceField> kSurface[] = {{"position", [](S s, size_t c) { return interval_of(s.position[c]); }},
                                          {"normal", [](S s, size_t c) { return interval_of(s.normal[c]); }},
                                          {"albedo", [](S s, size_t c) { return interval_of(s.albedo[c]); }},
                                          {"specular", [](S s, size_t c) { return interval_of(s.specular[c]); }},
                                          {"shininess",
                                           [](S s, size_t) {
                                             return interval_of({s.shininess, s.shininess_error});
                                           }},
                                          {"metallic", [](S s, size_t) { return interval_of(s.specular[0]); }},
                                          {"roughness", [](S s, size_t) { return interval_of(s.specular[1]); }},
                                          {"occlusion", [](S s, size_t) { return interval_of(s.ambient_share); }},
                                          {"emission", [](S s, size_t c) { return interval_of(s.emission[c]); }},
                                          {"uv", [](S s, size_t c) { return interval_of(s.uv[c]); }},
                                          {"uv1", [](S s, size_t c) { return interval_of(s.uv1[c]); }},
                                          {"tangent", [](S s, size_t c) { return interval_of(s.tangent[c]); }},
                                          {"user", [](S s, size_t c) { return interval_of(s.user[c]); }},
                                          {"object", [](S s, size_t) { return Interval::of(s.object); }},
                                          {"material", [](S s, size_t) { return Interval::of(s.material); }},
                                          {"pixel_x", [](S s, size_t) { return Interval::of(s.pixel[0]); }},
                                          {"pixel_y", [](S s, size_t) { return Interval::of(s.pixel[1]); }}};

double outer_cosine(const Light& l) { return std::cos(double(l.cone_rad) + double(l.penumbra_rad)); }
double cone_width(const Light& l) { return 1 / std::max(0.001, std::cos(double(l.cone_rad)) - outer_cosine(l)); }
/// The slope of a smooth cone that is lit whole from the cosine `lit` on. The edges are floats before they are
/// subtracted, and may be the next ones.
Interval slope(const Light& l, double lit) {
  const double width = double(float(lit)) - double(float(outer_cosine(l))), off = 0x1p-22;
  if (!(width > off)) return Interval::rounded_once(1 / width);
  return {1 / width, Interval::rounded_once(1 / (width + off)).low, Interval::rounded_once(1 / (width - off)).high,
          false};
}
Interval no_texture(const Light&, uint32_t, size_t) { return Interval::of(-1); }

/// docs/arithmetic.md section 8 for the numbers of cones. The members are named again, and not by light_value() of
/// scenes/pipeline/light_values.h, so that a wrong row there, which the renderer and the drivers share, is seen.
using L = const Light&;
constexpr Row<LightField> kLight[] = {
    {"type", [](L l, uint32_t, size_t) { return Interval::of(double(l.type)); }},
    {"index", [](L, uint32_t index, size_t) { return Interval::of(index); }},
    {"position", [](L l, uint32_t, size_t c) { return Interval::of(double(l.position[int(c)])); }},
    {"range", [](L l, uint32_t, size_t) { return Interval::of(double(l.range)); }},
    {"direction", [](L l, uint32_t, size_t c) { return Interval::of(double(l.direction[int(c)])); }},
    {"color", [](L l, uint32_t, size_t c) { return Interval::of(double(l.color[int(c)])); }},
    {"attenuation", [](L l, uint32_t, size_t c) { return Interval::of(double(l.attenuation[int(c)])); }},
    {"ambient", [](L l, uint32_t, size_t c) { return Interval::of(double(l.ambient[int(c)])); }},
    {"cone", [](L l, uint32_t, size_t) { return Interval::of(double(l.cone_rad)); }},
    {"penumbra", [](L l, uint32_t, size_t) { return Interval::of(double(l.penumbra_rad)); }},
    {"cos_inner", [](L l, uint32_t, size_t) { return Interval::rounded_once(std::cos(double(l.cone_rad))); }},
    {"cos_outer", [](L l, uint32_t, size_t) { return Interval::rounded_once(outer_cosine(l)); }},
    {"cone_scale", [](L l, uint32_t, size_t) { return Interval::rounded_once(cone_width(l)); }},
    {"cone_offset", [](L l, uint32_t, size_t) { return Interval::rounded_once(-outer_cosine(l) * cone_width(l)); }},
    {"spot_exponent", [](L l, uint32_t, size_t) { return Interval::of(double(l.spot_exponent)); }},
    {"penumbra_slope", [](L l, uint32_t, size_t) { return slope(l, std::cos(double(l.cone_rad))); }},
    {"cutoff_slope", [](L l, uint32_t, size_t) { return slope(l, outer_cosine(l) * 0.9 + 0.1); }},
    {"right", [](L l, uint32_t, size_t c) { return Interval::of(double(l.right[int(c)])); }},
    {"up", [](L l, uint32_t, size_t c) { return Interval::of(double(l.up[int(c)])); }},
    {"shadow", no_texture},
    {"cookie", no_texture}};

template <class Field, size_t N>
Field found(const Row<Field> (&rows)[N], std::string_view name) {
  const auto row =
      std::find_if(std::begin(rows), std::end(rows), [name](const Row<Field>& r) { return r.name == field_of(name); });
  if (row == std::end(rows))
    throw Error(ErrorKind::bad_input, std::string(name), "is a field that nothing gives", "another field");
  return {row->of, component_of(name)};
}

}  // namespace

size_t component_of(std::string_view name) {
  const size_t at = std::string_view("xyzw").find(name.back());
  return at == std::string_view::npos || name.size() < 2 || name[name.size() - 2] != '.' ? 0 : at;
}

SurfaceField surface_field(std::string_view name) {
  SurfaceField field = found(kSurface, name);
  constexpr std::string_view kUser = "surface.user[";
  if (name.starts_with(kUser)) field.component += 4 * size_t(name[kUser.size()] - '0');
  return field;
}
LightField light_field(std::string_view name) { return found(kLight, name); }

Interval frame_field(std::string_view name, const Scene& scene, const Pipeline& pipeline) {
  const std::string_view field = field_of(name);
  const size_t c = component_of(name);
  if (name.starts_with("parameters.")) {
    if (const std::optional<float> value = parameter_value(name, pipeline.light_program))
      return Interval::of(double(*value));
    throw Error(ErrorKind::usage, pipeline.light_program.file, "nothing gives " + std::string(name),
                "--light-parameter NAME=VALUE");
  }
  const auto element = [&](const Matrix4& matrix) {
    return Interval::rounded_once(matrix[4 * size_t(name[name.find('[') + 1] - '0') + c]);
  };
  check_camera(scene.camera, pipeline.light_program.file, std::vector{std::string(name)});
  if (field == "view") return element(view_matrix(scene.camera));
  if (field == "projection")
    return element(lens_matrix(scene.camera, pipeline.geometry, pipeline.width, pipeline.height));
  const Matrix4 clip = projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
  if (field == "eye") return Interval::of(double(scene.camera.eye[int(c)]));
  if (field == "axis") return Interval::rounded_once(-view_axis(clip)[c]);
  if (field == "size") return Interval::of(c == 0 ? pipeline.width : pipeline.height);
  if (field == "time") return Interval::of(double(float(scene.time)));
  if (field == "frame") return Interval::of(double(frame_at(scene)));
  if (field == "view_projection") return element(clip);
  throw Error(ErrorKind::bad_input, pipeline.light_program.file, "nothing gives " + std::string(name), "another field");
}

}  // namespace trueshade::oracle
