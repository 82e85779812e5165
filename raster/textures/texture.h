#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A texture with the state it is read by, as lookups want it. Borrows the texels.
struct TextureView {
  struct Level {
    const uint8_t* bytes;
    int width, height;
    double inverse_width, inverse_height;  ///< rounded
  };
  TextureFormat format;
  int levels;
  Level level[kMaxTextureLevels];
  Sampler sampler;
  uint8_t uv_set;  ///< of the mesh, that lookups take their coordinates from
  bool masks;      ///< four bytes a texel, both axes repeat and all sides are powers of two
};
TextureView view_of(const Texture& texture, const Sampler& sampler, uint8_t uv_set = 0);

/// What a material does with textures. Absent maps are not read.
struct MaterialMaps {
  std::optional<TextureView> color, normal;
  std::optional<TextureView> specular, metallic_roughness, emission, occlusion;  ///< where MaterialValues has them read
  float normal_scale;
  float base_alpha, alpha_cutoff;  ///< cutoff 0: no test
  bool values = false;             ///< any map is there that surface_planes-inl.h multiplies by the material's values
  bool any = false;                ///< any map is there
  bool same_texels = true;         ///< all maps read the same texels of the same levels
  int uv_sets = 1;                 ///< one more than the last that a map reads
};

/// The maps of all materials, made once a frame.
struct SceneMaps {
  std::vector<MaterialMaps> material;  ///< one per Scene::materials; empty where none has a map that is read, or a mask
  Interpolation uv_how, albedo_how;    ///< of texture coordinates and of vertex colours
  int uv_sets = 1;                     ///< one more than the last that a map reads
  bool tangents = false;               ///< normal maps are read, and some mesh has tangents
  bool textured() const { return !material.empty(); }
};
SceneMaps scene_maps(const Scene& scene, const Pipeline& pipeline);

/// A place in a texture and how it moves from pixel to pixel, in units of u and v.
struct TexturePoint {
  float u, v;
  double u_x, v_x, u_y, v_y;
};

/// RGBA at each point (docs/arithmetic.md section 13), on the SIMD target in force. For tests.
void look_up(const TextureView& texture, std::span<const TexturePoint> points, std::span<std::array<float, 4>> out);

}  // namespace trueshade
