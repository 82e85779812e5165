#include "core/error.h"
#include "scenes/files/gltf/extras/field_reader.h"
#include "scenes/files/gltf/extras/field_writer.h"
#include "scenes/files/gltf/extras/fields.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/pipeline/presets.h"

namespace trueshade::gltf {
namespace {

/// Indices of the member, against the document and each other.
class IndexCheck {
 public:
  IndexCheck(const SceneExtras& extras, const Document& document)
      : extras_(extras), document_(document), pointer_("/extras/trueshade/") {}

  void all() const {
    require(extras_.version == kExtrasVersion, "version", "the version is " + std::to_string(extras_.version),
            "version " + std::to_string(kExtrasVersion));
    require(
        extras_.meshes.size() == extras_.mesh_count, "meshes",
        "there are " + std::to_string(extras_.meshes.size()) + " for a count of " + std::to_string(extras_.mesh_count),
        "one a mesh");
    meshes();
    instances();
    for (const TextureExtras& texture : extras_.textures) check(texture);
    for (const MaterialExtras& m : extras_.materials)
      for (const auto* map :
           {&m.color_map, &m.specular_map, &m.normal_map, &m.metallic_roughness_map, &m.emission_map, &m.occlusion_map})
        if (*map) {
          below((*map)->texture, extras_.textures.size(), "materials", "texture");
          below((*map)->uv_set, kMaxUvSets, "materials", "set of texture coordinates");
        }
  }

 private:
  void require(bool holds, const std::string& at, const std::string& reason, const std::string& remedy) const {
    if (!holds) document_.fail(pointer_ + at, reason, remedy);
  }

  void below(uint32_t index, size_t count, const std::string& at, const std::string& one) const {
    require(index < count, at, "there is no " + one + ' ' + std::to_string(index),
            "an index below " + std::to_string(count));
  }

  void meshes() const {
    for (const uint32_t mesh : extras_.meshes) {
      if (mesh == kNone) continue;
      below(mesh, document_.meshes.size(), "meshes", "mesh");
      const Primitive& primitive = document_.meshes[mesh].primitives.at(0);
      require(primitive.attributes.position != kNone && primitive.attributes.normal != kNone, "meshes",
              "mesh " + std::to_string(mesh) + " lacks positions or normals", "both");
    }
    const auto one_each = [&](const std::vector<uint32_t>& list, const char* name) {
      require(list.empty() || list.size() == extras_.mesh_count, name,
              "there are " + std::to_string(list.size()) + " for " + std::to_string(extras_.mesh_count) + " meshes",
              "one a mesh, or none");
    };
    one_each(extras_.colors, "colors");
    one_each(extras_.uv_sets, "uv_sets");
    for (const uint32_t accessor : extras_.colors) {
      if (accessor == kNone) continue;
      below(accessor, document_.accessors.size(), "colors", "accessor");
      require(document_.accessors[accessor].shape == Shape::vec4, "colors", "the accessor is no VEC4", "R, G, B, A");
    }
  }

  void instances() const {
    require(extras_.instances.size() % 2 == 0, "instances", "the number of indices is odd",
            "a mesh and a material each");
    require(extras_.instances.size() / 2 <= document_.nodes.size(), "instances", "there are more instances than nodes",
            "a node for each");
    for (size_t i = 0; i < extras_.instances.size(); i += 2) {
      below(extras_.instances[i], extras_.meshes.size(), "instances", "mesh");
      below(extras_.instances[i + 1], extras_.materials.size(), "instances", "material");
    }
    for (const uint32_t mirrored : extras_.mirrored)
      below(mirrored, extras_.instances.size() / 2, "mirrored", "instance");
  }

  void check(const TextureExtras& texture) const {
    if (texture.levels != Levels::stored) {
      below(texture.image, document_.images.size(), "textures", "image");
      require(bytes_per_texel(texture.format) == 4, "textures", "an image has no texels of this format",
              "stored levels");
      return;
    }
    require(texture.width >= 1 && texture.width <= uint32_t(kMaxTextureSide) && texture.height >= 1 &&
                texture.height <= uint32_t(kMaxTextureSide) && !texture.views.empty() &&
                texture.views.size() <= size_t(kMaxTextureLevels),
            "textures", "stored levels have no size, or no views", "width, height, and a view a level");
    for (const uint32_t view : texture.views) below(view, document_.views.size(), "textures", "view");
  }

  const SceneExtras& extras_;
  const Document& document_;
  std::string pointer_;
};

}  // namespace

std::optional<SceneExtras> read_extras(const Document& document, const SceneLimits& limits) {
  if (!document.extras || !std::holds_alternative<std::unique_ptr<json::Members>>(document.extras->is))
    return std::nullopt;
  const json::Value no_value;
  const json::Node root(no_value, document.file), extras(*document.extras, root, std::string_view("extras"));
  const auto own = extras.find(kExtrasName);
  if (!own) return std::nullopt;
  SceneExtras out;
  uint64_t left = limits.geometry_bytes;
  FieldReader reader(*own, left);
  kSceneFields(reader, out);
  reader.finish();
  IndexCheck(out, document).all();
  for (const NodeExtras& node : out.nodes) {
    out.scene.timeline.nodes.push_back(node.node);
    out.scene.timeline.nodes.back().parent = node.parent == kNone ? -1 : int32_t(std::min(node.parent, kNone / 2));
  }
  if (const std::string& pipeline = out.scene.pipeline_text; !pipeline.empty())
    pipeline_from_json(pipeline, document.file + ": /extras/trueshade/pipeline", presets().front().pipeline);
  return out;
}

std::string extras_text(const SceneExtras& extras) {
  std::string text;
  FieldWriter writer(text);
  kSceneFields(writer, extras);
  writer.finish();
  return text;
}

}  // namespace trueshade::gltf
