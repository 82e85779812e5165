#include "scenes/files/gltf_scene.h"

#include "core/file_ending.h"
#include "core/fp_env.h"
#include "scenes/files/gltf/extras/extras_scene.h"
#include "scenes/files/gltf/read_document.h"
#include "scenes/files/gltf/scene_maker.h"

namespace trueshade {

bool is_gltf_name(std::string_view name) { return has_ending(name, ".gltf") || has_ending(name, ".glb"); }

Scene scene_from_gltf(std::span<const uint8_t> file, const std::string& path, const SceneLimits& limits,
                      const ImageDecoder& decode, const SceneParts& parts, GltfTangents tangents) {
  const FpScope fp;
  const gltf::Container container = gltf::container_of(file, path);
  const gltf::Document document = gltf::read_document(container, path, limits);
  const SceneFolder folder(path, limits.named_paths);
  gltf::Buffers buffers(document, container, folder, limits);
  auto extras = gltf::read_extras(document, limits);
  const bool is_ours = extras.has_value();
  Scene scene = extras
                    ? gltf::scene_of_extras(std::move(*extras), buffers, folder, limits, decode)
                    : gltf::SceneMaker(buffers, folder, limits, decode, parts, tangents == GltfTangents::kept).make();
  if (is_ours) document.faults.tell(scene);  // a SceneMaker has told them
  scene.extensions = document.extensions;
  return scene;
}

}  // namespace trueshade
