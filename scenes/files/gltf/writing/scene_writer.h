#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/files/gltf/extras/scene_extras.h"
#include "scenes/files/gltf/writing/glb_builder.h"
#include "scenes/files/gltf/writing/glb_scene.h"

namespace trueshade::gltf {

/// What a scene is written to. The parts below are called in this order.
struct Writing {
  const Scene& scene;
  const PictureEncoder& encode;
  GlbBuilder glb;
  SceneExtras extras;
  std::vector<std::string> notes;
  std::string lights_extension;  ///< a member of the root; empty without lights
};

/// Images, samplers, textures and materials; each material of the scene has its index in the document.
void write_materials(Writing& out);

/// Accessors, meshes and nodes; instance i is node i. A mesh of the document draws a mesh of the scene in a material,
/// and all that draw the same one share its accessors.
void write_meshes(Writing& out);

/// KHR_lights_punctual and the camera, with their nodes.
void write_lights_and_camera(Writing& out);

/// All that extras.trueshade holds besides.
void write_extras(Writing& out);

}  // namespace trueshade::gltf
