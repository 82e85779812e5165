// Judging some rows says of them what judging all rows says; a profile that is inferred from some is that of all.
#include "gl/driver/renderer.h"
#include "judge/bounds/window.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"
#include "tests/judge/random_scene.h"

using namespace trueshade;
using namespace trueshade::oracle;
using trueshade::testing::captured;

namespace {

/// 9 bands, the last of them of 8 rows.
Pipeline pipeline_of(Strategy strategy) {
  Pipeline p;
  p.strategy = strategy;
  p.width = 96, p.height = 136;
  p.gbuffer.normal.format = Format::rgba16f;
  return testing::with_surface_planes(p);
}

JudgedRows only(int band, int height) {
  std::vector<uint8_t> bands(size_t(JudgedRows::bands_of(height)), 0);
  bands[size_t(band)] = 1;
  return JudgedRows(bands);
}

void check_same(const Inference& a, const Inference& b) {
  INFO(text(a));
  INFO(text(b));
  CHECK(a.subpixel_bits == b.subpixel_bits);
  CHECK(a.snap == b.snap);
  CHECK(a.plane_origin == b.plane_origin);
  CHECK(a.half == b.half);
  CHECK(a.unorm_reach == b.unorm_reach);
  CHECK(a.known_as == b.known_as);
}

void check_inference(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  const Inference whole = infer_profile(scene, pipeline, capture, JudgedRows());
  CHECK(whole.sampled_rows == 0);
  for (const int band : {0, 4, 8}) {
    const Inference sampled = infer_profile(scene, pipeline, capture, only(band, pipeline.height));
    CAPTURE(band);
    check_same(sampled, whole);
  }
}

void check_sampled_rows(GlDriver which) {
  const GlContext* context = testing::opened(which);
  if (context == nullptr) return;
  for (const char* name : {"circle", "cornell"})
    for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
      const Scene scene = builtin_scene(name);
      const Pipeline pipeline = pipeline_of(strategy);
      CAPTURE(name, name_of(strategy));
      check_inference(scene, pipeline, GlRenderer(*context, scene).draw(pipeline).capture);
    }
}

}  // namespace

TEST_CASE("Bands of rows, judged each by itself, have the classes of the whole image") {
  const Scene scene = builtin_scene("city,lights=20,objects=120");
  Profile unknown;
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes, Strategy::forward_multipass}) {
    const Pipeline pipeline = pipeline_of(strategy);
    Capture capture = captured(scene, pipeline);
    for (int x = 10; x < 40; ++x) capture.color.set_code(x, 70, 1, 255);
    const auto judge = [&](const JudgedRows& rows) {
      return std::array{judge_gbuffer(scene, pipeline, unknown, capture, rows),
                        judge_lighting(scene, pipeline, unknown, capture, rows)};
    };
    const auto whole = judge({});
    CHECK(whole[1].count(PixelClass::violation) > 0);
    for (int band = 0; band < JudgedRows::bands_of(pipeline.height); ++band) {
      const auto part = judge(only(band, pipeline.height));
      const size_t first = size_t(band) * 16 * 96, last = std::min(first + 16 * 96, whole[0].classes.size());
      for (size_t s = 0; s < 2; ++s) {
        CAPTURE(name_of(strategy), band, s);
        CHECK(std::equal(whole[s].classes.begin() + int64_t(first), whole[s].classes.begin() + int64_t(last),
                         part[s].classes.begin() + int64_t(first)));
        uint64_t counted = 0;
        for (const uint64_t c : part[s].counts) counted += c;
        CHECK(counted == last - first);
      }
    }
  }
}

