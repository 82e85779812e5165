#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/blend_state.h"
#include "core/format.h"
#include "core/numeric_profile.h"
#include "scenes/pipeline/image_view.h"
#include "scenes/light.h"
#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/light_program.h"
#include "scenes/pipeline/post_chain.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade {

// GL's names for GL's state; the spelling in JSON is the enumerator's.
enum class DepthFunc : uint8_t { never, less, equal, lequal, greater, notequal, gequal, always };
enum class CullFace : uint8_t { none, front, back, front_and_back };
enum class FrontFace : uint8_t { ccw, cw };
enum class ClipOrigin : uint8_t { lower_left, upper_left };
enum class ClipDepth : uint8_t { negative_one_to_one, zero_to_one };
enum class Interpolation : uint8_t { smooth, flat, noperspective };
enum class Provoking : uint8_t { last, first };

/// Which shader makes normals unit length. Without the vertex shader, longer normals (M^-T n is long where an object is
/// scaled down) draw the directions between vertices to theirs; without the fragment shader, interpolated normals are
/// shorter than 1 between vertices.
enum class UnitNormals : uint8_t { vertex, fragment, both };
/// Whether the vertex shader makes normals unit length.
constexpr bool made_unit_at_vertex(UnitNormals shader) { return shader != UnitNormals::fragment; }
/// Whether the fragment shader does.
constexpr bool made_unit_at_fragment(UnitNormals shader) { return shader != UnitNormals::vertex; }

/// How lights come to pixels. Spelled with hyphens outside C++.
enum class Strategy : uint8_t {
  forward_multipass,  ///< every object once a light, added to the target after each
  forward_loop,       ///< every object once, all lights summed in float32 registers, one store
  deferred_volumes,   ///< G-buffer, then each light drawn as its geometry, blended and rounded light by light
  deferred_loop       ///< G-buffer, then one pass that sums the lights in float32 registers, one store
};
inline constexpr std::string_view kStrategyNames[] = {"forward-multipass", "forward-loop", "deferred-volumes",
                                                      "deferred-loop"};
/// Spelling on the command line and in JSON.
constexpr std::string_view name_of(Strategy strategy) { return kStrategyNames[size_t(strategy)]; }
/// Whether the target is rounded after each light.
constexpr bool blends_lights(Strategy s) { return s == Strategy::forward_multipass || s == Strategy::deferred_volumes; }
/// Whether lights are computed where objects are drawn, without a G-buffer.
constexpr bool is_forward(Strategy s) { return s == Strategy::forward_multipass || s == Strategy::forward_loop; }

/// What bounds a light beside its falloff. A light whose range is infinite is unbounded whatever this says.
enum class LightExtent : uint8_t {
  unbounded,  ///< nothing; drawn as a quad over the whole image
  range,      ///< distance < range; drawn as a quad whose fragments beyond are discarded
  box,        ///< axis-aligned mesh, half side `range`; where nothing is drawn as a mesh, the same as `range`, as are
  sphere,     ///< a mesh whose vertices lie on the sphere of radius `range`
  cone,       ///< a mesh with its apex at the light and its base at `range`, as wide as the light's cone
  hemisphere  ///< half a `sphere`, on the side that a flat area light shines to: what `cone` is to these, not stated
};

/// glViewport in window pixels, y up; any integers. 0 x 0 stands for the whole image, whatever x and y.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Viewport&) const = default;
};

