#include "gl/driver/objects.h"

#include <stdexcept>

#include "core/error.h"
#include "gl/emit/format_words.h"
#include "gl/lists/api_numbers.h"

namespace trueshade::oracle {

void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
void delete_program(GLuint name) { glDeleteProgram(name); }

GlFormat gl_format(Format format) {
  const FormatWords words = words_of(format);
  const auto number = [](std::string_view name) { return GLenum(api_number(ShaderApi::gl, name)); };
  if (format == Format::r11g11b10f)  // as it is stored
    return {number(words.gl), number(words.channels), GL_UNSIGNED_INT_10F_11F_11F_REV};
  return {number(words.gl), number(words.channels), number(words.type)};
}

GlBuffer make_buffer(GLenum target, const void* bytes, size_t size, GLenum usage) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  GlBuffer buffer(name);
  glBindBuffer(target, name);
  glBufferData(target, GLsizeiptr(size), bytes, usage);
  return buffer;
}

GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlTexture make_texture(Format format, int width, int height) {
  GLuint name = 0;
  glGenTextures(1, &name);
  GlTexture texture(name);
  const GlFormat gl = gl_format(format);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, GLint(gl.internal), width, height, 0, gl.external, gl.type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  return texture;
}

namespace {

GlTexelBuffer texel_buffer(GLenum internal, const void* bytes, size_t size, size_t texel) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (size / texel > size_t(most))
    throw Error(
        ErrorKind::limit, "OpenGL",
        "the driver reads buffers of " + std::to_string(most) + " texels, and one has " + std::to_string(size / texel),
        "a smaller scene, or another driver");
  GlTexelBuffer out;
  out.buffer = make_buffer(GL_TEXTURE_BUFFER, size == 0 ? nullptr : bytes, size == 0 ? texel : size);
  GLuint name = 0;
  glGenTextures(1, &name);
  out.texture = GlTexture(name);
  glBindTexture(GL_TEXTURE_BUFFER, name);
  glTexBuffer(GL_TEXTURE_BUFFER, internal, out.buffer);
  return out;
}

GLuint compiled(GLenum stage, std::string_view name, const std::string& text) {
  const GLuint shader = glCreateShader(stage);
  const char* start = text.c_str();
  glShaderSource(shader, 1, &start, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  std::string log(4096, '\0');
  glGetShaderInfoLog(shader, GLsizei(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  throw std::runtime_error("GLSL of " + std::string(name) + ": " + log.c_str());
}

}  // namespace

GlTexelBuffer make_texel_buffer(std::span<const float> rgba) {
  return texel_buffer(GL_RGBA32F, rgba.data(), rgba.size_bytes(), 16);
}

GlTexelBuffer make_index_buffer(std::span<const uint32_t> values) {
  return texel_buffer(GL_R32UI, values.data(), values.size_bytes(), 4);
}

GlTarget make_target(std::span<const GLuint> colors, GLuint depth) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  GlTarget target{GlFramebuffer(name), false};
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  std::vector<GLenum> buffers;
  for (const GLuint color : colors) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + GLenum(buffers.size());
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, color, 0);
    buffers.push_back(attachment);
  }
  if (buffers.empty()) buffers.push_back(GL_NONE);
  if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  glDrawBuffers(GLsizei(buffers.size()), buffers.data());
  glReadBuffer(buffers.front());
  target.complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  return target;
}

GlProgram make_program(std::string_view name, const std::string& vertex, const std::string& fragment) {
  const GLuint vertex_shader = compiled(GL_VERTEX_SHADER, std::string(name) + ".vert", vertex);
  const GLuint fragment_shader = compiled(GL_FRAGMENT_SHADER, std::string(name) + ".frag", fragment);
  GlProgram program(glCreateProgram());
  for (const GLuint shader : {vertex_shader, fragment_shader}) {
    glAttachShader(program, shader);
    glDeleteShader(shader);  // goes with the program
  }
  glLinkProgram(program);
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) return program;
  std::string log(4096, '\0');
  glGetProgramInfoLog(program, GLsizei(log.size()), nullptr, log.data());
  throw std::runtime_error("GLSL of " + std::string(name) + ": " + log.c_str());
}

void set_uniform(GLuint program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program, name), value);
}

void set_uniform(GLuint program, const char* name, float value) {
  glUniform1f(glGetUniformLocation(program, name), value);
}

void set_uniform(GLuint program, const char* name, std::span<const float> values) {
  const GLint location = glGetUniformLocation(program, name);
  switch (values.size()) {
    case 2:
      return glUniform2fv(location, 1, values.data());
    case 3:
      return glUniform3fv(location, 1, values.data());
    default:
      return glUniform4fv(location, GLsizei(values.size() / 4), values.data());
  }
}

void bind_texture(GLuint program, const char* sampler, int unit, GLenum target, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + GLenum(unit));
  glBindTexture(target, texture);
  set_uniform(program, sampler, unit);
}

void bind_block(GLuint program, const char* name, GLuint buffer) {
  const GLuint block = glGetUniformBlockIndex(program, name);
  if (block == GL_INVALID_INDEX) return;
  glUniformBlockBinding(program, block, 0);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
}

void check_gl(std::string_view where) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  throw std::runtime_error("OpenGL error " + std::to_string(error) + " in " + std::string(where));
}

}  // namespace trueshade::oracle