namespace {

/// Profiles as inference guesses them, and the named ones.
std::vector<Profile> guesses() {
  std::vector<Profile> all;
  for (const char* name : {"ideal", "mesa-llvmpipe-22.3", "d3d-class", "vulkan"}) all.push_back(*profile_named(name));
  Profile loose;
  loose.subpixel_bits = 8;
  all.push_back(loose);
  for (const SnapRule rule : {SnapRule::nearest, SnapRule::toward_zero, SnapRule::nearest_0_6}) {
    all.push_back(loose);
    all.back().snap = rule;
  }
  for (const PlaneOrigin origin : {PlaneOrigin::snapped, PlaneOrigin::unsnapped}) {
    all.push_back(loose);
    all.back().plane_origin = origin;
  }
  for (const HalfStore half : {HalfStore::toward_zero, HalfStore::nearest}) {
    all.push_back(loose);
    all.back().half = half;
  }
  all.push_back(loose);
  all.back().unorm_reach = 0.5;
  return all;
}

std::vector<bool> violations_in(const StageVerdict& v) {
  std::vector<bool> found;
  for (const PixelClass c : v.classes) found.push_back(c == PixelClass::violation);
  return found;
}

/// A capture with a code of every 37th pixel changed, planes in turn.
Capture with_faults(Capture capture) {
  const auto change = [](Image& image, uint32_t by) {
    for (int i = int(by); i < image.width * image.height; i += 37) {
      const int x = i % image.width, y = i / image.width, k = i % info(image.format).channels;
      image.set_code(x, y, k, image.code(x, y, k) ^ by);
    }
  };
  change(capture.color, 1);
  for (size_t i = 0; i < capture.planes.size(); ++i) change(capture.planes[i].image, 2 + uint32_t(i));
  return capture;
}

/// Of the guesses every other one. Counts how many pixels are violations of some guess and none of the base.
int check_guesses(const Scene& scene, const Pipeline& pipeline, const Capture& capture, size_t turn) {
  JudgedBefore before;
  const StageVerdict base = judge_gbuffer(scene, pipeline, before.profile, capture, {}, &before.found);
  const StageVerdict lit = judge_lighting(scene, pipeline, before.profile, capture);
  before.lighting = &lit;
  int refused = 0;
  const std::vector<Profile> all = guesses();
  for (size_t g = turn % 2; g < all.size(); g += 2) {
    const Profile& guess = all[g];
    CAPTURE(guess.name, text(guess.snap), text(guess.plane_origin), text(guess.half));
    const std::vector<bool> surfaces = violations_in(judge_gbuffer(scene, pipeline, guess, capture));
    const std::vector<bool> lights = violations_in(judge_lighting(scene, pipeline, guess, capture));
    for (const JudgedBefore* known : {static_cast<const JudgedBefore*>(nullptr), &std::as_const(before)}) {
      CAPTURE(known != nullptr);
      CHECK(violations_in(gbuffer_violations(scene, pipeline, guess, capture, {}, known)) == surfaces);
      CHECK(violations_in(lighting_violations(scene, pipeline, guess, capture, {}, known)) == lights);
    }
    for (size_t i = 0; i < surfaces.size(); ++i)
      refused += (surfaces[i] && base.classes[i] != PixelClass::violation) ||
                 (lights[i] && lit.classes[i] != PixelClass::violation);
  }
  return refused;
}

}  // namespace

TEST_CASE("Violations asked beside a looser judgement are those of a judgement of its own", "[slow]") {
  constexpr Format kTargets[] = {Format::rgba8, Format::rgba16f, Format::srgb8_a8, Format::rgba32f};
  int refused = 0;
  size_t turn = 0;
  for (const char* name : {"city,lights=20,objects=120", "circle", "lecture,lights=4"})
    for (const bool turned : {false, true}) {
      const Scene scene = builtin_scene(name);
      Pipeline pipeline = pipeline_of(Strategy::deferred_loop);
      pipeline.width = 40, pipeline.height = 24;
      pipeline.target = kTargets[turn++ % 4];
      if (turned) {  // other ways of testing depth
        pipeline.geometry.depth_func = DepthFunc::lequal;
        pipeline.geometry.polygon_offset_factor = 1, pipeline.geometry.polygon_offset_units = 2;
        pipeline.gbuffer.half_round = HalfRound::nearest;
      }
      CAPTURE(name, info(pipeline.target).name, turned);
      const Capture capture = captured(scene, pipeline);
      refused += check_guesses(scene, pipeline, capture, turn);
      refused += check_guesses(scene, pipeline, with_faults(capture), turn / 2);
    }
  CHECK(refused > 100);
}

namespace {

/// A scene with glass, with textured materials whose alpha test drops texels, or with both.
Scene scene_with_holes(Pcg32& random, bool glass, bool masks) {
  Scene scene;
  const auto suits = [&] {
    const Material& m = scene.materials[1];
    return m.transparent == glass && m.color_map.used() == masks;
  };
  do scene = testing::random_scene(random);
  while (!suits());
  if (masks) scene.materials[2].alpha_cutoff = 0.7f;
  for (size_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].material = uint32_t(i % 3);
  return scene;
}

}  // namespace

