#include "judge/stages/captured_surface.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "judge/legal/surface.h"
#include "oracle/exact_coverage.h"
#include "oracle/scalar_renderer.h"
#include "programs/front/light_program.h"
#include "scenes/pipeline/program_inputs.h"

namespace trueshade::oracle {

namespace {

/// Whether any surface has emission, or holds off ambient light: else nothing depends on the plane.
bool emits(const Scene& scene, const LightModel& model) {
  return model.emission && std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
           return m.unlit || m.emission != glm::vec3(0.0f) || m.occlusion_map.used();
         });
}

/// Whether metallic and roughness are planes of their own, which light programs read: those of them that the program
/// does. Error(bad_input): one of two is there.
bool has_metals(const Capture& capture, const LightProgram& given) {
  if (capture.plane("metallic") == nullptr && capture.plane("roughness") == nullptr) return false;
  for (const programs::ProgramInput& input : programs::kept_program(given.file, given.text)->inputs)
    for (const std::string name : {"metallic", "roughness"})
      if (input.name == "surface." + name && capture.plane(name) == nullptr)
        throw Error(ErrorKind::bad_input, capture.name + ": plane " + name, "is missing",
                    "give all that the light program reads, or the plane specular, which holds both");
  return true;
}

}  // namespace

CapturedSurface::CapturedSurface(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                 const Capture& capture)
    : pipeline_(pipeline),
      profile_(profile),
      normal_(required(capture, "normal")),
      albedo_(required(capture, "albedo")),
      object_(plane_of(capture, pipeline, "id.object")),
      specular_(reads_specular_plane(pipeline.light_model) &&
                        !(pipeline.light_model.keeps_metals && has_metals(capture, pipeline.light_program))
                    ? required(capture, "specular")
                    : PlaneView{}),
      emission_(emits(scene, pipeline.light_model) ? required(capture, "emission") : PlaneView{}),
      viewport_(resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height)) {
  if (pipeline.gbuffer.position_from_depth) {
    depth_ = required(capture, "depth");
    invert(scene);
  } else {
    position_ = required(capture, "position");
    depth_ = plane_of(capture, pipeline, "depth");
  }
  if (pipeline.light_program.used()) find_fields(scene, capture);
  const bool shaded = std::any_of(scene.materials.begin(), scene.materials.end(),
                                  [](const Material& m) { return m.occlusion_map.used(); });
  if (emission_ && shaded && info(pipeline.gbuffer.emission).channels > 3 && emission_.channels < 4)
    throw Error(ErrorKind::bad_input, capture.name + ": plane emission", "has no share of ambient light",
                "capture it as emission.A");
  if (!object_ && !depth_)
    throw Error(ErrorKind::bad_input, capture.name, "does not say where a surface is", "capture id.object or depth");
}

void CapturedSurface::find_fields(const Scene& scene, const Capture& capture) {
  const LightProgram& given = pipeline_.light_program;
  const std::shared_ptr<const programs::Program> program = programs::kept_program(given.file, given.text);
  std::vector<std::string> inputs;
  for (const programs::ProgramInput& input : program->inputs) inputs.push_back(input.name);
  const ProgramReads reads = program_reads(given.file, inputs);
  const auto plane = [&](const std::string& name) { return plane_of(capture, pipeline_, name); };
  const bool unlit =
      std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.unlit; });
  uv_ = reads.uv ? required(capture, "uv") : PlaneView{};
  material_ = unlit ? required(capture, "id.material") : plane("id.material");
  if (reads.metals) metallic_ = plane("metallic"), roughness_ = plane("roughness");
  occlusion_ = plane("occlusion");
  uv1_ = plane("uv1"), tangent_ = plane("tangent");
  CapturedFields there{bool(uv1_), bool(tangent_), {}};
  for (size_t i = 0; i < user_.size(); ++i) {
    user_[i] = plane("user" + std::to_string(i));
    there.user[i] = bool(user_[i]);
  }
  require_fields(given.file, reads.captured, there);
}

