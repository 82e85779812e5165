#pragma once
// The post chain (docs/post.md) as passes over the image. Nothing here calls OpenGL.
#include <string>
#include <utility>
#include <vector>

#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// One pass: a triangle over a picture it makes, each pixel from texels of others. Passes of one name have one shader.
struct PostPass {
  std::string name;  ///< the shader is `post_NAME.frag`, with the vertex shader of fullscreen_vertex_text()
  std::string frag;
  std::vector<std::pair<std::string, std::string>> reads;  ///< sampler, picture; the frame's own is called `target`
  std::string writes;                                      ///< picture
  int width = 0, height = 0;
  Format format = Format::rgba32f;
};

/// The pipeline that a frame before the chain is drawn by: `samples` times as large each way, without the chain.
/// Error(limit) for more than 65536 pixels a side.
Pipeline pipeline_without_post(const Pipeline& pipeline);

/// In order; the last writes the image. After the first, `load`, the light markers are drawn into its picture. None
/// where the chain does nothing.
std::vector<PostPass> post_passes(const Pipeline& pipeline, int version);

/// Light markers: the geometry pass's vertex shader, and their colour, alpha 1.
std::string marker_vertex_text(const Pipeline& pipeline, int version);
std::string marker_fragment_text(const Pipeline& pipeline, int version);

}  // namespace trueshade::oracle
