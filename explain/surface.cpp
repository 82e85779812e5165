#include "explain/surface.h"

#include <algorithm>
#include <cmath>

#include "explain/blended_pixel.h"
#include "explain/normal_map.h"
#include "raster/surfaces/back_faces.h"
#include "scenes/pipeline/material_values.h"
#include "scenes/placement.h"

namespace trueshade {
namespace {

/// Makes a vector unit length as the renderer does (docs/arithmetic.md section 2); a vector of length 0 becomes 0.
template <class Vector>
void make_unit(Vector& n) {
  const float l2 = (n[0] * n[0] + n[1] * n[1]) + n[2] * n[2], inverse = l2 > 0.0f ? 1.0f / std::sqrt(l2) : 0.0f;
  for (float& c : n) c *= inverse;
}

/// The corners of a fragment's triangle as submitted, and what the vertex stage makes of them.
struct TriangleCorners {
  const Mesh& mesh;
  const InstanceTransform& transform;
  const uint32_t* index;
  UnitNormals unit_normals;
  std::array<std::array<float, 3>, 3> position, normal;  ///< world; component, then corner

  TriangleCorners(const ExplainedFrame& frame, const PixelFragment& f)
      : mesh(frame.scene.meshes[frame.scene.instances[f.instance].mesh]),
        transform(frame.view.instances[f.instance]),
        index(mesh.indices.data() + 3 * size_t(f.triangle)),
        unit_normals(frame.pipeline.gbuffer.unit_normals) {
    for (size_t k = 0; k < 3; ++k) place(k);
  }

  /// A stream of the mesh at the corners; `missing` where the mesh has none.
  std::array<float, 3> of(const FloatStream& stream, float missing) const {
    if (stream.empty()) return {missing, missing, missing};
    return {stream[index[0]], stream[index[1]], stream[index[2]]};
  }

  /// A row of world_from_object times the tangents of the mesh.
  std::array<float, 3> tangent(size_t row) const {
    std::array<float, 3> out;
    const float* const m = transform.world[row];
    for (size_t k = 0; k < 3; ++k)
      out[k] = (m[0] * mesh.tangent[0][index[k]] + m[1] * mesh.tangent[1][index[k]]) + m[2] * mesh.tangent[2][index[k]];
    return out;
  }

 private:
  /// Sets the world position and the normal of corner k (docs/arithmetic.md section 2).
  void place(size_t k) {
    const uint32_t v = index[k];
    const float x = mesh.position[0][v], y = mesh.position[1][v], z = mesh.position[2][v];
    float n[3];
    for (size_t r = 0; r < 3; ++r) {
      const float *const m = transform.world[r], *const a = transform.normal[r];
      position[r][k] = ((m[0] * x + m[1] * y) + m[2] * z) + m[3];
      n[r] = (a[0] * mesh.normal[0][v] + a[1] * mesh.normal[1][v]) + a[2] * mesh.normal[2][v];
    }
    if (made_unit_at_vertex(unit_normals)) make_unit(n);
    for (size_t r = 0; r < 3; ++r) normal[r][k] = n[r];
  }
};

/// Interpolates attributes at one fragment, each by attribute_at() or texture_point().
struct Interpolator {
  const PixelFragment& fragment;
  const CornerWeights& weights;
  const WindowTransform& window;
  int provoking;

