#include "scenes/pipeline/pipeline_json.h"

#include <vector>

#include "core/fp_env.h"
#include "scenes/pipeline/pipeline_words.h"
#include "scenes/pipeline/presets.h"

namespace trueshade {
namespace {

using namespace pipeline_words;

void read(const json::Node& node, bool& value) { value = node.boolean(); }

template <typename Enum>
void read_choice(const json::Node& object, std::string_view key, Enum& value, Names names) {
  if (const auto node = object.find(key)) value = Enum(node->choice(names));
}

void read_flag(const json::Node& object, std::string_view key, bool& value) {
  if (const auto node = object.find(key)) read(*node, value);
}

void read_real(const json::Node& object, std::string_view key, float& value, double least, double most) {
  if (const auto node = object.find(key)) value = node->real(least, most);
}

void read_integer(const json::Node& object, std::string_view key, int& value, int least, int most) {
  if (const auto node = object.find(key)) value = int(node->integer(least, most));
}

void read_format(const json::Node& object, std::string_view key, Format& format, std::span<const Format> allowed) {
  const auto node = object.find(key);
  if (!node) return;
  std::vector<std::string_view> names;
  for (const Format f : allowed) names.push_back(info(f).name);
  format = allowed[node->choice(names)];
}

void read_geometry(const json::Node& node, GeometryState& g) {
  node.check_keys(kPipelineJsonKeys[kGeometry]);
  if (const auto v = node.find("viewport")) {
    v->check_keys(kPipelineJsonKeys[kViewport]);
    read_integer(*v, "x", g.viewport.x, INT32_MIN, INT32_MAX);
    read_integer(*v, "y", g.viewport.y, INT32_MIN, INT32_MAX);
    read_integer(*v, "width", g.viewport.width, 0, INT32_MAX);
    read_integer(*v, "height", g.viewport.height, 0, INT32_MAX);
  }
  read_real(node, "depth_near", g.depth_near, 0.0f, 1.0f);
  read_real(node, "depth_far", g.depth_far, 0.0f, 1.0f);
  read_choice(node, "depth_func", g.depth_func, kDepthFuncs);
  read_real(node, "clear_depth", g.clear_depth, 0.0f, 1.0f);
  read_flag(node, "depth_clamp", g.depth_clamp);
  read_choice(node, "cull_face", g.cull_face, kCullFaces);
  read_choice(node, "front_face", g.front_face, kFrontFaces);
  read_choice(node, "clip_origin", g.clip_origin, kClipOrigins);
  read_choice(node, "clip_depth", g.clip_depth, kClipDepths);
  read_choice(node, "provoking", g.provoking, kProvoking);
  read_format(node, "depth_format", g.depth_format, kDepthFormats);
  read_real(node, "polygon_offset_factor", g.polygon_offset_factor, -json::kLargest, json::kLargest);
  read_real(node, "polygon_offset_units", g.polygon_offset_units, -json::kLargest, json::kLargest);
}

void read_plane(const json::Node& gbuffer, std::string_view key, PlaneState& plane, std::span<const Format> allowed) {
  const auto node = gbuffer.find(key);
  if (!node) return;
  node->check_keys(kPipelineJsonKeys[kPlane]);
  read_format(*node, "format", plane.format, allowed);
  read_choice(*node, "interpolation", plane.interpolation, kInterpolations);
}

void read_gbuffer(const json::Node& node, GBufferState& g) {
  node.check_keys(kPipelineJsonKeys[kGBuffer]);
  read_plane(node, "position", g.position, kPositionFormats);
  read_plane(node, "normal", g.normal, kNormalFormats);
  read_plane(node, "albedo", g.albedo, kAlbedoFormats);
  read_plane(node, "uv", g.uv, kPositionFormats);
  read_format(node, "specular_format", g.specular, kSpecularFormats);
  read_format(node, "emission_format", g.emission, kEmissionFormats);
  read_choice(node, "unit_normals", g.unit_normals, kUnitNormals);
  read_flag(node, "position_from_depth", g.position_from_depth);
  read_choice(node, "half_round", g.half_round, kHalfRounds);
}

bool multiplies_albedo_last_but_reads_another(const LightModel& m) {
  return m.order == TermOrder::albedo_last && m.specular != Specular::none &&
         m.specular_source != SpecularSource::albedo;
}

void read_light_model(const json::Node& node, LightModel& m) {
  node.check_keys(kPipelineJsonKeys[kLightModel]);
  read_flag(node, "renormalize", m.renormalize);
  read_flag(node, "specular_masked", m.specular_masked);
  read_real(node, "shininess", m.shininess, 0.0f, json::kLargest);
  if (const auto color = node.find("specular_color")) m.specular_color = color->vec3(0.0f, json::kLargest);
  read_choice(node, "falloff", m.falloff, kFalloffs);
  read_choice(node, "order", m.order, kOrders);
  read_flag(node, "alpha_from_albedo", m.alpha_from_albedo);
  read_choice(node, "cone", m.cone, kCones);
  read_choice(node, "diffuse", m.diffuse, kDiffuses);
  read_choice(node, "specular", m.specular, kSpeculars);
  read_choice(node, "specular_source", m.specular_source, kSpecularSources);
  read_choice(node, "viewer", m.viewer, kViewers);
  read_flag(node, "emission", m.emission);
  if (const auto color = node.find("global_ambient")) m.global_ambient = color->vec3(0.0f, json::kLargest);
  read_real(node, "damping", m.damping, 0.0f, json::kLargest);
  read_flag(node, "clamp_result", m.clamp_result);
  if (multiplies_albedo_last_but_reads_another(m))
    node.fail("order albedo_last with a specular colour that is not the albedo",
              "specular none or specular_source albedo");
}

void read_light_program(const json::Node& node, LightProgram& program) {
  constexpr size_t kMostParameters = 256;
  node.check_keys(kPipelineJsonKeys[kLightProgram]);
  program = {node.member("file").string(), {}, {}, {}};
  if (program.file.empty()) node.fail("the file of a light program has no name", "its name");
  if (const auto sum = node.find("sha256")) program.sha256 = sum->string();
  const auto parameters = node.find("parameters");
  for (size_t i = 0; parameters && i < parameters->array(0, kMostParameters).size(); ++i) {
    const json::Node one = parameters->element(i);
    one.check_keys(kPipelineJsonKeys[kProgramParameter]);
    ProgramParameter& p = program.parameters.emplace_back(ProgramParameter{one.member("name").string(), {}});
    const json::Node value = one.member("value");
    for (size_t k = 0; k < value.array(1, 4).size(); ++k) p.value.push_back(value.element(k).real(-1e38, 1e38));
  }
}

/// A text that states a light model and no program means to draw by the model: the program of a preset makes room, and so
/// do the ends that it gives lights. A text that names both that preset and a model says two things.
void make_room_for_model(const json::Node& node, Pipeline& p) {
  const bool is_of_preset = !p.light_program.text.empty();  // of a text, no program has its own
  if (!is_of_preset || !node.find("light_model") || node.find("light_program")) return;
  if (node.find("preset"))
    node.fail("light_model beside the preset " + p.preset + ", which draws by a light program and reads none",
              "another preset, or light_program");
  p.light_program = {};
  p.light_volumes.point = p.light_volumes.spot = LightExtent::unbounded;
}

void read_light_volumes(const json::Node& node, LightVolumes& v) {
  node.check_keys(kPipelineJsonKeys[kLightVolumes]);
  read_choice(node, "point", v.point, kExtents);
  read_choice(node, "spot", v.spot, kExtents);
  read_integer(node, "slices", v.slices, 3, 64);
  read_integer(node, "stacks", v.stacks, 2, 64);
  read_choice(node, "cull_face", v.cull_face, kCullFaces);
  read_flag(node, "depth_clamp", v.depth_clamp);
  read_flag(node, "base", v.base);
}

void read_blend_term(const json::Node& blend, std::string_view key, BlendTerm& term) {
  const auto node = blend.find(key);
  if (!node) return;
  node->check_keys(kPipelineJsonKeys[kBlendTerm]);
  read_choice(*node, "equation", term.equation, kBlendEquationNames);
  read_choice(*node, "src", term.src, kBlendFactorNames);
  read_choice(*node, "dst", term.dst, kBlendFactorNames);
}

void read_blend(const json::Node& node, BlendState& b) {
  node.check_keys(kPipelineJsonKeys[kBlend]);
  read_flag(node, "enabled", b.enabled);
  read_blend_term(node, "rgb", b.rgb);
  read_blend_term(node, "alpha", b.alpha);
  if (const auto constant = node.find("constant")) {
    constant->array(4, 4);
    for (size_t k = 0; k < 4; ++k) b.constant[k] = constant->element(k).real(-json::kLargest, json::kLargest);
  }
  if (const auto mask = node.find("mask")) {
    mask->array(4, 4);
    for (size_t k = 0; k < 4; ++k) read(mask->element(k), b.mask[k]);
  }
}

void read_transparency(const json::Node& node, TransparencyState& t) {
  node.check_keys(kPipelineJsonKeys[kTransparency]);
  read_choice(node, "mode", t.mode, kTransparencyNames);
  if (const auto blend = node.find("blend")) read_blend(*blend, t.blend);
}

// Whether a text by itself wants surfaces blended into a G-buffer that its strategy has not. Where it says only one of
// the two it is right by itself; what it is put together with is validate()'s matter.
bool blends_into_no_gbuffer(const json::Node& text, const Pipeline& p) {
  const auto transparency = text.find("transparency");
  const bool all = text.find("preset").has_value();
  const bool strategy = all || text.find("strategy"), mode = all || (transparency && transparency->find("mode"));
  return strategy && mode && p.transparency.mode == TransparencyMode::into_albedo && is_forward(p.strategy);
}

void read_post(const json::Node& node, PostChain& p) {
  node.check_keys(kPipelineJsonKeys[kPost]);
  read_integer(node, "samples", p.samples, 1, 8);
  read_real(node, "marker_radius", p.marker_radius, 0.0, json::kLargest);
  if (const auto bloom = node.find("bloom")) {
    bloom->check_keys(kPipelineJsonKeys[kBloom]);
    read_real(*bloom, "strength", p.bloom.strength, 0.0, 1000.0);
    read_real(*bloom, "threshold", p.bloom.threshold, 0.0, json::kLargest);
    read_integer(*bloom, "radius", p.bloom.radius, 1, 14);
    read_integer(*bloom, "passes", p.bloom.passes, 1, 64);
  }
  read_choice(node, "tone_map", p.tone_map, kToneMaps);
  read_real(node, "key", p.key, 1e-6f, 1e6);
  read_real(node, "white", p.white, 0.0, json::kLargest);
  if (p.white > 0.0f && p.white < 1e-6f) node.fail("white is between 0 and 1e-6", "0 for none, or 1e-6 to 1e18");
  read_real(node, "log_offset", p.log_offset, 1e-12f, 1e6);
  read_choice(node, "encode", p.encode, kEncodes);
  read_flag(node, "edge_filter", p.edge_filter);
  read_format(node, "output", p.output, kPostOutputs);
}

}  // namespace

std::span<const json::ObjectKeys> pipeline_object_keys() { return kPipelineJsonKeys; }

Pipeline pipeline_from_node(const json::Node& node, const Pipeline& base) {
  node.check_keys(kPipelineJsonKeys[kRoot]);
  if (const auto schema = node.find("$schema")) schema->string();  // for editors
  if (const auto version = node.find("version")) version->integer(1, 1);
  Pipeline p = base;
  if (const auto preset = node.find("preset")) {
    std::vector<std::string_view> names;
    for (const Preset& row : presets()) names.push_back(row.name);
    p = presets()[preset->choice(names)].pipeline;
  }
  read_integer(node, "width", p.width, 1, kMostPictureSide);
  read_integer(node, "height", p.height, 1, kMostPictureSide);
  if (const auto geometry = node.find("geometry")) read_geometry(*geometry, p.geometry);
  if (const auto gbuffer = node.find("gbuffer")) read_gbuffer(*gbuffer, p.gbuffer);
  make_room_for_model(node, p);
  if (const auto model = node.find("light_model")) read_light_model(*model, p.light_model);
  if (const auto program = node.find("light_program")) read_light_program(*program, p.light_program);
  if (const auto volumes = node.find("light_volumes")) read_light_volumes(*volumes, p.light_volumes);
  if (const auto blend = node.find("blend")) read_blend(*blend, p.blend);
  if (const auto transparency = node.find("transparency")) read_transparency(*transparency, p.transparency);
  read_choice(node, "strategy", p.strategy, kStrategyNames);
  read_format(node, "target", p.target, kTargetFormats);
  read_choice(node, "profile", p.profile, kProfileNames);
  if (blends_into_no_gbuffer(node, p))
    node.fail("transparency into-albedo with strategy " + std::string(name_of(p.strategy)) + ", which has no G-buffer",
              "after-lights, or a deferred strategy");
  if (const auto post = node.find("post")) read_post(*post, p.post);
  read_choice(node, "view", p.view, kViewNames);
  if (p.gbuffer.position_from_depth && p.geometry.depth_near == p.geometry.depth_far)
    node.fail("position_from_depth with depth_near = depth_far: one depth stands for all positions",
              "give them different values");
  return p;
}

Pipeline pipeline_from_json(std::string_view text, std::string_view where, const Pipeline& base) {
  const FpScope fp;
  const json::Value value = json::parse(text, where);
  return pipeline_from_node(json::Node(value, where), base);
}

}  // namespace trueshade
