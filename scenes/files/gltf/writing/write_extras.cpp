#include "scenes/files/gltf/writing/scene_writer.h"

namespace trueshade::gltf {
namespace {

/// What a file keeps of a timeline: all but posed meshes, without which it is empty.
void write_timeline(Writing& out) {
  const Timeline& from = out.scene.timeline;
  Timeline& to = out.extras.scene.timeline;
  to.fps = from.fps;
  if (!from.posed.empty()) {
    out.notes.push_back(
        "The scene stands still, because a file keeps no skins and morph targets: It is that of its time");
    return;
  }
  to.motions = from.motions;
  to.instances = from.instances;
  to.materials = from.materials;
  to.lights = from.lights;
  to.orbits = from.orbits;
  to.camera = from.camera;
  to.node_motions = from.node_motions;
  to.node_instances = from.node_instances;
  to.node_lights = from.node_lights;
  to.node_camera = from.node_camera;
  for (const SceneNode& node : from.nodes)
    out.extras.nodes.push_back({node.parent < 0 ? kNone : uint32_t(node.parent), node});
  if (!from.empty())
    out.notes.push_back("What moves is for trueshade alone: Other programs show the scene of its time");
}

}  // namespace

void write_extras(Writing& out) {
  out.extras.version = kExtrasVersion;
  Scene& scene = out.extras.scene;
  scene.clear = out.scene.clear;
  scene.photometric = out.scene.photometric;
  scene.lights_of_ours = out.scene.lights_of_ours;
  scene.camera_of_ours = out.scene.camera_of_ours;
  scene.ground_of_ours = out.scene.ground_of_ours;
  scene.camera = out.scene.camera;
  scene.lights = out.scene.lights;
  scene.pipeline_text = out.scene.pipeline_text;
  write_timeline(out);
}

}  // namespace trueshade::gltf
