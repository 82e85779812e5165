#include "raster/light_geometry/light_outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/threads/parallel_for.h"
#include "raster/light_geometry/outline_maker.h"
#include "raster/light_geometry/transformed_mesh.h"

namespace trueshade {
namespace {

constexpr int kWindowOrigin[2] = {0, 0};

constexpr int64_t kSmallEdge = int64_t(1) << 24;  // a tile's 63 steps in both directions then stay below 2^31
static_assert(2 * (kMaxTile - 1) * kSmallEdge < int64_t(1) << 31);

// Masks of a tile's blocks by edges of any length.
void add_masks(std::span<const OutlineEdge> edges, const TileRect& rect, std::vector<uint16_t>& masks) {
  for (int y = rect.y; y < rect.y + rect.size; y += kBlockSize)
    for (int x = rect.x; x < rect.x + rect.size; x += kBlockSize) {
      unsigned mask = 0xFFFF;
      for (const OutlineEdge& e : edges) {
        const int64_t at = e.at + e.across * x + e.up * y;
        for (int i = 0; i < kBlockPixels; ++i)
          if (at + e.across * (i % kBlockSize) + e.up * (i / kBlockSize) < 0) mask &= ~(1u << i);
      }
      masks.push_back(uint16_t(mask));
    }
}

}  // namespace

GeometryState light_geometry_state(const Pipeline& pipeline) {
  GeometryState state = pipeline.geometry;
  state.cull_face = pipeline.light_volumes.cull_face;
  state.front_face = FrontFace::ccw;
  state.depth_clamp = pipeline.light_volumes.depth_clamp;
  return state;
}

namespace {

// Whether a ball lies wholly beyond one side of the view, by more than its vertices' roundings, or behind the eye: a
// mesh inside of it then covers no pixel.
bool out_of_view(const View& view, const glm::vec3& center, double radius) {
  const float* const row = view.clip_from_world.data();  // x y z w
  const auto beyond = [&](int axis, double sign) {       // of all points of the ball: w + sign * x < 0
    double middle = double(row[15]), slope2 = 0.0, size = std::abs(double(row[15]));
    if (axis >= 0) middle += sign * double(row[4 * axis + 3]), size += std::abs(double(row[4 * axis + 3]));
    for (int c = 0; c < 3; ++c) {
      const double other = axis >= 0 ? double(row[4 * axis + c]) : 0.0, slope = double(row[12 + c]) + sign * other;
      middle += slope * double(center[c]), slope2 += slope * slope;
      size += (std::abs(double(row[12 + c])) + std::abs(other)) * (std::abs(double(center[c])) + radius);
    }
    return middle + std::sqrt(slope2) * radius < -0x1p-16 * size;
  };
  return beyond(-1, 0.0) || beyond(0, 1.0) || beyond(0, -1.0) || beyond(1, 1.0) || beyond(1, -1.0);
}

// The radius of a ball about a light that its mesh lies in; infinity where that is not known.
double mesh_radius(LightExtent extent, float range) {
  if (extent == LightExtent::cone) return std::numeric_limits<double>::infinity();
  return double(range) * (extent == LightExtent::box ? 1.7320509 : 1.0000001);
}

}  // namespace

struct OutlineTasks::Work {
  struct Part {
    TransformedMesh placed;
    OutlineMaker maker;
  };
  std::span<const Light> lights;
  LightVolumes volumes;
  const LightMeshes* meshes;
  const View* view;
  LightOutlines* out;
  size_t task = 1;  // lights of one
  std::vector<std::unique_ptr<Part>> parts;

  int tasks() const { return int((lights.size() + task - 1) / task); }

