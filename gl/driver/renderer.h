#pragma once
#include <memory>
#include <string>
#include <vector>

#include "oracle/capture.h"
#include "gl/driver/context.h"
#include "gl/emit/glsl.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// What to draw beside the pipeline, and what to read back. None of it changes a pixel, but for `lights`.
struct GlDraw {
  bool planes = true;            ///< read every plane back, depth and ids among them; otherwise the target alone
  int lights = -1;               ///< only the first so many; -1: all. So the target after each light can be had
  int shift_x = 0, shift_y = 0;  ///< the picture moved by whole pixels, >= 0, and read back from there
  bool post = false;             ///< the post chain too, where the pipeline has one; the picture is not moved then
  const GlslShaders* shaders = nullptr;  ///< instead of shaders_of(pipeline, shader_options)
  GlslOptions shader_options;            ///< of `shaders`
  StepSink after_light;                  ///< of strategies that draw light by light: shown the target after each
  StepSink after_object;  ///< of surfaces transparent after the lights: shown the target before them (-1), and after
                          ///< each, by instance; of more than 64 after some of them, the last among these
};

struct GlPass {
  std::string name;
  double ms = 0;  ///< wall time up to glFinish
};

struct GlFrame {
  Capture capture;  ///< with GlDraw::post, of the frame before the chain: pipeline_without_post()
  Image finished;   ///< what the post chain made of the target; empty without GlDraw::post
  std::vector<GlPass> passes;
  std::vector<std::string> notes;  ///< where the driver could not do what the pipeline says, and what was done instead
};

class SceneBuffers;
struct Targets;
struct Programs;

/// Compiled shaders by their text, shared by renderers that use one context one after the other: a driver takes longer
/// to compile than to draw a small frame. Destroy it before the context, on the context's thread.
class KeptPrograms {
 public:
  KeptPrograms();
  ~KeptPrograms();

 private:
  friend class GlRenderer;
  std::vector<std::unique_ptr<Programs>> all_;
};

/// Draws a scene on one OpenGL driver. Meshes are uploaded once, for frames of any pipeline. Borrows context and scene,
/// which must outlive it unchanged. For one thread at a time.
class GlRenderer {
 public:
  /// Uploads the scene.
  ///   rotation: 0, 1 or 2, the vertex that each triangle starts with; changes which vertex flat attributes follow, and
  ///             nothing else
  ///   kept: programs of other renderers, to which this one's are added; null: only the last frame's programs are kept
  GlRenderer(const GlContext& context, const Scene& scene, int rotation = 0, KeptPrograms* kept = nullptr);
  ~GlRenderer();

  /// The shader options that draw() uses unless it is given shaders: for all planes, or for those that the light pass
  /// reads.
  GlslOptions shader_options(const GlDraw& draw) const;

  /// Draws a frame. Error(limit or no_gl_driver) where the driver cannot: too large an image, no clip control.
  GlFrame draw(const Pipeline& pipeline, const GlDraw& draw = {});

  const GlContext& context() const { return *context_; }
  SceneBuffers& buffers() { return *buffers_; }

 private:
  const GlContext* context_;
  std::unique_ptr<SceneBuffers> buffers_;
  std::unique_ptr<Targets> targets_;  ///< of the last frame, kept while size and formats stay
  KeptPrograms own_;
  KeptPrograms* kept_;  ///< null: own_
  bool rgb16f_, primitive_ids_;

  const Programs& programs(const GlslShaders& text);
  const Targets& targets(const Pipeline& pipeline, const GlslOptions& options, const GlDraw& draw);
};

}  // namespace trueshade::oracle
