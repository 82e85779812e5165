#pragma once
// A pipeline as GLSL: the text the judge compiles is the text `trueshade glsl` writes. Nothing here calls OpenGL.
#include <string>
#include <string_view>
#include <vector>

#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// What the text depends on beside the pipeline. As it stands: the judge's shaders on a driver of OpenGL 4.5.
struct GlslOptions {
  int version = 450;      ///< 450 or 330; 330 cannot forbid contraction of the position
  bool ids = true;        ///< planes id.object, id.material (index + 1) and id.primitive (triangle in the mesh + 1)
  bool primitive = true;  ///< of ids, id.primitive too
  bool uv = true;         ///< plane uv
  bool rgb16f = true;     ///< false: the driver cannot render to rgb16f, so rgba16f stands in
  bool products = false;  ///< light models in Spelling::in_products
  bool instance_uniforms = false;  ///< matrices and base colour are uniforms, a draw an instance: for large meshes
  bool maps = false;               ///< materials have colour maps (1 where one has none) and alpha cutoffs, a draw each
  bool specular_maps = false;      ///< of maps: specular maps too, read where the model takes the material's colour
  bool normal_maps = false;      ///< of maps: normal maps too; triangles share no vertices, `tangents` has their frames
  bool vertex_tangents = false;  ///< of normal maps: some meshes have tangents, which `vertex_tangents` has
  // Of maps, read where the light model maps metals or adds emission: white where a material has none.
  bool metal_maps = false, emission_maps = false, occlusion_maps = false;
  bool more_uv = false;           ///< of maps: some read texture coordinates beside the first set, from `more_uv`
  bool double_sided = false;      ///< materials may be: the uniform of that name says so, a draw each
  bool unlit = false;             ///< some materials are unlit
  bool transparent = false;       ///< surfaces are drawn after the lights
  bool vertex_color = true;       ///< false: no mesh has any, so the base colour is the albedo
  uint32_t light_types = 0b1111;  ///< that the loop knows besides point, a bit each: 1 << LightType
};

/// What a format is stored as: rgba16f for rgb16f where the driver cannot render to that.
constexpr Format renderable(Format format, bool rgb16f) {
  return format == Format::rgb16f && !rgb16f ? Format::rgba16f : format;
}

/// A plane of the G-buffer: colour attachment i of the geometry pass is the i-th of planes_of().
struct GlslPlane {
  std::string name;     ///< as --aov names it
  std::string output;   ///< of the geometry pass's fragment shader
  std::string sampler;  ///< of the light pass
  Format format;
  bool operator==(const GlslPlane&) const = default;
};

/// The planes of a pipeline in attachment order.
std::vector<GlslPlane> planes_of(const Pipeline& pipeline, const GlslOptions& options);

/// The plane whose texel tells whether a surface was drawn: its w (1, cleared to 0) or, for ids, the number itself.
const GlslPlane& coverage_plane(const std::vector<GlslPlane>& planes);

/// The shaders that draw a frame. The files of `trueshade glsl` have these names. Forward strategies light the scene
/// itself, with light_vert and light_frag; their geometry pass is there to show what is lit. base_frag, with
/// light_vert: the draw before the lights of deferred-volumes, empty where there is none. transparent_*: the draw of
/// transparent surfaces after the lights, of GlslOptions::transparent.
struct GlslShaders {
  std::string geometry_vert, geometry_frag, light_vert, light_frag, base_frag;
  std::string transparent_vert{}, transparent_frag{};
  bool operator==(const GlslShaders&) const = default;
};
GlslShaders shaders_of(const Pipeline& pipeline, const GlslOptions& options);
/// Of these the light pass, by the pipeline's strategy.
void set_light_shaders(const Pipeline& pipeline, const GlslOptions& options, GlslShaders& shaders);
/// The pipeline as OpenGL draws it: with the planes that surfaces really have, those of a light program among them.
Pipeline drawn_pipeline(const Pipeline& pipeline);

// Parts that the peers' shaders are made of too.

std::string glsl_header(int version, std::string_view purpose);
std::string glsl_float(float value);  ///< a literal that reads back as the same float
/// Varyings of the geometry pass, declared alike at both ends: `direction` is in or out.
std::string varyings_text(const Pipeline& pipeline, const GlslOptions& options, const std::string& direction);
/// The surface's colour and its normal, of any length, in a fragment shader with those varyings.
std::string albedo_text(const GlslOptions& options);
std::string normal_text(const Pipeline& pipeline, const GlslOptions& options);
/// Whether fragments of surfaces read `materials`: kMaterialTexels RGBA32F texels a material, (specular colour,
/// shininess), (emission, metallic) and (roughness, strength of the occlusion map, 1 for one that is shown unlit, 1 for
/// one with a map of metal and roughness); under metallic_roughness the shininess is that of the roughness.
bool reads_materials(const LightModel& model);
inline constexpr int kMaterialTexels = 3;
/// `vec4 albedo` of a fragment, and from its material `vec4 gloss` and `vec4 emission` where the model reads them;
/// emission.a is the share of ambient light that arrives.
std::string material_text(const LightModel& model, const GlslOptions& options);
std::string vertex_text(const Pipeline& pipeline, const GlslOptions& options);
std::string fullscreen_vertex_text(int version);
/// Samplers and uniforms that read_surface_text() reads, without those of the lights.
std::string surface_uniforms_text(const Pipeline& pipeline, const GlslOptions& options);
/// Discards pixels without a surface; then `vec3 P, stored_normal` and `vec4 albedo` of the pixel, from the planes, and
/// `gloss` and `emission` where the model reads them.
std::string read_surface_text(const Pipeline& pipeline, const GlslOptions& options);
/// Whether a falloff is 0 from the range on, so that nothing else has to end there.
bool ends_at_range(Falloff falloff);
/// Of which lights the shader has to leave out what lies beyond their range.
struct RangeLimits {
  bool all_around = false, to_one_side = false;
  bool any() const { return all_around || to_one_side; }
  bool ends(LightType type) const {
    const LightReach reach = row_of(type).reach;
    return (all_around && reach == LightReach::all_around) || (to_one_side && reach == LightReach::to_one_side);
  }
};
RangeLimits limits_range(const Pipeline& pipeline);
}  // namespace trueshade::oracle
