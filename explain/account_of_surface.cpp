#include "explain/account_parts.h"
#include "scenes/pipeline/material_values.h"

namespace trueshade {
namespace {

/// Adds the planes that the light model reads.
void add_planes(const SurfacePlanes& planes, const LightModel& model, Account& to) {
  to.add("position", planes.position, "world, scene units");
  to.add("normal", planes.normal, "world");
  to.add("albedo", planes.albedo, "linear R, G, B, A");
  to.add("uv", planes.uv, "texture coordinates of the first set");
  if (model.keeps_metals)
    to.add("metals", std::array{planes.specular[0], planes.specular[1]}, "metallic and roughness");
  else if (reads_specular_plane(model))
    to.add("specular", planes.specular, "specular R, G, B and shininess");
  if (model.emission)
    to.add("emission", planes.emission, "emission R, G, B and the share of ambient light that arrives");
}

/// The planes that every pipeline has, each with its format.
std::string format_names(const GBufferState& planes) {
  const auto name = [](Format format) { return std::string(info(format).name); };
  return "position " + (planes.position_from_depth ? "from depth" : name(planes.position.format)) + ", normal " +
         name(planes.normal.format) + ", albedo " + name(planes.albedo.format) + ", uv " + name(planes.uv.format);
}

}  // namespace

std::string_view depth_func_name(DepthFunc func) {
  constexpr std::string_view kNames[] = {"NEVER", "LESS", "EQUAL", "LEQUAL", "GREATER", "NOTEQUAL", "GEQUAL", "ALWAYS"};
  return kNames[size_t(func)];
}

Account surface_account(const ExplainedFrame& frame, uint32_t of_instance, const PixelSurface& surface,
                        const GBufferState& planes, const std::string& of) {
  const CornerWeights& w = surface.weights;
  const Instance& instance = frame.scene.instances[of_instance];
  const Material& material = frame.scene.materials[instance.material];
  Account out("surface", "Surface of " + of + " (docs/arithmetic.md, sections 5, 7 and 13)");
  out.add("u", w.u, "1 / w of corners 0, 1, 2");
  out.add("q", w.q, "sum of E_i u_i");
  out.add("b", w.smooth, "perspective weights b_1, b_2");
  out.add("b_linear", w.linear, "the same without perspective");
  if (surface.turned)
    out.add("turned", true, "the normal of a double-sided back face is negated, after a normal map has bent it");
  out.add("material", int64_t(instance.material),
          "index; its id is one more" + (material.name.empty() ? "" : ": " + material.name));
  out.add("base",
          std::array{material.base_color.r, material.base_color.g, material.base_color.b, material.base_color.a},
          "the material's base colour R, G, B, A");
  for (const MapLookup& lookup : surface.lookups) {
    Account& part = out.part("map", lookup.map + " map");
    part.add("uv", std::array{lookup.at.u, lookup.at.v}, "where it is read");
    part.add("along_x", std::array{lookup.at.u_x, lookup.at.v_x}, "how u and v change by a pixel to the right");
    part.add("along_y", std::array{lookup.at.u_y, lookup.at.v_y}, "and by a pixel up");
    part.add("texel", lookup.texel, "filtered R, G, B, A");
    if (lookup.map == "normal" && surface.tangent)
      part.add("tangent", *surface.tangent, "of the vertices, interpolated: U in the world, and the side of B");
  }
  const LightModel& model = frame.pipeline.light_model;
  add_planes(surface.computed, model, out.part("computed", "As interpolated, with maps and material"));
  const bool stored = !is_forward(frame.pipeline.strategy);
  add_planes(surface.read, model,
             out.part("read", stored ? "As lights read it from the planes: " + format_names(planes)
                                     : "As lights read it: the same, a forward strategy stores no planes"));
  return out;
}

}  // namespace trueshade