TEST_CASE("Violations asked beside a looser judgement are its own where there is glass and where masks drop texels",
          "[slow]") {
  int refused = 0;
  size_t turn = 0, in_albedo = 0, masked = 0;
  Pcg32 random(11);
  for (const bool glass : {true, false, true})
    for (const TransparencyMode mode :
         {TransparencyMode::into_albedo, TransparencyMode::after_lights, TransparencyMode::none}) {
      const Scene scene = scene_with_holes(random, glass, !glass || turn >= 6);
      Pipeline pipeline = testing::random_pipeline(random);
      pipeline.strategy = Strategy::deferred_loop;
      pipeline.transparency.mode = mode;
      const Capture capture = captured(scene, pipeline);
      in_albedo += glass && mode == TransparencyMode::into_albedo;
      masked += scene.materials[2].masked();
      CAPTURE(turn, glass, int(mode));
      refused += check_guesses(scene, pipeline, capture, turn);
      refused += check_guesses(scene, pipeline, with_faults(capture), turn++ / 2);
    }
  CHECK(refused > 100);
  CHECK(in_albedo > 0);
  CHECK(masked > 0);
}

TEST_CASE("The profile inferred from one band of our own frames is that of the whole image") {
  const Scene scene = builtin_scene("circle");
  for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
    const Pipeline pipeline = pipeline_of(strategy);
    check_inference(scene, pipeline, captured(scene, pipeline));
  }
}

TEST_CASE("The profile inferred from one band of what llvmpipe draws is that of the whole image") {
  check_sampled_rows(GlDriver::llvmpipe);
}

TEST_CASE("The profile inferred from one band of what softpipe draws is that of the whole image") {
  check_sampled_rows(GlDriver::softpipe);
}

TEST_CASE("A wrong pixel outside of the sample is known to every profile that is inferred") {
  const Scene scene = builtin_scene("circle");
  const Pipeline pipeline = pipeline_of(Strategy::deferred_loop);
  Capture capture = captured(scene, pipeline);
  capture.color.set_code(48, 68, 0, capture.color.code(48, 68, 0) ^ 0x40u);
  const Inference found = infer_profile(scene, pipeline, capture, only(0, pipeline.height));
  CHECK(found.known_as.empty());
  CHECK(found.sampled_rows > 16);
  check_same(found, infer_profile(scene, pipeline, capture, JudgedRows()));
}

TEST_CASE("What a box of samples is told of its coverage is true of each of its samples") {
  Pcg32 random(7);
  const auto number = [&](double low, double high) { return double(random.between(low, high)); };
  int decided = 0;
  for (int i = 0; i < 3000; ++i) {
    Piece piece;
    const double span = i % 3 == 0 ? 4 : i % 3 == 1 ? 60 : 3000, reach = i % 2 == 0 ? 0.05 : 0;
    for (WindowVertex& v : piece.v)
      for (size_t k = 0; k < 2; ++k) {
        v.exact[k] = std::nearbyint(number(-span, span) * 256) / 256;
        v.low[k] = v.exact[k] - reach, v.high[k] = v.exact[k] + reach;
      }
    const auto &a = piece.v[0].exact, &b = piece.v[1].exact, &c = piece.v[2].exact;
    piece.sign = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0 ? -1 : 1;
    const double x0 = std::floor(number(-span, span)) + 0.5, y0 = std::floor(number(-span, span)) + 0.5;
    const BoxCoverage box = coverage_of_box(piece, {x0, y0}, {x0 + 7, y0 + 7});
    decided += box.none || box.edges == 0 ? 1 : 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const auto at = [&](unsigned edges) {
          return coverage_at(piece, Profile{}, ClipOrigin::lower_left, x0 + x, y0 + y, edges);
        };
        const Coverage all = at(7), some = at(box.edges);
        CHECK((!box.none || all.cover == Cover::no));
        if (box.none) continue;
        CHECK((some.cover == all.cover && some.uncertain_edges == all.uncertain_edges && some.nominal == all.nominal));
      }
  }
  CHECK(decided > 500);
}
