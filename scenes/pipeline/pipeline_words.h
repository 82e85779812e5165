#pragma once
// The words of a pipeline in JSON: spelling of enumerators, keys of objects. Of pipeline_json.cpp and
// pipeline_text.cpp.
#include <array>
#include <span>
#include <string_view>

#include "scenes/json/json_value.h"

namespace trueshade::pipeline_words {

using Names = std::span<const std::string_view>;

/// Spelling of enumerators, in the order of their values.
inline constexpr std::string_view kDepthFuncs[] = {"never",   "less",     "equal",  "lequal",
                                                   "greater", "notequal", "gequal", "always"};
inline constexpr std::string_view kCullFaces[] = {"none", "front", "back", "front_and_back"};
inline constexpr std::string_view kFrontFaces[] = {"ccw", "cw"};
inline constexpr std::string_view kClipOrigins[] = {"lower_left", "upper_left"};
inline constexpr std::string_view kClipDepths[] = {"negative_one_to_one", "zero_to_one"};
inline constexpr std::string_view kInterpolations[] = {"smooth", "flat", "noperspective"};
inline constexpr std::string_view kProvoking[] = {"last", "first"};
inline constexpr std::string_view kUnitNormals[] = {"vertex", "fragment", "both"};
inline constexpr std::string_view kExtents[] = {"unbounded", "range", "box", "sphere", "cone"};
inline constexpr std::string_view kHalfRounds[] = {"toward_zero", "nearest"};
inline constexpr std::string_view kFalloffs[] = {"linear_range", "quadratic",   "none",
                                                 "linear",       "attenuation", "inverse_square"};
inline constexpr std::string_view kOrders[] = {"factored", "separate", "albedo_last", "with_ambient"};
inline constexpr std::string_view kCones[] = {"none", "smooth_cutoff", "smooth_penumbra", "exponent",
                                              "squared_penumbra"};
inline constexpr std::string_view kDiffuses[] = {"clamped", "unclamped"};
inline constexpr std::string_view kSpeculars[] = {"blinn_phong", "phong", "none"};
inline constexpr std::string_view kSpecularSources[] = {"model", "albedo", "material", "metallic_roughness"};
inline constexpr std::string_view kViewers[] = {"local", "infinite"};

inline constexpr std::string_view kRootKeys[] = {
    "version",     "preset",        "width",         "height", "geometry",     "gbuffer",
    "light_model", "light_program", "light_volumes", "blend",  "transparency", "strategy",
    "target",      "profile",       "post",          "view",   "$schema"};
inline constexpr std::string_view kGeometryKeys[] = {"viewport",
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
inline constexpr std::string_view kViewportKeys[] = {"x", "y", "width", "height"};
inline constexpr std::string_view kGBufferKeys[] = {
    "position",  "normal", "albedo", "uv", "specular_format", "emission_format", "unit_normals", "position_from_depth",
    "half_round"};
inline constexpr std::string_view kPlaneKeys[] = {"format", "interpolation"};
inline constexpr std::string_view kLightModelKeys[] = {
    "renormalize", "specular_masked", "shininess", "specular_color",  "falloff", "order",    "alpha_from_albedo",
    "cone",        "diffuse",         "specular",  "specular_source", "viewer",  "emission", "global_ambient",
    "damping",     "clamp_result"};
inline constexpr std::string_view kLightProgramKeys[] = {"file", "sha256", "parameters"};
inline constexpr std::string_view kProgramParameterKeys[] = {"name", "value"};
inline constexpr std::string_view kLightVolumesKeys[] = {"point",     "spot",        "slices", "stacks",
                                                         "cull_face", "depth_clamp", "base"};
inline constexpr std::string_view kBlendKeys[] = {"enabled", "rgb", "alpha", "constant", "mask"};
inline constexpr std::string_view kTransparencyKeys[] = {"mode", "blend"};
inline constexpr std::string_view kBlendTermKeys[] = {"equation", "src", "dst"};

inline constexpr std::string_view kToneMaps[] = {"none", "reinhard"};
inline constexpr std::string_view kEncodes[] = {"linear", "srgb"};
inline constexpr std::string_view kPostKeys[] = {"samples", "marker_radius", "bloom",  "tone_map",    "key",
                                                 "white",   "log_offset",    "encode", "edge_filter", "output"};
inline constexpr std::string_view kBloomKeys[] = {"strength", "threshold", "radius", "passes"};

enum : size_t {
  kRoot,
  kGeometry,
  kViewport,
  kGBuffer,
  kPlane,
  kLightModel,
  kLightProgram,
  kProgramParameter,
  kLightVolumes,
  kBlend,
  kBlendTerm,
  kTransparency,
  kPost,
  kBloom
};
inline constexpr std::array<json::ObjectKeys, 14> kPipelineJsonKeys{{{"", kRootKeys},
                                                                     {"geometry", kGeometryKeys},
                                                                     {"viewport", kViewportKeys},
                                                                     {"gbuffer", kGBufferKeys},
                                                                     {"plane", kPlaneKeys},
                                                                     {"light_model", kLightModelKeys},
                                                                     {"light_program", kLightProgramKeys},
                                                                     {"program_parameter", kProgramParameterKeys},
                                                                     {"light_volumes", kLightVolumesKeys},
                                                                     {"blend", kBlendKeys},
                                                                     {"blend_term", kBlendTermKeys},
                                                                     {"transparency", kTransparencyKeys},
                                                                     {"post", kPostKeys},
                                                                     {"bloom", kBloomKeys}}};

}  // namespace trueshade::pipeline_words
