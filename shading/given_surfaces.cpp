#include "shading/given_surfaces.h"

#include <bit>
#include <string>
#include <utility>

#include "core/error.h"

namespace trueshade {
namespace {

void check_plane(const Image* image, const char* name, bool needed, const Pipeline& pipeline) {
  const std::string where = std::string("plane ") + name;
  if (image == nullptr && needed) throw Error(ErrorKind::bad_input, where, "is missing", "the lights read it");
  if (image != nullptr && (image->width != pipeline.width || image->height != pipeline.height))
    throw Error(ErrorKind::bad_input, where,
                "is " + std::to_string(image->width) + "x" + std::to_string(image->height) + ", not " +
                    std::to_string(pipeline.width) + "x" + std::to_string(pipeline.height),
                "give planes of the picture's size");
}

float plane_value(const Image* image, int x, int y, int channel, float absent) {
  if (image == nullptr || channel >= info(image->format).channels) return absent;
  return float(image->value(x, y, channel));
}

}  // namespace

void check_surfaces(const GivenSurfaces& given, const Pipeline& pipeline) {
  if (pipeline.strategy == Strategy::forward_multipass)
    throw Error(ErrorKind::usage, "--strategy",
                "forward-multipass blends every fragment at the visible depth, which no G-buffer has",
                "another strategy");
  if (pipeline.post.samples > 1)
    throw Error(ErrorKind::usage, "post", "samples light more pixels than a G-buffer has", "one sample a pixel");
  if (pipeline.view != ImageView::lit)
    throw Error(ErrorKind::usage, "--view", "a G-buffer that is lit is shown lit", "leave the view out");
  const bool reads_depth = given.object == nullptr || given.position == nullptr || pipeline.post.marker_radius > 0.0f;
  check_plane(given.depth, "depth", reads_depth, pipeline);
  check_plane(given.object, "id.object", false, pipeline);
  check_plane(given.position, "position", false, pipeline);
  check_plane(given.normal, "normal", true, pipeline);
  check_plane(given.albedo, "albedo", true, pipeline);
  const bool by_program = pipeline.light_program.used();  // see check_fields()
  check_plane(given.specular, "specular", !by_program && reads_specular_plane(pipeline.light_model), pipeline);
  check_plane(given.emission, "emission", false, pipeline);
  const std::pair<const Image*, const char*> others[] = {{given.metallic, "metallic"},   {given.roughness, "roughness"},
                                                         {given.occlusion, "occlusion"}, {given.uv1, "uv1"},
                                                         {given.tangent, "tangent"},     {given.user[0], "user0"},
                                                         {given.user[1], "user1"},       {given.user[2], "user2"},
                                                         {given.user[3], "user3"},       {given.uv, "uv"},
                                                         {given.material, "id.material"}};
  for (const auto& [image, name] : others) check_plane(image, name, false, pipeline);
}

CapturedFields captured_fields(const GivenSurfaces& given) {
  CapturedFields there{given.uv1 != nullptr, given.tangent != nullptr, {}};
  for (size_t i = 0; i < there.user.size(); ++i) there.user[i] = given.user[i] != nullptr;
  return there;
}

void check_fields(const GivenSurfaces& given, const ProgramReads& reads, bool has_unlit, const Pipeline& pipeline) {
  const bool splits_metals = given.metallic != nullptr && given.roughness != nullptr;
  check_plane(given.specular, "specular", reads.gloss || (reads.metals && !splits_metals), pipeline);
  check_plane(given.object, "id.object", reads.object, pipeline);
  check_plane(given.material, "id.material", reads.material || has_unlit, pipeline);
  check_plane(given.uv, "uv", reads.uv, pipeline);
}

namespace {

void load_captured(const GivenSurfaces& given, int x, int y, int i, CapturedTile& out) {
  for (int c = 0; c < 2; ++c) out.plane[kUv1 + c][i] = plane_value(given.uv1, x, y, c, 0.0f);
  for (int c = 0; c < 4; ++c) {
    out.plane[kTangent + c][i] = plane_value(given.tangent, x, y, c, 1.0f);
    for (int k = 0; k < 4; ++k)
      out.plane[kUser + 4 * k + c][i] = plane_value(given.user[k], x, y, c, c < 3 ? 0.0f : 1.0f);
  }
}

/// Fields that a light program reads, in place of what the planes of ours have.
void load_fields(const GivenSurfaces& given, const ProgramReads& reads, int x, int y, int i, SurfaceTile& out) {
  for (int c = 0; c < 2; ++c) out.plane[kUv + c][i] = plane_value(given.uv, x, y, c, 0.0f);
  if (reads.metals && given.metallic != nullptr) out.plane[kSpecular][i] = plane_value(given.metallic, x, y, 0, 0.0f);
  if (reads.metals && given.roughness != nullptr)
    out.plane[kSpecular + 1][i] = plane_value(given.roughness, x, y, 0, 0.0f);
  if (given.occlusion != nullptr) out.plane[kOcclusion][i] = plane_value(given.occlusion, x, y, 0, 1.0f);
  if (given.object != nullptr) out.object[i] = given.object->code(x, y, 0);
  if (given.material != nullptr) out.material[i] = given.material->code(x, y, 0);
  if (out.captured != nullptr) load_captured(given, x, y, i, *out.captured);
}

}  // namespace

void load_surfaces(const GivenSurfaces& given, const ProgramReads* reads, const View& view, const TileRect& rect,
                   VisibilityTile& visible, SurfaceTile& out) {
  const bool halved = info(given.normal->format).number_class == NumberClass::unorm;
  out.covered_pixels = 0;
  out.x = rect.x, out.y = rect.y;
  if (captured_fields(given).any() && out.captured == nullptr) out.captured = std::make_unique<CapturedTile>();
  for (int in_tile_y = 0; in_tile_y < rect.size; ++in_tile_y)
    for (int in_tile_x = 0; in_tile_x < rect.size; ++in_tile_x) {
      const int i = tile_index(rect.size, in_tile_x, in_tile_y);
      const int x = rect.x + in_tile_x, y = view.height - 1 - (rect.y + in_tile_y);
      const bool inside = x < view.width && y >= 0;
      const float depth = inside ? plane_value(given.depth, x, y, 0, given.clear_depth) : given.clear_depth;
      const bool covered =
          inside && (given.object != nullptr ? given.object->code(x, y, 0) != 0 : depth != given.clear_depth);
      visible.depth[i] = depth;
      out.covered[i] = covered ? -1 : 0;
      out.object[i] = out.material[i] = covered ? 1u : 0u;
      out.covered_pixels += covered;
      if (!covered) continue;
      for (int c = 0; c < 3; ++c) {
        const float normal = plane_value(given.normal, x, y, c, 0.0f);
        out.plane[kPosition + c][i] = plane_value(given.position, x, y, c, 0.0f);
        out.plane[kNormal + c][i] = halved ? (normal + normal) - 1.0f : normal;
      }
      for (int c = 0; c < 4; ++c) {
        out.plane[kAlbedo + c][i] = plane_value(given.albedo, x, y, c, 1.0f);
        out.plane[kSpecular + c][i] = plane_value(given.specular, x, y, c, 0.0f);
        out.plane[kEmission + c][i] = plane_value(given.emission, x, y, c, c < 3 ? 0.0f : 1.0f);
      }
      if (reads != nullptr) load_fields(given, *reads, x, y, i, out);
    }
  if (given.position == nullptr) positions_from_depth(view, rect, visible.depth, out);
}

}  // namespace trueshade
