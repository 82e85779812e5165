#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "scenes/pipeline.h"

namespace trueshade {
namespace {

void require(bool holds, const char* field, const std::string& found, const char* range) {
  if (!holds) throw Error(ErrorKind::usage, field, found + " is out of range", range);
}

void require_integer(int value, int least, int most, const char* field, const char* range) {
  require(value >= least && value <= most, field, std::to_string(value), range);
}

void require_real(float value, float least, float most, const char* field, const char* range) {
  require(value >= least && value <= most, field, std::to_string(value), range);  // false for NaN
}

template <typename Enum>
void require_enumerator(Enum value, Enum last, const char* field) {
  require(value <= last, field, std::to_string(int(value)), "an enumerator of its type");
}

void require_format(Format format, std::span<const Format> allowed, const char* field) {
  std::string names;
  for (const Format f : allowed)
    names += (names.empty() ? "" : f == allowed.back() ? " or " : ", ") + std::string(info(f).name);
  require(std::find(allowed.begin(), allowed.end(), format) != allowed.end(), field, std::string(info(format).name),
          names.c_str());
}

void check_geometry(const GeometryState& g) {
  require(g.viewport.width >= 0 && g.viewport.height >= 0, "geometry.viewport",
          std::to_string(g.viewport.width) + " x " + std::to_string(g.viewport.height), "width and height at least 0");
  require_real(g.depth_near, 0.0f, 1.0f, "geometry.depth_near", "0 to 1");
  require_real(g.depth_far, 0.0f, 1.0f, "geometry.depth_far", "0 to 1");
  require_real(g.clear_depth, 0.0f, 1.0f, "geometry.clear_depth", "0 to 1");
  require_enumerator(g.depth_func, DepthFunc::always, "geometry.depth_func");
  require_enumerator(g.cull_face, CullFace::front_and_back, "geometry.cull_face");
  require_enumerator(g.front_face, FrontFace::cw, "geometry.front_face");
  require_enumerator(g.clip_origin, ClipOrigin::upper_left, "geometry.clip_origin");
  require_enumerator(g.clip_depth, ClipDepth::zero_to_one, "geometry.clip_depth");
  require_enumerator(g.provoking, Provoking::first, "geometry.provoking");
}

void check_gbuffer(const GBufferState& g) {
  require_format(g.position.format, kPositionFormats, "gbuffer.position.format");
  require_format(g.normal.format, kNormalFormats, "gbuffer.normal.format");
  require_format(g.uv.format, kPositionFormats, "gbuffer.uv.format");
  require_format(g.albedo.format, kAlbedoFormats, "gbuffer.albedo.format");
  for (const PlaneState* plane : {&g.position, &g.normal, &g.albedo, &g.uv})
    require_enumerator(plane->interpolation, Interpolation::noperspective, "gbuffer: interpolation");
  require_enumerator(g.half_round, HalfRound::nearest, "gbuffer.half_round");
}

void check_light_model(const LightModel& m) {
  require_real(m.shininess, 0.0f, 1e18f, "light_model.shininess", "0 to 1e18");
  for (int k = 0; k < 3; ++k)
    require_real(m.specular_color[k], 0.0f, 1e18f, "light_model.specular_color", "each 0 to 1e18");
  require_enumerator(m.falloff, Falloff::quadratic, "light_model.falloff");
  require_enumerator(m.order, TermOrder::separate, "light_model.order");
}

}  // namespace

void validate(const Pipeline& pipeline) {
  require_integer(pipeline.width, 1, 65536, "width", "1 to 65536 pixels");
  require_integer(pipeline.height, 1, 65536, "height", "1 to 65536 pixels");
  check_geometry(pipeline.geometry);
  check_gbuffer(pipeline.gbuffer);
  check_light_model(pipeline.light_model);
  require_enumerator(pipeline.strategy, Strategy::deferred_loop, "strategy");
  require_format(pipeline.target, kTargetFormats, "target");
  require_enumerator(pipeline.profile, NumericProfile::mesa_llvmpipe_22_3, "profile");
  if (!profile_has(pipeline.profile, pipeline.target))
    throw Error(ErrorKind::usage, "target",
                std::string(profile_name(pipeline.profile)) + " does not promise the bits of " +
                    std::string(info(pipeline.target).name),
                "use the profile ideal, or a target it promises: rgba8, rgba16f, rgba32f");
  require(!pipeline.gbuffer.position_from_depth || pipeline.geometry.depth_near != pipeline.geometry.depth_far,
          "gbuffer.position_from_depth", "a depth range of one value", "depth_near and depth_far that differ");
}

void validate(const Execution& execution) {
  require_integer(execution.threads, 0, 1024, "threads", "0 to 1024; 0 is one a core");
  constexpr int kTiles[] = {8, 16, 32, 48, 64};
  require(std::find(std::begin(kTiles), std::end(kTiles), execution.tile) != std::end(kTiles), "tile",
          std::to_string(execution.tile), "8, 16, 32, 48 or 64");
  constexpr std::string_view kSimd[] = {"best", "scalar", "sse4", "avx2", "avx512"};
  require(std::find(std::begin(kSimd), std::end(kSimd), execution.simd) != std::end(kSimd), "simd",
          "'" + std::string(execution.simd) + "'", "best, scalar, sse4, avx2 or avx512");
}

}  // namespace trueshade
