// Tests of the whole image: faults that leave each pixel legal are convicted, and implementations that are known are
// not.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/shapes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/loose_renderer.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::captured;
using trueshade::testing::Liberties;

namespace {

Verdict judged(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  return validate_capture(scene, pipeline, capture, {testing::unknown_of_8_bits(), false, {}, {}});
}

bool fails(const Verdict& v) { return v.violations() > 0 || v.convicted(); }

/// Ways of rounding that implementations have.
constexpr const char* kHardware[] = {"nearest",         "within 0.6",          "not snapped",
                                     "nearest, halves", "sums kept in floats", "llvmpipe's codes"};

struct Hardware {
  const char* name;
  Liberties liberties;
};

Hardware hardware(uint32_t index, Pcg32& random) {
  Liberties l;
  l.any_rounding = random.below(2) == 0;
  l.snapped_planes = random.below(2) == 0;
  l.turn_ties = random.below(2) == 0;
  l.reverse_lights = random.below(2) == 0;
  if (index == 1) l.reach = 0.6, l.conversion = random.next();
  if (index == 2) l.subpixel_bits = 0;
  l.nearest_halves = index == 3, l.sums_in_floats = index == 4, l.mesa_codes = index == 5;
  return {kHardware[index], l};
}

int convicted_of(uint32_t class_index, int count, uint64_t first_seed, std::optional<Strategy> strategy = {}) {
  int alarms = 0;
  const char* name = "";
  for (int i = 0; i < count; ++i) {
    Pcg32 random(first_seed + uint64_t(i));
    const Scene scene = testing::random_scene(random);
    Pipeline pipeline = testing::random_pipeline(random);
    pipeline.strategy = strategy.value_or(Strategy(uint32_t(i) % uint32_t(std::size(kStrategyNames))));
    pipeline.target = kTargetFormats[random.below(uint32_t(std::size(kTargetFormats)))];
    if (is_forward(pipeline.strategy) && pipeline.transparency.mode == TransparencyMode::into_albedo)
      pipeline.transparency.mode = TransparencyMode::after_lights;
    const Hardware drawn_by = hardware(class_index, random);
    // llvmpipe blends sRGB in floats that it decodes by a polynomial of its own: drawn by the driver alone.
    if (drawn_by.liberties.mesa_codes && info(pipeline.target).srgb) pipeline.target = Format::rgb10_a2;
    name = drawn_by.name;
    const Capture capture = testing::loose_frame(scene, pipeline, drawn_by.liberties, first_seed + uint64_t(i));
    const Verdict v = judged(scene, pipeline, capture);
    if (!fails(v)) continue;
    ++alarms;
    WARN(name << ", image " << first_seed + uint64_t(i) << ", " << name_of(pipeline.strategy) << " "
              << info(pipeline.target).name << ": " << v.violations() << " violations; " << v.evidence_line());
  }
  std::printf("legal images of hardware that is %s, %s: %d, convicted %d\n", name,
              strategy ? std::string(name_of(*strategy)).c_str() : "every strategy", count, alarms);
  return alarms;
}

/// Something that is wrong in a picture while its planes are right.
struct Fault {
  const char* name;
  Capture (*plant)(const Scene& scene, const Pipeline& pipeline, const Capture& right);
  bool may_be_remark = false;  ///< small enough to be what hardware within 0.6 of a code makes
};

Capture with_lights(const Scene& scene, const Pipeline& pipeline, const Capture& right, void (*change)(Light&)) {
  Scene other = scene;
  for (Light& light : other.lights) change(light);
  Capture wrong = right;
  wrong.color = captured(other, pipeline).color;
  return wrong;
}

/// A tile of 16 x 16 pixels where the lights are other ones, in the middle of the image.
Capture stale_tile(const Scene& scene, const Pipeline& pipeline, const Capture& right) {
  Scene other = scene;
  for (size_t i = 0; i < other.lights.size(); i += 2) other.lights[i].color *= 0.5f;
  const Capture stale = captured(other, pipeline);
  Capture wrong = right;
  const auto bytes = size_t(info(pipeline.target).bytes_per_texel());
  for (int y = 0; y < 16; ++y)
    std::copy_n(stale.color.texel(pipeline.width / 32 * 16, pipeline.height / 32 * 16 + y), 16 * bytes,
                wrong.color.texel(pipeline.width / 32 * 16, pipeline.height / 32 * 16 + y));
  return wrong;
}

/// The light that reaches fewest pixels, of those that change 60 or more by a code.
Capture without_a_light(const Scene& scene, const Pipeline& pipeline, const Capture& right) {
  Capture wrong = right;
  size_t fewest = SIZE_MAX;
  for (size_t i = 0; i < scene.lights.size(); i += std::max<size_t>(1, scene.lights.size() / 6)) {
    Scene other = scene;
    other.lights.erase(other.lights.begin() + ptrdiff_t(i));
    Capture without = captured(other, pipeline);
    const auto bytes = size_t(right.color.row_bytes()) / size_t(right.color.width);
    size_t changed = 0;
    for (size_t at = 0; at < right.color.texels.size(); at += bytes)
      changed +=
          !std::equal(right.color.texels.begin() + ptrdiff_t(at), right.color.texels.begin() + ptrdiff_t(at + bytes),
                      without.color.texels.begin() + ptrdiff_t(at));
    if (changed >= 60 && changed < fewest) fewest = changed, wrong.color = std::move(without.color);
  }
  return wrong;
}

/// What a driver that cuts the last code off stores: one below where the real value is no code.
Capture cut_codes(const Scene& scene, const Pipeline& pipeline, const Capture& right) {
  Pipeline floats = pipeline;
  floats.target = Format::rgba32f;
  const Capture real = captured(scene, floats);
  Capture wrong = right;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x)
      for (int k = 0; k < 3; ++k)
        if (pipeline.target == Format::rgba8)
          wrong.color.set_code(x, y, k, uint32_t(std::floor(std::min(1.0, real.color.value(x, y, k)) * 255)));
  return wrong;
}

