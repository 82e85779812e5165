#pragma once
// Names of GL objects that free themselves, and the few calls that need checking. The context that made an object must
// be current where the object ends.
#include <epoxy/gl.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/format.h"

namespace trueshade::oracle {

template <void (*kDelete)(GLuint)>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name) : name_(name) {}
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlObject() {
    if (name_ != 0) kDelete(name_);
  }
  operator GLuint() const { return name_; }

 private:
  GLuint name_ = 0;
};

void delete_buffer(GLuint name);
void delete_texture(GLuint name);
void delete_framebuffer(GLuint name);
void delete_vertex_array(GLuint name);
void delete_program(GLuint name);

using GlBuffer = GlObject<delete_buffer>;
using GlTexture = GlObject<delete_texture>;
using GlFramebuffer = GlObject<delete_framebuffer>;
using GlVertexArray = GlObject<delete_vertex_array>;
using GlProgram = GlObject<delete_program>;

/// What glTexImage2D and glReadPixels need to know of a format.
struct GlFormat {
  GLenum internal, external, type;
};
GlFormat gl_format(Format format);

GlBuffer make_buffer(GLenum target, const void* bytes, size_t size, GLenum usage = GL_STATIC_DRAW);
template <typename T>
GlBuffer make_buffer(GLenum target, std::span<const T> values) {
  return make_buffer(target, values.data(), values.size_bytes());
}

GlVertexArray make_vertex_array();
GlTexture make_texture(Format format, int width, int height);  ///< one level, nearest, clamped

/// A buffer that shaders read by texelFetch(samplerBuffer): at least one RGBA32F texel.
struct GlTexelBuffer {
  GlBuffer buffer;
  GlTexture texture;
};
GlTexelBuffer make_texel_buffer(std::span<const float> rgba);
GlTexelBuffer make_index_buffer(std::span<const uint32_t> values);  ///< R32UI texels, for usamplerBuffer

/// A framebuffer. `complete` is false where the driver cannot render into these attachments.
struct GlTarget {
  GlFramebuffer framebuffer;
  bool complete = false;
};
GlTarget make_target(std::span<const GLuint> colors, GLuint depth);

/// Compiles and links a program. Throws std::runtime_error with the driver's log, as the text is ours or from a file
/// that we wrote.
GlProgram make_program(std::string_view name, const std::string& vertex, const std::string& fragment);

void set_uniform(GLuint program, const char* name, int value);
void set_uniform(GLuint program, const char* name, float value);
void set_uniform(GLuint program, const char* name, std::span<const float> values);  ///< vec2, vec3 or vec4 by size

/// Binds a texture to a unit, and sets the program's sampler of that name to the unit.
void bind_texture(GLuint program, const char* sampler, int unit, GLenum target, GLuint texture);

/// Binds a buffer to the program's uniform block of that name. Does nothing where the program has none.
void bind_block(GLuint program, const char* name, GLuint buffer);

/// Throws std::runtime_error if GL has recorded an error since the last call.
void check_gl(std::string_view where);

}  // namespace trueshade::oracle
