#include "scenes/timeline_end.h"

#include <algorithm>

namespace trueshade {
namespace {

void see(const std::optional<Track>& track, TimelineEnd& end) {
  if (!track) return;
  end.last = std::max(end.last, track->repeats ? track->end : track->times.back());
  end.is_endless = end.is_endless || track->repeats;
}

void see(const ObjectMotion& motion, TimelineEnd& end) {
  for (const std::optional<Track>* track : {&motion.position, &motion.rotation, &motion.scale}) see(*track, end);
}

}  // namespace

TimelineEnd end_of(const Timeline& timeline) {
  TimelineEnd end;
  for (const LightMotion& motion : timeline.lights) see(motion.track, end);
  for (const CameraMotion& motion : timeline.camera) see(motion.track, end);
  for (const MaterialMotion& motion : timeline.materials) see(motion.color, end);
  for (const ObjectMotion& motion : timeline.motions) see(motion, end);
  for (const NodeMotion& node : timeline.node_motions) see(node.motion, end);
  for (const PosedMesh& posed : timeline.posed)
    if (posed.motion && !posed.motion->times.empty()) end.last = std::max(end.last, posed.motion->times.back());
  for (const Orbit& orbit : timeline.orbits) end.last = std::max(end.last, double(orbit.period)), end.is_endless = true;
  return end;
}

}  // namespace trueshade
