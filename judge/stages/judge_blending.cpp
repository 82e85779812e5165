#include "judge/stages/judge_blending.h"

#include "core/error.h"
#include "judge/stages/blending_judge.h"

namespace trueshade::oracle {

StageVerdict judge_blending(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                            const Capture& capture, const LightSteps& steps) {
  return std::move(judge_blending(scene, pipeline, std::span(&profile, 1), capture, steps).front());
}

std::vector<StageVerdict> judge_blending(const Scene& scene, const Pipeline& pipeline,
                                         std::span<const Profile> profiles, const Capture& capture,
                                         const LightSteps& steps) {
  std::vector<std::unique_ptr<BlendingJudge>> judges;
  for (const Profile& profile : profiles)
    judges.push_back(std::make_unique<BlendingJudge>(scene, pipeline, resolved(profile, pipeline), capture));
  int expected = -1;
  steps([&](int light, const Image& target) {
    if (light != expected || target.width != pipeline.width || target.height != pipeline.height ||
        target.format != capture.color.format)
      throw Error(ErrorKind::bad_input, "target after light " + std::to_string(light), "is not the one that comes next",
                  "hand over -1 and then each light, in the capture's size and format");
    for (const auto& judge : judges) {
      if (light < 0)
        judge->start(&target);
      else
        judge->light(light, &target);
    }
    ++expected;
  });
  if (expected != int(scene.lights.size()))
    throw Error(ErrorKind::bad_input, capture.name, "ends after " + std::to_string(expected) + " lights",
                "hand over the target after each light");
  std::vector<StageVerdict> verdicts;
  for (const auto& judge : judges) verdicts.push_back(judge->verdict("blending", nullptr));
  return verdicts;
}

}  // namespace trueshade::oracle
