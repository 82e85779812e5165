#include "tests/judge/legal_by_formula.h"

#include <cmath>
#include <cstring>
#include <optional>

#include "oracle/scalar_light.h"
#include "oracle/scalar_renderer.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

// docs/gl_rules.md section 9, how far a driver's planes were seen from the truth; two pictures may be twice that apart.
constexpr double kPlaneCeiling = 2 * 1e-5;  // attributes, w within a ratio of 10, relative to the largest value
constexpr double kDepthCeiling = 2 * 4e-6;  // depth in 32 bits

/// Exactly snapped triangles, and whether an edge passes a sample closely.
class Edges {
 public:
  Edges(const Scene& scene, const Pipeline& pipeline)
      : height_(pipeline.height), frame_(scalar_frame(scene, pipeline)) {}

  /// Within 1/256 pixel of the sample along either axis.
  bool near(int x, int y_from_top) const {
    const int64_t px = 256 * int64_t(x) + 128, py = 256 * int64_t(height_ - 1 - y_from_top) + 128;
    for (const DrawnTriangle& t : frame_.triangles)
      for (int i = 0; i < 3; ++i) {
        const WindowTriangle& w = t.window;
        const auto a = size_t((i + 1) % 3), b = size_t((i + 2) % 3);
        const Int128 reach = Int128(std::abs(w.x[b] - w.x[a])) + std::abs(w.y[b] - w.y[a]), e = w.edge(i, px, py);
        const bool beside = px < std::min(w.x[a], w.x[b]) - 2 || px > std::max(w.x[a], w.x[b]) + 2 ||
                            py < std::min(w.y[a], w.y[b]) - 2 || py > std::max(w.y[a], w.y[b]) + 2;
        if (!beside && (e < 0 ? -e : e) <= reach) return true;
      }
    return false;
  }

  /// How much a driver's attribute may be off for making its plane from the window's corner in floats
  /// (docs/data/drivers.md, False alarms): 10 u (|da/dx| X + |da/dy| Y) of the triangle that is seen. And for snapping
  /// vertices to within 0.6 of 1/256 pixel (D3D11.3 functional spec, 3.2.4.1): 0.6/256 (|da/dx| + |da/dy|).
  double plane_error(size_t value, Interpolation interpolation, const GeometryState& state, int x,
                     int y_from_top) const {
    const int y = height_ - 1 - y_from_top;
    const Visible seen = visible_fragment(frame_.at(x, y), state);
    if (!seen.fragment) return 0;
    const DrawnTriangle& t = frame_.triangles[frame_.at(x, y)[*seen.fragment].window];
    const auto at = [&](int dx, int dy) { return value_at(t, value, interpolation, x + dx, y + dy).value; };
    const auto along_x = std::fabs(at(1, 0) - at(0, 0)), along_y = std::fabs(at(0, 1) - at(0, 0));
    return double(10 * 0x1p-23L * (along_x * (x + 1) + along_y * (y + 1)) + 0.6L / 256 * (along_x + along_y));
  }

 private:
  int height_;
  ScalarFrame frame_;
};

/// Where a plane's values are among a vertex's; nothing of planes that are not interpolated.
std::optional<size_t> value_of(const std::string& plane) {
  if (plane == "position") return oracle::kPosition;
  if (plane == "normal") return oracle::kNormal;
  if (plane == "albedo") return oracle::kAlbedo;
  return plane == "uv" ? std::optional<size_t>(oracle::kUv) : std::nullopt;
}

bool small_float(const Image& image) { return info(image.format).small_float(); }
bool fixed(const Image& image) { return info(image.format).number_class == NumberClass::unorm; }

double largest_of(const Image& image) {
  double most = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int k = 0; k < info(image.format).channels; ++k) most = std::max(most, std::fabs(image.value(x, y, k)));
  return most;
}

/// Two stored values of one number, each either neighbour of it, or computed by other roundings.
bool neighbours(const Image& a, const Image& b, int x, int y, int k, double ceiling) {
  if (fixed(a)) return std::abs(int64_t(a.code(x, y, k)) - int64_t(b.code(x, y, k))) <= 1;
  const double u = a.value(x, y, k), v = b.value(x, y, k);
  if (!small_float(a)) return u == v || std::fabs(u - v) <= ceiling;
  const double size = std::max({std::fabs(u), std::fabs(v), 0x1p-14});
  return std::fabs(u - v) <= std::ldexp(1.0, std::ilogb(size) - 10) + ceiling;
}

struct Lit {
  std::array<double, 3> value{}, error{};
};