void CapturedSurface::fetch_fields(int x, int y, ShadedSurface& s) const {
  const auto channel = [&](const PlaneView& view, int c, double absent) {
    return view && c < view.channels ? fetched(view, x, y, c) : Bounded{absent, 0};
  };
  if (metallic_) s.specular[0] = channel(metallic_, 0, 0);
  if (roughness_) s.specular[1] = channel(roughness_, 0, 0);
  if (occlusion_) s.ambient_share = channel(occlusion_, 0, 1);
  for (int c = 0; c < 2; ++c) s.uv[size_t(c)] = channel(uv_, c, 0), s.uv1[size_t(c)] = channel(uv1_, c, 0);
  for (int c = 0; c < 4; ++c) {
    s.tangent[size_t(c)] = channel(tangent_, c, 1);
    for (int k = 0; k < 4; ++k) s.user[size_t(4 * k + c)] = channel(user_[size_t(k)], c, c < 3 ? 0 : 1);
  }
  if (object_) s.object = uint32_t(object_.stored(x, y, 0));
  if (material_) s.material = uint32_t(material_.stored(x, y, 0));
  s.pixel = {x, pipeline_.height - 1 - y};
}

PlaneView CapturedSurface::required(const Capture& capture, std::string_view name) const {
  const PlaneView view = plane_of(capture, pipeline_, name);
  if (!view)
    throw Error(ErrorKind::bad_input, capture.name + ": plane " + std::string(name), "is missing",
                name == "specular" && pipeline_.light_program.used()
                    ? "the light program reads what it holds; metallic and roughness may be planes of their own instead"
                    : "the lighting of the picture is judged from it");
  if (name == "specular" && view.channels < 4)
    throw Error(ErrorKind::bad_input, capture.name + ": plane specular", "has no shininess",
                "capture it as specular.A");
  return view;
}

bool CapturedSurface::covered(int x, int y) const {
  return object_ ? object_.stored(x, y, 0) != 0 : !is_clear_depth(pipeline_.geometry, depth_.stored(x, y, 0));
}

/// A channel as the shader reads it; unorm codes k as k / largest with the profile's fetch error, unpacked values with
/// that of unpacking.
Bounded CapturedSurface::fetched(const PlaneView& view, int x, int y, int channel) const {
  const double stored = view.stored(x, y, channel);
  if (!view.unorm()) return {stored, view.reading_error(x, y)};
  const double largest = view.layout.largest_code(channel), value = stored / largest;
  return {value, stored == 0 || stored == largest ? 0 : value * profile_.fetch_error};
}

ShadedSurface CapturedSurface::at(int x, int y) const {
  ShadedSurface s;
  for (int k = 0; k < 3; ++k) {
    if (position_) s.position[size_t(k)] = fetched(position_, x, y, k);
    s.normal[size_t(k)] =
        normal_.unorm() ? doubled_normal(fetched(normal_, x, y, k), profile_.arithmetic) : fetched(normal_, x, y, k);
  }
  for (int k = 0; k < 4; ++k) s.albedo[size_t(k)] = k < albedo_.channels ? fetched(albedo_, x, y, k) : Bounded{1, 0};
  for (int k = 0; k < 3; ++k) {
    if (specular_) s.specular[size_t(k)] = fetched(specular_, x, y, k);
    if (emission_) s.emission[size_t(k)] = fetched(emission_, x, y, k);
  }
  if (specular_) s.shininess = specular_.stored(x, y, 3);
  if (emission_ && emission_.channels > 3) s.ambient_share = fetched(emission_, x, y, 3);
  if (!position_) s.position = position_from_depth(x, y);
  if (pipeline_.light_program.used()) fetch_fields(x, y, s);
  return s;
}

