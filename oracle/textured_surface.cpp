#include "oracle/textured_surface.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

using Real = long double;

/// 1 / w weighted edge functions at a sample, or the edge functions themselves.
std::array<Real, 3> edges_at(const DrawnTriangle& t, Interpolation interpolation, int64_t px, int64_t py) {
  std::array<Real, 3> l{};
  for (int i = 0; i < 3; ++i) {
    l[size_t(i)] = Real(t.window.edge(i, px, py));
    if (interpolation == Interpolation::smooth) l[size_t(i)] /= Real(t.window.values[size_t(i)][3]);
  }
  return l;
}

/// Change of a plane's value per pixel: the quotient rule, with the linear functions' own differences.
Real slope(const std::array<Real, 3>& here, const std::array<Real, 3>& next, const std::array<double, 3>& a) {
  Real sum = 0, value = 0, sum_slope = 0, value_slope = 0;
  for (size_t i = 0; i < 3; ++i) {
    sum += here[i], value += here[i] * Real(a[i]);
    sum_slope += next[i] - here[i], value_slope += (next[i] - here[i]) * Real(a[i]);
  }
  return (value_slope - value / sum * sum_slope) / sum;
}

bool close(Real a, Real b, Real scale) { return std::fabs(a - b) <= scale; }

/// Whether a coordinate that may be off by `off` texels lies on the same side of every boundary that counts.
bool inside_texel(Real texels, Real off) { return !close(texels, std::nearbyint(texels), off); }

/// Whether a lookup jumps at a level of detail this close: between the filters at 0, or, where one level is chosen,
/// from it to the next at every half. Elsewhere it is smooth.
bool at_jump(const Texture& texture, const Sampler& s, Real lod) {
  if (s.mag_filter != s.min_filter && close(lod, 0, 1e-6L)) return true;
  const Real half = std::floor(lod) + 0.5L;
  return s.mip_filter == MipFilter::nearest && half > 0 && half < Real(texture.levels.size() - 1) &&
         close(lod, half, 1e-6L);
}

/// Whether any coordinate within its bounds reads the same texels the same way, smoothly or not at all different.
bool certain_lookup(const Texture& texture, const Sampler& s, const TexturePlace& p, double u_off, double v_off) {
  if (at_jump(texture, s, level_of_detail(texture, s, p))) return false;
  if (s.mag_filter == Filter::linear && s.min_filter == Filter::linear) return true;
  for (const TextureLevel& level : texture.levels)
    if (!inside_texel(p.u * level.width, Real(u_off) * level.width) ||
        !inside_texel(p.v * level.height, Real(v_off) * level.height))
      return false;
  return true;
}

}  // namespace

TexturePlace texture_place(const DrawnTriangle& t, Interpolation interpolation, int x, int y, size_t set) {
  const size_t u = uv_index(set);
  const auto value = [&](size_t k) { return Real(float(value_at(t, u + k, interpolation, x, y).value)); };
  TexturePlace place{value(0), value(1), 0, 0, 0, 0};
  if (interpolation == Interpolation::flat) return place;
  const int64_t px = int64_t(x) * kSubpixels + kSubpixels / 2, py = int64_t(y) * kSubpixels + kSubpixels / 2;
  const std::array<Real, 3> here = edges_at(t, interpolation, px, py);
  const std::array<Real, 3> right = edges_at(t, interpolation, px + kSubpixels, py);
  const std::array<Real, 3> above = edges_at(t, interpolation, px, py + kSubpixels);
  const auto corners = [&](size_t k) {
    const auto& v = t.window.values;
    return std::array<double, 3>{v[0][u + k], v[1][u + k], v[2][u + k]};
  };
  place.u_x = slope(here, right, corners(0)), place.v_x = slope(here, right, corners(1));
  place.u_y = slope(here, above, corners(0)), place.v_y = slope(here, above, corners(1));
  return place;
}

