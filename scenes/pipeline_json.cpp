#include "scenes/pipeline_json.h"

#include <array>
#include <vector>

#include "scenes/presets.h"

namespace trueshade {
namespace {

using Names = std::span<const std::string_view>;

// Spelling of enumerators, in the order of their values.
constexpr std::string_view kDepthFuncs[] = {"never",   "less",     "equal",  "lequal",
                                            "greater", "notequal", "gequal", "always"};
constexpr std::string_view kCullFaces[] = {"none", "front", "back", "front_and_back"};
constexpr std::string_view kFrontFaces[] = {"ccw", "cw"};
constexpr std::string_view kClipOrigins[] = {"lower_left", "upper_left"};
constexpr std::string_view kClipDepths[] = {"negative_one_to_one", "zero_to_one"};
constexpr std::string_view kInterpolations[] = {"smooth", "flat", "noperspective"};
constexpr std::string_view kProvoking[] = {"last", "first"};
constexpr std::string_view kExtents[] = {"unbounded", "range", "box", "sphere", "cone"};
constexpr std::string_view kHalfRounds[] = {"toward_zero", "nearest"};
constexpr std::string_view kFalloffs[] = {"linear_range", "quadratic",   "none",
                                          "linear",       "attenuation", "inverse_square"};
constexpr std::string_view kOrders[] = {"factored", "separate", "albedo_last", "with_ambient"};
constexpr std::string_view kCones[] = {"none", "smooth_cutoff", "smooth_penumbra", "exponent", "squared_penumbra"};
constexpr std::string_view kDiffuses[] = {"clamped", "unclamped"};
constexpr std::string_view kSpeculars[] = {"blinn_phong", "phong", "none"};
constexpr std::string_view kSpecularSources[] = {"model", "albedo", "material", "metallic_roughness"};
constexpr std::string_view kViewers[] = {"local", "infinite"};

constexpr std::string_view kRootKeys[] = {"version", "preset",      "width",         "height", "geometry",
                                          "gbuffer", "light_model", "light_volumes", "blend",  "strategy",
                                          "target",  "profile",     "post",          "view"};
constexpr std::string_view kGeometryKeys[] = {"viewport",
                                              "depth_near",
                                              "depth_far",
                                              "depth_func",
                                              "clear_depth",
                                              "depth_clamp",
                                              "cull_face",
                                              "front_face",
                                              "clip_origin",
                                              "clip_depth",
                                              "provoking",
                                              "depth_format",
                                              "polygon_offset_factor",
                                              "polygon_offset_units"};
constexpr std::string_view kViewportKeys[] = {"x", "y", "width", "height"};
constexpr std::string_view kGBufferKeys[] = {
    "position", "normal", "albedo", "uv", "specular_format", "emission_format", "position_from_depth", "half_round"};
constexpr std::string_view kPlaneKeys[] = {"format", "interpolation"};
constexpr std::string_view kLightModelKeys[] = {"renormalize", "specular_masked", "shininess",         "specular_color",
                                                "falloff",     "order",           "alpha_from_albedo", "cone",
                                                "diffuse",     "specular",        "specular_source",   "viewer",
                                                "emission",    "global_ambient",  "damping",           "clamp_result"};
constexpr std::string_view kLightVolumesKeys[] = {"point",     "spot",        "slices", "stacks",
                                                  "cull_face", "depth_clamp", "base"};
constexpr std::string_view kBlendKeys[] = {"enabled", "rgb", "alpha", "constant", "mask"};
constexpr std::string_view kBlendTermKeys[] = {"equation", "src", "dst"};

constexpr std::string_view kToneMaps[] = {"none", "reinhard"};
constexpr std::string_view kEncodes[] = {"linear", "srgb"};
constexpr std::string_view kPostKeys[] = {"samples", "marker_radius", "bloom",  "tone_map",    "key",
                                          "white",   "log_offset",    "encode", "edge_filter", "output"};
constexpr std::string_view kBloomKeys[] = {"strength", "threshold", "radius", "passes"};

enum Object : size_t {
  kRoot,
  kGeometry,
  kViewport,
  kGBuffer,
  kPlane,
  kLightModel,
  kLightVolumes,
  kBlend,
  kBlendTerm,
  kPost,
  kBloom
};
constexpr std::array<json::ObjectKeys, 11> kObjects{{{"", kRootKeys},
                                                     {"geometry", kGeometryKeys},
                                                     {"viewport", kViewportKeys},
                                                     {"gbuffer", kGBufferKeys},
                                                     {"plane", kPlaneKeys},
                                                     {"light_model", kLightModelKeys},
                                                     {"light_volumes", kLightVolumesKeys},
                                                     {"blend", kBlendKeys},
                                                     {"blend_term", kBlendTermKeys},
                                                     {"post", kPostKeys},
                                                     {"bloom", kBloomKeys}}};

// --- Writing -------------------------------------------------------------------------------------------------------

/// An object being written, member after member.
class Writer {
 public:
  explicit Writer(std::string& out) : out_(out) { out_ += '{'; }
  ~Writer() { out_ += '}'; }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  std::string& key(std::string_view name) {
    if (!first_) out_ += ',';
    first_ = false;
    json::append_string(out_, name);
    return out_ += ':';
  }
  void put(std::string_view name, int value) { key(name) += std::to_string(value); }
  void put(std::string_view name, bool value) { key(name) += value ? "true" : "false"; }
  void put(std::string_view name, float value) { json::append_number(key(name), value); }
  void put(std::string_view name, std::string_view value) { json::append_string(key(name), value); }
  template <typename Enum>
  void put(std::string_view name, Enum value, Names names) {
    put(name, names[size_t(value)]);
  }