/// Sets world_from_clip_, by Gauss-Jordan with pivots in long double and no matrix code of the renderer's.
/// Error(bad_input) where the camera's matrix has no inverse.
void CapturedSurface::invert(const Scene& scene) {
  const Matrix4 m = projection_of(scene.camera, pipeline_.geometry, pipeline_.width, pipeline_.height);
  long double a[4][8] = {};
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) a[r][c] = static_cast<long double>(m[4 * c + r]), a[r][4 + c] = r == c ? 1 : 0;
  for (size_t c = 0; c < 4; ++c) {
    size_t pivot = c;
    for (size_t r = c + 1; r < 4; ++r)
      if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
    if (a[pivot][c] == 0)
      throw Error(ErrorKind::bad_input, "camera", "its matrix has no inverse", "position from depth needs one");
    std::swap(a[c], a[pivot]);
    for (size_t k = 8; k-- > c;) a[c][k] /= a[c][c];
    for (size_t r = 0; r < 4; ++r) {
      const long double factor = a[r][c];
      for (size_t k = c; k < 8 && r != c; ++k) a[r][k] -= factor * a[c][k];
    }
  }
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) world_from_clip_[4 * c + r] = double(a[r][4 + c]);
}

/// The world position that a shader rebuilds of a pixel's depth (docs/arithmetic.md section 7). Each product of a row
/// passes five roundings: the matrix element's, its own and three sums'.
Bounded3 CapturedSurface::position_from_depth(int x, int y) const {
  const Arithmetic& a = profile_.arithmetic;
  const double v = a.roundoff, near = double(pipeline_.geometry.depth_near), far = double(pipeline_.geometry.depth_far);
  const bool zero_to_one = pipeline_.geometry.clip_depth == ClipDepth::zero_to_one;
  const double scale = zero_to_one ? far - near : (far - near) / 2, offset = zero_to_one ? near : (near + far) / 2;
  const auto ndc = [&](double centre, int corner, int size) {
    const double at = (centre - corner) * 2 / size;
    return Bounded{at - 1, 3 * v * (std::fabs(at) + 1)};
  };
  const double z = depth_.stored(x, y, 0);
  const bool codes = pipeline_.geometry.depth_format != Format::d32f;
  const double fetch = (codes && z != 1 ? z * profile_.fetch_error : 0) +  // a code is read as a float
                       depth_.reading_error(x, y);
  std::array<Bounded, 4> p = {
      ndc(x + 0.5, viewport_.x, viewport_.width), ndc(pipeline_.height - 1 - y + 0.5, viewport_.y, viewport_.height),
      Bounded{(z - offset) / scale, (4 * v * (std::fabs(z) + std::fabs(offset)) + fetch) / std::fabs(scale)},
      Bounded{1, 0}};
  if (pipeline_.geometry.clip_origin == ClipOrigin::upper_left) p[1].value = -p[1].value;
  std::array<Bounded, 4> h;
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) {
      const double m = world_from_clip_[4 * c + r];
      h[r].value += m * p[c].value;
      h[r].error += std::fabs(m) * p[c].error + 5 * v * std::fabs(m) * (std::fabs(p[c].value) + p[c].error);
    }
  const Bounded one_over_w = quotient(a, {1, 0}, h[3]);
  return {product(a, h[0], one_over_w), product(a, h[1], one_over_w), product(a, h[2], one_over_w)};
}

Bounded doubled_normal(const Bounded& fetched, const Arithmetic& arithmetic) {
  return difference(arithmetic, {2 * fetched.value, 2 * fetched.error}, {1, 0});
}

void require_planes_of(const ProgramBounds& program, const Capture& capture) {
  for (const auto& [field, plane] : {std::pair("surface.material", "id.material"), {"surface.object", "id.object"}})
    if (program.reads(field) && capture.plane(plane) == nullptr)
      throw Error(ErrorKind::bad_input, capture.name + ": plane " + plane, "is missing",
                  "the light program reads " + std::string(field));
}

}  // namespace trueshade::oracle
