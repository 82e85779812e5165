#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "judge/bounds/profile.h"
#include "oracle/capture.h"
#include "scenes/pipeline/transparency.h"
#include "shading/frame.h"

namespace trueshade::testing {

/// The planes that are judged: those of every surface, and those that the light model reads.
inline std::vector<std::string> judged_planes(const LightModel& model) {
  std::vector<std::string> planes = {"depth", "position",  "normal",      "albedo",
                                     "uv",    "id.object", "id.material", "light.count"};
  if (reads_specular_plane(model)) planes.emplace_back("specular");
  if (model.emission) planes.emplace_back("emission");
  return planes;
}

/// A profile that knows of a driver only on which grid it puts vertices.
inline oracle::Profile unknown_of_8_bits() {
  oracle::Profile profile;
  profile.subpixel_bits = 8;
  return profile;
}

/// Our own frame as a capture: the target and planes.
inline oracle::Capture captured(const PreparedScene& scene, const Pipeline& pipeline) {
  Frame frame = render_frame(scene, pipeline, {}, judged_planes(pipeline.light_model));
  return {"trueshade", std::move(frame.color), std::move(frame.aovs)};
}
inline oracle::Capture captured(const Scene& scene, const Pipeline& pipeline) {
  return captured(PreparedScene(scene), pipeline);
}

/// The pipeline as judge_gbuffer() and the others take it: with the planes that surfaces really have.
inline Pipeline with_surface_planes(Pipeline pipeline) {
  pipeline.gbuffer = surface_planes(pipeline);
  return pipeline;
}

/// Our own target after each light: a frame of the first so many lights. The scene is borrowed.
inline oracle::LightSteps steps_of(const Scene& scene, const Pipeline& pipeline) {
  return [&scene, pipeline](const oracle::StepSink& sink) {
    Scene part = scene;  // without what is transparent
    const auto nothing = uint32_t(part.meshes.size());
    part.meshes.emplace_back();
    if (draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::after_lights)
      for (Instance& i : part.instances)
        if (scene.materials[i.material].transparent) i.mesh = nothing;
    const std::vector<Instance> drawn = part.instances;
    for (int last = -1; last < int(scene.lights.size()); ++last) {
      part.lights.assign(scene.lights.begin(), scene.lights.begin() + last + 1);
      // The first draw of forward-multipass is a light's, unless there is none.
      const bool cleared = last < 0 && pipeline.strategy == Strategy::forward_multipass && !scene.lights.empty();
      part.instances = cleared ? std::vector<Instance>{} : drawn;
      sink(last, render_frame(part, pipeline).color);
    }
  };
}

/// Our own target before transparent surfaces, and after each: frames without those that follow. The scene is borrowed.
inline oracle::LightSteps objects_of(const Scene& scene, const Pipeline& pipeline) {
  return [&scene, pipeline](const oracle::StepSink& sink) {
    Scene part = scene;
    const auto nothing = uint32_t(part.meshes.size());
    part.meshes.emplace_back();
    const auto glass = [&](size_t i) { return scene.materials[scene.instances[i].material].transparent; };
    for (size_t i = 0; i < scene.instances.size(); ++i)
      if (glass(i)) part.instances[i].mesh = nothing;
    sink(-1, render_frame(part, pipeline).color);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
      if (!glass(i)) continue;
      part.instances[i] = scene.instances[i];
      sink(int(i), render_frame(part, pipeline).color);
    }
  };
}

}  // namespace trueshade::testing