/// The image's own planes at a pixel; nothing where one is missing.
std::optional<Surface> surface_at(const Capture& c, int x, int y) {
  const Image *position = c.plane("position"), *normal = c.plane("normal"), *albedo = c.plane("albedo");
  const Image *specular = c.plane("specular"), *emission = c.plane("emission");
  if (position == nullptr || normal == nullptr || albedo == nullptr) return std::nullopt;
  Surface s;
  for (int k = 0; k < 3; ++k) {
    const auto i = size_t(k);
    s.position[i] = position->value(x, y, k), s.normal[i] = normal->value(x, y, k),
    s.albedo[i] = albedo->value(x, y, k);
    if (fixed(*normal)) s.normal[i] = 2 * s.normal[i] - 1;
    if (specular != nullptr) s.specular[i] = specular->value(x, y, k);
    if (emission != nullptr) s.emission[i] = emission->value(x, y, k);
  }
  if (specular != nullptr) s.shininess = specular->value(x, y, 3);
  return s;
}

/// The scene's lights on it as real numbers.
Lit lit_by(const Scene& scene, const LightModel& m, const Surface& s, const std::array<double, 3>& axis) {
  const LitSum sum = lit_sum(s, scene, m, axis);
  const double shininess = reads_specular_plane(m) ? s.shininess : double(m.shininess);
  // docs/gl_rules.md section 6: the power's share, and roundings of the terms and of their sum.
  const double relative = shininess * 0x1p-21 * std::log(2.0) + double(scene.lights.size() + 40) * 0x1p-23;
  Lit lit;
  for (size_t k = 0; k < 3; ++k) {
    lit.value[k] = m.clamp_result ? std::clamp(sum.color[k], 0.0, 1.0) : sum.color[k];
    lit.error[k] = relative * sum.magnitude[k];
  }
  return lit;
}

/// A draw of light geometry and how many fragments it has at each pixel.
struct LightDraw {
  Scene alone;  ///< the light
  bool mesh = false;
  ScalarFrame cover;
  std::optional<Edges> edges;
};

/// Whether the target may hold what it does for that real value.
bool stores(const Image& color, int x, int y, int k, double value, double error, double more_codes) {
  const FormatInfo layout = info(color.format);
  if (fixed(color)) {
    const double largest = double(layout.largest_code(k)), code = double(color.code(x, y, k));
    const double low = largest * std::clamp(value - error, 0.0, 1.0),
                 high = largest * std::clamp(value + error, 0.0, 1.0);
    return code >= std::floor(low) - more_codes && code <= std::ceil(high) + more_codes;
  }
  const double stored = color.value(x, y, k);
  const double unit = small_float(color) ? std::ldexp(1.0, std::ilogb(std::max(std::fabs(value), 0x1p-14)) - 10) : 0;
  return std::fabs(stored - value) <= error + unit * (1 + more_codes) + 0x1p-126;
}

