// One image a scene and pipeline, whatever draws it: threads, tiles, SIMD targets, culling, order of tiles, the
// caller's floating-point environment; and, since the hashes stand in the source, compilers and machines.
#include <algorithm>
#include <array>
#include <cfenv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/golden/frames.h"

using namespace trueshade;

namespace {

constexpr int kThreads[] = {1, 2, 3, 8, 32}, kTiles[] = {8, 16, 32, 48, 64};

// What a host may have done to this thread before it calls us.
enum class Host { as_is, flushing, upward, toward_zero };
constexpr Host kHosts[] = {Host::as_is, Host::flushing, Host::upward, Host::toward_zero};

class HostScope {
 public:
  explicit HostScope(Host host) {
    std::fegetenv(&saved_);
    if (host == Host::upward) std::fesetround(FE_UPWARD);
    if (host == Host::toward_zero) std::fesetround(FE_TOWARDZERO);
#if defined(__x86_64__)
    if (host == Host::flushing) _mm_setcsr(_mm_getcsr() | 0x8040);  // FTZ and DAZ
#endif
  }
  ~HostScope() { std::fesetenv(&saved_); }

 private:
  std::fenv_t saved_;
};

struct Way {
  Execution execution;
  Host host = Host::as_is;
};

// A way from one number per choice; `choice` holds indices into the lists above.
constexpr int kChoices = 10;
using Choice = std::array<int, kChoices>;

Choice choice_counts(size_t targets) { return {5, 5, int(targets), 4, 2, 2, 2, 2, 2, 2}; }

Way way(const Choice& c, const std::vector<std::string_view>& targets) {
  Way out;
  out.execution = {kThreads[c[0]], kTiles[c[1]], targets[size_t(c[2])], c[4] == 0, c[5] == 0, c[6] == 1, c[7] == 0};
  out.execution.fast_geometry = c[8] == 0;
  out.execution.bounded_codes = c[9] == 0;
  out.host = kHosts[c[3]];
  return out;
}

// Choices such that any two values of any two choices meet at least once. Greedy over a fixed pseudo-random sequence.
std::vector<Choice> pairwise(const Choice& counts) {
  std::vector<Choice> picked;
  std::vector<char> met(kChoices * kChoices * 8 * 8, 0);
  const auto slot = [&](int a, int va, int b, int vb) { return ((a * kChoices + b) * 8 + va) * 8 + vb; };
  uint64_t state = 1;
  const auto random = [&](int n) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return int((state >> 33) % uint64_t(n));
  };
  for (;;) {
    Choice best{};
    int most = 0;
    for (int attempt = 0; attempt < 200; ++attempt) {
      Choice c;
      for (size_t i = 0; i < kChoices; ++i) c[i] = random(counts[i]);
      int fresh = 0;
      for (int a = 0; a < kChoices; ++a)
        for (int b = a + 1; b < kChoices; ++b) fresh += !met[size_t(slot(a, c[size_t(a)], b, c[size_t(b)]))];
      if (fresh > most) most = fresh, best = c;
    }
    if (most == 0) return picked;
    for (int a = 0; a < kChoices; ++a)
      for (int b = a + 1; b < kChoices; ++b) met[size_t(slot(a, best[size_t(a)], b, best[size_t(b)]))] = 1;
    picked.push_back(best);
  }
}

bool is_dense(std::string_view scene) {
  return scene == "builtin:rabbits" || scene == "builtin:red" || scene.starts_with("builtin:atrium");
}

void check(const PreparedScene& scene, const GoldenFrame& golden, const Way& way) {
  Pipeline pipeline = *preset_pipeline(golden.preset);
  pipeline.width = golden.width;
  pipeline.height = golden.height;
  const HostScope host(way.host);
  const Frame frame = render_frame(scene, pipeline, way.execution);
  INFO(golden.scene << " " << golden.preset << ": threads " << way.execution.threads << ", tile " << way.execution.tile
                    << ", " << way.execution.simd << ", light culling " << way.execution.light_culling
                    << ", geometry culling " << way.execution.geometry_culling << ", shuffled "
                    << way.execution.shuffle_tiles << ", compiled models " << way.execution.compiled_models
                    << ", fast geometry " << way.execution.fast_geometry << ", bounded codes "
                    << way.execution.bounded_codes << ", host " << int(way.host));
  CHECK(image_hash(frame.color) == golden.hash);
}

// Without geometry culling each cluster is set up in each tile, so small tiles do not meet narrow vectors there, nor
// millions of triangles any but large tiles and wide vectors: that takes minutes a frame.
Way affordable(Way w, bool dense) {
  if (w.execution.geometry_culling) return w;
  const bool narrow = w.execution.simd == "scalar" || w.execution.simd == "sse4";
  w.execution.tile = std::max(w.execution.tile, narrow ? 48 : 16);
  if (dense) w.execution.tile = 64, w.execution.simd = "best";
  return w;
}

}  // namespace