constexpr Fault kFaults[] = {
    {"range off by 1 %",
     [](const Scene& s, const Pipeline& p, const Capture& right) {
       return with_lights(s, p, right, [](Light& l) { l.range *= 1.01f; });
     }},
    {"all light off by 0.1 %",
     [](const Scene& s, const Pipeline& p, const Capture& right) {
       return with_lights(s, p, right, [](Light& l) { l.color *= 1.001f; });
     },
     true},
    {"a stale tile of 16 x 16", stale_tile},
    {"a light of few pixels missing", without_a_light},
    {"codes cut off", cut_codes},
};

void try_fault(const Fault& fault, int& tried, int& convicted, int& by_pixels) {
  for (const char* name : {"city,lights=40,objects=300", "sphere,lights=24", "cornell"})
    for (const Format target : {Format::rgba8, Format::rgba16f})
      for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
        const Scene scene = builtin_scene(name);
        Pipeline pipeline;
        pipeline.width = 128, pipeline.height = 96;
        pipeline.target = target, pipeline.strategy = strategy;
        const Capture right = captured(scene, pipeline), wrong = fault.plant(scene, pipeline, right);
        if (wrong.color.texels == right.color.texels) continue;
        const Verdict v = judged(scene, pipeline, wrong);
        int changed = 0;
        const auto texel = size_t(info(pipeline.target).bytes_per_texel());
        for (size_t at = 0; at < right.color.texels.size(); at += texel)
          changed += std::memcmp(&right.color.texels[at], &wrong.color.texels[at], texel) != 0 ? 1 : 0;
        CAPTURE(fault.name, name, info(target).name, name_of(strategy), changed, v.violations(), v.evidence_line());
        ++tried, convicted += fails(v) ? 1 : 0, by_pixels += v.violations() > 0 ? 1 : 0;
        if (changed < 60) continue;
        CHECK((fails(v) || (fault.may_be_remark && v.suspicious())));
      }
}

}  // namespace

