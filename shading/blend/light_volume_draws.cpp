#include "shading/blend/light_volume_draws.h"

#include <bit>

#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

// A light's mesh, triangle by triangle: masks of what it covers once, twice, and so on.
void list_mesh(const LightVolumeDraws& in, const TileRect& rect, uint32_t light, std::vector<uint16_t>& counts,
               TileLights& out) {
  counts.resize(kMaxTilePixels);
  const LightMesh& mesh = in.meshes[drawn_extent(in.lights[light], in.volumes)];
  const int most = count_light_mesh(mesh, in.lights[light], in.outlines, in.view, rect, counts.data());
  const int pixels = rect.size * rect.size;
  for (int layer = 1; layer <= most; ++layer) {
    const auto first = uint32_t(out.masks.size());
    for (int i = 0; i < pixels; i += kBlockPixels) {
      unsigned mask = 0;
      for (int k = 0; k < kBlockPixels; ++k) mask |= unsigned(counts[size_t(i + k)] >= layer) << k;
      out.masks.push_back(uint16_t(mask));
    }
    out.add(in.table, light, first, ListedLight::kMasked);
  }
}

}  // namespace

LightVolumeDraws light_volume_draws(std::span<const Light> lights, const Pipeline& pipeline, const Execution& execution,
                                    const LightTable& table, const LightClusters& clusters, const LightMeshes& meshes,
                                    const LightOutlines& outlines, const View& view) {
  const bool multipass = pipeline.strategy == Strategy::forward_multipass;
  const BlendTarget target{pipeline.target, pipeline.profile, pipeline.gbuffer.half_round};
  return {.lights = lights,
          .table = table,
          .clusters = clusters,
          .model = pipeline.light_model,
          .volumes = pipeline.light_volumes,
          .meshes = meshes,
          .outlines = outlines,
          .view = view,
          .blend = multipass ? kAddLight : pipeline.blend,
          .target = target,
          .base = multipass || pipeline.light_volumes.base,
          .first_base = multipass,
          .culling = execution.light_culling,
          .compiled = execution.compiled_models,
          .bounded_codes = execution.bounded_codes};
}

int start_outlines(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes, const View& view,
                   OutlineTasks& tasks, LightOutlines& out) {
  if (pipeline.strategy != Strategy::forward_multipass) return tasks.start(lights, pipeline, meshes, view, out);
  Pipeline drawn = pipeline;
  drawn.light_volumes.point = drawn.light_volumes.spot = LightExtent::unbounded;
  return tasks.start(lights, drawn, meshes, view, out);
}

LightOutlines outlines_of_draws(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                                const View& view, int threads) {
  LightOutlines out;
  OutlineTasks tasks;
  parallel_for(start_outlines(lights, pipeline, meshes, view, tasks, out), threads, [&](int i) { tasks.run(i); });
  tasks.finish(threads);
  return out;
}

void list_draws(const LightVolumeDraws& in, const TileRect& rect, std::span<const uint32_t> lights,
                std::vector<uint16_t>& counts, TileLights& out) {
  for (const uint32_t light : lights) {
    const OutlineKind kind = in.outlines.kind[light];
    if (kind == OutlineKind::nothing) continue;
    if (kind == OutlineKind::mesh) {
      list_mesh(in, rect, light, counts, out);
      continue;
    }
    const auto edges = uint32_t(out.edges.size()), masks = uint32_t(out.masks.size());
    const Cover cover =
        kind == OutlineKind::everywhere ? Cover::all : tile_cover(in.outlines, light, rect, out.edges, out.masks);
    if (cover == Cover::none) continue;
    const bool masked = cover == Cover::masks;
    for (int i = 0; i < in.outlines.layers[light]; ++i)
      out.add(in.table, light, masked ? masks : edges,
              masked ? ListedLight::kMasked : int16_t(out.edges.size() - edges));
  }
}

void covered_bits(const SurfaceTile& surface, int blocks, uint16_t* bits) {
  for (int b = 0; b < blocks; ++b) {
    unsigned mask = 0;
    for (int i = 0; i < kBlockPixels; ++i) mask |= unsigned(surface.covered[b * kBlockPixels + i] & 1) << i;
    bits[b] = uint16_t(mask);
  }
}

uint64_t count_lit_geometry(const LightVolumeDraws& draws, const SurfaceTile& surface, const TileRect& rect,
                            std::vector<uint16_t>& counts, TileLights& scratch) {
  const int blocks = rect.size / kBlockSize;
  uint16_t covered[kMaxTilePixels / kBlockPixels];
  covered_bits(surface, blocks * blocks, covered);
  const LightOutlines& o = draws.outlines;
  uint64_t total = 0;
  for (uint32_t light = 0; light < draws.lights.size(); ++light) {
    const bool touches = o.x0[light] < rect.x + rect.size && o.x1[light] > rect.x && o.y0[light] < rect.y + rect.size &&
                         o.y1[light] > rect.y;
    if (!touches) continue;
    scratch.clear();
    list_draws(draws, rect, std::span(&light, 1), counts, scratch);
    for (const ListedLight& listed : scratch.light)
      for (int b = 0; b < blocks * blocks; ++b)
        total += uint64_t(std::popcount(cover_of_block(scratch, listed, b, blocks) & covered[b]));
  }
  return total;
}

}  // namespace trueshade
