// Colour maps that are read otherwise than scenes can say: with an anisotropic filter.
#include <algorithm>
#include <bit>
#include <cmath>

#include "oracle/scalar_renderer.h"
#include "oracle/textured_surface.h"
#include "tests/judge/diagnosis/plants.h"

namespace trueshade::testing {

namespace {

using oracle::TexturePlace;

/// Boards of 8 by 8 fields, so often over each object, with floors that are seen at a slant.
void chequered(Scene& s, Pipeline&) {
  constexpr float kTimes = 6;
  Texture board;
  board.format = TextureFormat::rgba8;
  board.levels.push_back({64, 64, {}});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool light = (x / 8 + y / 8) % 2 == 0;
      append_texel(board.format, light ? std::array{0.9f, 0.8f, 0.6f, 1.0f} : std::array{0.2f, 0.3f, 0.4f, 1.0f},
                   board.levels[0].bytes);
    }
  build_mip_chain(board);
  s.textures.push_back(std::move(board));
  for (Mesh& mesh : s.meshes) {
    const glm::vec3 reach(reach_of(mesh));
    const float size = std::max({reach.x, reach.y, reach.z, 1e-6f});
    for (size_t k = 0; k < 2; ++k) mesh.uv[k].resize(mesh.vertex_count());
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      mesh.uv[0][v] = kTimes / size * (mesh.position[0][v] + 0.37f * mesh.position[1][v]);
      mesh.uv[1][v] = kTimes / size * (mesh.position[2][v] - 0.21f * mesh.position[1][v]);
    }
  }
  for (Material& m : s.materials) m.color_map = {int32_t(s.textures.size() - 1), {}, 0};
}

/// EXT_texture_filter_anisotropic as it is written there: the texel before vertex and base colours.
oracle::TexelValue anisotropic(const Texture& map, const Sampler& sampler, const TexturePlace& p, int most) {
  const long double w = map.levels[0].width, h = map.levels[0].height;
  const long double p_x = std::sqrt(p.u_x * w * p.u_x * w + p.v_x * h * p.v_x * h),
                    p_y = std::sqrt(p.u_y * w * p.u_y * w + p.v_y * h * p.v_y * h);
  const long double p_max = std::max(p_x, p_y), p_min = std::min(p_x, p_y);
  const long double n = std::min(std::ceil(p_max / p_min), (long double)(most));
  oracle::TexelValue sum{};
  for (long double i = 1; i <= n; ++i) {
    const long double moved = -0.5L + i / (n + 1);
    const long double u = p.u + moved * (p_x > p_y ? p.u_x : p.u_y), v = p.v + moved * (p_x > p_y ? p.v_x : p.v_y);
    const oracle::TexelValue one = oracle::filtered(map, sampler, u, v, std::log2(p_max / n));
    for (size_t c = 0; c < 4; ++c) sum[c] += one[c] / n;
  }
  return sum;
}

/// Of every visible fragment, where the map reads another texel than the isotropic filter does: the albedo is scaled by
/// both texels' ratio.
void filter_anisotropically(const Scene& s, const Pipeline& p, oracle::Capture& c, int variant) {
  constexpr int kMost[] = {16, 4, 8};
  const oracle::ScalarFrame frame = oracle::scalar_frame(s, p);
  NamedImage& plane = *std::find_if(c.planes.begin(), c.planes.end(), [](auto& i) { return i.name == "albedo"; });
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const oracle::Visible seen = visible_fragment(frame.at(x, y), p.geometry);
      if (!seen.fragment) continue;
      const oracle::DrawnTriangle& t = frame.triangles[frame.at(x, y)[*seen.fragment].window];
      const Material& m = s.materials[s.instances[t.instance].material];
      const Texture& map = s.textures[size_t(m.color_map.texture)];
      const TexturePlace place = texture_place(t, p.gbuffer.albedo.interpolation, x, y, m.color_map.uv_set);
      const oracle::TexelValue texel = anisotropic(map, m.color_map.sampler, place, kMost[variant % 3]);
      for (int k = 0; k < 3; ++k) {
        const double value =
            double(value_at(t, oracle::kAlbedo + size_t(k), p.gbuffer.albedo.interpolation, x, y).value *
                   texel[size_t(k)]) *
            double(m.base_color[k]);
        const int row = frame.height - 1 - y;
        if (plane.image.format == Format::rgba8)
          plane.image.set_code(x, row, k, uint32_t(std::lround(std::clamp(value, 0.0, 1.0) * 255)));
        else
          plane.image.set_code(x, row, k, std::bit_cast<uint32_t>(float(value)));
      }
    }
}

}  // namespace

const std::vector<Plant>& plants_of_filters() {
  static const std::vector<Plant> all = [] {
    Plant p;
    p.name = "an anisotropic filter left on", p.names = {"texture-anisotropy"}, p.plane = "albedo";
    p.presets = {"many-lights", "touchdesigner"};
    p.output = filter_anisotropically, p.base = chequered;
    return std::vector<Plant>{p};
  }();
  return all;
}

}  // namespace trueshade::testing
