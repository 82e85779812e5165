#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/threads/parallel_for.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/pipeline/program_inputs.h"

namespace trueshade {
namespace {

// Every frame's values are looked at: numbers become text, and texts one, only where one is refused.
[[noreturn]] void refuse(const std::string& field, const std::string& found, const std::string& range) {
  throw Error(ErrorKind::usage, field, found + " is out of range", range);
}

void require(bool holds, const char* field, const char* found, const char* range) {
  if (!holds) refuse(field, found, range);
}

void require_integer(int value, int least, int most, const char* field, const char* range) {
  if (!(value >= least && value <= most)) refuse(field, std::to_string(value), range);
}

void require_real(float value, float least, float most, const char* field, const char* range,
                  const char* of_field = "") {
  if (!(value >= least && value <= most))  // a NaN too
    refuse(std::string(field) + of_field, std::to_string(value), range);
}

template <typename Enum>
void require_enumerator(Enum value, Enum last, const char* field, const char* of_field = "") {
  if (value > last) refuse(std::string(field) + of_field, std::to_string(int(value)), "an enumerator of its type");
}

void require_format(Format format, std::span<const Format> allowed, const char* field) {
  if (std::find(allowed.begin(), allowed.end(), format) != allowed.end()) return;
  std::string names;
  for (const Format f : allowed)
    names += (names.empty() ? "" : f == allowed.back() ? " or " : ", ") + std::string(info(f).name);
  refuse(field, std::string(info(format).name), names);
}

void check_geometry(const GeometryState& g) {
  if (g.viewport.width < 0 || g.viewport.height < 0)
    refuse("geometry.viewport", std::to_string(g.viewport.width) + " x " + std::to_string(g.viewport.height),
           "width and height at least 0");
  require_real(g.depth_near, 0.0f, 1.0f, "geometry.depth_near", "0 to 1");
  require_real(g.depth_far, 0.0f, 1.0f, "geometry.depth_far", "0 to 1");
  require_real(g.clear_depth, 0.0f, 1.0f, "geometry.clear_depth", "0 to 1");
  require_enumerator(g.depth_func, DepthFunc::always, "geometry.depth_func");
  require_enumerator(g.cull_face, CullFace::front_and_back, "geometry.cull_face");
  require_enumerator(g.front_face, FrontFace::cw, "geometry.front_face");
  require_enumerator(g.clip_origin, ClipOrigin::upper_left, "geometry.clip_origin");
  require_enumerator(g.clip_depth, ClipDepth::zero_to_one, "geometry.clip_depth");
  require_enumerator(g.provoking, Provoking::first, "geometry.provoking");
  require_format(g.depth_format, kDepthFormats, "geometry.depth_format");
  require_real(g.polygon_offset_factor, -1e18f, 1e18f, "geometry.polygon_offset_factor", "-1e18 to 1e18");
  require_real(g.polygon_offset_units, -1e18f, 1e18f, "geometry.polygon_offset_units", "-1e18 to 1e18");
}

void check_gbuffer(const GBufferState& g) {
  require_format(g.position.format, kPositionFormats, "gbuffer.position.format");
  require_format(g.normal.format, kNormalFormats, "gbuffer.normal.format");
  require_format(g.uv.format, kPositionFormats, "gbuffer.uv.format");
  require_format(g.albedo.format, kAlbedoFormats, "gbuffer.albedo.format");
  for (const PlaneState* plane : {&g.position, &g.normal, &g.albedo, &g.uv})
    require_enumerator(plane->interpolation, Interpolation::noperspective, "gbuffer: interpolation");
  require_format(g.specular, kSpecularFormats, "gbuffer.specular");
  require_format(g.emission, kEmissionFormats, "gbuffer.emission");
  require_enumerator(g.unit_normals, UnitNormals::both, "gbuffer.unit_normals");
  require_enumerator(g.half_round, HalfRound::nearest, "gbuffer.half_round");
}

void check_light_model(const LightModel& m) {
  require_real(m.shininess, 0.0f, 1e18f, "light_model.shininess", "0 to 1e18");
  for (int k = 0; k < 3; ++k)
    require_real(m.specular_color[k], 0.0f, 1e18f, "light_model.specular_color", "each 0 to 1e18");
  require_enumerator(m.falloff, Falloff::inverse_square, "light_model.falloff");
  require_enumerator(m.order, TermOrder::with_ambient, "light_model.order");
  require_enumerator(m.cone, Cone::squared_penumbra, "light_model.cone");
  require_enumerator(m.diffuse, Diffuse::unclamped, "light_model.diffuse");
  require_enumerator(m.specular, Specular::none, "light_model.specular");
  require_enumerator(m.specular_source, SpecularSource::metallic_roughness, "light_model.specular_source");
  require_enumerator(m.viewer, Viewer::infinite, "light_model.viewer");
  for (int k = 0; k < 3; ++k)
    require_real(m.global_ambient[k], 0.0f, 1e18f, "light_model.global_ambient", "each 0 to 1e18");
  require_real(m.damping, 0.0f, 1e18f, "light_model.damping", "0 to 1e18");
}

void check_order(const LightModel& m) {
  require(
      m.order != TermOrder::albedo_last || m.specular == Specular::none || m.specular_source == SpecularSource::albedo,
      "light_model.order", "albedo_last with a specular colour that is not the albedo",
      "specular none or specular_source albedo");
}

void check_light_volumes(const LightVolumes& v) {
  require_enumerator(v.point, LightExtent::cone, "light_volumes.point");
  require_enumerator(v.spot, LightExtent::cone, "light_volumes.spot");
  require_integer(v.slices, 3, 64, "light_volumes.slices", "3 to 64");
  require_integer(v.stacks, 2, 64, "light_volumes.stacks", "2 to 64");
  require_enumerator(v.cull_face, CullFace::front_and_back, "light_volumes.cull_face");
}

void check_blend(const BlendState& b, const char* field) {
  for (const BlendTerm& term : {b.rgb, b.alpha}) {
    require_enumerator(term.equation, BlendEquation::max, field, ": equation");
    require_enumerator(term.src, BlendFactor::src_alpha_saturate, field, ": src");
    require_enumerator(term.dst, BlendFactor::src_alpha_saturate, field, ": dst");
  }
  for (const float constant : b.constant)
    require_real(constant, -1e18f, 1e18f, field, "each -1e18 to 1e18", ".constant");
}

void check_transparency(const Pipeline& p) {
  const TransparencyState& t = p.transparency;
  require_enumerator(t.mode, TransparencyMode::after_lights, "transparency.mode");
  check_blend(t.blend, "transparency.blend");
  if (t.mode != TransparencyMode::into_albedo) return;
  if (is_forward(p.strategy))
    throw Error(ErrorKind::usage, "transparency.mode",
                "into-albedo blends into the G-buffer, which " + std::string(name_of(p.strategy)) + " has not",
                "after-lights, or a deferred strategy");
}

void check_post(const PostChain& p) {
  require_integer(p.samples, 1, 8, "post.samples", "1 to 8");
  require_real(p.marker_radius, 0.0f, 1e18f, "post.marker_radius", "0 to 1e18");
  require_real(p.bloom.strength, 0.0f, 1000.0f, "post.bloom.strength", "0 to 1000");
  require_real(p.bloom.threshold, 0.0f, 1e18f, "post.bloom.threshold", "0 to 1e18");
  require_integer(p.bloom.radius, 1, 14, "post.bloom.radius", "1 to 14");
  require_integer(p.bloom.passes, 1, 64, "post.bloom.passes", "1 to 64");
  require_enumerator(p.tone_map, PostChain::ToneMap::reinhard, "post.tone_map");
  require_real(p.key, 1e-6f, 1e6f, "post.key", "1e-6 to 1e6");
  if (p.white != 0.0f) require_real(p.white, 1e-6f, 1e18f, "post.white", "0, or 1e-6 to 1e18");
  require_real(p.log_offset, 1e-12f, 1e6f, "post.log_offset", "1e-12 to 1e6");
  require_enumerator(p.encode, PostChain::Encode::srgb, "post.encode");
  require_format(p.output, kPostOutputs, "post.output");
}

}  // namespace

void validate(const Pipeline& pipeline) {
  const FpScope fp;
  require_integer(pipeline.width, 1, kMostPictureSide, "width", "1 to 1048576 pixels");
  require_integer(pipeline.height, 1, kMostPictureSide, "height", "1 to 1048576 pixels");
  check_geometry(pipeline.geometry);
  check_gbuffer(pipeline.gbuffer);
  check_light_model(pipeline.light_model);
  if (!pipeline.light_program.used()) check_order(pipeline.light_model);
  check_light_volumes(pipeline.light_volumes);
  check_blend(pipeline.blend, "blend");
  check_transparency(pipeline);
  require_enumerator(pipeline.strategy, Strategy::deferred_loop, "strategy");
  require_format(pipeline.target, kTargetFormats, "target");
  require_enumerator(pipeline.profile, NumericProfile::mesa_llvmpipe_22_3, "profile");
  check_post(pipeline.post);
  require_enumerator(pipeline.view, ImageView::overdraw, "view");
  require(!pipeline.gbuffer.position_from_depth || pipeline.geometry.depth_near != pipeline.geometry.depth_far,
          "gbuffer.position_from_depth", "a depth range of one value", "depth_near and depth_far that differ");
}

void require_no_light_program(const Pipeline& pipeline, std::string_view what) {
  if (pipeline.light_program.used())
    throw Error(ErrorKind::usage, pipeline.light_program.file, std::string(what) + " takes no light program",
                "leave --light-shader out");
}

int tile_for(int width, int height, int threads) {
  const auto tiles = [](int side) { return uint64_t(side + 63) / 64; };
  return tiles(width) * tiles(height) < 8 * uint64_t(thread_count(threads)) ? 32 : 64;
}

void validate_region(const Pipeline& pipeline, const PictureRegion& region) {
  const auto within = [](int first, int size, int most) { return first >= 0 && size >= 1 && first <= most - size; };
  if (!region.whole() &&
      !(within(region.x, region.width, pipeline.width) && within(region.y, region.height, pipeline.height)))
    refuse("region",
           std::to_string(region.x) + ',' + std::to_string(region.y) + ',' + std::to_string(region.width) + 'x' +
               std::to_string(region.height),
           "X,Y,WxH within the picture of " + std::to_string(pipeline.width) + 'x' + std::to_string(pipeline.height) +
               " pixels");
}

void validate_drawn_size(const Pipeline& pipeline, const PictureRegion& region) {
  const PictureRegion drawn = drawn_region(pipeline, region);
  if (std::max(drawn.width, drawn.height) > kMostDrawnSide)
    refuse(region.whole() ? "size" : "region", std::to_string(drawn.width) + 'x' + std::to_string(drawn.height),
           "at most 65536 pixels a side are drawn at once; a larger picture is drawn by regions");
}

void validate(const Execution& execution) {
  const FpScope fp;
  require_integer(execution.threads, 0, 1024, "threads", "0 to 1024; 0 is one a core");
  constexpr int kTiles[] = {0, 8, 16, 32, 48, 64};
  if (std::find(std::begin(kTiles), std::end(kTiles), execution.tile) == std::end(kTiles))
    refuse("tile", std::to_string(execution.tile), "8, 16, 32, 48 or 64; 0 is by size and threads");
  constexpr std::string_view kSimd[] = {"best", "scalar", "sse4", "avx2", "avx512"};
  if (std::find(std::begin(kSimd), std::end(kSimd), execution.simd) == std::end(kSimd))
    refuse("simd", "'" + std::string(execution.simd) + "'", "best, scalar, sse4, avx2 or avx512");
}

}  // namespace trueshade
