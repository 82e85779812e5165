#include "tests/judge/mutants/mutants.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "judge/legal/possible_surfaces.h"

namespace trueshade::oracle {

namespace {

// --- what the renderer is given -------------------------------------------------------------------------------------

/// The lamp nearest to what the camera looks at: one that matters.
size_t main_lamp(const Scene& scene) {
  size_t best = 0;
  float least = HUGE_VALF;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const glm::vec3 d = scene.lights[i].position - scene.camera.target;
    const float d2 = d.x * d.x + d.y * d.y + d.z * d.z;
    if (is_lamp(scene.lights[i]) && d2 < least) least = d2, best = i;
  }
  return best;
}

template <class Change>
void each_lamp(Scene& scene, const Change& change) {
  for (Light& l : scene.lights)
    if (is_lamp(l)) change(l);
}

void light_missing(Scene& s, Pipeline&) {
  if (!s.lights.empty()) s.lights.erase(s.lights.begin() + std::ptrdiff_t(main_lamp(s)));
}
void light_twice(Scene& s, Pipeline&) {
  if (!s.lights.empty()) s.lights.push_back(s.lights[main_lamp(s)]);
}
void last_lights_dropped(Scene& s, Pipeline&) { s.lights.resize(s.lights.size() * 3 / 4); }
void lights_reversed(Scene& s, Pipeline&) { std::reverse(s.lights.begin(), s.lights.end()); }
void falloff_one_percent(Scene& s, Pipeline&) {
  each_lamp(s, [](Light& l) { l.range *= 1.01f, l.attenuation *= 0.99f; });
}
void range_squared(Scene& s, Pipeline&) {
  each_lamp(s, [](Light& l) { l.range *= l.range, l.attenuation *= l.attenuation; });
}
void range_halved(Scene& s, Pipeline&) {
  each_lamp(s, [](Light& l) { l.range *= 0.5f, l.attenuation *= 2.0f; });
}
void light_moved(Scene& s, Pipeline&) {
  each_lamp(s, [](Light& l) { l.position *= 1.01f; });
}
void light_mirrored(Scene& s, Pipeline&) {
  each_lamp(s, [](Light& l) { l.position.z = -l.position.z; });
}
void light_dimmer(Scene& s, Pipeline&) {
  for (Light& l : s.lights) l.color *= 0.99f;
}
void light_swapped(Scene& s, Pipeline&) {
  for (Light& l : s.lights) std::swap(l.color.x, l.color.z);
}
void other_falloff(Scene&, Pipeline& p) {
  p.light_model.falloff = p.light_model.falloff == Falloff::quadratic ? Falloff::linear_range : Falloff::quadratic;
}
void specular_mask(Scene&, Pipeline& p) { p.light_model.specular_masked = !p.light_model.specular_masked; }
void specular_dropped(Scene&, Pipeline& p) { p.light_model.specular_color = glm::vec3(0.0f); }
void shininess_up(Scene&, Pipeline& p) { p.light_model.shininess += 1; }
void shininess_halved(Scene&, Pipeline& p) { p.light_model.shininess /= 2; }
void other_normal_length(Scene&, Pipeline& p) { p.light_model.renormalize = !p.light_model.renormalize; }
void other_alpha_source(Scene&, Pipeline& p) { p.light_model.alpha_from_albedo = !p.light_model.alpha_from_albedo; }

void flat_normals(Scene&, Pipeline& p) { p.gbuffer.normal.interpolation = Interpolation::flat; }
void flat_base(Scene&, Pipeline& p) {
  p.gbuffer.normal.interpolation = p.gbuffer.position.interpolation = Interpolation::flat;
}
void first_provokes(Scene&, Pipeline& p) { p.geometry.provoking = Provoking::first; }
void affine_attributes(Scene&, Pipeline& p) {
  for (PlaneState* plane : {&p.gbuffer.position, &p.gbuffer.normal, &p.gbuffer.albedo, &p.gbuffer.uv})
    plane->interpolation = Interpolation::noperspective;
}
void cull_front(Scene&, Pipeline& p) { p.geometry.cull_face = CullFace::front; }
void greater_depth(Scene&, Pipeline& p) { p.geometry.depth_func = DepthFunc::greater, p.geometry.clear_depth = 0; }
void always_passes(Scene&, Pipeline& p) { p.geometry.depth_func = DepthFunc::always; }
void lequal(Scene&, Pipeline& p) { p.geometry.depth_func = DepthFunc::lequal; }
void near_ignored(Scene&, Pipeline& p) { p.geometry.depth_clamp = true; }
void depth_range(Scene&, Pipeline& p) { p.geometry.depth_far = 0.999f; }
void zero_to_one(Scene& s, Pipeline& p) {
  if (!s.camera.clip_from_world) p.geometry.clip_depth = ClipDepth::zero_to_one;
}
void half_base(Scene&, Pipeline& p) { p.gbuffer.normal.format = p.gbuffer.position.format = Format::rgba16f; }
void half_nearest_mode(Scene&, Pipeline& p) { p.gbuffer.half_round = HalfRound::nearest; }
void position_as_half(Scene&, Pipeline& p) { p.gbuffer.position.format = Format::rgba16f; }
void float_target(Scene&, Pipeline& p) { p.target = Format::rgba32f; }

/// Every object drawn twice, the second time in another material: exact ties everywhere.
void twice_drawn(Scene& s, Pipeline&) {
  if (s.instances.size() > 500) return;
  Material material = s.materials.empty() ? Material{} : s.materials[0];
  material.base_color *= glm::vec4(0.5f, 0.75f, 1.0f, 1.0f);
  s.materials.push_back(material);
  const size_t count = s.instances.size();
  for (size_t i = 0; i < count; ++i) {
    Instance copy = s.instances[i];
    copy.material = uint32_t(s.materials.size() - 1);
    s.instances.push_back(copy);
  }
}

/// The camera brought so near that the near plane cuts.
void close_camera(Scene& s, Pipeline&) {
  const glm::vec3 away = s.camera.eye - s.camera.target;
  s.camera.near = 0.75f * std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
}

Camera moved_in_window(const Scene& scene, const Pipeline& p, double pixels) {
  Matrix4 m = Projector(scene, p, Profile{}).clip_from_world();
  for (size_t c = 0; c < 4; ++c) m[4 * c] += m[4 * c + 3] * (2 * pixels / p.width);
  Camera camera = scene.camera;
  camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*camera.clip_from_world)[i] = float(m[i]);
  return camera;
}
void as_matrix(Scene& s, Pipeline& p) { s.camera = moved_in_window(s, p, 0); }
/// Mirrored, to be turned back: the edges that were at the bottom are at the top when samples are given out.
void mirrored(Scene& s, Pipeline&) {
  for (size_t c = 0; c < 4; ++c) (*s.camera.clip_from_world)[4 * c + 1] *= -1;
}
void half_a_pixel(Scene& s, Pipeline& p) { s.camera = moved_in_window(s, p, 0.5); }
void field_of_view(Scene& s, Pipeline&) { s.camera.fov_y_rad *= 1.001f; }
void near_moved(Scene& s, Pipeline&) { s.camera.near *= 1.01f; }
void instance_stale(Scene& s, Pipeline&) {
  for (size_t i = 0; i < s.instances.size(); i += 3)
    s.instances[i].world_from_object[3] += glm::vec3(0.0f, 0.02f, 0.0f);
}
void instance_missing(Scene& s, Pipeline&) {
  if (!s.instances.empty()) s.instances.erase(s.instances.begin() + std::ptrdiff_t(s.instances.size() / 2));
}
void no_base_color(Scene& s, Pipeline&) {
  for (Material& m : s.materials) m.base_color = glm::vec4(1.0f);
}
void other_clear(Scene& s, Pipeline&) { s.clear += glm::vec4(0.01f, 0.0f, 0.0f, 0.0f); }

