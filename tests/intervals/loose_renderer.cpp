#include "tests/intervals/loose_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "oracle/scalar_renderer.h"

namespace trueshade::testing {

using oracle::Capture;

float LooseFloat::round(double exact) {
  const auto nearest = float(exact);
  if (!any_ || double(nearest) == exact || !std::isfinite(nearest)) return nearest;
  const float infinity = std::numeric_limits<float>::infinity();
  const float other = std::nextafter(nearest, double(nearest) < exact ? infinity : -infinity);
  return (random_.next() & 1) != 0 ? nearest : other;
}

float LooseFloat::off_by(double exact, double ulps) {
  if (!any_ || exact == 0) return float(exact);
  const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
  // Half an ulp of the allowance is left for this rounding itself.
  return float(exact + ulp * (ulps - 0.5) * random_.between(-1, 1));
}

float LooseFloat::mad(float a, float b, float c) {
  if (any_ && (random_.next() & 1) != 0) return round(double(a) * double(b) + double(c));
  return add(mul(a, b), c);
}
float LooseFloat::div(float a, float b) { return off_by(double(a) / double(b), 2.5); }
float LooseFloat::inverse_sqrt(float x) { return off_by(1 / std::sqrt(double(x)), 2); }
float LooseFloat::sqrt(float x) { return x == 0 ? 0 : any_ ? div(1, inverse_sqrt(x)) : float(std::sqrt(double(x))); }

float LooseFloat::pow(float x, float y) {
  if (y == 0) return 1;
  if (x == 0) return 0;
  const double exact = std::log2(double(x));
  float log2_x = float(exact);
  if (any_) log2_x = x >= 0.5f && x <= 2 ? float(exact + (0x1p-21 - 0x1p-24) * random_.between(-1, 1)) : off_by(exact, 3);
  const float e = mul(y, log2_x);
  return off_by(std::exp2(double(e)), 3 + 2 * std::fabs(double(e)));
}

float LooseFloat::dot(const float a[3], const float b[3]) {
  std::array<int, 3> order = {0, 1, 2};
  if (any_)
    for (int i = 2; i > 0; --i) std::swap(order[size_t(i)], order[size_t(random_.below(uint32_t(i) + 1))]);
  const float first = mul(a[order[0]], b[order[0]]);
  return mad(a[order[2]], b[order[2]], mad(a[order[1]], b[order[1]], first));
}

void LooseFloat::unit(const float in[3], float out[3]) {
  const float l2 = dot(in, in), r = l2 > 0 ? inverse_sqrt(l2) : 0;
  for (int k = 0; k < 3; ++k) out[k] = mul(in[k], r);
}

void loose_light(LooseFloat& f, const Scene& scene, const LightModel& model, bool reverse, const float position[3],
                 const float normal[3], const float albedo[3], float color[3]) {
  float n[3] = {normal[0], normal[1], normal[2]}, to_eye[3], v[3], sum[3] = {0, 0, 0};
  if (model.renormalize) f.unit(normal, n);
  for (int k = 0; k < 3; ++k) to_eye[k] = f.sub(scene.camera.eye[k], position[k]);
  f.unit(to_eye, v);
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[reverse ? scene.lights.size() - 1 - i : i];
    if (light.type == LightType::ambient) {
      for (int k = 0; k < 3; ++k) sum[k] = f.mad(albedo[k], light.color[k], sum[k]);
      continue;
    }
    float l[3], falloff = 1;
    if (light.type == LightType::directional) {
      for (int k = 0; k < 3; ++k) l[k] = -light.direction[k];
    } else {
      float d[3];
      for (int k = 0; k < 3; ++k) d[k] = f.sub(light.position[k], position[k]);
      const float length = f.sqrt(f.dot(d, d));
      f.unit(d, l);
      if (model.falloff == Falloff::linear_range)
        falloff = std::max(0.0f, f.sub(1, f.div(length, light.range)));
      else
        falloff = f.div(1, f.mad(f.mul(light.attenuation.z, length), length, f.mad(light.attenuation.y, length, 1)));
    }
    const float n_l = f.dot(n, l), c = std::max(n_l, 0.0f);
    if (model.specular_masked && !(n_l > 0)) continue;
    float h[3], unit_h[3];
    for (int k = 0; k < 3; ++k) h[k] = f.add(l[k], v[k]);
    f.unit(h, unit_h);
    const float s = f.pow(std::max(f.dot(n, unit_h), 0.0f), model.shininess);
    for (int k = 0; k < 3; ++k) {
      const float strength = f.mul(light.color[k], falloff), ks = model.specular_color[k];
      if (model.order == TermOrder::factored)
        sum[k] = f.mad(f.mad(albedo[k], c, f.mul(ks, s)), strength, sum[k]);
      else
        sum[k] = f.add(sum[k], f.add(f.mul(f.mul(f.mul(c, albedo[k]), light.color[k]), falloff), f.mul(f.mul(f.mul(light.color[k], s), ks), falloff)));
    }
  }
  for (int k = 0; k < 3; ++k) color[k] = sum[k];
}