/// State of the geometry pass. Every field may change pixels.
struct GeometryState {
  Viewport viewport;
  float depth_near = 0.0f, depth_far = 1.0f;  ///< glDepthRange, each in [0, 1]
  DepthFunc depth_func = DepthFunc::less;
  float clear_depth = 1.0f;  ///< in [0, 1]
  bool depth_clamp = false;  ///< no near and far clipping; depth clamped to the range instead
  CullFace cull_face = CullFace::none;
  FrontFace front_face = FrontFace::ccw;
  ClipOrigin clip_origin = ClipOrigin::lower_left;
  ClipDepth clip_depth = ClipDepth::negative_one_to_one;
  Provoking provoking = Provoking::last;  ///< the vertex a flat attribute follows
  Format depth_format = Format::d32f;     ///< one of kDepthFormats: what depths are rounded to before they are compared
  float polygon_offset_factor = 0.0f, polygon_offset_units = 0.0f;  ///< glPolygonOffset, each within 1e18; 0, 0 is off
  bool operator==(const GeometryState&) const = default;
};

/// How a plane of the G-buffer is stored, and how its values are interpolated between vertices.
struct PlaneState {
  Format format = Format::rgba32f;
  Interpolation interpolation = Interpolation::smooth;
  bool operator==(const PlaneState&) const = default;
};

/// The planes the light pass reads, in the formats that round them. position, uv: kPositionFormats; normal:
/// kNormalFormats; albedo: kAlbedoFormats. Ids are r32ui. The planes `specular` (RGB the specular colour, A the
/// shininess; kSpecularFormats) and `emission` (RGB the emission, A the share of ambient light that arrives, 1 in
/// formats without alpha; kEmissionFormats) exist where the light model reads them; they hold what the material makes
/// of the pixel.
struct GBufferState {
  PlaneState position, normal, albedo{Format::rgba8, Interpolation::smooth}, uv;
  Format specular = Format::rgba32f, emission = Format::rgba32f;
  UnitNormals unit_normals = UnitNormals::vertex;
  bool position_from_depth = false;  ///< rebuilt from the stored depth (docs/arithmetic.md); `position` is not read
  HalfRound half_round = HalfRound::toward_zero;
  bool operator==(const GBufferState&) const = default;
};

/// How lights are bounded and drawn. Ambient and directional lights are unbounded. Quads are never culled.
struct LightVolumes {
  LightExtent point = LightExtent::unbounded, spot = LightExtent::unbounded;
  int slices = 16;                      ///< of spheres and cones, around their axis: 3 to 64
  int stacks = 8;                       ///< of spheres, from pole to pole: 2 to 64
  CullFace cull_face = CullFace::none;  ///< of meshes; seen from outside their triangles are counter-clockwise
  bool depth_clamp = true;              ///< of meshes; there is no depth test
  bool base = true;                     ///< first a draw over the image, not blended: what a surface has without lights
  bool operator==(const LightVolumes&) const = default;
};

/// What bounds lights of a type whose range is finite.
constexpr LightExtent stated_extent(LightType type, const LightVolumes& volumes) {
  const LightReach reach = kLightTypes[size_t(type)].reach;
  return reach == LightReach::everywhere   ? LightExtent::unbounded
         : reach == LightReach::all_around ? volumes.point
                                           : volumes.spot;
}

/// Blending of the draws of deferred-volumes: RGB accumulate, alpha is not written.
inline constexpr BlendState kAddLight{true, kAccumulate, kAccumulate, {}, {true, true, true, false}};

/// Everything that may change a pixel, beside the scene.
struct Pipeline {
  std::string preset = "many-lights";  ///< the row the other values started from; not read by any stage
  int width = 800, height = 800;       ///< pixels, 1..2^20 each; over 65536 a side a picture is drawn by regions
  GeometryState geometry;
  GBufferState gbuffer;
  LightModel light_model;
  LightProgram light_program;  ///< takes the place of light_model where there is one
  LightVolumes light_volumes;
  BlendState blend = kAddLight;  ///< of deferred-volumes, a light's draws; forward-multipass always has kAddLight
  TransparencyState transparency;
  Strategy strategy = Strategy::deferred_loop;
  Format target = Format::rgba8;  ///< one of kTargetFormats
  NumericProfile profile = NumericProfile::ideal;
  PostChain post;                   ///< of the view `lit`
  ImageView view = ImageView::lit;  ///< of others the image is rgba8, whatever the target
  bool operator==(const Pipeline&) const = default;
};