/// One triangle that is seen: the one nominally in front nearest to the middle of the picture.
void triangle_dropped(Scene& s, Pipeline& p) {
  const Projector projector(s, p, Profile{});
  const PossibleSurfaces map = possible_surfaces(projector);
  const auto pixels = size_t(p.width) * size_t(p.height);
  for (size_t step = 0; step < pixels; ++step) {
    const std::span<const PossibleSurface> list = map.at((pixels / 2 + size_t(p.width) / 2 + step) % pixels);
    const PossibleSurface* front = nullptr;
    for (const PossibleSurface& c : list)
      if (c.certain && (front == nullptr || c.middle < front->middle)) front = &c;
    if (front == nullptr) continue;
    Array<uint32_t>& indices = s.meshes[s.instances[front->instance].mesh].indices;
    std::vector<uint32_t> rest(indices.begin(), indices.end());
    const auto at = rest.begin() + 3 * std::ptrdiff_t(front->triangle);
    rest.erase(at, at + 3);
    indices = std::move(rest);
    return;
  }
}

// --- what it gives --------------------------------------------------------------------------------------------------

Image* plane(Capture& c, std::string_view name) {
  if (name == "color") return &c.color;
  for (NamedImage& p : c.planes)
    if (p.name == name) return &p.image;
  return nullptr;
}

