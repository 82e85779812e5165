#pragma once
#include <string>

#include "cli/option_table.h"
#include "core/image_files/image_io.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

// How a picture is to look: --samples, --background, --faces, --lights, --exposure and --tone-map, as one value that
// commands and the metadata of pictures share (docs/looks.md).
namespace trueshade {

struct CachedScene;

/// `soft` and `add` with how many times as bright the lights are that they add: `add:2.5`.
inline constexpr std::string_view kLightChoices[] = {"keep", "soft", "add", "three", "none"};

/// The rows of all of them, under a heading of their own.
void add_looks(CommandTable& table, Looks& looks);

/// Error(usage) naming the option whose text means nothing.
void check_looks(const Looks& looks);

/// --samples, with an output of the post chain that fits the target. Nothing without the option.
void set_samples(const Looks& looks, Pipeline& pipeline);

/// Whether the scene is a model file that is shown for its looks: no option says how it is drawn.
bool is_shown_for_looks(const PipelineOptions& options, const Scene& scene);

/// The options with the samples of smooth edges, where none are asked for, of a model that is shown for its looks in a
/// picture that is not large: others are drawn as they are. The machine has no say, so that a hash is one everywhere.
PipelineOptions with_smooth_edges(PipelineOptions options, const Scene& scene);

/// Whether the looks that were not asked for are chosen by the scene.
enum class ChosenLooks : uint8_t { by_scene, never };

/// Brings a scene that was just loaded to the looks asked for, and returns them with nothing left to choose: what is
/// passed here again, with ChosenLooks::never, gives the same scene. By the scene, of a model file whose pipeline no
/// option names, are chosen: both faces of OBJ and PLY lit, lights where the file's own leave its surfaces black,
/// exposure where they would be burnt or black, and an opaque background. Says in Scene::notes what was chosen. Lights
/// of ours are not yet fitted to the pipeline. Draws small pictures to measure what the lights do, before set_time().
/// Error(usage): a tone curve of a target that cuts light off. `stored`: of a scene in a cache file, which is checked
/// before it is measured.
Looks bring_to_looks(const PipelineOptions& options, const Pipeline& pipeline, ChosenLooks chosen, Scene& scene,
                     const CachedScene* stored = nullptr);

/// Of looks with nothing left to choose, and of what they were brought to; what does nothing where they have no
/// exposure, and where averaged samples have no transparent background.
DisplayTransform display_of(const Looks& looks, const Pipeline& pipeline, const Scene& scene);

/// As options with a space before each, but for the samples, which are in the pipeline; empty where there are none.
std::string looks_text(const Looks& looks);
/// What looks_text() gave. Error(usage) of other texts.
Looks looks_of_text(const std::string& text);

}  // namespace trueshade
