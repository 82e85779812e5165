#include "scenes/files/gltf/writing/glb_scene.h"

#include "core/fp_env.h"
#include "scenes/files/gltf/writing/scene_writer.h"

namespace trueshade {

GlbFile glb_of_scene(const Scene& scene, const PictureEncoder& encode) {
  const FpScope fp;
  gltf::Writing out{scene, encode, {}, {}, {}, {}};
  gltf::write_materials(out);
  gltf::write_meshes(out);
  gltf::write_lights_and_camera(out);
  gltf::write_extras(out);
  std::string roots;
  for (size_t i = 0; i < out.glb.count("nodes"); ++i) roots += (i > 0 ? "," : "") + std::to_string(i);
  out.glb.add("scenes", roots.empty() ? "{}" : "{\"nodes\":[" + roots + "]}");
  const std::string extras =
      "\"scene\":0,\"extras\":{\"" + std::string(gltf::kExtrasName) + "\":" + gltf::extras_text(out.extras) + "}";
  const std::string lights = out.lights_extension.empty() ? "" : ',' + out.lights_extension;
  return {std::move(out.glb).file(extras + lights, scene.spec), std::move(out.notes)};
}

}  // namespace trueshade