template <class Change>
void each_code(Image& image, const Change& change) {
  if (image.format != Format::rgba8) return;
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = change(image.texels[i], i % 4);
}

void shifted(Image& image, int dx, int dy) {
  const Image from = image;
  const size_t bytes = size_t(info(image.format).bytes_per_texel());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      std::memcpy(image.texel(x, y),
                  from.texel(std::clamp(x + dx, 0, image.width - 1), std::clamp(y + dy, 0, image.height - 1)), bytes);
}
template <class Change>
void each_image(Capture& c, const Change& change) {
  change(c.color);
  for (NamedImage& p : c.planes) change(p.image);
}
void up_one(const Pipeline&, Capture& c) {
  each_image(c, [](Image& i) { shifted(i, 0, 1); });
}
void left_one(const Pipeline&, Capture& c) {
  each_image(c, [](Image& i) { shifted(i, 1, 0); });
}
void upside_down(const Pipeline&, Capture& c) {
  each_image(c, [](Image& image) {
    for (int y = 0; y < image.height / 2; ++y)
      std::swap_ranges(image.texel(0, y), image.texel(0, y) + image.row_bytes(), image.texel(0, image.height - 1 - y));
  });
}
void gamma_applied(const Pipeline&, Capture& c) {
  each_code(c.color,
            [](uint8_t v, size_t k) { return k == 3 ? v : uint8_t(std::lround(255 * std::pow(v / 255.0, 1 / 2.2))); });
}
void five_bits(const Pipeline&, Capture& c) {
  each_code(c.color, [](uint8_t v, size_t) { return uint8_t((v & 0xf8) | v >> 5); });
}
void bgra(const Pipeline&, Capture& c) {
  for (size_t i = 0; i + 3 < c.color.texels.size() && c.color.format == Format::rgba8; i += 4)
    std::swap(c.color.texels[i], c.color.texels[i + 2]);
}
void albedo_swapped(const Pipeline&, Capture& c) {
  Image* albedo = plane(c, "albedo");
  if (albedo == nullptr) return;
  const size_t channel = size_t(info(albedo->format).bytes_per_channel),
               texel = size_t(info(albedo->format).bytes_per_texel());
  for (size_t i = 0; i + texel <= albedo->texels.size(); i += texel)
    std::swap_ranges(&albedo->texels[i], &albedo->texels[i] + channel, &albedo->texels[i + 2 * channel]);
}
void one_off(const Pipeline&, Capture& c) {
  each_code(c.color, [](uint8_t v, size_t k) { return k < 3 && v > 0 && v < 254 ? uint8_t(v + 2) : v; });
}
void alpha_wrong(const Pipeline&, Capture& c) {
  each_code(c.color, [](uint8_t v, size_t k) { return k == 3 && v > 0 ? uint8_t(v - 2) : v; });
}
/// A code next to one that stands for exactly 1.
void alpha_short_of_one(const Pipeline&, Capture& c) {
  each_code(c.color, [](uint8_t v, size_t k) { return k == 3 && v == 255 ? uint8_t(254) : v; });
}

/// A block keeps what another one shows.
void tile_stale(const Pipeline& p, Capture& c) {
  const int x0 = p.width / 2, y0 = p.height / 2;
  for (int y = 0; y < 16 && y0 + y < c.color.height; ++y)
    for (int x = 0; x < 16 && x0 + x < c.color.width; ++x)
      std::memcpy(c.color.texel(x0 + x, y0 + y), c.color.texel((x0 + x + 24) % c.color.width, y0 + y),
                  size_t(info(c.color.format).bytes_per_texel()));
}
void pixel_black(const Pipeline& p, Capture& c) {
  std::memset(c.color.texel(p.width / 2, p.height / 2), 0, size_t(info(c.color.format).bytes_per_texel()));
}

