#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gl/emit/draw_plan.h"
#include "gl/emit/shader_interface.h"
#include "gl/lists/frame_values.h"
#include "scenes/scene.h"

// A frame as a list of passes over named pictures, buffers and textures: all that a program needs which draws it, in
// any API. docs/opengl.md says the same of the files that are written from it.
namespace trueshade::oracle {

/// A picture that passes draw into and read.
struct ListedPicture {
  std::string name;
  Format format;
  int width = 0, height = 0;
  std::array<float, 4> clear{};  ///< the first of a depth
  std::string plane;             ///< as --aov names it; "color" is the frame's image; empty: no part of a capture
  int channels = 4;              ///< that the pipeline's format has, for which another may stand in
};

struct ListedBuffer {
  std::string name;
  std::vector<uint8_t> bytes;  ///< indices are of 32 bits, texels RGBA32F, blocks std140
  bool texels = false;         ///< else vertices, instances, indices, or a block of uniforms
};

/// A texture of a material, with how lookups read it.
struct ListedTexture {
  std::string name;
  Texture texture;
  Sampler sampler;
};

/// An input of the vertex shader: how many 32-bit components, and where they lie in each vertex or each instance.
struct ListedAttribute {
  std::string name;
  int location = 0, components = 0;
  bool integers = false, per_instance = false;
  int offset = 0, stride = 0;  ///< bytes
};

/// A sampler of the pass's shaders, and the name of the picture, buffer or texture that it reads.
struct ListedBinding {
  std::string sampler, source;
};

struct ListedDraw {
  std::string vertices, instances, indices;          ///< buffers; empty: none
  size_t vertices_offset = 0, instances_offset = 0;  ///< bytes, of the first
  int count = 0;                                     ///< indices, or vertices where there are none
  int instance_count = 1;
  std::vector<NamedValue> uniforms;     ///< of this draw, beside the pass's
  std::vector<ListedBinding> bindings;  ///< of this draw, beside the pass's
  int light = -1;                       ///< the last draw of that light, where lights are blended one by one
  int object = -1;                      ///< the last draw of that transparent instance
};

/// A pass: draws by one program, into the same pictures, in one state.
struct ListedPass {
  std::string name, vert, frag;
  std::vector<std::string> colors;
  std::string depth;                 ///< empty: none
  std::vector<std::string> cleared;  ///< of these pictures, before the first draw
  DrawState state;
  bool strip = false;  ///< triangles in a strip; else three vertices each
  std::vector<ListedAttribute> attributes;
  std::vector<NamedValue> uniforms;
  std::vector<ListedBinding> bindings;
  std::vector<ListedBinding> blocks;  ///< a light program's block of parameters, and the buffer that it reads
  std::vector<ListedDraw> draws;
};

struct FrameList {
  int width = 0, height = 0;
  std::vector<std::pair<std::string, std::string>> shaders;  ///< name and text, in OpenGL's terms
  std::vector<ListedPicture> pictures;
  std::vector<ListedBuffer> buffers;
  std::vector<ListedTexture> textures;
  std::vector<ListedPass> passes;
};

/// The passes of a frame, without the post chain.
///   options: scene_options() of the scene, and what the API can do
FrameList frame_list(const Scene& scene, const Pipeline& pipeline, const GlslOptions& options);

}  // namespace trueshade::oracle