  OutlineMaker::Outline outline(const Light& light, Part& part) const {
    const LightExtent extent = drawn_extent(light, volumes);
    if (!is_mesh(extent)) return part.maker.everywhere(OutlineKind::everywhere);
    if (out_of_view(*view, light.position, mesh_radius(extent, light.range))) return {};
    transform_mesh((*meshes)[extent], light, *view, out->window, kWindowOrigin, part.placed);
    return part.maker.outline((*meshes)[extent], part.placed);
  }
};

OutlineTasks::OutlineTasks() : work_(std::make_unique<Work>()) {}
OutlineTasks::~OutlineTasks() = default;

int OutlineTasks::start(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                        const View& view, LightOutlines& out) {
  Work& w = *work_;
  w.lights = lights, w.volumes = pipeline.light_volumes, w.meshes = &meshes, w.view = &view, w.out = &out;
  out.state = light_geometry_state(pipeline);
  out.window = window_transform(out.state, pipeline.width, pipeline.height, pipeline.profile, view.region);
  const size_t padded = (lights.size() + 15) / 16 * 16;
  out.kind.resize(lights.size());
  out.layers.resize(lights.size());
  for (auto* side : {&out.x0, &out.y0, &out.x1, &out.y1}) {
    side->resize(padded);
    std::fill(side->begin() + std::ptrdiff_t(lights.size()), side->end(), 0);
  }
  out.first.resize(lights.size() + 1);
  w.task = std::clamp<size_t>(lights.size() / 32, 1, 1024);
  while (int(w.parts.size()) < w.tasks()) w.parts.push_back(std::make_unique<Work::Part>());
  return w.tasks();
}

void OutlineTasks::run(int task) {
  Work& w = *work_;
  LightOutlines& out = *w.out;
  Work::Part& part = *w.parts[size_t(task)];
  part.maker.start(out.state, out.window);
  for (size_t i = size_t(task) * w.task; i < std::min(w.lights.size(), size_t(task + 1) * w.task); ++i) {
    const OutlineMaker::Outline r = w.outline(w.lights[i], part);
    out.kind[i] = r.kind;
    out.layers[i] = r.layers;
    out.x0[i] = r.x0, out.y0[i] = r.y0, out.x1[i] = r.x1, out.y1[i] = r.y1;
    out.first[i + 1] = r.edges;
  }
}

void OutlineTasks::finish(int threads) {
  const Work& w = *work_;
  LightOutlines& out = *w.out;
  out.first[0] = 0;
  for (size_t i = 0; i < w.lights.size(); ++i) out.first[i + 1] += out.first[i];
  out.edges.resize(out.first.back());
  constexpr size_t kFew = 4096;  // edges that are as soon copied by one
  parallel_for(w.tasks(), out.edges.size() > kFew ? threads : 1, [&](int task) {
    const std::vector<OutlineEdge>& edges = w.parts[size_t(task)]->maker.edges();
    std::copy(edges.begin(), edges.end(), out.edges.begin() + std::ptrdiff_t(out.first[size_t(task) * w.task]));
  });
}

LightOutlines make_light_outlines(std::span<const Light> lights, const Pipeline& pipeline, const LightMeshes& meshes,
                                  const View& view, int threads) {
  LightOutlines out;
  OutlineTasks tasks;
  parallel_for(tasks.start(lights, pipeline, meshes, view, out), threads, [&](int task) { tasks.run(task); });
  tasks.finish(threads);
  return out;
}

Cover tile_cover(const LightOutlines& outlines, size_t light, const TileRect& rect, std::vector<TileEdge>& edges,
                 std::vector<uint16_t>& masks) {
  const std::span<const OutlineEdge> all(outlines.edges.data() + outlines.first[light],
                                         outlines.edges.data() + outlines.first[light + 1]);
  const size_t first = edges.size();
  bool fits = true;
  for (const OutlineEdge& e : all) {
    const int64_t at = e.at + e.across * rect.x + e.up * rect.y, steps = rect.size - 1;
    if (at + std::max<int64_t>(e.across, 0) * steps + std::max<int64_t>(e.up, 0) * steps < 0) {
      edges.resize(first);
      return Cover::none;
    }
    if (at + std::min<int64_t>(e.across, 0) * steps + std::min<int64_t>(e.up, 0) * steps >= 0) continue;
    fits = fits && std::abs(e.across) < kSmallEdge && std::abs(e.up) < kSmallEdge;
    edges.push_back({int32_t(at), int32_t(e.across), int32_t(e.up)});
  }
  if (edges.size() == first) return Cover::all;
  if (fits) return Cover::edges;
  edges.resize(first);
  add_masks(all, rect, masks);
  return Cover::masks;
}

uint16_t block_mask(std::span<const TileEdge> edges, int x, int y) {
  unsigned mask = 0xFFFF;
  for (const TileEdge& e : edges) {
    if (edge_contains(e, x, y, kBlockSize, kBlockSize)) continue;
    for (int i = 0; i < kBlockPixels; ++i)
      if (!edge_touches(e, x + i % kBlockSize, y + i / kBlockSize, 1, 1)) mask &= ~(1u << i);
  }
  return uint16_t(mask);
}

int count_light_mesh(const LightMesh& mesh, const Light& light, const LightOutlines& outlines, const View& view,
                     const TileRect& rect, uint16_t* counts) {
  const size_t pixels = size_t(rect.size) * size_t(rect.size);
  std::fill_n(counts, pixels, uint16_t(0));
  const int sample[2] = {rect.x * 256 + 128, rect.y * 256 + 128};
  thread_local TransformedMesh placed;
  transform_mesh(mesh, light, view, outlines.window, sample, placed);
  count_mesh(mesh, placed, outlines.state, outlines.window, rect, counts);
  return *std::max_element(counts, counts + pixels);
}

}  // namespace trueshade