SurfaceColor surface_color(const Scene& scene, const GBufferState& planes, const DrawnTriangle& t, int x, int y) {
  const Material& material = scene.materials[scene.instances[t.instance].material];
  SurfaceColor out;
  for (size_t c = 0; c < 4; ++c)
    out.value[c] =
        value_at(t, kAlbedo + c, planes.albedo.interpolation, x, y).value * Real(material.base_color[int(c)]);
  if (!material.color_map.used()) return out;
  const Texture& texture = scene.textures[size_t(material.color_map.texture)];
  const Sampler& s = material.color_map.sampler;
  const size_t set = material.color_map.uv_set;
  const TexturePlace p = texture_place(t, planes.uv.interpolation, x, y, set);
  const double u_off = value_at(t, uv_index(set), planes.uv.interpolation, x, y).ulp,
               v_off = value_at(t, uv_index(set) + 1, planes.uv.interpolation, x, y).ulp;
  out.certain = certain_lookup(texture, s, p, u_off, v_off);
  const TexelValue texel = filtered(texture, s, p.u, p.v, level_of_detail(texture, s, p));
  for (size_t c = 0; c < 4; ++c) out.value[c] *= texel[c];
  return out;
}

namespace {

/// The texel of a map at a pixel; white where the slot is empty.
TexelValue map_texel(const Scene& scene, const GBufferState& planes, const TextureSlot& slot, const DrawnTriangle& t,
                     int x, int y, bool& certain) {
  if (!slot.used()) return {1, 1, 1, 1};
  const Texture& texture = scene.textures[size_t(slot.texture)];
  const TexturePlace p = texture_place(t, planes.uv.interpolation, x, y, slot.uv_set);
  const size_t u = uv_index(slot.uv_set);
  const double u_off = value_at(t, u, planes.uv.interpolation, x, y).ulp,
               v_off = value_at(t, u + 1, planes.uv.interpolation, x, y).ulp;
  certain = certain && certain_lookup(texture, slot.sampler, p, u_off, v_off);
  return filtered(texture, slot.sampler, p.u, p.v, level_of_detail(texture, slot.sampler, p));
}

}  // namespace

MaterialSurface material_surface(const Scene& scene, const Pipeline& pipeline, const DrawnTriangle& t, int x, int y) {
  const LightModel& model = pipeline.light_model;
  const Material& m = scene.materials[scene.instances[t.instance].material];
  const SurfaceColor base = surface_color(scene, pipeline.gbuffer, t, x, y);
  MaterialSurface out;
  out.certain = base.certain;
  const auto texel = [&](const TextureSlot& slot) {
    return map_texel(scene, pipeline.gbuffer, slot, t, x, y, out.certain);
  };
  const bool glass_in_albedo = m.transparent && pipeline.transparency.mode == TransparencyMode::into_albedo;
  const bool unlit = m.unlit && shows_unlit(model) && !glass_in_albedo;
  const TexelValue gloss = texel(m.specular_map), metal = texel(m.metallic_roughness_map), glow = texel(m.emission_map),
                   shade = texel(m.occlusion_map);
  const Real metallic = maps_metals(model) ? Real(m.metallic) * metal[2] : 0;
  for (size_t c = 0; c < 3; ++c) {
    out.albedo[c] = unlit ? 0 : base.value[c] * (1 - metallic);
    out.emission[c] = unlit ? base.value[c] : Real(m.emission[int(c)]) * glow[c];
    out.specular[c] =
        maps_metals(model) ? 0.04L + (base.value[c] - 0.04L) * metallic : Real(m.specular_color[int(c)]) * gloss[c];
    if (unlit) out.specular[c] = 0;
  }
  out.roughness = Real(m.roughness) * (unlit ? 1 : metal[1]);
  out.exponent = maps_metals(model) ? 2 / std::pow(std::max(out.roughness, 0.04L), 4.0L) - 2 : Real(m.shininess);
  if (!unlit) out.ambient_share = 1 - Real(m.occlusion_strength) * (1 - shade[0]);
  return out;
}

std::optional<bool> discarded(const Scene& scene, const GBufferState& planes, const DrawnTriangle& t, int x, int y) {
  const Material& material = scene.materials[scene.instances[t.instance].material];
  if (!material.masked()) return false;
  const SurfaceColor color = surface_color(scene, planes, t, x, y);
  const Real cutoff = material.alpha_cutoff;
  // A linear filter turns an ulp of a coordinate into less than 1e-4 of alpha for the textures that tests draw.
  if (!color.certain || close(color.value[3], cutoff, 1e-4L * std::max<Real>(1, cutoff))) return std::nullopt;
  return color.value[3] < cutoff;
}

}  // namespace trueshade::oracle