template <class Change>
void each_float(Image* image, const Change& change) {
  if (image == nullptr || info(image->format).bytes_per_channel != 4) return;
  for (size_t i = 0; i + 4 <= image->texels.size(); i += 4) {
    float v;
    std::memcpy(&v, &image->texels[i], 4);
    v = change(v, (i / 4) % size_t(info(image->format).channels));
    std::memcpy(&image->texels[i], &v, 4);
  }
}
void depth_16_bits(const Pipeline&, Capture& c) {
  each_float(plane(c, "depth"), [](float v, size_t) { return float(std::nearbyint(double(v) * 65535) / 65535); });
}
void normals_turned(const Pipeline&, Capture& c) {
  each_float(plane(c, "normal"), [](float v, size_t k) { return k < 3 ? -v : v; });
}
void half_as_float(const Pipeline&, Capture& c) {
  Image* position = plane(c, "position");
  if (position == nullptr || position->format != Format::rgba16f) return;
  Image wide(position->width, position->height, Format::rgba32f);
  for (int y = 0; y < wide.height; ++y)
    for (int x = 0; x < wide.width; ++x)
      for (int k = 0; k < 4; ++k) {
        const auto v = float(position->value(x, y, k));
        std::memcpy(wide.texel(x, y) + 4 * k, &v, 4);
      }
  *position = std::move(wide);
}
void truncated_codes(const Pipeline&, Capture& c) {
  if (c.color.format != Format::rgba32f) return;
  Image codes(c.color.width, c.color.height, Format::rgba8);
  for (int y = 0; y < codes.height; ++y)
    for (int x = 0; x < codes.width; ++x)
      for (int k = 0; k < 4; ++k)
        codes.texel(x, y)[k] = uint8_t(std::floor(std::clamp(c.color.value(x, y, k), 0.0, 1.0) * 255));
  c.color = std::move(codes);
}
void ids_off(const Pipeline&, Capture& c) {
  Image* ids = plane(c, "id.object");
  if (ids == nullptr) return;
  for (size_t i = 0; i + 4 <= ids->texels.size(); i += 4) {
    uint32_t v;
    std::memcpy(&v, &ids->texels[i], 4);
    v += v > 0 ? 1 : 0;
    std::memcpy(&ids->texels[i], &v, 4);
  }
}
void hole(const Pipeline& p, Capture& c) {
  each_image(c, [&](Image& i) {
    std::memset(i.texel(p.width / 2, p.height / 2), 0, size_t(info(i.format).bytes_per_texel()));
  });
  each_image(c, [&](Image& i) {
    const float clear = p.geometry.clear_depth;
    if (i.format == Format::d32f) std::memcpy(i.texel(p.width / 2, p.height / 2), &clear, 4);
  });
}
void neighbours_mixed(const Pipeline&, Capture& c) {
  for (const char* name : {"depth", "position", "normal"}) {
    Image* image = plane(c, name);
    if (image == nullptr) continue;
    const Image from = *image;
    const auto channels = size_t(info(image->format).channels);
    size_t i = 0;
    each_float(image, [&](float v, size_t) {
      const size_t next = (i++ + channels) * 4;
      float other = v;
      if (next + 4 <= from.texels.size()) std::memcpy(&other, &from.texels[next], 4);
      return 0.5f * v + 0.5f * other;
    });
  }
}

constexpr auto kStated = Latitude::stated_rules;

