#include "judge/diagnosis/picture_faults.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/srgb_numbers.h"

namespace trueshade::oracle {

namespace {

constexpr double kGammas[] = {1 / 2.4, 1 / 2.2, 1 / 1.8, 1.8, 2.2, 2.4};
constexpr double kCeilings[] = {0.25, 0.5, 0.75, 0.9};
constexpr double kBits[] = {3, 4, 5, 6, 7};
constexpr double kPictureShifts[] = {-1, 1, -2, 2, -3, 3, -4, 4};

template <class Change>
void each_of_rgb(Color& c, const Change& change) {
  for (size_t k = 0; k < 3; ++k) c[k] = change(c[k]);
}

void encode(Color& c, double, int, int) { each_of_rgb(c, encoded_srgb); }
void encode_twice(Color& c, double, int, int) {
  each_of_rgb(c, [](double v) { return encoded_srgb(encoded_srgb(v)); });
}
void decode(Color& c, double, int, int) { each_of_rgb(c, decoded_srgb); }
void power(Color& c, double p, int, int) {
  each_of_rgb(c, [p](double v) { return v > 0 ? std::pow(v, p) : 0; });
}
void expose(Color& c, double f, int, int) {
  each_of_rgb(c, [f](double v) { return v * f; });
}
void premultiply(Color& c, double, int, int) {
  each_of_rgb(c, [a = c[3]](double v) { return v * a; });
}
void unpremultiply(Color& c, double, int, int) {
  each_of_rgb(c, [a = c[3]](double v) { return a > 0 ? v / a : v; });
}
/// Shows channel R of `from` as the first, and so on.
template <size_t R, size_t G, size_t B, size_t A>
void show(Color& c, double, int, int) {
  c = {c[R], c[G], c[B], c[A]};
}
void map_tones(Color& c, double, int, int) {
  each_of_rgb(c, [](double v) { return v / (1 + v); });
}
void clamp_to_one(Color& c, double, int, int) {
  each_of_rgb(c, [](double v) { return std::clamp(v, 0.0, 1.0); });
}
void cut_bits(Color& c, double bits, int, int) {
  each_of_rgb(c, [bits](double v) {
    if (std::isnan(v)) return v;
    const int low = 8 - int(bits), code = int(std::nearbyint(std::clamp(v, 0.0, 1.0) * 255));
    return double((code >> low << low) | code >> int(bits)) / 255;
  });
}
void raise(Color& c, double codes, int, int) {
  each_of_rgb(c, [codes](double v) { return v + codes / 255; });
}
void invert(Color& c, double, int, int) {
  each_of_rgb(c, [](double v) { return 1 - v; });
}
void set_alpha(Color& c, double alpha, int, int) { c[3] = alpha; }
void encode_alpha(Color& c, double, int, int) { c[3] = encoded_srgb(c[3]); }
void decode_alpha(Color& c, double, int, int) { c[3] = decoded_srgb(c[3]); }
/// One channel alone.
template <size_t K>
void expose_one(Color& c, double f, int, int) {
  c[K] *= f;
}
template <size_t K>
void leave_one_out(Color& c, double, int, int) {
  c[K] = 0;
}
double grey_of(const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }
void saturate(Color& c, double f, int, int) {
  each_of_rgb(c, [f, grey = grey_of(c)](double v) { return grey + f * (v - grey); });
}
void cut_off(Color& c, double most, int, int) {
  each_of_rgb(c, [most](double v) { return std::min(v, most); });
}
void make_grey(Color& c, double, int, int) {
  each_of_rgb(c, [grey = grey_of(c)](double) { return grey; });
}
void nothing(Color&, double, int, int) {}

void flip_y(Move& m, double) { m.flip_y = !m.flip_y; }
void flip_x(Move& m, double) { m.flip_x = !m.flip_x; }
void turn(Move& m, double) { m.flip_x = !m.flip_x, m.flip_y = !m.flip_y; }
void shift_x(Move& m, double pixels) { m.x += int(pixels); }
void shift_y(Move& m, double pixels) { m.y += int(pixels); }

constexpr double kPictureAlphas[] = {0, 1};
constexpr double kCodes[] = {-4, -3, -2, -1, 1, 2, 3, 4};

bool of_floats(const LightPass& p) { return info(p.pipeline.target).number_class == NumberClass::floating; }
/// The value before the only store is known, and a code is a step of it.
bool shows_dither(const LightPass& p) {
  return holds_codes(p) && !info(p.pipeline.target).srgb && !blends_lights(p.pipeline.strategy);
}

/// Whether alpha can be anything but 1.
bool has_alpha(const LightPass& p) { return p.pipeline.light_model.alpha_from_albedo; }

// name, text, light, value, can, search, starts, move, doubt, reach
constexpr PictureFault kPictureFaults[] = {
    {"picture-flip-y", "the picture is upside down", nullptr, nullptr, nullptr, Search::none, {}, flip_y},
    {"picture-flip-x", "the picture is mirrored, left for right", nullptr, nullptr, nullptr, Search::none, {}, flip_x},
    {"picture-turned", "the picture is turned by 180 degrees", nullptr, nullptr, nullptr, Search::none, {}, turn},
    {"picture-shift-x", "the picture is moved by %s pixels to the right", nullptr, nullptr, nullptr, Search::one_of,
     kPictureShifts, shift_x},
    {"picture-shift-y", "the picture is moved by %s pixels downward", nullptr, nullptr, nullptr, Search::one_of,
     kPictureShifts, shift_y},
    {"picture-bgr", "the picture's channels are in the order BGR", nullptr, show<2, 1, 0, 3>},
    {"picture-grb", "the picture's channels are in the order GRB", nullptr, show<1, 0, 2, 3>},
    {"picture-rbg", "the picture's channels are in the order RBG", nullptr, show<0, 2, 1, 3>},
    {"picture-gbr", "the picture's channels are in the order GBR", nullptr, show<1, 2, 0, 3>},
    {"picture-brg", "the picture's channels are in the order BRG", nullptr, show<2, 0, 1, 3>},
    {"picture-argb", "the picture's channels are in the order ARGB", nullptr, show<3, 0, 1, 2>},
    {"picture-abgr", "the picture's channels are in the order ABGR", nullptr, show<3, 2, 1, 0>},
    {"picture-gbar", "the picture's channels are in the order GBAR", nullptr, show<1, 2, 3, 0>},
    {"picture-srgb-encoded", "the picture is sRGB-encoded once more than the target says", nullptr, encode},
    {"picture-srgb-encoded-twice", "the picture is sRGB-encoded twice more than the target says", nullptr,
     encode_twice},
    {"picture-srgb-missing", "the picture is not sRGB-encoded, or decoded once more than the target says", nullptr,
     decode},
    {"picture-gamma", "the picture is raised to the power of %s", nullptr, power, nullptr, Search::smooth, kGammas,
     nullptr, 0.01},
    {"picture-premultiplied", "the picture's colours are multiplied by its alpha", nullptr, premultiply, has_alpha},
    {"picture-unpremultiplied", "the picture's colours are divided by its alpha", nullptr, unpremultiply, has_alpha},
    {"picture-exposure", "the picture is %s times as bright as it should be", nullptr, expose, nullptr, Search::smooth,
     kFactorsNearOne},
    {"picture-red-gain", "the picture's red is %s times as bright as it should be", nullptr, expose_one<0>, nullptr,
     Search::smooth, kFactorsNearOne, nullptr, 0.01},
    {"picture-green-gain", "the picture's green is %s times as bright as it should be", nullptr, expose_one<1>, nullptr,
     Search::smooth, kFactorsNearOne, nullptr, 0.01},
    {"picture-blue-gain", "the picture's blue is %s times as bright as it should be", nullptr, expose_one<2>, nullptr,
     Search::smooth, kFactorsNearOne, nullptr, 0.01},
    {"picture-red-missing", "the picture has no red", nullptr, leave_one_out<0>},
    {"picture-green-missing", "the picture has no green", nullptr, leave_one_out<1>},
    {"picture-blue-missing", "the picture has no blue", nullptr, leave_one_out<2>},
    {"picture-grey", "the picture is grey", nullptr, make_grey},
    {"picture-saturation", "the picture's colours are %s times as far from grey as they should be", nullptr, saturate,
     nullptr, Search::smooth, kFactorsNearOne, nullptr, 0.01},
    {"picture-ceiling", "the picture holds nothing above %s", nullptr, cut_off, nullptr, Search::smooth, kCeilings,
     nullptr, 0.01},
    {"picture-tone-mapped", "the picture is tone-mapped by x / (1 + x)", nullptr, map_tones},
    {"picture-clamped", "the picture is clamped to [0, 1]", nullptr, clamp_to_one, of_floats},
    {"picture-inverted", "the picture shows 1 - x", nullptr, invert},
    {"picture-bits", "the picture keeps %s bits a channel", nullptr, cut_bits, holds_codes, Search::one_of, kBits,
     nullptr, 0.01},
    {"picture-offset", "a constant of %s / 255 is added to the picture", nullptr, raise, nullptr, Search::one_of,
     kCodes, nullptr, 0.01},
    {"picture-alpha", "the picture's alpha is %s everywhere", nullptr, set_alpha, nullptr, Search::one_of,
     kPictureAlphas},
    {"picture-alpha-srgb-encoded", "the picture's alpha is sRGB-encoded", nullptr, encode_alpha, has_alpha},
    {"picture-alpha-srgb-decoded", "the picture's alpha is decoded as if it were sRGB", nullptr, decode_alpha,
     has_alpha},
    {"picture-dithered",
     "the picture is dithered: each code is one of the two beside the value",
     nullptr,
     nothing,
     shows_dither,
     Search::none,
     {},
     nullptr,
     0.05,
     1.02},
};

}  // namespace

std::span<const PictureFault> picture_value_faults() { return kPictureFaults; }

}  // namespace trueshade::oracle