  float operator()(Interpolation how, const std::array<float, 3>& value) const {
    return attribute_at(fragment, weights, window, how, value, provoking);
  }
  TexturePoint point(Interpolation how, const TriangleCorners& corners, size_t uv_set) const {
    const UvStreams& uv = corners.mesh.uv_set(uv_set);
    return texture_point(fragment, weights, window, how, corners.of(uv[0], 0.0f), corners.of(uv[1], 0.0f), provoking);
  }
};

/// An interpolator, which borrows the fragment and the weights, by the pipeline's provoking corner.
Interpolator interpolator(const ExplainedFrame& frame, const PixelFragment& f, const CornerWeights& weights) {
  return {f, weights, frame.view.window, frame.pipeline.geometry.provoking == Provoking::last ? 2 : 0};
}

/// The maps of the fragment's material; null where no material of the scene has any.
const MaterialMaps* maps_of_fragment(const ExplainedFrame& frame, const PixelFragment& f) {
  const SceneMaps& maps = frame.view.maps;
  return maps.textured() ? &maps.material[frame.scene.instances[f.instance].material] : nullptr;
}

/// Looks the material's maps up, each at its own set of texture coordinates.
std::vector<MapLookup> look_maps_up(const MaterialMaps& maps, const TriangleCorners& corners, const Interpolator& at,
                                    Interpolation how) {
  std::vector<MapLookup> out;
  const auto look = [&](const char* name, const std::optional<TextureView>& map) {
    if (!map) return;
    MapLookup lookup{name, at.point(how, corners, map->uv_set), {}};
    look_up(*map, std::span(&lookup.at, 1), std::span(&lookup.texel, 1));
    out.push_back(lookup);
  };
  look("color", maps.color);
  look("specular", maps.specular);
  look("metallic-roughness", maps.metallic_roughness);
  look("emission", maps.emission);
  look("occlusion", maps.occlusion);
  look("normal", maps.normal);
  return out;
}

/// The texel that a map gave; null where that map was not looked up.
const std::array<float, 4>* texel_of(const std::vector<MapLookup>& lookups, std::string_view map) {
  const auto found = std::find_if(lookups.begin(), lookups.end(), [&](const MapLookup& l) { return l.map == map; });
  return found == lookups.end() ? nullptr : &found->texel;
}

/// Sets what a material makes of the pixel: emission, specular and, of metals and unlit materials, albedo
/// (docs/arithmetic.md section 7). out.albedo holds the base colour already.
void apply_values(const MaterialValues& m, const LightModel& model, const std::vector<MapLookup>& lookups,
                  SurfacePlanes& out) {
  if (m.unlit) {
    for (size_t c = 0; c < 3; ++c) out.emission[c] = out.albedo[c], out.albedo[c] = out.specular[c] = 0.0f;
    out.emission[3] = 1.0f, out.specular[3] = m.specular[3];
    return;
  }
  if (model.emission) {
    const auto *const map = texel_of(lookups, "emission"), *const occlusion = texel_of(lookups, "occlusion");
    for (size_t c = 0; c < 3; ++c) out.emission[c] = map != nullptr ? m.emission[c] * (*map)[c] : m.emission[c];
    out.emission[3] = occlusion != nullptr ? 1.0f + m.occlusion_strength * ((*occlusion)[0] - 1.0f) : 1.0f;
  }
  if (maps_metals(model)) {
    const auto* const map = texel_of(lookups, "metallic-roughness");
    if (model.keeps_metals) {
      out.specular = {map != nullptr ? m.metallic * (*map)[2] : m.metallic,
                      map != nullptr ? m.roughness * (*map)[1] : m.roughness, 0.0f, 0.0f};
      return;
    }
    const float metallic = map != nullptr ? m.metallic * (*map)[2] : m.metallic, rest = 1.0f - metallic;
    out.specular[3] = map != nullptr ? shininess_of_roughness(m.roughness * (*map)[1]) : m.specular[3];
    for (size_t c = 0; c < 3; ++c) {
      out.specular[c] = 0.04f * rest + out.albedo[c] * metallic;
      out.albedo[c] = out.albedo[c] * rest;
    }
    return;
  }
  const auto* const map = texel_of(lookups, "specular");
  for (size_t c = 0; c < 4; ++c) out.specular[c] = map != nullptr && c < 3 ? m.specular[c] * (*map)[c] : m.specular[c];
}

/// The world position that is rebuilt from a pixel's depth (docs/arithmetic.md section 7, "Position from depth").
std::array<float, 3> position_from_depth(const ExplainedFrame& frame, float depth, WindowPixel pixel) {
  const WindowTransform& t = frame.view.window;
  const int64_t width = t.scale[0] / 128, height = std::abs(t.scale[1]) / 128;
  const auto ndc = [](int at, int64_t offset, int64_t size) {
    const float low = float(offset / 128 - size) * 0.5f;
    return (float(at) + 0.5f - low) * float(2.0 / double(size)) - 1.0f;
  };
  const float x = ndc(pixel.x, t.offset[0], width), up = ndc(pixel.y, t.offset[1], height);
  const float y = t.upper_left ? -up : up, z = (depth - float(t.z_offset)) * float(1.0 / t.z_scale);
  float h[4];
  for (size_t r = 0; r < 4; ++r) {
    const float* const m = frame.view.world_from_clip.data() + 4 * r;
    h[r] = ((m[0] * x + m[1] * y) + m[2] * z) + m[3];
  }
  const float inverse = 1.0f / h[3];
  return {h[0] * inverse, h[1] * inverse, h[2] * inverse};
}

/// What lights read of `values` once a plane of the format has stored them.
template <size_t n>
std::array<float, n> read_from_plane(const std::array<float, n>& values, Format format, const ExplainedFrame& frame,
                                     HalfRound half_round) {
  if (info(format).bytes_per_channel == 4) return values;
  std::array<float, 4> source{0.0f, 0.0f, 0.0f, 1.0f};
  std::copy(values.begin(), values.end(), source.begin());
  const std::array<float, 4> read = read_back(source, {format, frame.pipeline.profile, half_round});
  std::array<float, n> out;
  std::copy_n(read.begin(), n, out.begin());
  return out;
}

/// What lights read of the computed values once the planes have stored them.
SurfacePlanes read_planes(const ExplainedFrame& frame, const SurfacePlanes& computed, const GBufferState& planes) {
  const auto read = [&](const auto& values, Format format) {
    return read_from_plane(values, format, frame, planes.half_round);
  };
  SurfacePlanes out;
  out.position = planes.position_from_depth ? computed.position : read(computed.position, planes.position.format);
  if (info(planes.normal.format).number_class == NumberClass::unorm) {
    std::array<float, 3> halved;
    for (size_t c = 0; c < 3; ++c) halved[c] = computed.normal[c] * 0.5f + 0.5f;
    halved = read(halved, planes.normal.format);
    for (size_t c = 0; c < 3; ++c) out.normal[c] = (halved[c] + halved[c]) - 1.0f;
  } else {
    out.normal = read(computed.normal, planes.normal.format);
  }
  out.albedo = read(computed.albedo, planes.albedo.format);
  out.uv = read(computed.uv, planes.uv.format);
  out.specular = read(computed.specular, planes.specular);
  out.emission = read(computed.emission, planes.emission);
  out.object = computed.object, out.material = computed.material;
  return out;
}

/// The frame that a normal map is read in: the triangle's, or that of vertices' tangents (docs/arithmetic.md section
/// 13). Sets out.tangent for the latter.
MapTangents frame_of(const ExplainedFrame& frame, const PixelFragment& f, const TriangleCorners& corners,
                     const Interpolator& at, size_t uv_set, PixelSurface& out) {
  if (!corners.mesh.has_tangents()) {
    const UvStreams& uv = corners.mesh.uv_set(uv_set);
    const std::array<float, 3> u = corners.of(uv[0], 0.0f), v = corners.of(uv[1], 0.0f);
    std::array<MapCorner, 3> of_map;
    for (size_t k = 0; k < 3; ++k)
      of_map[k] = {corners.position[0][k], corners.position[1][k], corners.position[2][k], u[k], v[k]};
    return tangents_of(of_map);
  }
  const std::array<float, 3> w = corners.of(corners.mesh.tangent[3], 0.0f);
  const bool mirrored = mirrors(frame.scene.instances[f.instance].world_from_object);
  out.tangent = {0.0f, 0.0f, 0.0f, (w[0] + w[1] + w[2] < 0.0f) == mirrored ? 1.0f : -1.0f};
  MapTangents along;
  for (size_t c = 0; c < 3; ++c) {
    (*out.tangent)[c] = at(frame.pipeline.gbuffer.normal.interpolation, corners.tangent(c));
    along.u[c] = double((*out.tangent)[c]);
  }
  along.side = double((*out.tangent)[3]);
  return along;
}

/// Sets position, normal, colour and uv of out.computed as interpolated, looks the maps up into out.lookups, and
/// applies the colour map and the normal map.
void interpolate(const ExplainedFrame& frame, const PixelFragment& f, const GBufferState& planes, PixelSurface& out) {
  const TriangleCorners corners(frame, f);
  const Interpolator at = interpolator(frame, f, out.weights);
  SurfacePlanes& to = out.computed;
  for (size_t c = 0; c < 3; ++c) {
    to.position[c] = at(planes.position.interpolation, corners.position[c]);
    to.normal[c] = at(planes.normal.interpolation, corners.normal[c]);
  }
  for (size_t c = 0; c < 4; ++c)
    to.albedo[c] = at(planes.albedo.interpolation, corners.of(corners.mesh.color[c], 1.0f));
  for (size_t c = 0; c < 2; ++c) to.uv[c] = at(planes.uv.interpolation, corners.of(corners.mesh.uv[c], 0.0f));
  if (made_unit_at_fragment(planes.unit_normals)) make_unit(to.normal);
  if (const MaterialMaps* const maps = maps_of_fragment(frame, f)) {
    out.lookups = look_maps_up(*maps, corners, at, frame.view.maps.uv_how);
    if (const auto* texel = texel_of(out.lookups, "color"))
      for (size_t c = 0; c < 4; ++c) to.albedo[c] = to.albedo[c] * (*texel)[c];
    if (const auto* texel = texel_of(out.lookups, "normal")) {
      const MapTangents along = frame_of(frame, f, corners, at, maps->normal->uv_set, out);
      to.normal = bent_normal(along, to.normal, *texel, maps->normal_scale);
    }
  }
  if (out.turned)
    for (float& n : to.normal) n = -n;
}

}  // namespace

std::array<float, 4> read_back(const std::array<float, 4>& values, const BlendTarget& target) {
  return values_of(target, stored_alone(target, values));
}

PixelSurface surface_of(const ExplainedFrame& frame, const PixelFragment& fragment, const GBufferState& planes,
                        WindowPixel pixel) {
  PixelSurface out;
  out.weights = corner_weights(fragment);
  out.turned = is_turned(frame.view, fragment.instance, fragment.fan.facing > 0);
  interpolate(frame, fragment, planes, out);
  if (planes.position_from_depth) out.computed.position = position_from_depth(frame, fragment.depth, pixel);
  const uint32_t material = frame.scene.instances[fragment.instance].material;
  out.computed.object = fragment.instance + 1, out.computed.material = material + 1;
  const glm::vec4& base = frame.scene.materials[material].base_color;
  for (size_t c = 0; c < 4; ++c) out.computed.albedo[c] = out.computed.albedo[c] * base[int(c)];
  if (!frame.view.materials.empty())
    apply_values(frame.view.materials[material], frame.pipeline.light_model, out.lookups, out.computed);
  out.read = read_planes(frame, out.computed, planes);
  return out;
}

bool has_alpha_test(const ExplainedFrame& frame, uint32_t instance) {
  const SceneMaps& maps = frame.view.maps;
  return maps.textured() && maps.material[frame.scene.instances[instance].material].alpha_cutoff != 0.0f;
}

std::optional<float> tested_alpha(const ExplainedFrame& frame, const PixelFragment& fragment) {
  const MaterialMaps* const maps = maps_of_fragment(frame, fragment);
  if (maps == nullptr || maps->alpha_cutoff == 0.0f) return std::nullopt;
  const TriangleCorners corners(frame, fragment);
  const CornerWeights weights = corner_weights(fragment);
  const Interpolator at = interpolator(frame, fragment, weights);
  float alpha = at(frame.view.maps.albedo_how, corners.of(corners.mesh.color[3], 1.0f));
  if (maps->color) {
    const TexturePoint point = at.point(frame.view.maps.uv_how, corners, maps->color->uv_set);
    std::array<float, 4> texel;
    look_up(*maps->color, std::span(&point, 1), std::span(&texel, 1));
    alpha = alpha * texel[3];
  }
  return alpha * maps->base_alpha;
}

}  // namespace trueshade
