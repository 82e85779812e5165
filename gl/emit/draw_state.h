#pragma once
#include <string>
#include <vector>

#include "gl/emit/glsl_terms.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// All state of a draw.
struct DrawState {
  Viewport viewport;       ///< in pixels, never 0 x 0
  GeometryState geometry;  ///< but for its viewport, depth format and clear value
  bool depth_test = true, depth_write = true;
  BlendState blend;
  int only = -1;  ///< the colour attachment that is written, blended; -1: all are
};

/// A draw of the scene: tested and written as said, blended so.
DrawState scene_state(const Pipeline& pipeline, DepthFunc func, bool writes, const BlendState& blend);
/// Of it, one that blends into the colour plane of the G-buffer alone, attachment `albedo`.
DrawState albedo_state(const Pipeline& pipeline, int albedo);
/// Light geometry over the image: no depth test, nothing of the scene's culling.
DrawState volume_state(const Pipeline& pipeline, CullFace culled, const BlendState& blend);
/// A pass over the whole of an image of that size: no test, no blending, no culling.
DrawState image_state(int width, int height);

/// As calls of OpenGL, in C, complete but for a framebuffer of `attachments` colours. OpenGL 3.3 and ES are spared the
/// calls that they have not; Error(usage) where the state needs one of these.
std::vector<std::string> gl_calls(ShaderApi api, const DrawState& state, int attachments);

/// Fields of Vulkan's create infos, as a JSON object: those of a graphics pipeline, and its viewport. Pictures have
/// their rows as in OpenGL, the first one the window's lowest. `attachments`: their formats; integers are never
/// blended.
std::string vulkan_state(const DrawState& state, const std::vector<Format>& attachments);

/// What the formats are called: GL_RGBA8, VK_FORMAT_R8G8B8A8_UNORM.
std::string format_name(ShaderApi api, Format format);

// Text of JSON.
std::string quoted(const std::string& text);
std::string array_of(const std::vector<std::string>& lines);  ///< of values that are JSON, one a line
std::string strings_of(std::vector<std::string> lines);       ///< of texts

}  // namespace trueshade::oracle
