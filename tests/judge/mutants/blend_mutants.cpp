#include "tests/judge/mutants/blend_mutants.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace trueshade::oracle {

namespace {

using Images = std::vector<Image>;

/// The lamp in the middle of the list.
size_t middle_lamp(const Scene& s) {
  size_t best = s.lights.size() / 2;
  for (size_t i = 0; i < s.lights.size() && !is_lamp(s.lights[best]); ++i) best = i;
  return best;
}

// --- what both are given --------------------------------------------------------------------------------------------

/// Boxes that the eye is outside of.
void boxes(Scene& s, Pipeline& p) {
  for (Light& l : s.lights) {
    const glm::vec3 d = l.position - s.camera.eye;
    if (is_lamp(l)) l.range = 0.35f * std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  }
  p.light_volumes.point = p.light_volumes.spot = LightExtent::box;
  p.light_volumes.cull_face = CullFace::front;
}
/// Lights that end at their boxes alone.
void hard_boxes(Scene& s, Pipeline& p) {
  boxes(s, p);
  p.light_model.falloff = Falloff::quadratic;
  for (Light& l : s.lights) l.attenuation = {1.0f, 0.0f, 0.0f};
}
/// Boxes whose near sides the near plane cuts.
void near_boxes(Scene& s, Pipeline& p) {
  hard_boxes(s, p);
  p.light_volumes.cull_face = CullFace::back;
  const glm::vec3 away = s.camera.eye - s.camera.target;
  if (!s.camera.clip_from_world) s.camera.near = 0.75f * std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
}
/// The eye in every box.
void eye_in_boxes(Scene& s, Pipeline& p) {
  hard_boxes(s, p);
  for (Light& l : s.lights) {
    const glm::vec3 d = l.position - s.camera.eye;
    if (is_lamp(l)) l.range = 1.25f * std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  }
}
void bright(Scene& s, Pipeline&) {
  for (Light& l : s.lights) l.color *= 4.0f;
}
void negative(Scene& s, Pipeline& p) {
  p.light_model.falloff = Falloff::linear;
  p.light_model.diffuse = Diffuse::unclamped;
  p.light_model.specular = Specular::none;
  for (Light& l : s.lights) l.range *= 0.6f;
}
void alpha_writes(Scene& s, Pipeline& p) {
  for (Material& m : s.materials) m.base_color.a = 0.25f;
  p.light_volumes.base = false;
  s.clear.a = 0.0f;
  p.blend.mask[3] = true;
  p.light_model.alpha_from_albedo = true;
}
/// Each light over the ones before it: order matters.
void over(Scene& s, Pipeline& p) {
  p.blend.rgb = {BlendEquation::add, BlendFactor::src_alpha, BlendFactor::one_minus_src_alpha};
  p.light_model.alpha_from_albedo = true;
  for (Material& m : s.materials) m.base_color.a = 0.25f;
}
void grey_clear(Scene& s, Pipeline&) { s.clear = {0.25f, 0.25f, 0.25f, 0.0f}; }

// --- what the wrong one does ----------------------------------------------------------------------------------------

Images right(const Scene& s, const Pipeline& p, const StepRenderer& render) { return images_of(render(s, p)); }

Images of_pipeline(const Scene& s, const Pipeline& p, const StepRenderer& render, void (*change)(Pipeline&)) {
  Pipeline wrong = p;
  change(wrong);
  return right(s, wrong, render);
}

Images blended_twice(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  if (s.lights.empty()) return right(s, p, render);
  Scene twice = s;
  const size_t which = middle_lamp(s);
  twice.lights.insert(twice.lights.begin() + std::ptrdiff_t(which), s.lights[which]);
  Images images = right(twice, p, render);
  images.erase(images.begin() + std::ptrdiff_t(which) + 1);  // the two are one step
  return images;
}

Scene without_middle(const Scene& s) {
  Scene dark = s;
  if (!dark.lights.empty()) dark.lights[middle_lamp(s)].color = dark.lights[middle_lamp(s)].ambient = glm::vec3(0.0f);
  return dark;
}

Images lost(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  const Scene dark = without_middle(s);
  return right(dark, p, render);
}

void copy_tile(const Images& from, Images& to) {
  for (size_t i = 0; i < to.size(); ++i) {
    const int x = to[i].width / 3, y = to[i].height / 3;
    const auto bytes = size_t(info(to[i].format).bytes_per_texel());
    for (int row = y; row < std::min(y + 16, to[i].height); ++row)
      std::memcpy(to[i].texel(x, row), from[i].texel(x, row), 16 * bytes);
  }
}

Images skipped_in_a_tile(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  Images images = right(s, p, render);
  copy_tile(lost(s, p, render), images);
  return images;
}

/// Codes added up from the float images' differences, by `add(code, change in codes)`.
template <class Add>
Images in_codes(const Scene& s, const Pipeline& p, const StepRenderer& render, const Add& add) {
  Images images = right(s, p, render);
  if (p.target != Format::rgba8) return images;
  Pipeline floats = p;
  floats.target = Format::rgba32f;
  const Images real = right(s, floats, render);
  for (size_t i = 1; i < images.size(); ++i)
    for (int y = 0; y < images[i].height; ++y)
      for (int x = 0; x < images[i].width; ++x)
        for (int k = 0; k < 3; ++k) {
          const bool stored = i == 1 && p.strategy == Strategy::forward_multipass;
          const double change = 255 * (real[i].value(x, y, k) - (stored ? 0 : real[i - 1].value(x, y, k)));
          const double code = add(stored ? 0.0 : double(images[i - 1].texel(x, y)[k]), change);
          images[i].texel(x, y)[k] = uint8_t(code);
        }
  return images;
}

Images truncated(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return in_codes(s, p, render, [](double code, double change) {
    return std::clamp(code + std::floor(std::clamp(change, 0.0, 255.0)), 0.0, 255.0);
  });
}
Images wrapped(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return in_codes(s, p, render, [](double code, double change) {
    return std::fmod(code + std::nearbyint(std::clamp(change, 0.0, 255.0)), 256.0);
  });
}
Images not_clamped(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return in_codes(s, p, render,
                  [](double code, double change) { return std::clamp(code + std::nearbyint(change), 0.0, 255.0); });
}

Images reversed(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  Scene other = s;
  std::reverse(other.lights.begin(), other.lights.end());
  return right(other, p, render);
}
Images stale_light(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  Scene other = s;
  if (s.lights.size() > 1) std::rotate(other.lights.begin(), other.lights.end() - 1, other.lights.end());
  return right(other, p, render);
}
Images smaller(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  Scene other = s;
  for (Light& l : other.lights) {
    const glm::vec3 d =
        l.position - s.camera.eye;  // a pixel at the light's distance, of a view about as wide as it is far
    l.range = std::max(0.5f * l.range, l.range - std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z) / float(p.height));
  }
  return right(other, p, render);
}
Images near_clipped(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return of_pipeline(s, p, render, [](Pipeline& w) { w.light_volumes.depth_clamp = false; });
}
Images back_culled(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return of_pipeline(s, p, render, [](Pipeline& w) { w.light_volumes.cull_face = CullFace::back; });
}
Images both_faces(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return of_pipeline(s, p, render, [](Pipeline& w) { w.light_volumes.cull_face = CullFace::none; });
}
Images alpha_masked(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return of_pipeline(s, p, render, [](Pipeline& w) { w.blend.mask[3] = false; });
}
Images no_base(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return of_pipeline(s, p, render, [](Pipeline& w) { w.light_volumes.base = false; });
}
Images factors_swapped(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  return of_pipeline(s, p, render, [](Pipeline& w) { std::swap(w.blend.rgb.src, w.blend.rgb.dst); });
}

