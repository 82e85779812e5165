#include "oracle/gl/map_textures.h"

#include <algorithm>

namespace trueshade::oracle {

namespace {

GlFormat gl_format(TextureFormat format) {
  switch (format) {
    case TextureFormat::rgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case TextureFormat::srgb8_a8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case TextureFormat::rgba16f:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    case TextureFormat::rgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
  }
  return {};
}

GLint gl_wrap(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return GL_REPEAT;
    case Wrap::mirrored_repeat:
      return GL_MIRRORED_REPEAT;
    case Wrap::clamp_to_edge:
      return GL_CLAMP_TO_EDGE;
    case Wrap::clamp_to_border:
      return GL_CLAMP_TO_BORDER;
    case Wrap::mirror_clamp_to_edge:
      return GL_MIRROR_CLAMP_TO_EDGE;
  }
  return GL_REPEAT;
}

GLint gl_min_filter(const Sampler& s) {
  const bool linear = s.min_filter == Filter::linear;
  switch (s.mip_filter) {
    case MipFilter::none:
      return linear ? GL_LINEAR : GL_NEAREST;
    case MipFilter::nearest:
      return linear ? GL_LINEAR_MIPMAP_NEAREST : GL_NEAREST_MIPMAP_NEAREST;
    case MipFilter::linear:
      return linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_LINEAR;
  }
  return GL_LINEAR;
}

GlTexture uploaded(const Texture& texture, const Sampler& s) {
  GLuint name = 0;
  glGenTextures(1, &name);
  GlTexture out(name);
  glBindTexture(GL_TEXTURE_2D, name);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const GlFormat format = gl_format(texture.format);
  for (size_t k = 0; k < texture.levels.size(); ++k)
    glTexImage2D(GL_TEXTURE_2D, GLint(k), GLint(format.internal), texture.levels[k].width, texture.levels[k].height, 0,
                 format.external, format.type, texture.levels[k].bytes.data());
  const auto set = [](GLenum what, GLint value) { glTexParameteri(GL_TEXTURE_2D, what, value); };
  set(GL_TEXTURE_MAX_LEVEL, GLint(texture.levels.size()) - 1);
  set(GL_TEXTURE_WRAP_S, gl_wrap(s.wrap[0]));
  set(GL_TEXTURE_WRAP_T, gl_wrap(s.wrap[1]));
  set(GL_TEXTURE_MAG_FILTER, s.mag_filter == Filter::linear ? GL_LINEAR : GL_NEAREST);
  set(GL_TEXTURE_MIN_FILTER, gl_min_filter(s));
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_LOD_BIAS, s.lod_bias);
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MIN_LOD, s.lod_min);
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_LOD, s.lod_max);
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, &s.border.x);
  return out;
}

Texture white_texel() {
  Texture texture{"", TextureFormat::rgba8, {{1, 1, {255, 255, 255, 255}}}};
  return texture;
}

}  // namespace

MapTextures::MapTextures(const Scene& scene) : scene_(&scene) {
  if (std::none_of(scene.materials.begin(), scene.materials.end(),
                   [](const Material& m) { return m.color_map.used() || m.masked(); }))
    return;
  for (const Material& m : scene.materials)
    color_.push_back(m.color_map.used() ? uploaded(scene.textures[size_t(m.color_map.texture)], m.color_map.sampler)
                                        : uploaded(white_texel(), Sampler{}));
}

void MapTextures::bind(GLuint program, uint32_t material, int unit) const {
  bind_texture(program, "color_map", unit, GL_TEXTURE_2D, color_[material]);
  set_uniform(program, "alpha_cutoff", scene_->materials[material].alpha_cutoff);
}

}  // namespace trueshade::oracle
