// Faults of the picture: its lights, and what became of it afterwards.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/half.h"
#include "tests/judge/diagnosis/plants.h"
#include "tests/judge/diagnosis/wrong_lights.h"
#include "tests/judge/srgb_in_double.h"

namespace trueshade::testing {

namespace {

using oracle::Capture;

const Names kModels = {"many-lights", "punctual"}, kShiny = {"many-lights", "touchdesigner"};

/// A channel's number of rgba8 or rgba16f, as a store makes it.
void put(Image& image, int x, int y, int k, double v) {
  if (image.format == Format::rgba8)
    image.set_code(x, y, k, uint32_t(std::lround(std::clamp(v, 0.0, 1.0) * 255)));
  else
    image.set_code(x, y, k, half_from_float(float(v), HalfRound::nearest));
}

/// Every pixel's colour by a formula of its own four numbers.
template <class Formula>
Output repainted(Formula formula) {
  return [formula](const Scene&, const Pipeline&, Capture& c, int variant) {
    for (int y = 0; y < c.color.height; ++y)
      for (int x = 0; x < c.color.width; ++x) {
        std::array<double, 4> v;
        for (int k = 0; k < 4; ++k) v[size_t(k)] = c.color.value(x, y, k);
        formula(v, variant);
        for (int k = 0; k < 4; ++k) put(c.color, x, y, k, v[size_t(k)]);
      }
  };
}

/// Texels from elsewhere.
template <class Where>
Output displaced(Where where) {
  return [where](const Scene&, const Pipeline&, Capture& c, int variant) {
    const Image from = c.color;
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x) {
        const auto [sx, sy] = where(x, y, from.width, from.height, variant);
        std::memcpy(c.color.texel(x, y),
                    from.texel(std::clamp(sx, 0, from.width - 1), std::clamp(sy, 0, from.height - 1)),
                    size_t(info(from.format).bytes_per_texel()));
      }
  };
}

Output slipped(LightSlip slip, std::initializer_list<int> amounts = {0}) {
  return [slip, amounts = std::vector<int>(amounts)](const Scene& s, const Pipeline& p, Capture& c, int variant) {
    c.color = slipped_picture(s, p, c, slip, amounts[size_t(variant) % amounts.size()]);
  };
}

double linear_of(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

template <class Change>
Input lamps(Change change) {
  return [change](Scene& s, Pipeline&, int variant) {
    for (Light& l : s.lights)
      if (l.type == LightType::point || l.type == LightType::spot) change(l, variant);
    return !s.lights.empty();
  };
}

template <class Change>
Input model(Change change) {
  return [change](Scene& s, Pipeline& p, int variant) {
    change(p.light_model, variant);
    return !s.lights.empty();
  };
}

using Color4 = std::array<double, 4>;
using Where = std::pair<int, int>;

/// Of targets of floats alone: codes of 8 bits hide faults so small, or leave them legal.
Input in_floats(Input input) {
  return [input](Scene& s, Pipeline& p, int variant) {
    return info(p.target).number_class == NumberClass::floating && input(s, p, variant);
  };
}

std::vector<Plant> made_pictures() {
  std::vector<Plant> all;
  const auto out = [&](std::string_view name, Names names, Output output, int variants = 1, Names presets = kModels) {
    all.push_back({name, std::move(names), "picture", std::move(presets), variants, nullptr, std::move(output)});
  };
  const auto slip = [&](std::string_view name, Names names, Output output, int variants = 1, Names presets = kModels) {
    out(name, std::move(names), std::move(output), variants, std::move(presets));
    all.back().lights_again = true;
  };
  const auto in = [&](std::string_view name, Names names, Input input, int variants = 1, Names presets = kModels) {
    all.push_back({name, std::move(names), "picture", std::move(presets), variants, std::move(input)});
  };
  out("picture upside down", {"picture-flip-y"}, displaced([](int x, int y, int, int h, int) {
        return Where{x, h - 1 - y};
      }));
  out("picture mirrored", {"picture-flip-x"}, displaced([](int x, int y, int w, int, int) {
        return Where{w - 1 - x, y};
      }));
  out("picture one pixel to the side", {"picture-shift-x"}, displaced([](int x, int y, int, int, int v) {
        return Where{x + (v == 0 ? 1 : -1), y};
      }),
      2);
  out("picture one pixel up or down", {"picture-shift-y"}, displaced([](int x, int y, int, int, int v) {
        return Where{x, y + (v == 0 ? 1 : -1)};
      }),
      2);
  out("channels as BGRA", {"picture-bgr"}, repainted([](Color4& c, int) { std::swap(c[0], c[2]); }));
  out("channels as ARGB or ABGR", {"picture-argb", "picture-abgr"}, repainted([](Color4& c, int v) {
        c = v == 0 ? Color4{c[3], c[0], c[1], c[2]} : Color4{c[3], c[2], c[1], c[0]};
      }),
      2);
  out("sRGB once too often", {"picture-srgb-encoded"}, repainted([](Color4& c, int) {
        for (int k = 0; k < 3; ++k) c[size_t(k)] = srgb_encoded(c[size_t(k)]);
      }));
  out("sRGB twice too often", {"picture-srgb-encoded-twice"}, repainted([](Color4& c, int) {
        for (int k = 0; k < 3; ++k) c[size_t(k)] = srgb_encoded(srgb_encoded(c[size_t(k)]));
      }));
  out("sRGB decoded once too often", {"picture-srgb-missing"}, repainted([](Color4& c, int) {
        for (int k = 0; k < 3; ++k) c[size_t(k)] = linear_of(c[size_t(k)]);
      }));
  out("gamma of 2.2 or 1.8", {"picture-gamma"}, repainted([](Color4& c, int v) {
        for (int k = 0; k < 3; ++k) c[size_t(k)] = std::pow(std::max(0.0, c[size_t(k)]), v == 0 ? 1 / 2.2 : 1 / 1.8);
      }),
      2);
  slip("premultiplied alpha", {"picture-premultiplied"}, slipped(LightSlip::premultiplied), 1, {"touchdesigner"});
  all.back().loops_only = true;
  all.back().base = [](Scene& s, Pipeline&) {
    for (Material& m : s.materials) m.base_color.a = 0.6f;
  };
  out("exposure", {"picture-exposure", "light-intensity"}, repainted([](Color4& c, int v) {
        for (int k = 0; k < 3; ++k) c[size_t(k)] *= pick({0.5f, 0.9f, 1.02f, 1.25f}, v);
      }),
      4);
  slip("truncating stores", {"store-truncated"}, slipped(LightSlip::truncated_stores));
  slip("dithering", {"picture-dithered"}, slipped(LightSlip::dithered), 2);
  all.back().loops_only = true;
  in("intensity a little off", {"light-intensity", "picture-exposure"}, lamps([](Light& l, int v) {
       l.color *= pick({0.99f, 0.98f, 1.01f, 1.05f}, v);
     }),
     4);
  in("intensity hardly off", {"light-intensity", "picture-exposure"}, in_floats(lamps([](Light& l, int v) {
       l.color *= pick({1.003f, 0.999f, 1.005f, 0.997f, 1.001f, 0.995f}, v);
     })),
     6);
  in("range hardly off", {"light-range"}, in_floats(lamps([](Light& l, int v) {
       l.range *= pick({1.003f, 0.997f}, v);
     })),
     2);
  in("range a little off", {"light-range"}, lamps([](Light& l, int v) {
       l.range *= pick({0.99f, 0.97f, 1.01f, 1.05f}, v);
     }),
     4);
  in("attenuation a little off", {"light-attenuation"}, lamps([](Light& l, int v) {
       const float f = pick({0.97f, 0.9f, 1.03f, 1.1f}, v);
       l.attenuation.y *= f, l.attenuation.z *= f;
     }),
     4, {"touchdesigner", "gl-fixed"});
  in("light positions off", {"light-position"}, lamps([](Light& l, int v) {
       l.position *= pick({0.98f, 1.01f}, v);
     }),
     2);
  in("light z mirrored", {"light-mirrored-z"}, lamps([](Light& l, int) { l.position.z = -l.position.z; }));
  in("light colours as BGR", {"light-colors-bgr"}, lamps([](Light& l, int) { std::swap(l.color.x, l.color.z); }));
  slip("d for d^2", {"falloff-distance-once"}, slipped(LightSlip::distance_once), 2, {"touchdesigner", "punctual"});
  slip("d^2 for d", {"falloff-distance-squared"}, slipped(LightSlip::distance_squared), 2,
       {"many-lights", "touchdesigner"});
  in("another falloff", {"falloff-other"}, model([](LightModel& m, int v) {
       m.falloff = m.falloff == Falloff::linear_range ? (v == 0 ? Falloff::quadratic : Falloff::inverse_square)
                                                      : (v == 0 ? Falloff::linear_range : Falloff::none);
     }),
     2, kShiny);
  slip("half vector without the viewer's sign", {"half-vector-viewer"}, slipped(LightSlip::half_without_viewer), 1,
       kShiny);
  slip("half vector without the light's sign", {"half-vector-light", "specular-missing"},
       slipped(LightSlip::half_without_light), 1, kShiny);
  slip("R.V for N.H", {"specular-reflected"}, slipped(LightSlip::reflection), 1, kShiny);
  slip("unmasked specular, or masked", {"specular-mask"}, slipped(LightSlip::highlight_mask), 1, kShiny);
  in("no highlight", {"specular-missing", "specular-factor", "half-vector-light"},
     model([](LightModel& m, int) { m.specular = Specular::none; }), 1, kShiny);
  in("shininess off", {"shininess"}, model([](LightModel& m, int v) {
       m.shininess *= pick({0.5f, 0.25f, 2.0f}, v);
     }),
     3, kShiny);
  slip("normals not normalised", {"lighting-normal-length"}, slipped(LightSlip::normals_raw), 1, kShiny);
  slip("normals of 8 bits", {"lighting-normal-rounded"}, slipped(LightSlip::normals_of_8_bits), 1, kShiny);
  slip("normals in view space", {"lighting-normal-in-view"}, slipped(LightSlip::normals_in_view), 1, kShiny);
  slip("N.L by its magnitude", {"diffuse-two-sided"}, slipped(LightSlip::two_sided), 1, kShiny);
  in(
      "a light missing", {"light-missing"},
      [](Scene& s, Pipeline&, int v) {
        if (s.lights.empty()) return false;
        s.lights.erase(s.lights.begin() + ptrdiff_t((size_t(v) * 7 + 1) % s.lights.size()));
        return true;
      },
      4);
  in(
      "a light doubled", {"light-twice"},
      [](Scene& s, Pipeline&, int v) {
        if (s.lights.empty()) return false;
        const size_t at = (size_t(v) * 5 + 1) % s.lights.size();
        const Light copy = s.lights[at];
        s.lights.insert(s.lights.begin() + ptrdiff_t(at), copy);
        return true;
      },
      4);
  in(
      "lights capped at a count", {"light-count", "light-missing"},
      [](Scene& s, Pipeline&, int v) {
        const auto keep = size_t(pick({0.5f, 0.75f, 0.9f}, v) * float(s.lights.size()));
        if (keep + 1 >= s.lights.size()) return false;
        s.lights.resize(keep);
        return true;
      },
      3);
  slip("lights at a pixel capped", {"light-count-pixel", "light-count"}, slipped(LightSlip::most_at_pixel, {2, 4, 8}),
       3);
  in("lights out of order", {"light-order"}, [](Scene& s, Pipeline&, int) {
    std::reverse(s.lights.begin(), s.lights.end());
    return true;
  });
  slip("tiles with their neighbours' lists", {"tile-lists-16"}, slipped(LightSlip::shifted_tiles), 2);
  slip("tiles whose lists are full", {"tile-count-16", "tile-count-8", "light-count"},
       slipped(LightSlip::full_lists, {4, 8, 2}), 3);
  slip("a stale tile", {"tile-stale-16"}, slipped(LightSlip::stale_tile), 2);
  slip(
      "estimated roots", {"root-newton", "root-12-bits"},
      [](const Scene& s, const Pipeline& p, Capture& c, int v) {
        c.color = slipped_picture(s, p, c, v == 0 ? LightSlip::quake_root : LightSlip::short_root);
      },
      2, kShiny);
  slip("half-precision sums", {"sum-halves"}, slipped(LightSlip::half_sums), 2, kShiny);
  all.back().loops_only = true;
  return all;
}

}  // namespace

const std::vector<Plant>& plants_of_pictures() {
  static const std::vector<Plant> all = made_pictures();
  return all;
}

}  // namespace trueshade::testing