namespace {

struct LooseVertex {
  float x, y, plane_x, plane_y, z, u;
  float attribute[10];  ///< world position, normal, albedo RGBA
};

class Drawing {
 public:
  Drawing(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed)
      : scene_(scene), pipeline_(pipeline), free_(liberties), f_(seed, liberties.any_rounding),
        projection_(oracle::projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)) {
    const int w = pipeline.width, h = pipeline.height;
    capture_.color = Image(w, h, pipeline.target);
    for (const auto& [name, format] : {std::pair<const char*, Format>{"depth", Format::d32f}, {"position", Format::rgba32f},
                                       {"normal", Format::rgba32f}, {"albedo", Format::rgba8}, {"id.object", Format::r32ui}})
      capture_.planes.push_back({name, Image(w, h, format)});
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) put(0, x, y, 0, 1.0f);
  }

  Capture draw() {
    for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
      const std::vector<uint32_t>& indices = scene_.meshes[scene_.instances[i].mesh].indices;
      std::vector<LooseVertex> vertices;
      for (uint32_t v = 0; v < scene_.meshes[scene_.instances[i].mesh].vertex_count(); ++v) vertices.push_back(vertex(scene_.instances[i], v));
      for (size_t t = 0; t + 2 < indices.size(); t += 3)
        triangle(i, {&vertices[indices[t]], &vertices[indices[t + 1]], &vertices[indices[t + 2]]});
    }
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x) light(x, y);
    return std::move(capture_);
  }

 private:
  void put(size_t plane, int x, int y, int channel, float v) { std::memcpy(capture_.planes[plane].image.texel(x, y) + 4 * channel, &v, 4); }
  float get(size_t plane, int x, int y, int channel) const { return float(capture_.planes[plane].image.value(x, y, channel)); }

  float row(const float m[4], const float p[3]) {  // four terms, contracted or not
    return f_.mad(m[0], p[0], f_.mad(m[1], p[1], f_.mad(m[2], p[2], m[3])));
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
    v.x = free_.subpixel_bits > 0 ? std::nearbyint(v.plane_x * grid) / grid : v.plane_x;
    v.y = free_.subpixel_bits > 0 ? std::nearbyint(v.plane_y * grid) / grid : v.plane_y;
    if (free_.snapped_planes) v.plane_x = v.x, v.plane_y = v.y;
    for (int r = 0; r < 3; ++r) {
      const float m[4] = {instance.world_from_object[0][r], instance.world_from_object[1][r], instance.world_from_object[2][r], instance.world_from_object[3][r]};
      v.attribute[r] = row(m, p);
    }
    normal_of(instance, mesh, index, v.attribute + 3);
    for (size_t k = 0; k < 4; ++k) v.attribute[6 + k] = mesh.has_color() ? mesh.color[k][index] : 1;
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
      for (int c = 0; c < 3; ++c) m[c] = float((a(c + 1, r + 1) * a(c + 2, r + 2) - a(c + 1, r + 2) * a(c + 2, r + 1)) / det);
      world[r] = f_.dot(m, n);
    }
    f_.unit(world, out);
  }

  struct Plane {
    float a0, gx, gy;
  };
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

  void triangle(uint32_t instance, const std::array<const LooseVertex*, 3>& v) {
    const double area = (double(v[1]->x) - double(v[0]->x)) * (double(v[2]->y) - double(v[0]->y)) -
                        (double(v[2]->x) - double(v[0]->x)) * (double(v[1]->y) - double(v[0]->y));
    if (area == 0) return;
    const float z[3] = {v[0]->z, v[1]->z, v[2]->z}, u[3] = {v[0]->u, v[1]->u, v[2]->u};
    const Plane depth = plane(v, z), divisor = plane(v, u);
    std::array<Plane, 10> planes{};
    for (size_t k = 0; k < 10; ++k) {
      const float n[3] = {f_.mul(v[0]->attribute[k], u[0]), f_.mul(v[1]->attribute[k], u[1]), f_.mul(v[2]->attribute[k], u[2])};
      planes[k] = plane(v, n);
    }
    const glm::vec4 tint = scene_.materials[scene_.instances[instance].material].base_color;
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x) {
        const float sx = float(x) + 0.5f, sy = float(pipeline_.height - 1 - y) + 0.5f;
        if (!inside(v, area, double(sx), double(sy))) continue;
        const float d = std::clamp(at(depth, sx, sy), 0.0f, 1.0f);
        if (!(d < get(0, x, y, 0))) continue;
        put(0, x, y, 0, d);
        for (int k = 0; k < 10; ++k) {
          const float a = f_.div(at(planes[size_t(k)], sx, sy), at(divisor, sx, sy));
          if (k < 6)
            put(k < 3 ? 1 : 2, x, y, k % 3, a);
          else
            capture_.planes[3].image.texel(x, y)[k - 6] = code(f_.mul(a, tint[k - 6]));
        }
        put(1, x, y, 3, 1);
        put(2, x, y, 3, 1);
        const uint32_t id = instance + 1;
        std::memcpy(capture_.planes[4].image.texel(x, y), &id, 4);
      }
  }

  uint8_t code(float v) {
    const double scaled = std::clamp(double(v), 0.0, 1.0) * 255;
    if (free_.any_neighbour) return uint8_t((f_.random().next() & 1) != 0 ? std::floor(scaled) : std::ceil(scaled));
    return uint8_t(std::nearbyint(scaled));
  }

  void light(int x, int y) {
    if (capture_.planes[4].image.value(x, y, 0) == 0) return;
    float position[3], normal[3], albedo[3], color[4] = {0, 0, 0, 1};
    for (int k = 0; k < 3; ++k) position[k] = get(1, x, y, k), normal[k] = get(2, x, y, k), albedo[k] = f_.div(float(capture_.planes[3].image.texel(x, y)[k]), 255);
    loose_light(f_, scene_, pipeline_.light_model, free_.reverse_lights, position, normal, albedo, color);
    for (int k = 0; k < 4; ++k) {
      if (pipeline_.target == Format::rgba8)
        capture_.color.texel(x, y)[k] = code(color[k]);
      else
        std::memcpy(capture_.color.texel(x, y) + 4 * k, color + k, 4);
    }
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Liberties free_;
  LooseFloat f_;
  const Matrix4 projection_;
  Capture capture_;
};

}  // namespace

Capture loose_frame(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed) {
  Capture capture = Drawing(scene, pipeline, liberties, seed).draw();
  capture.driver = "loose";
  return capture;
}

}  // namespace trueshade::testing
