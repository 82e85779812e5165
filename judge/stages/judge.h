#pragma once
// Judges what a renderer drew, stage by stage, so that no stage is blamed for the one before it (docs/gl_rules.md
// section 6, "amplification": an 8-bit normal one code off moves a lit pixel by 11).
#include <memory>
#include <span>
#include <vector>

#include "judge/bounds/profile.h"
#include "judge/legal/judged_rows.h"
#include "judge/legal/possible_surfaces.h"
#include "judge/stages/verdict.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// What judge_gbuffer() finds on its way and other judgements of the capture may use.
struct FoundSurfaces {
  PossibleSurfaces surfaces;                  ///< `first` is empty where none were looked for
  std::shared_ptr<LevelHulls> level_hulls{};  ///< of the scene's textures, whatever the profile
};

/// Judges the G-buffer planes of `capture` against the surfaces that each pixel may show: those of depth, position,
/// normal, albedo, uv, id.object and id.material that it has, and specular and emission where the light model reads
/// them. A pixel must equal one possible surface in all planes together, or the clear values where no surface surely
/// covers it. An edge shared by two triangles has exactly one owner: where triangles that meet about a sample close
/// around it, the clear value and what is behind them are not legal. Surfaces that are blended as transparent are not
/// possible surfaces; under into-albedo the plane albedo alone must hold a value that their draws may leave, or the
/// clear value where nothing opaque is. Half planes follow the profile's mode; `ideal` follows the pipeline's
/// half_round. Error(bad_input) for planes of another size than the pipeline's, or none.
///   rows:  the rows to judge; the verdict counts no others
///   found: if not null, gets the possible surfaces and texture hulls that were found
StageVerdict judge_gbuffer(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& rows = {}, FoundSurfaces* found = nullptr);

/// Judges the target against the lights summed over the capture's own planes, in double, with the error bound of
/// docs/gl_rules.md section 6. Needs position (or depth, under position_from_depth), normal and albedo; id.object or
/// depth tell where there is a surface. light.count, where captured, must be a number that the comparisons allow.
/// Surfaces that are transparent after the lights are followed, each fragment from what the pixel may hold before it.
/// Under strategies that blend light by light the final image is judged against the interval of all blends
/// (judge_blending.h), and light.count is ignored. Error(bad_input), naming the plane, where one is missing or has
/// another size than the pipeline's.
///   rows:  the rows to judge; the verdict counts no others
StageVerdict judge_lighting(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                            const Capture& capture, const JudgedRows& rows = {});

/// The judgement of a capture by one profile. Profiles that allow less are judged faster with it.
struct JudgedBefore {
  Profile profile;
  FoundSurfaces found;
  const StageVerdict* lighting = nullptr;  ///< judge_lighting() of all rows, where that was asked
};

/// As judge_gbuffer(), but finds violations only: every other pixel is EXACT, and nothing is kept for the tests of the
/// whole image.
///   before: may be null; not used where its profile does not allow all that `profile` allows
StageVerdict gbuffer_violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                const Capture& capture, const JudgedRows& rows, const JudgedBefore* before);

/// As judge_lighting(), but finds violations only; `before` as for gbuffer_violations().
StageVerdict lighting_violations(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                 const Capture& capture, const JudgedRows& rows, const JudgedBefore* before);

/// Judges strategies that blend, light by light: the target after each light against what the driver's *own* target
/// before that light may become. Under deferred-volumes each triangle of a light's geometry that covers the pixel is a
/// fragment (light_cover.h); EDGE and CLIP are pixels with another number of fragments than the nominal one. Under
/// forward-multipass surfaces that may share the visible one's depth may add to the pixel too: DEPTH-TIE. A pixel's
/// class is its worst over all lights. A pixel that is a violation after one light is judged from what it then holds
/// after the next.
///   steps: hands over the target before the first light (-1), then after each light; Error(bad_input) where it does
///          not
StageVerdict judge_blending(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                            const Capture& capture, const LightSteps& steps);

/// judge_blending() by each of the profiles; the lights are drawn once for all.
std::vector<StageVerdict> judge_blending(const Scene& scene, const Pipeline& pipeline,
                                         std::span<const Profile> profiles, const Capture& capture,
                                         const LightSteps& steps);

/// Judges surfaces that are blended over the target after the lights: the target after each surface against what the
/// driver's *own* target before it may become. Fragments are tested against the capture's plane depth where it has one.
/// A pixel's class is its worst over all steps.
///   objects: hands over the target before the first such surface (-1), then after transparent instances in order, not
///            necessarily all; the last among them. Error(bad_input) where it does not
StageVerdict judge_transparency(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                const Capture& capture, const LightSteps& objects);

}  // namespace trueshade::oracle
