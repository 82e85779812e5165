#include "gl/driver/map_textures.h"

#include <algorithm>
#include <array>

#include "gl/lists/api_numbers.h"
#include "gl/lists/scene_records.h"

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

GLint gl_wrap(Wrap wrap) { return GLint(api_number(ShaderApi::gl, wrap_name(ShaderApi::gl, wrap))); }

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

/// A texture of one texel, so that a lookup gives it exactly.
Texture constant_texture(const std::array<float, 4>& value) {
  Texture texture{"", TextureFormat::rgba32f, {{1, 1, {}}}};
  append_texel(texture.format, value, texture.levels[0].bytes);
  return texture;
}

}  // namespace

MapTextures::MapTextures(const Scene& scene) : scene_(&scene) {
  const auto any = [&](auto has) { return std::any_of(scene.materials.begin(), scene.materials.end(), has); };
  if (!any([](const Material& m) { return m.textured() || m.masked(); })) return;
  const Texture white = constant_texture({1, 1, 1, 1}), level = constant_texture({0.5f, 0.5f, 1, 1});
  const auto upload = [&](const TextureSlot Material::*slot, const Texture& none) {
    std::vector<GlTexture> textures;
    for (const Material& m : scene.materials)
      textures.push_back((m.*slot).used() ? uploaded(scene.textures[size_t((m.*slot).texture)], (m.*slot).sampler)
                                          : uploaded(none, Sampler{}));
    return textures;
  };
  more_uv_ = reads_more_uv(scene);
  vertex_tangents_ = reads_tangents(scene);
  white_ = uploaded(white, Sampler{});
  color_ = upload(&Material::color_map, white);
  const auto uploaded_if_any = [&](const TextureSlot Material::*slot, const Texture& none) {
    return any([slot](const Material& m) { return (m.*slot).used(); }) ? upload(slot, none) : std::vector<GlTexture>();
  };
  specular_ = uploaded_if_any(&Material::specular_map, white);
  normal_ = uploaded_if_any(&Material::normal_map, level);
  metal_ = uploaded_if_any(&Material::metallic_roughness_map, white);
  emission_ = uploaded_if_any(&Material::emission_map, white);
  occlusion_ = uploaded_if_any(&Material::occlusion_map, white);
}

void MapTextures::bind(GLuint program, uint32_t material) const {
  // Fragment shaders have 16 samplers or more, and all stages together 48 texture units or more (GL 3.3, table 6.32).
  // Unit 16 is that of the texture coordinates behind the first set, unit 20 that of vertices' tangents.
  constexpr int kColorUnit = 15, kSpecularUnit = 14, kNormalUnit = 13;
  constexpr int kMetalUnit = 17, kEmissionUnit = 18, kOcclusionUnit = 19;
  const Material& m = scene_->materials[material];
  const auto hand = [&](const std::string& map, int unit, const std::vector<GlTexture>& textures,
                        const TextureSlot& slot) {
    const std::string sampler = map + "_map", set = map + "_uv_set";
    bind_texture(program, sampler.c_str(), unit, GL_TEXTURE_2D, textures.empty() ? white_ : textures[material]);
    if (more_uv_) set_uniform(program, set.c_str(), int(slot.uv_set));
  };
  hand("color", kColorUnit, color_, m.color_map);
  hand("specular", kSpecularUnit, specular_, m.specular_map);
  if (normal()) hand("normal", kNormalUnit, normal_, m.normal_map);
  hand("metallic_roughness", kMetalUnit, metal_, m.metallic_roughness_map);
  hand("emission", kEmissionUnit, emission_, m.emission_map);
  hand("occlusion", kOcclusionUnit, occlusion_, m.occlusion_map);
  set_uniform(program, "alpha_cutoff", m.alpha_cutoff);
  if (normal()) set_uniform(program, "normal_scale", m.normal_scale);
}

}  // namespace trueshade::oracle