class Prover {
 public:
  Prover(const Scene& scene, const Pipeline& pipeline, const Capture& right, const Capture& wrong)
      : scene_(scene),
        pipeline_(pipeline),
        right_(right),
        wrong_(wrong),
        axis_(view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height))) {
    for (const NamedImage& plane : right.planes)
      ceilings_.push_back(plane.name == "depth" ? kDepthCeiling : kPlaneCeiling * largest_of(plane.image));
  }

  std::string run() {
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x) {
        const std::string found = at(x, y);
        if (!found.empty()) return found + " at " + std::to_string(x) + "," + std::to_string(y);
      }
    return {};
  }

 private:
  static bool is_judged(const std::string& plane) { return plane != "id.primitive" && plane != "light.count"; }
  bool covered(const Capture& c, int x, int y) const { return c.plane("id.object")->value(x, y, 0) != 0; }

  /// The plane in which the pixel is not the same surface; empty where all agree.
  std::string other_surface(int x, int y) {
    for (size_t i = 0; i < right_.planes.size(); ++i) {
      const NamedImage& plane = right_.planes[i];
      const Image *a = &plane.image, *b = wrong_.plane(plane.name);
      if (!is_judged(plane.name)) continue;
      if (b == nullptr) return plane.name;
      const bool whole = info(a->format).number_class == NumberClass::integer;
      for (int k = 0; k < info(a->format).channels; ++k)
        if (whole ? a->code(x, y, k) != b->code(x, y, k)
                  : !same_value(*a, *b, x, y, k, ceilings_[i]) &&
                        !same_value(*a, *b, x, y, k, ceilings_[i] + 2 * plane_error(plane.name, k, x, y)))
          return plane.name + " (" + std::to_string(a->value(x, y, k)) + ", " + std::to_string(b->value(x, y, k)) + ")";
    }
    return {};
  }

  double plane_error(const std::string& plane, int channel, int x, int y) {
    const std::optional<size_t> value = value_of(plane);
    if (!value || channel == 3) return 0;
    return edges().plane_error(*value + size_t(channel), pipeline_.gbuffer.normal.interpolation, pipeline_.geometry, x,
                               y);
  }

  const Edges& edges() {
    if (!edges_) edges_.emplace(scene_, pipeline_);
    return *edges_;
  }

  /// Of a float plane held against a wider one, a half as float: the numbers tell.
  static bool same_value(const Image& a, const Image& b, int x, int y, int k, double ceiling) {
    if (a.format == b.format) return neighbours(a, b, x, y, k, ceiling);
    return std::fabs(a.value(x, y, k) - b.value(x, y, k)) <= ceiling;
  }

  /// Of deferred-volumes: every light's mesh as a scene of its own, drawn by the exact geometry.
  void find_draws() {
    const LightVolumes& v = pipeline_.light_volumes;
    const LightMeshes meshes(v);
    Pipeline drawn = pipeline_;
    drawn.geometry.cull_face = v.cull_face, drawn.geometry.front_face = FrontFace::ccw,
    drawn.geometry.depth_clamp = v.depth_clamp;
    for (const Light& light : scene_.lights) {
      LightDraw& draw = draws_.emplace_back();
      draw.alone.camera = scene_.camera, draw.alone.lights = {light};
      const LightExtent extent = drawn_extent(light, v);
      draw.mesh = is_mesh(extent);
      if (!draw.mesh) continue;
      std::vector<glm::vec3> vertices(meshes[extent].unit.size());
      light_vertices(meshes[extent], light, vertices);
      Scene geometry;
      geometry.camera = scene_.camera;
      Mesh& mesh = geometry.meshes.emplace_back();
      for (const glm::vec3& p : vertices)
        for (int k = 0; k < 3; ++k)
          mesh.position[size_t(k)].push_back(p[k]), mesh.normal[size_t(k)].push_back(k == 0 ? 1.0f : 0.0f);
      mesh.indices = meshes[extent].indices;
      geometry.materials.resize(1);
      geometry.instances = {{0, 0, glm::mat4x3(1.0f)}};
      draw.cover = scalar_frame(geometry, drawn);
      draw.edges.emplace(geometry, drawn);
    }
  }

  /// The target as the draws of all lights may leave it.
  std::string blended_at(int x, int y, const Surface& s) {
    if (draws_.empty()) find_draws();
    Scene dark = scene_;
    dark.lights.clear();
    const bool clamps = fixed(wrong_.color);
    std::array<double, 3> low{}, high{};
    double count = 1;
    const auto add = [&](const Lit& lit, int least, int most) {
      for (size_t k = 0; k < 3; ++k) {
        const auto kept = [&](double c) { return clamps ? std::clamp(c, 0.0, 1.0) : c; };
        const double a = kept(lit.value[k] - lit.error[k]), b = kept(lit.value[k] + lit.error[k]);
        low[k] += std::min(least * a, most * a), high[k] += std::max(least * b, most * b);
      }
      count += most;
    };
    if (pipeline_.light_volumes.base) add(lit_by(dark, pipeline_.light_model, s, axis_), 1, 1);
    for (const LightDraw& draw : draws_) {
      const int n = draw.mesh ? int(draw.cover.at(x, pipeline_.height - 1 - y).size()) : 1;
      const int doubt = draw.mesh && draw.edges->near(x, y) ? 1 : 0;
      add(lit_by(draw.alone, pipeline_.light_model, s, axis_), std::max(0, n - doubt), n + doubt);
    }
    for (int k = 0; k < 3; ++k) {
      const double middle = (low[size_t(k)] + high[size_t(k)]) / 2, error = (high[size_t(k)] - low[size_t(k)]) / 2;
      if (!stores(wrong_.color, x, y, k, middle, error, count))
        return "other lights blended in channel " + std::to_string(k);
    }
    return {};
  }

  std::string at(int x, int y) {
    const std::string plane = other_surface(x, y);
    if (!plane.empty()) {
      if (!edges().near(x, y)) return "another surface in " + plane + ", no edge is near";
    }
    if (!covered(wrong_, x, y)) {
      for (int k = 0; k < 3; ++k)
        if (!stores(wrong_.color, x, y, k, double(scene_.clear[k]), 0, 0)) return "another clear colour";
      return {};
    }
    const std::optional<Surface> s = surface_at(wrong_, x, y);
    if (!s) return "planes are missing";
    if (pipeline_.strategy == Strategy::deferred_volumes) return blended_at(x, y, *s);
    const Lit lit = lit_by(scene_, pipeline_.light_model, *s, axis_);
    for (int k = 0; k < 3; ++k)
      if (!stores(wrong_.color, x, y, k, lit.value[size_t(k)], lit.error[size_t(k)], 0))
        return "another light in channel " + std::to_string(k);
    const double alpha = pipeline_.light_model.alpha_from_albedo ? wrong_.plane("albedo")->value(x, y, 3) : 1;
    if (info(wrong_.color.format).channels > 3 && !stores(wrong_.color, x, y, 3, alpha, 1e-6, 0))
      return "another alpha";
    return {};
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Capture &right_, &wrong_;
  const std::array<double, 3> axis_;
  std::vector<double> ceilings_;
  std::optional<Edges> edges_;
  std::vector<LightDraw> draws_;
};

}  // namespace

std::string why_not_legal(const Scene& scene, const Pipeline& pipeline, const Capture& right, const Capture& wrong) {
  return Prover(scene, pipeline, right, wrong).run();
}

}  // namespace trueshade::testing