constexpr Mutant kMutants[] = {
    {"light missing", kNone, nullptr, light_missing, nullptr},
    {"one light twice", kNone, nullptr, light_twice, nullptr},
    {"last quarter of the lights dropped", kNone, nullptr, last_lights_dropped, nullptr},
    {"lights in another order", Latitude::always_legal, float_target, lights_reversed, nullptr},
    {"falloff off by 1%", kNone, nullptr, falloff_one_percent, nullptr},
    {"range squared", kNone, nullptr, range_squared, nullptr},
    {"range halved", kNone, nullptr, range_halved, nullptr},
    {"light positions off by 1%", kNone, nullptr, light_moved, nullptr},
    {"light positions mirrored", kNone, nullptr, light_mirrored, nullptr},
    {"light colours off by 1%", kNone, nullptr, light_dimmer, nullptr},
    {"light colours as BGR", kNone, nullptr, light_swapped, nullptr},
    {"the other falloff", kNone, nullptr, other_falloff, nullptr},
    {"specular mask wrong", kNone, nullptr, specular_mask, nullptr},
    {"specular dropped", kNone, nullptr, specular_dropped, nullptr},
    {"shininess off by one", kNone, nullptr, shininess_up, nullptr},
    {"half vector as Phong's: shininess halved", kNone, nullptr, shininess_halved, nullptr},
    {"normal not normalised, or twice", kNone, nullptr, other_normal_length, nullptr},
    {"alpha from elsewhere", kNone, nullptr, other_alpha_source, nullptr},
    {"normals flat", kNone, nullptr, flat_normals, nullptr},
    {"wrong provoking vertex", kNone, flat_base, first_provokes, nullptr},
    {"attributes noperspective", kNone, nullptr, affine_attributes, nullptr},
    {"front faces culled", kNone, nullptr, cull_front, nullptr},
    {"depth GREATER", kNone, nullptr, greater_depth, nullptr},
    {"depth ALWAYS", kNone, nullptr, always_passes, nullptr},
    {"depth LEQUAL for LESS", kNone, twice_drawn, lequal, nullptr},
    {"near plane ignored", kNone, close_camera, near_ignored, nullptr},
    {"depth range wrong", kNone, nullptr, depth_range, nullptr},
    {"clip depth zero to one", kStated, nullptr, zero_to_one, nullptr},
    {"half stores rounded to nearest", kStated, half_base, half_nearest_mode, nullptr},
    {"position through half floats", kNone, nullptr, position_as_half, half_as_float},
    {"fill rule: top edges instead of bottom ones", kStated, as_matrix, mirrored, upside_down},
    {"unorm store truncates", kStated, nullptr, float_target, truncated_codes},
    {"window moved by half a pixel", kNone, nullptr, half_a_pixel, nullptr},
    {"field of view off by 0.1%", kNone, nullptr, field_of_view, nullptr},
    {"near plane off by 1%", kNone, nullptr, near_moved, nullptr},
    {"instance transforms stale", kNone, nullptr, instance_stale, nullptr},
    {"one instance missing", kNone, nullptr, instance_missing, nullptr},
    {"one triangle dropped", kNone, nullptr, triangle_dropped, nullptr},
    {"base colour ignored", kNone, nullptr, no_base_color, nullptr},
    {"clear colour wrong", kNone, nullptr, other_clear, nullptr},
    {"y off by one", kNone, nullptr, nullptr, up_one},
    {"x off by one", kNone, nullptr, nullptr, left_one},
    {"upside down", kNone, nullptr, nullptr, upside_down},
    {"gamma applied twice", kNone, nullptr, nullptr, gamma_applied},
    {"five bits a channel", kNone, nullptr, nullptr, five_bits},
    {"colour as BGRA", kNone, nullptr, nullptr, bgra},
    {"albedo channels swapped", kNone, nullptr, nullptr, albedo_swapped},
    {"two codes too bright", kNone, nullptr, nullptr, one_off},
    {"alpha two codes low", kNone, nullptr, nullptr, alpha_wrong},
    {"alpha one code low", kNone, nullptr, nullptr, alpha_short_of_one},
    {"one tile stale", kNone, nullptr, nullptr, tile_stale},
    {"one pixel black", kNone, nullptr, nullptr, pixel_black},
    {"depth of 16 bits", kNone, nullptr, nullptr, depth_16_bits},
    {"normals turned", kNone, nullptr, nullptr, normals_turned},
    {"identifiers off by one", kNone, nullptr, nullptr, ids_off},
    {"a hole of one pixel", kNone, nullptr, nullptr, hole},
    {"surfaces of two pixels mixed", kNone, nullptr, nullptr, neighbours_mixed},
};

}  // namespace

std::span<const Mutant> mutants() { return kMutants; }

bool differ(const Capture& a, const Capture& b) {
  if (a.color.texels != b.color.texels || a.planes.size() != b.planes.size()) return true;
  for (size_t i = 0; i < a.planes.size(); ++i)
    if (a.planes[i].image.texels != b.planes[i].image.texels) return true;
  return false;
}

bool same_surfaces(const Capture& a, const Capture& b) {
  if (a.planes.size() != b.planes.size() || a.drawn_at != b.drawn_at) return false;
  for (size_t i = 0; i < a.planes.size(); ++i) {
    const NamedImage &p = a.planes[i], &q = b.planes[i];
    if (p.name != q.name || p.image.format != q.image.format) return false;
    if (p.name != "light.count" && p.image.texels != q.image.texels) return false;
  }
  return true;
}

Capture mutated(const Mutant& mutant, const Scene& scene, const Pipeline& pipeline, const Renderer& renderer,
                const Capture& right) {
  Capture capture = right;
  if (mutant.input != nullptr) {
    Scene wrong_scene = scene;
    Pipeline wrong_pipeline = pipeline;
    mutant.input(wrong_scene, wrong_pipeline);
    capture = renderer(wrong_scene, wrong_pipeline);
  }
  if (mutant.output != nullptr) mutant.output(pipeline, capture);
  capture.driver = "mutant: " + std::string(mutant.name);
  return capture;
}

}  // namespace trueshade::oracle