/// forward-multipass whose first light is added to the clear colour.
Images first_added(const Scene& s, const Pipeline& p, const StepRenderer& render) {
  Images images = right(s, p, render);
  if (p.strategy != Strategy::forward_multipass || p.target != Format::rgba8) return images;
  const Image clear = images.front();
  for (size_t i = 1; i < images.size(); ++i)
    for (int y = 0; y < clear.height; ++y)
      for (int x = 0; x < clear.width; ++x)
        for (int k = 0; k < 3 && std::memcmp(images[i].texel(x, y), clear.texel(x, y), 4) != 0; ++k)
          images[i].texel(x, y)[k] = uint8_t(std::min(255, images[i].texel(x, y)[k] + clear.texel(x, y)[k]));
  return images;
}

constexpr BlendMutant kBlendMutants[] = {
    {"a light blended twice", Latitude::none, nullptr, blended_twice},
    {"a light's draw lost", Latitude::none, nullptr, lost},
    {"a light skipped in one tile", Latitude::none, nullptr, skipped_in_a_tile},
    {"sums of codes truncated", Latitude::stated_rules, nullptr, truncated},
    {"sums of codes wrap around", Latitude::none, bright, wrapped},
    {"sources below 0 not clamped", Latitude::none, negative, not_clamped},
    {"lights drawn in reverse, one over the other", Latitude::none, over, reversed},
    {"blend factors swapped", Latitude::none, over, factors_swapped},
    {"each light drawn with the one before it", Latitude::none, nullptr, stale_light},
    {"light volumes a pixel too small", Latitude::none, hard_boxes, smaller},
    {"light volumes cut by the near plane", Latitude::none, near_boxes, near_clipped},
    {"light volumes about the eye culled", Latitude::none, eye_in_boxes, back_culled},
    {"both faces of light volumes drawn", Latitude::none, boxes, both_faces},
    {"alpha not written", Latitude::none, alpha_writes, alpha_masked},
    {"no draw before the lights", Latitude::none, grey_clear, no_base},
    {"first light added to the clear colour", Latitude::none, grey_clear, first_added},
};

}  // namespace

std::span<const BlendMutant> blend_mutants() { return kBlendMutants; }

std::vector<Image> images_of(const LightSteps& steps) {
  Images images;
  steps([&](int, const Image& target) { images.push_back(target); });
  return images;
}

LightSteps steps_from(std::span<const Image> images) {
  return [images](const StepSink& sink) {
    for (size_t i = 0; i < images.size(); ++i) sink(int(i) - 1, images[i]);
  };
}

}  // namespace trueshade::oracle