TEST_CASE("Images of hardware that is known are not convicted") {
  for (uint32_t c = 0; c < std::size(kHardware); ++c) CHECK(convicted_of(c, 40, 1) == 0);
}

// LEGAL_IMAGES=N in the environment judges N of each, for those who wait less or want to know more.
TEST_CASE("Of ten thousand images of each strategy and class of hardware at most one is convicted", "[long]") {
  const char* const asked = std::getenv("LEGAL_IMAGES");
  const int count = asked != nullptr ? std::max(1, std::atoi(asked)) : 10000;
  for (uint32_t c = 0; c < std::size(kHardware); ++c)
    for (uint32_t s = 0; s < std::size(kStrategyNames); ++s) CHECK(convicted_of(c, count, 1000, Strategy(s)) <= 1);
}

TEST_CASE("Faults that leave pixels legal are convicted by the whole image") {
  for (const Fault& fault : kFaults) {
    int tried = 0, convicted = 0, by_pixels = 0;
    try_fault(fault, tried, convicted, by_pixels);
    std::printf("%-32s tried %d, convicted %d, %d of these by a pixel in no legal set\n", fault.name, tried, convicted,
                by_pixels);
    CHECK(tried > 0);
  }
}

TEST_CASE("Our own frames follow the stated rounding") {
  for (const char* name : {"city,lights=40,objects=300", "sphere,lights=24", "cornell"})
    for (const Format target : {Format::rgba8, Format::rgba16f, Format::srgb8_a8, Format::rgb10_a2})
      for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
        const Scene scene = builtin_scene(name);
        Pipeline pipeline;
        pipeline.width = 80, pipeline.height = 60;
        pipeline.target = target, pipeline.strategy = strategy;
        const Verdict v = judged(scene, pipeline, captured(scene, pipeline));
        CAPTURE(name, info(target).name, name_of(strategy), verdict_json(v));
        CHECK_FALSE(fails(v));
        CHECK_FALSE(v.suspicious());
      }
}

TEST_CASE("A wall of one value that is stored as two codes is convicted, whatever the pattern") {
  Scene scene;
  scene.spec = "wall";
  scene.meshes = {plane_mesh(1)};
  scene.materials = {{"", {0.4041f, 0.4041f, 0.4041f, 1.0f}}};  // 103.05 codes, lit by white light alone
  scene.instances.push_back({0, 0, placed({0, 0, 0}, {20, 1, 20})});
  scene.lights.resize(1);
  scene.lights[0].type = LightType::directional;
  scene.lights[0].direction = {0.0f, -1.0f, 0.0f};
  scene.camera.eye = {0.0f, 6.0f, 0.1f};
  Pipeline pipeline;
  pipeline.width = 96, pipeline.height = 64;
  pipeline.light_model.specular = Specular::none;
  const Capture right = captured(scene, pipeline);
  CHECK_FALSE(fails(judged(scene, pipeline, right)));
  using Pattern = bool (*)(int x, int y);
  constexpr Pattern patterns[] = {[](int x, int y) { return ((x ^ y) & 1) != 0; }, [](int x, int) { return x >= 48; },
                                  [](int x, int y) { return x / 16 == 2 && y / 16 == 1; }};
  for (const Pattern pattern : patterns) {
    Capture wrong = right;
    for (int y = 0; y < pipeline.height; ++y)
      for (int x = 0; x < pipeline.width; ++x)
        if (pattern(x, y)) wrong.color.set_code(x, y, 1, right.color.code(x, y, 1) + 1);
    const Verdict v = judged(scene, pipeline, wrong);
    CAPTURE(verdict_json(v));
    CHECK(v.violations() == 0);
    CHECK(v.convicted());
  }
}
