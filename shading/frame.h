#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/simd/simd_target.h"
#include "core/threads/parallel_for.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/output/extent.h"

namespace trueshade {

/// The work that OpenGL would do for the frame, by which strategies are compared; how we draw does not matter. N is the
/// number of pixels with a surface (FrameStats counts overdraw as fragments), L that of lights. P is the number of
/// pixels with a surface under light geometry, each counted as often as geometry is drawn there. `planes` are the
/// planes of the G-buffer that the light pass reads.
struct GlCounts {
  uint64_t light_pixels = 0;            ///< P; deferred-loop: N
  uint64_t material_computations = 0;   ///< forward: N L; deferred-volumes: P; deferred-loop: N L
  uint64_t gbuffer_fragments_read = 0;  ///< deferred: planes P
  uint64_t target_fragments_read = 0;   ///< by blending: multipass N (L - 1), volumes P, else 0
  uint64_t fragments_written = 0;       ///< multipass: N L; forward-loop: N; deferred: planes N + P
  uint64_t draws = 0;                   ///< multipass: instances times L; deferred: instances and one a light, or one
  uint64_t light_triangles = 0;         ///< of light geometry; a quad has two
  int planes = 0;
};

/// Core time by stage, ms: of a tile, or of many.
struct StageTimes {
  double visibility = 0, surfaces = 0, light = 0, store = 0;
  double geometry() const { return visibility + surfaces; }
  double sum() const { return visibility + surfaces + light + store; }
  StageTimes& operator+=(const StageTimes& other) {
    visibility += other.visibility, surfaces += other.surfaces, light += other.light, store += other.store;
    return *this;
  }
};

/// Counts of one frame. The first group depends on scene and pipeline alone; the second on Execution too.
struct FrameStats {
  uint64_t pixels = 0;                 ///< of the image
  uint64_t covered_pixels = 0;         ///< N: with an opaque surface
  uint64_t lit_pixel_lights = 0;       ///< pairs of covered pixel and light in range that it faces; 0 if none is shown
  uint64_t pixel_lights = 0;           ///< covered pixels times lights
  uint64_t transparent_fragments = 0;  ///< blended: they pass the depth test
  uint64_t triangles = 0;              ///< submitted, over all instances
  uint64_t lights = 0;

  GlCounts gl;  ///< for deferred-volumes complete only with Execution::count_as_gl: P has to be counted separately

  uint64_t clusters_drawn = 0;     ///< cluster x tile pairs whose triangles were set up
  uint64_t triangles_tested = 0;   ///< set up, over all tiles
  uint64_t fragments = 0;          ///< covered samples before the depth test
  uint64_t tile_pixel_lights = 0;  ///< covered pixels times lights in the tile's list; of many lights, its region's
  uint64_t evaluated_pixel_lights = 0;           ///< lanes the light kernel computed a contribution for
  uint64_t lights_tested = 0;                    ///< tests of a light against the bounds of a tile or of a region
  StageTimes core_ms;                            ///< of the tiles, summed over threads
  double total_ms = 0;                           ///< wall time of the frame
  double before_tiles_ms = 0;                    ///< wall time: view, bins, light tables
  double first_tile_ms = 0;                      ///< wall time until a tile was finished
  std::vector<ParallelLoop> loops_before_tiles;  ///< the parts of that which threads share
  int tile = 0, threads = 0;                     ///< of the frame: pixels a side, and how many at work
  std::vector<StageTimes> tile_ms;               ///< each tile's, in the order they are started
};

/// Planes to hand out beside the colour target (docs/views.md). Names: depth Z position normal albedo specular
/// emission uv id.object id.material light.count light.tile light.boxes light.edges light.intensity overdraw, and
/// `light.<i>` for each light of the scene.
std::span<const std::string_view> aov_names();  ///< but for `light.<i>`
bool is_aov_name(std::string_view name);        ///< of one of them, or `light.<i>` with any i

/// What a frame has made: the picture, and what was asked for beside it.
struct Frame {
  Image color;
  std::vector<NamedImage> aovs;  ///< in the order asked for
  FrameStats stats;
  uint32_t view_scale = 0;  ///< of views that are heat maps: the count at the top of the colour map; else 0
};

struct ClusteredScene;

/// Scene with its meshes split into clusters, built once; frames of any pipeline are drawn from it.
/// Borrows the scene, which must outlive it with its meshes unchanged. set_time() may move it between frames; update()
/// follows where a mesh deforms.
class PreparedScene {
 public:
  explicit PreparedScene(const Scene& scene);
  /// With the clusters of its meshes, where they are there already.
  PreparedScene(const Scene& scene, std::unique_ptr<ClusteredScene> clusters);
  ~PreparedScene();
  PreparedScene(PreparedScene&&) noexcept;

  /// Splits those meshes again that set_time() has posed since the last call. Without it, frames show the old pose.
  void update();

  const Scene& scene() const { return *scene_; }
  const ClusteredScene& clusters() const { return *clusters_; }

 private:
  const Scene* scene_;
  std::unique_ptr<ClusteredScene> clusters_;
};

/// Numbers of the whole picture that the pixels of all its regions depend on (shading/picture_region.h); each is as it
/// is here where nothing depends on it.
struct PictureConstants {
  uint32_t view_scale = 0;           ///< of heat maps: Frame::view_scale
  double logarithmic_mean = 0.0;     ///< of the luminance before tones are mapped
  std::array<Extent, 3> extents{};   ///< of the views `depth` (the first) and `position`: finite values on surfaces
};

/// Called now and then with the tiles done and the tiles in all, from any one thread at a time.
using Progress = std::function<void(int done, int total)>;

/// Draws one frame: geometry pass, light lists, light pass, store. The image is a pure function of scene and pipeline;
/// `execution`, the machine and the caller's floating-point environment never change a bit of it.
/// The image is the target, or what pipeline.view shows instead. `aovs`: names, see is_aov_name(). Throws Error(usage)
/// for values out of range.
/// With execution.region the frame and its planes are that part of the picture, and its counts are those of what had to
/// be drawn for it. `constants`: of the picture; null: where has_constants(), the whole picture is drawn to find them.
Frame render_frame(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution = {},
                   std::span<const std::string> aovs = {}, const Progress& progress = {},
                   const PictureConstants* constants = nullptr);
/// The same of a scene that is split into clusters for this frame alone.
Frame render_frame(const Scene& scene, const Pipeline& pipeline, const Execution& execution = {},
                   std::span<const std::string> aovs = {}, const Progress& progress = {});

}  // namespace trueshade
