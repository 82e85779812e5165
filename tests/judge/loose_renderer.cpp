#include "tests/judge/loose_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "oracle/scalar_renderer.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::testing {

using oracle::Capture;

namespace {

struct LooseVertex {
  float x, y, plane_x, plane_y, z, u;
  float attribute[15];  ///< world position, normal, albedo RGBA, uv, the tangent of meshes that have any
};

class Drawing {
 public:
  Drawing(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed)
      : scene_(scene),
        pipeline_(pipeline),
        free_(liberties),
        f_(seed, liberties.any_rounding),
        textures_(scene, liberties),
        projection_(oracle::projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)) {
    const int w = pipeline.width, h = pipeline.height;
    capture_.color = Image(w, h, liberties.sums_in_floats ? Format::rgba32f : pipeline.target);
    const bool stores = !is_forward(pipeline.strategy);
    const Format normal = stores ? pipeline.gbuffer.normal.format : Format::rgba32f,
                 albedo = stores ? Format::rgba8 : Format::rgba32f;
    tied_.resize(size_t(w) * size_t(h));
    for (const auto& [name, format] : {std::pair<const char*, Format>{"depth", Format::d32f},
                                       {"position", Format::rgba32f},
                                       {"normal", normal},
                                       {"albedo", albedo},
                                       {"id.object", Format::r32ui},
                                       {"specular", Format::rgba32f}})
      capture_.planes.push_back({name, Image(w, h, format)});
    if (!reads_specular_plane(pipeline.light_model)) capture_.planes.pop_back();
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) put(0, x, y, 0, 1.0f);
  }

  Capture draw() {
    const TransparencyMode mode =
        draws_transparent(scene_, pipeline_) ? pipeline_.transparency.mode : TransparencyMode::none;
    apart_ = mode != TransparencyMode::none;
    draw_instances(Pass::opaque);
    if (mode == TransparencyMode::into_albedo) draw_instances(Pass::into_albedo);
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x)
        if (covered(x, y) || pipeline_.strategy == Strategy::forward_multipass) light(x, y);
    if (mode == TransparencyMode::after_lights) draw_instances(Pass::over);
    if (free_.sums_in_floats) store_sums();
    return std::move(capture_);
  }

 private:
  enum class Pass : uint8_t { opaque, into_albedo, over };

  /// A target that stood in floats, as its format holds it.
  void store_sums() {
    Image stored(pipeline_.width, pipeline_.height, pipeline_.target);
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x)
        for (int k = 0; k < info(stored.format).channels; ++k)
          store(stored, x, y, k, float(capture_.color.value(x, y, k)));
    capture_.color = std::move(stored);
  }

  void draw_instances(Pass pass) {
    for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
      if (apart_ && scene_.materials[scene_.instances[i].material].transparent != (pass != Pass::opaque)) continue;
      const Mesh& mesh = scene_.meshes[scene_.instances[i].mesh];
      const std::span<const uint32_t> indices = mesh.indices;
      std::vector<LooseVertex> vertices;
      for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        vertices.push_back(vertex(scene_.instances[i], v));
        share_place(mesh, v, vertices);
      }
      for (size_t t = 0; t + 2 < indices.size(); t += 3)
        triangle(pass, i, t, {&vertices[indices[t]], &vertices[indices[t + 1]], &vertices[indices[t + 2]]});
    }
  }

  void put(size_t plane, int x, int y, int channel, float v) {
    std::memcpy(capture_.planes[plane].image.texel(x, y) + 4 * channel, &v, 4);
  }
  float get(size_t plane, int x, int y, int channel) const {
    return float(capture_.planes[plane].image.value(x, y, channel));
  }

  float row(const float m[4], const float p[3]) {  // four terms, contracted or not
    return f_.mad(m[0], p[0], f_.mad(m[1], p[1], f_.mad(m[2], p[2], m[3])));
  }

  /// Vertices of one position are one in the window: the same shader, the same input (GL 4.6, appendix A, rule 4).
  static void share_place(const Mesh& mesh, uint32_t v, std::vector<LooseVertex>& vertices) {
    for (uint32_t earlier = 0; earlier < v; ++earlier) {
      bool same = true;
      for (size_t k = 0; k < 3; ++k) same = same && mesh.position[k][earlier] == mesh.position[k][v];
      if (!same) continue;
      const LooseVertex& first = vertices[earlier];
      LooseVertex& now = vertices[v];
      now.x = first.x, now.y = first.y, now.plane_x = first.plane_x, now.plane_y = first.plane_y, now.z = first.z,
      now.u = first.u;
      return;
    }
  }

  LooseVertex vertex(const Instance& instance, uint32_t index) {
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const float p[3] = {mesh.position[0][index], mesh.position[1][index], mesh.position[2][index]};
    float clip[4];
    for (size_t r = 0; r < 4; ++r) {
      float m[4];
      for (int c = 0; c < 4; ++c) {
        double e = c == 3 ? projection_[12 + r] : 0;
        for (int k = 0; k < 3; ++k) e += projection_[size_t(4 * k) + r] * double(instance.world_from_object[c][k]);
        m[c] = float(e);
      }
      clip[r] = row(m, p);
    }
    LooseVertex v{};
    v.u = f_.div(1, clip[3]);
    const float width = float(pipeline_.width), height = float(pipeline_.height);
    v.plane_x = f_.mul(f_.add(f_.div(clip[0], clip[3]), 1), width / 2);
    v.plane_y = f_.mul(f_.add(f_.div(clip[1], clip[3]), 1), height / 2);
    v.z = f_.mad(f_.div(clip[2], clip[3]), 0.5f, 0.5f);
    const float grid = std::ldexp(1.0f, free_.subpixel_bits);
    v.x = free_.subpixel_bits > 0 ? float(loose_neighbour(f_, nearly(), double(v.plane_x * grid))) / grid : v.plane_x;
    v.y = free_.subpixel_bits > 0 ? float(loose_neighbour(f_, nearly(), double(v.plane_y * grid))) / grid : v.plane_y;
    if (free_.snapped_planes) v.plane_x = v.x, v.plane_y = v.y;
    for (int r = 0; r < 3; ++r) {
      const float m[4] = {instance.world_from_object[0][r], instance.world_from_object[1][r],
                          instance.world_from_object[2][r], instance.world_from_object[3][r]};
      v.attribute[r] = row(m, p);
    }
    normal_of(instance, mesh, index, v.attribute + 3);
    for (size_t k = 0; k < 4; ++k) v.attribute[6 + k] = mesh.has_color() ? mesh.color[k][index] : 1;
    for (size_t k = 0; k < 2 && !mesh.uv[0].empty(); ++k) v.attribute[10 + k] = mesh.uv[k][index];
    for (int r = 0; r < 3 && mesh.has_tangents(); ++r) {
      const float m[3] = {instance.world_from_object[0][r], instance.world_from_object[1][r],
                          instance.world_from_object[2][r]};
      const float along[3] = {mesh.tangent[0][index], mesh.tangent[1][index], mesh.tangent[2][index]};
      v.attribute[12 + r] = f_.dot(m, along);
    }
    return v;
  }

  void normal_of(const Instance& instance, const Mesh& mesh, uint32_t index, float out[3]) {
    const auto a = [&](int c, int r) { return double(instance.world_from_object[c % 3][r % 3]); };
    double det = 0;
    for (int r = 0; r < 3; ++r) det += a(0, r) * (a(1, r + 1) * a(2, r + 2) - a(1, r + 2) * a(2, r + 1));
    const float n[3] = {mesh.normal[0][index], mesh.normal[1][index], mesh.normal[2][index]};
    float world[3];
    for (int r = 0; r < 3; ++r) {
      float m[3];
      for (int c = 0; c < 3; ++c)
        m[c] = float((a(c + 1, r + 1) * a(c + 2, r + 2) - a(c + 1, r + 2) * a(c + 2, r + 1)) / det);
      world[r] = f_.dot(m, n);
    }
    f_.unit(world, out);
  }

  struct Plane {
    float a0, gx, gy;
  };
  using Planes = std::array<Plane, 15>;  ///< of LooseVertex::attribute
  Plane plane(const std::array<const LooseVertex*, 3>& v, const float n[3]) {
    const float x1 = f_.sub(v[1]->plane_x, v[0]->plane_x), y1 = f_.sub(v[1]->plane_y, v[0]->plane_y);
    const float x2 = f_.sub(v[2]->plane_x, v[0]->plane_x), y2 = f_.sub(v[2]->plane_y, v[0]->plane_y);
    const float over = f_.div(1, f_.sub(f_.mul(x1, y2), f_.mul(x2, y1)));
    const float d1 = f_.sub(n[1], n[0]), d2 = f_.sub(n[2], n[0]);
    Plane p{};
    p.gx = f_.mul(f_.sub(f_.mul(d1, y2), f_.mul(d2, y1)), over);
    p.gy = f_.mul(f_.sub(f_.mul(d2, x1), f_.mul(d1, x2)), over);
    p.a0 = f_.sub(f_.sub(n[0], f_.mul(p.gx, v[0]->plane_x)), f_.mul(p.gy, v[0]->plane_y));
    return p;
  }
  float at(const Plane& p, float x, float y) { return f_.mad(p.gy, y, f_.mad(p.gx, x, p.a0)); }

  bool inside(const std::array<const LooseVertex*, 3>& v, double area, double x, double y) const {
    for (size_t i = 0; i < 3; ++i) {
      const LooseVertex &a = *v[(i + 1) % 3], &b = *v[(i + 2) % 3];
      const double ax = double(a.x) - x, ay = double(a.y) - y, bx = double(b.x) - x, by = double(b.y) - y;
      const double e = (ax * by - ay * bx) * (area > 0 ? 1 : -1);
      if (e < 0) return false;
      if (e > 0) continue;
      const double dx = (bx - ax) * (area > 0 ? 1 : -1), dy = (by - ay) * (area > 0 ? 1 : -1);
      if ((dy < 0 || (dy == 0 && dx > 0)) == free_.turn_ties) return false;
    }
    return true;
  }

  /// Where u and v grow on a triangle: in the object, turned into the world.
  void tangents(uint32_t instance, size_t t, float along[2][3]) {
    const Instance& drawn = scene_.instances[instance];
    const Mesh& mesh = scene_.meshes[drawn.mesh];
    const auto change = [&](const FloatStream& stream, size_t i) {
      return double(stream[mesh.indices[t + i]]) - double(stream[mesh.indices[t]]);
    };
    const double a1 = change(mesh.uv[0], 1), b1 = change(mesh.uv[1], 1), a2 = change(mesh.uv[0], 2),
                 b2 = change(mesh.uv[1], 2);
    const double area = a1 * b2 - a2 * b1, sign = area < 0 ? -1 : area > 0 ? 1 : 0;
    float object[2][3];
    for (size_t k = 0; k < 3; ++k) {
      const double e1 = change(mesh.position[k], 1), e2 = change(mesh.position[k], 2);
      object[0][k] = float(sign * (e1 * b2 - e2 * b1)), object[1][k] = float(sign * (e2 * a1 - e1 * a2));
    }
    for (int axis = 0; axis < 2; ++axis)
      for (int r = 0; r < 3; ++r) {
        const float m[3] = {drawn.world_from_object[0][r], drawn.world_from_object[1][r],
                            drawn.world_from_object[2][r]};
        along[axis][r] = f_.dot(m, object[axis]);
      }
  }

  struct LooseSurface {
    float position[3], normal[3], albedo[4], gloss[4];
  };

  /// The side of N x U on which B is.
  float side_of_v(uint32_t instance, size_t t) const {
    const Mesh& mesh = scene_.meshes[scene_.instances[instance].mesh];
    float side = 0;
    for (size_t i = 0; i < 3; ++i) side += mesh.tangent[3][mesh.indices[t + i]];
    const glm::dmat4x3 m(scene_.instances[instance].world_from_object);
    double determinant = 0;
    for (int r = 0; r < 3; ++r)
      determinant += m[0][r] * (m[1][(r + 1) % 3] * m[2][(r + 2) % 3] - m[1][(r + 2) % 3] * m[2][(r + 1) % 3]);
    return determinant < 0 ? -side : side;
  }

  /// What the fragment shader makes of a sample.
  LooseSurface surface(uint32_t instance, size_t t, const Planes& planes, const Plane& divisor, float sx, float sy) {
    const Material& material = scene_.materials[scene_.instances[instance].material];
    const auto lookup = [&](const TextureSlot& slot) {
      return slot.used() ? textures_.texel(f_, slot, place(planes, divisor, sx, sy)) : std::array<float, 4>{1, 1, 1, 1};
    };
    LooseSurface out{};
    for (int k = 0; k < 10; ++k) {
      const float a = f_.div(at(planes[size_t(k)], sx, sy), at(divisor, sx, sy));
      (k < 3 ? out.position[k] : k < 6 ? out.normal[k - 3] : out.albedo[k - 6]) = a;
    }
    const std::array<float, 4> texel = lookup(material.color_map);
    for (int k = 0; k < 4; ++k)
      out.albedo[k] = f_.mul(material.color_map.used() ? f_.mul(out.albedo[k], texel[size_t(k)]) : out.albedo[k],
                             material.base_color[k]);
    const std::array<float, 4> gloss = lookup(material.specular_map);
    for (int k = 0; k < 3; ++k)
      out.gloss[k] = material.specular_map.used() ? f_.mul(material.specular_color[k], gloss[size_t(k)])
                                                  : material.specular_color[k];
    out.gloss[3] = material.shininess;
    if (!material.normal_map.used()) return out;
    float along[2][3] = {}, side = 0;
    if (scene_.meshes[scene_.instances[instance].mesh].has_tangents()) {
      for (size_t k = 0; k < 3; ++k) along[0][k] = f_.div(at(planes[12 + k], sx, sy), at(divisor, sx, sy));
      side = side_of_v(instance, t);
    } else {
      tangents(instance, t, along);
    }
    loose_bend(f_, along[0], along[1], side, lookup(material.normal_map), material.normal_scale, out.normal);
    return out;
  }

  void keep(int x, int y, uint32_t instance, float depth, const LooseSurface& s) {
    put(0, x, y, 0, depth);
    const bool halved = info(capture_.planes[2].image.format).number_class == NumberClass::unorm;
    for (int k = 0; k < 3; ++k) {
      put(1, x, y, k, s.position[k]);
      store(capture_.planes[2].image, x, y, k, halved ? f_.mad(s.normal[k], 0.5f, 0.5f) : s.normal[k]);
    }
    put(1, x, y, 3, 1);
    store(capture_.planes[2].image, x, y, 3, 1);
    for (int k = 0; k < 4; ++k) store(capture_.planes[3].image, x, y, k, s.albedo[k]);
    const uint32_t id = instance + 1;
    std::memcpy(capture_.planes[4].image.texel(x, y), &id, 4);
    for (int k = 0; k < 4 && capture_.planes.size() > 5; ++k) put(5, x, y, k, s.gloss[k]);
  }

  /// A transparent fragment, blended into the albedo or, lit, into the target.
  void draw_over(Pass pass, int x, int y, const LooseSurface& s) {
    float source[4] = {s.albedo[0], s.albedo[1], s.albedo[2], s.albedo[3]};
    if (pass == Pass::over)
      loose_light(f_, scene_, pipeline_.light_model, free_.reverse_lights, s.position, s.normal, s.albedo, source,
                  reads_specular_plane(pipeline_.light_model) ? s.gloss : nullptr, pipeline_.light_volumes);
    blend(pipeline_.transparency.blend, pass == Pass::over ? capture_.color : capture_.planes[3].image, x, y, source);
  }

  /// What is kept of a source or a sum that stands in floats for a target of fixed-point numbers, or of floats without
  /// a sign: what the target has.
  float kept(float v) const {
    if (!free_.sums_in_floats) return v;
    if (info(pipeline_.target).number_class == NumberClass::unorm) return std::clamp(v, 0.0f, 1.0f);
    return pipeline_.target == Format::r11g11b10f ? std::max(v, 0.0f) : v;
  }

  void blend(const BlendState& state, Image& image, int x, int y, const float given[4]) {
    const FormatInfo layout = info(image.format);
    const bool is_fixed = info(pipeline_.target).number_class == NumberClass::unorm;
    float source[4];
    for (int k = 0; k < 4; ++k) source[k] = is_fixed ? kept(given[k]) : given[k];
    const bool codes = layout.number_class == NumberClass::unorm;
    std::array<double, 4> stored{};
    for (int k = 0; k < layout.channels; ++k)
      stored[size_t(k)] = codes ? double(image.code(x, y, k)) : image.value(x, y, k);
    const std::array<double, 4> left = loose_blend(f_, state, image.format, free_, source, stored);
    for (int k = 0; k < layout.channels; ++k) {
      if (!state.mask[size_t(k)]) continue;
      if (blends_in_codes(image.format, free_))
        image.set_code(x, y, k, uint32_t(std::lround(left[size_t(k)])));
      else
        loose_store_blended(f_, free_, image, x, y, k, double(kept(float(left[size_t(k)]))));
    }
  }

  void triangle(Pass pass, uint32_t instance, size_t t, const std::array<const LooseVertex*, 3>& v) {
    const double area = (double(v[1]->x) - double(v[0]->x)) * (double(v[2]->y) - double(v[0]->y)) -
                        (double(v[2]->x) - double(v[0]->x)) * (double(v[1]->y) - double(v[0]->y));
    if (area == 0) return;
    const float z[3] = {v[0]->z, v[1]->z, v[2]->z}, u[3] = {v[0]->u, v[1]->u, v[2]->u};
    const Plane depth = plane(v, z), divisor = plane(v, u);
    Planes planes{};
    const bool tangents = scene_.meshes[scene_.instances[instance].mesh].has_tangents();
    for (size_t k = 0; k < (tangents ? planes.size() : 12); ++k) {
      const float n[3] = {f_.mul(v[0]->attribute[k], u[0]), f_.mul(v[1]->attribute[k], u[1]),
                          f_.mul(v[2]->attribute[k], u[2])};
      planes[k] = plane(v, n);
    }
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x) {
        const float sx = float(x) + 0.5f, sy = float(pipeline_.height - 1 - y) + 0.5f;
        if (!inside(v, area, double(sx), double(sy))) continue;
        const float d = stored_depth(depth, z, sx, sy);
        std::vector<LooseSurface>& tied = tied_[size_t(y) * size_t(pipeline_.width) + size_t(x)];
        const bool ties = pass == Pass::opaque && d == get(0, x, y, 0);  // EQUAL passes there, LESS does not
        if (!ties && !(d < get(0, x, y, 0))) continue;
        if (pass == Pass::opaque && !ties) tied.clear();
        if (ties) {
          tied.push_back(surface(instance, t, planes, divisor, sx, sy));
          continue;
        }
        const LooseSurface s = surface(instance, t, planes, divisor, sx, sy);
        if (pass == Pass::opaque)
          keep(x, y, instance, d, s), tied.push_back(s);
        else
          draw_over(pass, x, y, s);
      }
  }

  /// Where a lookup is, and the change to a neighbour in its quad: to the right and up, or from the left and below.
  oracle::TexturePlace place(const Planes& planes, const Plane& divisor, float x, float y) {
    const float next = (f_.random().next() & 1) != 0 ? 1.0f : -1.0f;
    float uv[3][2];
    for (int at_pixel = 0; at_pixel < 3; ++at_pixel)
      for (size_t k = 0; k < 2; ++k) {
        const float px = at_pixel == 1 ? x + next : x, py = at_pixel == 2 ? y + next : y;
        uv[at_pixel][k] = f_.div(at(planes[10 + k], px, py), at(divisor, px, py));
      }
    const auto change = [&](int pixel, int k) {
      return (static_cast<long double>(uv[pixel][k]) - static_cast<long double>(uv[0][k])) *
             static_cast<long double>(next);
    };
    return {uv[0][0], uv[0][1], change(1, 0), change(1, 1), change(2, 0), change(2, 1)};
  }

  /// Offset, clamped, and in fixed point a neighbour of its value.
  float stored_depth(const Plane& plane, const float z[3], float x, float y) {
    const GeometryState& g = pipeline_.geometry;
    float d = at(plane, x, y);
    const double codes = g.depth_format == Format::d32f ? 0 : double(info(g.depth_format).largest_code(0));
    if (g.polygon_offset_factor != 0 || g.polygon_offset_units != 0) {
      const double gx = std::fabs(double(plane.gx)), gy = std::fabs(double(plane.gy)), larger = std::max(gx, gy);
      const double m = larger + free_.slope_norm * (std::hypot(gx, gy) - larger);
      const double deepest = double(std::max({std::fabs(z[0]), std::fabs(z[1]), std::fabs(z[2])}));
      const double r = codes > 0 ? free_.depth_unit / codes : std::ldexp(1.0, std::ilogb(deepest) - 23);
      d = f_.add(d, f_.mad(float(m), g.polygon_offset_factor, float(r * double(g.polygon_offset_units))));
    }
    d = std::clamp(d, 0.0f, 1.0f);
    return codes > 0 ? float(loose_neighbour(f_, free_, double(d) * codes) / codes) : d;
  }

  /// Liberties of the subpixel grid.
  Liberties nearly() const {
    Liberties l;
    l.reach = free_.reach;
    return l;
  }

  void store(Image& image, int x, int y, int channel, float v) { loose_store(f_, free_, image, x, y, channel, v); }

  /// The pixel's surface as the light pass reads it.
  LooseSurface read(int x, int y) {
    LooseSurface s{};
    const Image &normals = capture_.planes[2].image, &albedo = capture_.planes[3].image;
    const bool halved = info(normals.format).number_class == NumberClass::unorm;
    const bool coded = info(albedo.format).number_class == NumberClass::unorm;
    for (int k = 0; k < 3; ++k) {
      s.position[k] = get(1, x, y, k);
      s.normal[k] =
          halved ? f_.mad(2, f_.div(float(normals.code(x, y, k)), float(info(normals.format).largest_code(k))), -1)
                 : get(2, x, y, k);
      s.albedo[k] = coded ? f_.div(float(albedo.code(x, y, k)), 255) : get(3, x, y, k);
    }
    for (int k = 0; k < 4 && capture_.planes.size() > 5; ++k) s.gloss[k] = get(5, x, y, k);
    return s;
  }

  /// What lights [first, end) add up to, alpha 1.
  std::array<float, 4> lit(const LooseSurface& s, size_t first, size_t end) {
    Scene some;
    some.camera = scene_.camera;
    some.lights.assign(scene_.lights.begin() + std::ptrdiff_t(first), scene_.lights.begin() + std::ptrdiff_t(end));
    std::array<float, 4> color{0, 0, 0, 1};
    loose_light(f_, some, pipeline_.light_model, free_.reverse_lights, s.position, s.normal, s.albedo, color.data(),
                capture_.planes.size() > 5 ? s.gloss : nullptr, pipeline_.light_volumes);
    return color;
  }

  void store_color(int x, int y, const std::array<float, 4>& color) {
    for (int k = 0; k < info(capture_.color.format).channels; ++k)
      store(capture_.color, x, y, k, kept(color[size_t(k)]));
  }

  void add_light(int x, int y, const float light[4]) {
    if (free_.mesa_codes && info(capture_.color.format).number_class == NumberClass::unorm)
      return add_mesa_codes(capture_.color, x, y, light);
    blend(kAddLight, capture_.color, x, y, light);
  }

  void light(int x, int y) {
    const size_t lights = scene_.lights.size();
    if (!covered(x, y)) return add_tied(x, y);
    const LooseSurface s = read(x, y);
    if (!blends_lights(pipeline_.strategy)) return store_color(x, y, lit(s, 0, lights));
    const bool multipass = pipeline_.strategy == Strategy::forward_multipass;
    const size_t first = multipass && lights > 0 ? 1 : 0;
    if (multipass || pipeline_.light_volumes.base) store_color(x, y, lit(s, 0, first));
    if (multipass) return add_tied(x, y);
    for (size_t i = first; i < lights; ++i) add_light(x, y, lit(s, i, i + 1).data());
  }

  /// What the draws of forward-multipass after the first add, whose test is EQUAL: the light of each surface that has the
  /// pixel's very depth, be it the clear depth.
  void add_tied(int x, int y) {
    for (size_t i = 1; i < scene_.lights.size(); ++i)
      for (const LooseSurface& tied : tied_[size_t(y) * size_t(pipeline_.width) + size_t(x)])
        add_light(x, y, lit(tied, i, i + 1).data());
  }

  bool covered(int x, int y) const { return capture_.planes[4].image.value(x, y, 0) != 0; }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Liberties free_;
  LooseFloat f_;
  const LooseTextures textures_;
  const Matrix4 projection_;
  bool apart_ = false;
  Capture capture_;
  std::vector<std::vector<LooseSurface>> tied_;  ///< of each pixel what has its very depth, in order of submission
};

}  // namespace

Capture loose_frame(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed) {
  Capture capture = Drawing(scene, pipeline, liberties, seed).draw();
  capture.driver = "loose";
  return capture;
}

}  // namespace trueshade::testing