TEST_CASE("every built-in scene has one hash over pairs of all ways to draw it", "[determinism][slow]") {
  const std::vector<std::string_view> targets = simd_targets();
  const std::vector<Choice> ways = pairwise(choice_counts(targets.size()));
  std::string loaded;
  Scene scene;
  std::optional<PreparedScene> prepared;
  std::map<std::string_view, size_t> share_of;  // the next frame of a scene
  for (const GoldenFrame& golden : kGoldenFrames) {
    if (golden.width != 200) continue;
    if (loaded != golden.scene) {
      scene = load_scene(std::string(golden.scene));
      prepared.emplace(scene);
      loaded = golden.scene;
    }
    // A scene's frames share its ways: every third each, and every eighth of millions of triangles. The nine presets
    // begin with another one each, and every scene with another preset.
    const bool dense = is_dense(golden.scene);
    const size_t shares = dense ? 8 : 3;
    const size_t share = share_of.try_emplace(golden.scene, share_of.size()).first->second++ % shares;
    for (size_t n = share; n < ways.size(); n += shares)
      check(*prepared, golden, affordable(way(ways[n], targets), dense));
  }
}

TEST_CASE("every built-in scene has one hash over the whole matrix", "[determinism][long]") {
  const std::vector<std::string_view> targets = simd_targets();
  const Choice counts = choice_counts(targets.size());
  for (const GoldenFrame& golden : kGoldenFrames) {
    if (golden.width != 200) continue;
    const Scene scene = load_scene(std::string(golden.scene));
    const PreparedScene prepared(scene);
    Choice c{};
    for (c[0] = 0; c[0] < counts[0]; ++c[0])
      for (c[1] = 0; c[1] < counts[1]; ++c[1])
        for (c[2] = 0; c[2] < counts[2]; ++c[2])
          for (c[4] = 0; c[4] < counts[4]; ++c[4])
            for (c[5] = 0; c[5] < counts[5]; ++c[5]) {
              if (is_dense(golden.scene) && c[5] == 1 && kTiles[c[1]] != 64) continue;
              c[3] = (c[0] + c[1] + c[2]) % counts[3];
              c[6] = (c[1] + c[4]) % counts[6];
              c[7] = (c[1] + c[5]) % counts[7];
              c[8] = (c[0] + c[1] + c[4]) % counts[8];
              c[9] = (c[2] + c[4] + c[5]) % counts[9];
              check(prepared, golden, way(c, targets));
            }
  }
}

TEST_CASE("every built-in scene at 800x800 has one hash over pairs of all ways to draw it", "[determinism][long]") {
  const std::vector<std::string_view> targets = simd_targets();
  const std::vector<Choice> ways = pairwise(choice_counts(targets.size()));
  for (const GoldenFrame& golden : kGoldenFrames) {
    if (golden.width == 200) continue;
    const Scene scene = load_scene(std::string(golden.scene));
    const PreparedScene prepared(scene);
    for (const Choice& choice : ways) check(prepared, golden, affordable(way(choice, targets), is_dense(golden.scene)));
  }
}

TEST_CASE("more than nine in ten of city's pixel-light pairs are culled, and not one bit changes",
          "[determinism][culling]") {
  const Scene scene = load_scene("builtin:city");
  const PreparedScene prepared(scene);
  const Pipeline pipeline = *preset_pipeline("many-lights");
  Execution brute;
  brute.light_culling = false;
  const Frame culled = render_frame(prepared, pipeline), all = render_frame(prepared, pipeline, brute);
  CHECK(image_hash(culled.color) == image_hash(all.color));
  CHECK(culled.stats.lit_pixel_lights == all.stats.lit_pixel_lights);
  CHECK(culled.stats.tile_pixel_lights * 10 < culled.stats.pixel_lights);
  CHECK(culled.stats.evaluated_pixel_lights * 50 < culled.stats.pixel_lights);
  CHECK(all.stats.tile_pixel_lights == all.stats.pixel_lights);
}

TEST_CASE("the benchmark scenes are as hard as they are meant to be", "[scenes]") {
  struct Bar {
    const char* scene;
    double covered, lit;
  };
  const Bar bar = GENERATE(Bar{"builtin:city", 0.74, 2.1}, Bar{"builtin:rabbits", 0.64, 2.8},
                           Bar{"builtin:sphere", 0.48, 16.0}, Bar{"builtin:red", 0.56, 4.2});
  const Scene scene = load_scene(bar.scene);
  const FrameStats stats = render_frame(scene, *preset_pipeline("many-lights")).stats;
  INFO(bar.scene);
  CHECK(double(stats.covered_pixels) >= bar.covered * double(stats.pixels));
  CHECK(double(stats.lit_pixel_lights) >= bar.lit * double(stats.covered_pixels));
  CHECK(double(stats.tile_pixel_lights) >=
        2.0 * double(stats.lit_pixel_lights));  // and several times as many in its tile
}