/// The planes surfaces really have: forward strategies store none, so that lights see float32 attributes.
constexpr GBufferState surface_planes(const Pipeline& pipeline) {
  GBufferState g = pipeline.gbuffer;
  if (!is_forward(pipeline.strategy)) return g;
  g.position_from_depth = false;
  for (PlaneState* plane : {&g.position, &g.normal, &g.albedo, &g.uv}) plane->format = Format::rgba32f;
  g.specular = g.emission = Format::rgba32f;
  return g;
}

/// A rectangle of a picture's pixels, rows counted from the top. 0 x 0 stands for the whole picture, whatever x and y.
struct PictureRegion {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PictureRegion&) const = default;
  bool whole() const { return width == 0 && height == 0; }
};

inline constexpr int kMostPictureSide = 1 << 20;  ///< pixels
inline constexpr int kMostDrawnSide = 1 << 16;    ///< pixels, of what one frame draws: the picture, or a region of it

/// How a frame is computed. Never changes a pixel.
struct Execution {
  int threads = 0;                 ///< 0: one a core; at most 1024
  int tile = 0;                    ///< pixels a side: 8, 16, 32, 48 or 64; 0: by size and threads, see tile_for()
  std::string_view simd = "best";  ///< best, scalar, sse4, avx2 or avx512
  bool light_culling = true;
  bool geometry_culling = true;  ///< clusters outside the view or behind nearer blocks are left out
  bool shuffle_tiles = false;    ///< tiles in a scrambled order; for tests of determinism
  bool compiled_models = true;   ///< light kernels compiled for the usual models; otherwise the general one for all
  bool count_as_gl = false;      ///< count pixels under light geometry too (FrameStats::gl)
  bool fast_geometry = true;     ///< special paths for usual triangles and surfaces; otherwise the general ones for all
  bool bounded_codes = true;     ///< codes of a light's term and of sums by bounds on them, where one code is possible
  PictureRegion region{};        ///< the frame is this part of the picture: the pixels that the picture has there
};

/// The part of the picture that a frame shows, in pixels.
constexpr PictureRegion drawn_region(const Pipeline& pipeline, const PictureRegion& region) {
  return region.width == 0 && region.height == 0 ? PictureRegion{0, 0, pipeline.width, pipeline.height} : region;
}
/// How many pixels that part has.
constexpr uint64_t drawn_pixels(const Pipeline& pipeline, const PictureRegion& region) {
  const PictureRegion drawn = drawn_region(pipeline, region);
  return uint64_t(drawn.width) * uint64_t(drawn.height);
}

/// The side of tiles that a frame is drawn with where Execution::tile is 0: 64 pixels, or 32 if there are fewer than 8
/// tiles of 64 pixels for each thread. `threads` as in Execution.
int tile_for(int width, int height, int threads);

/// Throws Error(usage) naming the field and its range.
void validate(const Pipeline& pipeline);
/// Error(usage) where the pipeline has a light program: `what` does not take one.
void require_no_light_program(const Pipeline& pipeline, std::string_view what);
/// The same for what never changes a pixel.
void validate(const Execution& execution);
void validate_region(const Pipeline& pipeline, const PictureRegion& region);  ///< that it is within the picture
/// That what is drawn at once, the picture or a region of it, is at most kMostDrawnSide pixels a side.
void validate_drawn_size(const Pipeline& pipeline, const PictureRegion& region);

/// Pipeline as JSON, all fields, fixed key order and number spelling: equal pipelines are equal texts.
std::string pipeline_json(const Pipeline& pipeline);

/// Reads `text` over `base`: keys present replace, unknown keys and bad values throw Error(bad_input) with a JSON
/// pointer behind `where`. The schema is scenes/schemas/pipeline.schema.json.
Pipeline pipeline_from_json(std::string_view text, std::string_view where, const Pipeline& base);

}  // namespace trueshade
