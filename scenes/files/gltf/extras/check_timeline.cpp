#include <cmath>

#include "core/error.h"
#include "scenes/files/gltf/extras/scene_extras.h"

namespace trueshade::gltf {
namespace {

/// What moves, against the scene.
class TimelineCheck {
 public:
  TimelineCheck(const Scene& scene, const std::string& where) : scene_(scene), t_(scene.timeline), where_(where) {}

  void all() const {
    require(t_.fps > 0.0 && std::isfinite(t_.fps), "fps is not above 0", "frames a second");
    for (const ObjectMotion& motion : t_.motions) check(motion);
    for (const MovingInstance& moving : t_.instances) {
      below(moving.instance, scene_.instances.size(), "instance");
      below(moving.motion, t_.motions.size(), "motion");
      check(moving.copy);
    }
    for (const MaterialMotion& motion : t_.materials) {
      below(motion.material, scene_.materials.size(), "material");
      check(motion.color);
      require(!scene_.materials[motion.material].textured(), "a material with maps moves", "one without");
    }
    for (const LightMotion& motion : t_.lights) {
      below(motion.light, scene_.lights.size(), "light");
      check(motion.track);
    }
    for (const Orbit& orbit : t_.orbits) {
      below(orbit.light, scene_.lights.size(), "light");
      require(orbit.period > 0.0f && std::isfinite(orbit.phase), "an orbit's period is not above 0", "seconds");
    }
    for (const CameraMotion& motion : t_.camera) check(motion.track);
    hierarchy();
  }

 private:
  void require(bool holds, const char* reason, const char* remedy) const {
    if (!holds) throw Error(ErrorKind::bad_input, where_, reason, remedy);
  }

  void below(uint32_t index, size_t count, const char* one) const {
    if (index >= count)
      throw Error(ErrorKind::bad_input, where_, std::string("there is no ") + one + ' ' + std::to_string(index),
                  "an index below " + std::to_string(count));
  }

  void check(const Placement& placement) const {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) sum += std::fabs(placement.rotation[k]);
    for (int k = 0; k < 3; ++k) sum += std::fabs(placement.position[k]) + std::fabs(placement.scale[k]);
    require(std::isfinite(sum), "a placement is not finite", "finite numbers");
  }

  void check(const Track& track) const {
    require(!track.times.empty() && track.values.size() == track.times.size(),
            "a track has no steps, or not a value each", "a time and a value a step");
    for (size_t i = 0; i < track.times.size(); ++i)
      require(std::fabs(track.times[i]) <= 1e18 && (i == 0 || track.times[i] > track.times[i - 1]),
              "the times of a track do not ascend", "ascending times");
    const size_t slopes = track.between == Between::cubic ? track.times.size() : 0;
    require(track.arriving.size() == slopes && track.leaving.size() == slopes, "a track has too many or too few slopes",
            "one a step of a spline");
    require(!track.repeats || (track.start < track.end && std::isfinite(track.end - track.start)),
            "a track repeats from its end on", "start < end");
    for (const auto* values : {&track.values, &track.arriving, &track.leaving})
      for (const glm::dvec4& v : *values)
        for (int k = 0; k < 4; ++k) require(std::isfinite(v[k]), "a track's value is not finite", "finite numbers");
  }

  void check(const ObjectMotion& motion) const {
    check(motion.rest);
    for (const auto* track : {&motion.position, &motion.rotation, &motion.scale})
      if (*track) check(**track);
  }

  void hierarchy() const {
    for (size_t i = 0; i < t_.nodes.size(); ++i)
      require(t_.nodes[i].parent < int64_t(i), "a node stands before its parent", "parents first");
    for (const NodeMotion& moved : t_.node_motions) {
      below(moved.node, t_.nodes.size(), "node");
      check(moved.motion);
    }
    for (const NodeInstance& hung : t_.node_instances) {
      below(hung.instance, scene_.instances.size(), "instance");
      below(hung.node, t_.nodes.size(), "node");
    }
    for (const NodeLight& hung : t_.node_lights) {
      below(hung.light, scene_.lights.size(), "light");
      below(hung.node, t_.nodes.size(), "node");
      require(!has_area(scene_.lights[hung.light].type), "a light with an area hangs on a node",
              "none that would have to be turned with it");
    }
    if (t_.node_camera) below(t_.node_camera->node, t_.nodes.size(), "node");
  }

  const Scene& scene_;
  const Timeline& t_;
  const std::string& where_;
};

}  // namespace

void check_timeline(const Scene& scene, const std::string& where) { TimelineCheck(scene, where).all(); }

}  // namespace trueshade::gltf