 private:
  std::string& out_;
  bool first_ = true;
};

void write_geometry(std::string& out, const GeometryState& g) {
  Writer w(out);
  {
    Writer v(w.key("viewport"));
    v.put("x", g.viewport.x);
    v.put("y", g.viewport.y);
    v.put("width", g.viewport.width);
    v.put("height", g.viewport.height);
  }
  w.put("depth_near", g.depth_near);
  w.put("depth_far", g.depth_far);
  w.put("depth_func", g.depth_func, kDepthFuncs);
  w.put("clear_depth", g.clear_depth);
  w.put("depth_clamp", g.depth_clamp);
  w.put("cull_face", g.cull_face, kCullFaces);
  w.put("front_face", g.front_face, kFrontFaces);
  w.put("clip_origin", g.clip_origin, kClipOrigins);
  w.put("clip_depth", g.clip_depth, kClipDepths);
  w.put("provoking", g.provoking, kProvoking);
  w.put("depth_format", info(g.depth_format).name);
  w.put("polygon_offset_factor", g.polygon_offset_factor);
  w.put("polygon_offset_units", g.polygon_offset_units);
}

void write_plane(std::string& out, const PlaneState& plane) {
  Writer w(out);
  w.put("format", info(plane.format).name);
  w.put("interpolation", plane.interpolation, kInterpolations);
}

void write_gbuffer(std::string& out, const GBufferState& g) {
  Writer w(out);
  write_plane(w.key("position"), g.position);
  write_plane(w.key("normal"), g.normal);
  write_plane(w.key("albedo"), g.albedo);
  write_plane(w.key("uv"), g.uv);
  w.put("specular_format", info(g.specular).name);
  w.put("emission_format", info(g.emission).name);
  w.put("position_from_depth", g.position_from_depth);
  w.put("half_round", g.half_round, kHalfRounds);
}

void write_color(std::string& out, const glm::vec3& color) {
  for (int k = 0; k < 3; ++k) json::append_number(out += k == 0 ? '[' : ',', color[k]);
  out += ']';
}

void write_light_model(std::string& out, const LightModel& m) {
  Writer w(out);
  w.put("renormalize", m.renormalize);
  w.put("specular_masked", m.specular_masked);
  w.put("shininess", m.shininess);
  write_color(w.key("specular_color"), m.specular_color);
  w.put("falloff", m.falloff, kFalloffs);
  w.put("order", m.order, kOrders);
  w.put("alpha_from_albedo", m.alpha_from_albedo);
  w.put("cone", m.cone, kCones);
  w.put("diffuse", m.diffuse, kDiffuses);
  w.put("specular", m.specular, kSpeculars);
  w.put("specular_source", m.specular_source, kSpecularSources);
  w.put("viewer", m.viewer, kViewers);
  w.put("emission", m.emission);
  write_color(w.key("global_ambient"), m.global_ambient);
  w.put("damping", m.damping);
  w.put("clamp_result", m.clamp_result);
}

void write_light_volumes(std::string& out, const LightVolumes& v) {
  Writer w(out);
  w.put("point", v.point, kExtents);
  w.put("spot", v.spot, kExtents);
  w.put("slices", v.slices);
  w.put("stacks", v.stacks);
  w.put("cull_face", v.cull_face, kCullFaces);
  w.put("depth_clamp", v.depth_clamp);
  w.put("base", v.base);
}

void write_blend_term(std::string& out, const BlendTerm& term) {
  Writer w(out);
  w.put("equation", term.equation, kBlendEquationNames);
  w.put("src", term.src, kBlendFactorNames);
  w.put("dst", term.dst, kBlendFactorNames);
}

void write_blend(std::string& out, const BlendState& b) {
  Writer w(out);
  w.put("enabled", b.enabled);
  write_blend_term(w.key("rgb"), b.rgb);
  write_blend_term(w.key("alpha"), b.alpha);
  std::string& constant = w.key("constant");
  for (size_t k = 0; k < 4; ++k) json::append_number(constant += k == 0 ? '[' : ',', b.constant[k]);
  constant += ']';
  std::string& mask = w.key("mask");
  for (size_t k = 0; k < 4; ++k) (mask += k == 0 ? '[' : ',') += b.mask[k] ? "true" : "false";
  mask += ']';
}

void write_post(std::string& out, const PostChain& p) {
  Writer w(out);
  w.put("samples", p.samples);
  w.put("marker_radius", p.marker_radius);
  {
    Writer b(w.key("bloom"));
    b.put("strength", p.bloom.strength);
    b.put("threshold", p.bloom.threshold);
    b.put("radius", p.bloom.radius);
    b.put("passes", p.bloom.passes);
  }
  w.put("tone_map", p.tone_map, kToneMaps);
  w.put("key", p.key);
  w.put("white", p.white);
  w.put("log_offset", p.log_offset);
  w.put("encode", p.encode, kEncodes);
  w.put("edge_filter", p.edge_filter);
  w.put("output", info(p.output).name);
}

// --- Reading -------------------------------------------------------------------------------------------------------

constexpr double kLargest = 1e18;

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
  node.check_keys(kObjects[kGeometry]);
  if (const auto v = node.find("viewport")) {
    v->check_keys(kObjects[kViewport]);
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
  read_real(node, "polygon_offset_factor", g.polygon_offset_factor, -kLargest, kLargest);
  read_real(node, "polygon_offset_units", g.polygon_offset_units, -kLargest, kLargest);
}

void read_plane(const json::Node& gbuffer, std::string_view key, PlaneState& plane, std::span<const Format> allowed) {
  const auto node = gbuffer.find(key);
  if (!node) return;
  node->check_keys(kObjects[kPlane]);
  read_format(*node, "format", plane.format, allowed);
  read_choice(*node, "interpolation", plane.interpolation, kInterpolations);
}

void read_gbuffer(const json::Node& node, GBufferState& g) {
  node.check_keys(kObjects[kGBuffer]);
  read_plane(node, "position", g.position, kPositionFormats);
  read_plane(node, "normal", g.normal, kNormalFormats);
  read_plane(node, "albedo", g.albedo, kAlbedoFormats);
  read_plane(node, "uv", g.uv, kPositionFormats);
  read_format(node, "specular_format", g.specular, kSpecularFormats);
  read_format(node, "emission_format", g.emission, kEmissionFormats);
  read_flag(node, "position_from_depth", g.position_from_depth);
  read_choice(node, "half_round", g.half_round, kHalfRounds);
}

bool multiplies_albedo_last_but_reads_another(const LightModel& m) {
  return m.order == TermOrder::albedo_last && m.specular != Specular::none &&
         m.specular_source != SpecularSource::albedo;
}

void read_light_model(const json::Node& node, LightModel& m) {
  node.check_keys(kObjects[kLightModel]);
  read_flag(node, "renormalize", m.renormalize);
  read_flag(node, "specular_masked", m.specular_masked);
  read_real(node, "shininess", m.shininess, 0.0f, kLargest);
  if (const auto color = node.find("specular_color")) m.specular_color = color->vec3(0.0f, kLargest);
  read_choice(node, "falloff", m.falloff, kFalloffs);
  read_choice(node, "order", m.order, kOrders);
  read_flag(node, "alpha_from_albedo", m.alpha_from_albedo);
  read_choice(node, "cone", m.cone, kCones);
  read_choice(node, "diffuse", m.diffuse, kDiffuses);
  read_choice(node, "specular", m.specular, kSpeculars);
  read_choice(node, "specular_source", m.specular_source, kSpecularSources);
  read_choice(node, "viewer", m.viewer, kViewers);
  read_flag(node, "emission", m.emission);
  if (const auto color = node.find("global_ambient")) m.global_ambient = color->vec3(0.0f, kLargest);
  read_real(node, "damping", m.damping, 0.0f, kLargest);
  read_flag(node, "clamp_result", m.clamp_result);
  if (multiplies_albedo_last_but_reads_another(m))
    node.fail("order albedo_last with a specular colour that is not the albedo",
              "specular none or specular_source albedo");
}

void read_light_volumes(const json::Node& node, LightVolumes& v) {
  node.check_keys(kObjects[kLightVolumes]);
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
  node->check_keys(kObjects[kBlendTerm]);
  read_choice(*node, "equation", term.equation, kBlendEquationNames);
  read_choice(*node, "src", term.src, kBlendFactorNames);
  read_choice(*node, "dst", term.dst, kBlendFactorNames);
}

void read_blend(const json::Node& node, BlendState& b) {
  node.check_keys(kObjects[kBlend]);
  read_flag(node, "enabled", b.enabled);
  read_blend_term(node, "rgb", b.rgb);
  read_blend_term(node, "alpha", b.alpha);
  if (const auto constant = node.find("constant")) {
    constant->array(4, 4);
    for (size_t k = 0; k < 4; ++k) b.constant[k] = constant->element(k).real(-kLargest, kLargest);
  }
  if (const auto mask = node.find("mask")) {
    mask->array(4, 4);
    for (size_t k = 0; k < 4; ++k) read(mask->element(k), b.mask[k]);
  }
}

void read_post(const json::Node& node, PostChain& p) {
  node.check_keys(kObjects[kPost]);
  read_integer(node, "samples", p.samples, 1, 8);
  read_real(node, "marker_radius", p.marker_radius, 0.0, kLargest);
  if (const auto bloom = node.find("bloom")) {
    bloom->check_keys(kObjects[kBloom]);
    read_real(*bloom, "strength", p.bloom.strength, 0.0, 1000.0);
    read_real(*bloom, "threshold", p.bloom.threshold, 0.0, kLargest);
    read_integer(*bloom, "radius", p.bloom.radius, 1, 14);
    read_integer(*bloom, "passes", p.bloom.passes, 1, 64);
  }
  read_choice(node, "tone_map", p.tone_map, kToneMaps);
  read_real(node, "key", p.key, 1e-6f, 1e6);
  read_real(node, "white", p.white, 0.0, kLargest);
  if (p.white > 0.0f && p.white < 1e-6f) node.fail("white is between 0 and 1e-6", "0 for none, or 1e-6 to 1e18");
  read_real(node, "log_offset", p.log_offset, 1e-12f, 1e6);
  read_choice(node, "encode", p.encode, kEncodes);
  read_flag(node, "edge_filter", p.edge_filter);
  read_format(node, "output", p.output, kPostOutputs);
}

}  // namespace

std::span<const json::ObjectKeys> pipeline_object_keys() { return kObjects; }

std::string pipeline_json(const Pipeline& pipeline) {
  std::string out;
  {
    Writer w(out);
    w.put("version", 1);
    w.put("preset", std::string_view(pipeline.preset));
    w.put("width", pipeline.width);
    w.put("height", pipeline.height);
    write_geometry(w.key("geometry"), pipeline.geometry);
    write_gbuffer(w.key("gbuffer"), pipeline.gbuffer);
    write_light_model(w.key("light_model"), pipeline.light_model);
    write_light_volumes(w.key("light_volumes"), pipeline.light_volumes);
    write_blend(w.key("blend"), pipeline.blend);
    w.put("strategy", pipeline.strategy, kStrategyNames);
    w.put("target", info(pipeline.target).name);
    w.put("profile", pipeline.profile, kProfileNames);
    write_post(w.key("post"), pipeline.post);
    w.put("view", pipeline.view, kViewNames);
  }
  return out;
}

Pipeline pipeline_from_node(const json::Node& node, const Pipeline& base) {
  node.check_keys(kObjects[kRoot]);
  if (const auto version = node.find("version")) version->integer(1, 1);
  Pipeline p = base;
  if (const auto preset = node.find("preset")) {
    std::vector<std::string_view> names;
    for (const Preset& row : presets()) names.push_back(row.name);
    p = presets()[preset->choice(names)].pipeline;
  }
  read_integer(node, "width", p.width, 1, 65536);
  read_integer(node, "height", p.height, 1, 65536);
  if (const auto geometry = node.find("geometry")) read_geometry(*geometry, p.geometry);
  if (const auto gbuffer = node.find("gbuffer")) read_gbuffer(*gbuffer, p.gbuffer);
  if (const auto model = node.find("light_model")) read_light_model(*model, p.light_model);
  if (const auto volumes = node.find("light_volumes")) read_light_volumes(*volumes, p.light_volumes);
  if (const auto blend = node.find("blend")) read_blend(*blend, p.blend);
  read_choice(node, "strategy", p.strategy, kStrategyNames);
  read_format(node, "target", p.target, kTargetFormats);
  read_choice(node, "profile", p.profile, kProfileNames);
  if (const auto post = node.find("post")) read_post(*post, p.post);
  read_choice(node, "view", p.view, kViewNames);
  if (p.gbuffer.position_from_depth && p.geometry.depth_near == p.geometry.depth_far)
    node.fail("position_from_depth with depth_near = depth_far: one depth stands for all positions",
              "give them different values");
  return p;
}

Pipeline pipeline_from_json(std::string_view text, std::string_view where, const Pipeline& base) {
  const json::Value value = json::parse(text, where);
  return pipeline_from_node(json::Node(value, where), base);
}

}  // namespace trueshade
