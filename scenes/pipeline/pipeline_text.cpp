#include <string>

#include "core/fp_env.h"
#include "core/sha256.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/pipeline/pipeline_words.h"

namespace trueshade {
namespace {

using namespace pipeline_words;

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
  w.put("unit_normals", g.unit_normals, kUnitNormals);
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

void write_light_program(std::string& out, const LightProgram& program) {
  Writer w(out);
  w.put("file", std::string_view(program.file));
  w.put("sha256", std::string_view(program.text.empty() ? program.sha256 : sha256_of(program.text)));
  std::string& parameters = w.key("parameters") += '[';
  for (const ProgramParameter& p : program.parameters) {
    if (&p != &program.parameters.front()) parameters += ',';
    Writer one(parameters);
    one.put("name", std::string_view(p.name));
    std::string& value = one.key("value");
    for (size_t k = 0; k < p.value.size(); ++k) json::append_number(value += k == 0 ? '[' : ',', p.value[k]);
    value += ']';
  }
  parameters += ']';
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

void write_transparency(std::string& out, const TransparencyState& t) {
  Writer w(out);
  w.put("mode", t.mode, kTransparencyNames);
  write_blend(w.key("blend"), t.blend);
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

}  // namespace

std::string pipeline_json(const Pipeline& pipeline) {
  const FpScope fp;
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
    if (pipeline.light_program.used()) write_light_program(w.key("light_program"), pipeline.light_program);
    write_light_volumes(w.key("light_volumes"), pipeline.light_volumes);
    write_blend(w.key("blend"), pipeline.blend);
    write_transparency(w.key("transparency"), pipeline.transparency);
    w.put("strategy", pipeline.strategy, kStrategyNames);
    w.put("target", info(pipeline.target).name);
    w.put("profile", pipeline.profile, kProfileNames);
    write_post(w.key("post"), pipeline.post);
    w.put("view", pipeline.view, kViewNames);
  }
  return out;
}

}  // namespace trueshade
