#include "gl/lists/frame_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/json_number.h"
#include "gl/emit/format_words.h"
#include "gl/emit/light_text.h"
#include "gl/lists/api_numbers.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kAlignment = 256;  ///< of each buffer and each level in the file

/// An object or a list, `open` and its members.
std::string joined_members(char open, const std::vector<std::string>& members, const char* between) {
  std::string text(1, open);
  for (size_t i = 0; i < members.size(); ++i) text += (i == 0 ? "" : ",") + std::string(between) + members[i];
  return text + (open == '[' ? ']' : '}');
}
std::string member(const std::string& name, const std::string& value) { return quoted(name) + ": " + value; }
std::string member(const std::string& name, size_t value) { return member(name, std::to_string(value)); }

/// With a point or an exponent, as whole numbers have none.
std::string float_text(double value) {
  return std::isfinite(value) ? glsl_float(float(value)) : std::string(json_of_nonfinite(value));
}

template <typename Numbers>
std::string numbers_text(const Numbers& numbers, bool whole) {
  std::string text;
  for (const auto value : numbers)
    text += (text.empty() ? "" : ", ") + (whole ? std::to_string(int64_t(value)) : float_text(double(value)));
  return '[' + text + ']';
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + quoted(name);
  return '[' + text + ']';
}

/// The channels of a capture's EXR that a picture's components are (docs/validation.md).
std::vector<std::string> capture_channels(const ListedPicture& picture) {
  if (picture.plane == "depth") return {"depth.Z"};
  if (picture.plane == "position") return {"P.X", "P.Y", "P.Z"};
  if (picture.plane == "normal") return {"N.X", "N.Y", "N.Z"};
  if (picture.plane == "uv") return {"uv.X", "uv.Y"};
  if (picture.plane.starts_with("id.")) return {picture.plane};
  std::vector<std::string> names;
  for (const char* channel : {"R", "G", "B", "A"})
    if (int(names.size()) < picture.channels)
      names.push_back((picture.plane == "color" ? "" : picture.plane + '.') + channel);
  return names;
}

std::string size_text(size_t width, size_t height) {
  return '[' + std::to_string(width) + ", " + std::to_string(height) + ']';
}

/// Two words for glTexImage2D or glReadPixels: a format and a type.
std::vector<std::string> pixel_words(Format format) {
  return {std::string(words_of(format).channels), std::string(words_of(format).type)};
}

bool is_depth(Format format) { return format == Format::d32f || format == Format::d24 || format == Format::d16; }

/// How a picture's texels are read back, as every driver allows it: OpenGL converts them, Vulkan copies them.
std::vector<std::string> read_members(Format format, ShaderApi api) {
  const auto read = [](const std::vector<std::string>& words, std::string_view layout) {
    return std::vector<std::string>{member("read", names_text(words)), member("layout", quoted(std::string(layout)))};
  };
  if (api == ShaderApi::vulkan) return {member("layout", quoted(std::string(info(format).name)))};
  if (is_depth(format) && api == ShaderApi::es31)  // NV_read_depth converts nothing
    return read(pixel_words(format), format == Format::d24 ? "d32" : info(format).name);
  if (is_depth(format)) return read({"GL_DEPTH_COMPONENT", "GL_FLOAT"}, "d32f");
  if (info(format).number_class == NumberClass::integer)
    return read({"GL_RGBA_INTEGER", "GL_UNSIGNED_INT"}, "rgba32ui");
  if (info(format).number_class == NumberClass::floating) return read({"GL_RGBA", "GL_FLOAT"}, "rgba32f");
  return read(pixel_words(format), info(format).name);
}

/// What glTexImage2D and glTexParameter are told of a picture, or of texels in rows, beside its format.
std::string only_fetched(Format format) {
  return member("pixels", names_text(pixel_words(format))) +
         R"(, "sampler": {"GL_TEXTURE_MIN_FILTER": "GL_NEAREST", "GL_TEXTURE_MAG_FILTER": "GL_NEAREST"})";
}

std::string picture_text(const ListedPicture& p, ShaderApi api) {
  const bool whole = info(p.format).number_class == NumberClass::integer;
  std::vector<std::string> members{member("name", quoted(p.name)), member("format", quoted(format_name(api, p.format))),
                                   member("size", size_text(size_t(p.width), size_t(p.height))),
                                   member("clear", numbers_text(p.clear, whole))};
  members.push_back(
      api == ShaderApi::vulkan
          ? member("aspect", quoted(is_depth(p.format) ? "VK_IMAGE_ASPECT_DEPTH_BIT" : "VK_IMAGE_ASPECT_COLOR_BIT"))
          : only_fetched(p.format));
  if (!p.plane.empty()) {
    members.push_back(member("capture", names_text(capture_channels(p))));
    for (const std::string& text : read_members(p.format, api)) members.push_back(text);
  }
  return joined_members('{', members, " ");
}

/// The file's bytes, one block after the other.
class FileBytes {
 public:
  /// "offset" and "bytes" of a block, with zeros behind it up to `size`.
  std::string added(std::span<const uint8_t> block, size_t size) {
    bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
    const size_t offset = bytes_.size();
    bytes_.insert(bytes_.end(), block.begin(), block.end());
    bytes_.resize(offset + size);
    return member("offset", offset) + ", " + member("bytes", size);
  }
  std::vector<uint8_t> bytes_;
};

std::string buffer_text(const ListedBuffer& b, ShaderApi api, FileBytes& file) {
  constexpr size_t kTexel = 16, kRow = kTexel * size_t(kTexelRow);
  if (!b.texels) return member(b.name, "{" + file.added(b.bytes, b.bytes.size()) + "}");
  if (api != ShaderApi::es31)
    return member(b.name,
                  "{" + file.added(b.bytes, b.bytes.size()) + ", " + member("texels", b.bytes.size() / kTexel) + "}");
  const size_t rows = (b.bytes.size() + kRow - 1) / kRow;
  return member(b.name, "{" + file.added(b.bytes, rows * kRow) + ", " +
                            member("size", size_text(size_t(kTexelRow), rows)) + ", " +
                            member("format", quoted(format_name(api, Format::rgba32f))) + ", " +
                            only_fetched(Format::rgba32f) + "}");
}

Format format_of(TextureFormat format) {
  constexpr Format kFormats[] = {Format::rgba8, Format::srgb8_a8, Format::rgba16f, Format::rgba32f};
  return kFormats[size_t(format)];
}

std::string border_numbers(const Sampler& s) {
  const float border[] = {s.border.x, s.border.y, s.border.z, s.border.w};
  return numbers_text(border, false);
}

/// Parameters of glTexParameter, complete for a texture of so many levels.
std::string gl_sampler(const Sampler& s, size_t levels, ShaderApi api) {
  const auto refuse = [&](const std::string& what) {
    if (api == ShaderApi::es31)
      throw Error(ErrorKind::usage, "--api es31", "OpenGL ES 3.1 has no " + what, "choose another API");
  };
  const auto word = [](std::string_view name) { return quoted("GL_" + capitals(name)); };
  for (const Wrap wrap : s.wrap)
    if (wrap >= Wrap::clamp_to_border) refuse(std::string(kWrapNames[size_t(wrap)]));
  const std::string mip =
      s.mip_filter == MipFilter::none ? std::string() : "_MIPMAP_" + capitals(kMipFilterNames[size_t(s.mip_filter)]);
  std::vector<std::string> members{
      member("GL_TEXTURE_WRAP_S", quoted(wrap_name(api, s.wrap[0]))),
      member("GL_TEXTURE_WRAP_T", quoted(wrap_name(api, s.wrap[1]))),
      member("GL_TEXTURE_MAG_FILTER", word(kFilterNames[size_t(s.mag_filter)])),
      member("GL_TEXTURE_MIN_FILTER", quoted("GL_" + capitals(kFilterNames[size_t(s.min_filter)]) + mip)),
      member("GL_TEXTURE_MIN_LOD", float_text(double(s.lod_min))),
      member("GL_TEXTURE_MAX_LOD", float_text(double(s.lod_max))),
      member("GL_TEXTURE_MAX_LEVEL", levels - 1)};
  if (s.lod_bias != 0.0f) {
    refuse("lod_bias of a sampler");
    members.push_back(member("GL_TEXTURE_LOD_BIAS", float_text(double(s.lod_bias))));
  }
  if (reads_border(s)) members.push_back(member("GL_TEXTURE_BORDER_COLOR", border_numbers(s)));
  return joined_members('{', members, " ");
}

/// One of the three borders that every device of Vulkan has.
std::string vulkan_border(const Sampler& s) {
  const std::string name = "VK_BORDER_COLOR_FLOAT_";
  if (!reads_border(s) || s.border == glm::vec4(0.0f)) return quoted(name + "TRANSPARENT_BLACK");
  if (s.border == glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)) return quoted(name + "OPAQUE_BLACK");
  if (s.border == glm::vec4(1.0f)) return quoted(name + "OPAQUE_WHITE");
  throw Error(ErrorKind::usage, "--api vulkan", "a texture's border is no colour that Vulkan has",
              "--api gl has any; or give it (0, 0, 0, 0), (0, 0, 0, 1) or (1, 1, 1, 1), or another wrap");
}

/// Members of VkSamplerCreateInfo. Without a filter between levels the first level alone is read, magnified or not, as
/// Vulkan's manual has it of GL_LINEAR and GL_NEAREST.
std::string vulkan_sampler(const Sampler& s, size_t levels) {
  const auto filter = [](Filter f) { return quoted("VK_FILTER_" + capitals(kFilterNames[size_t(f)])); };
  const auto address = [](Wrap w) { return quoted(wrap_name(ShaderApi::vulkan, w)); };
  const bool none = s.mip_filter == MipFilter::none;
  const float most = none ? 0.25f : std::min(std::max(s.lod_max, 0.0f), float(levels)),
              least = none ? 0.0f : std::min(std::max(s.lod_min, 0.0f), most);
  const std::string mip = s.mip_filter == MipFilter::linear ? "LINEAR" : "NEAREST";
  return joined_members(
      '{',
      {member("magFilter", filter(s.mag_filter)), member("minFilter", filter(s.min_filter)),
       member("mipmapMode", quoted("VK_SAMPLER_MIPMAP_MODE_" + mip)), member("addressModeU", address(s.wrap[0])),
       member("addressModeV", address(s.wrap[1])), member("mipLodBias", float_text(double(s.lod_bias))),
       member("minLod", float_text(double(least))), member("maxLod", float_text(double(most))),
       member("borderColor", vulkan_border(s))},
      " ");
}

std::string texture_text(const ListedTexture& t, ShaderApi api, FileBytes& file) {
  const size_t count = t.texture.levels.size();
  const Format format = format_of(t.texture.format);
  std::vector<std::string> members{member("format", quoted(format_name(api, format)))}, levels;
  for (const TextureLevel& level : t.texture.levels)
    levels.push_back("{" + member("size", size_text(size_t(level.width), size_t(level.height))) + ", " +
                     file.added(level.bytes, level.bytes.size()) + "}");
  if (api != ShaderApi::vulkan) members.push_back(member("pixels", names_text(pixel_words(format))));
  members.push_back(member(
      "sampler", api == ShaderApi::vulkan ? vulkan_sampler(t.sampler, count) : gl_sampler(t.sampler, count, api)));
  members.push_back(member("levels", joined_members('[', levels, "")));
  return member(t.name, joined_members('{', members, " "));
}

/// Vulkan has one word for components and type.
std::string vulkan_attribute_format(const ListedAttribute& a) {
  constexpr const char* kFloats[] = {"R32", "R32G32", "R32G32B32", "R32G32B32A32"};
  return std::string("VK_FORMAT_") + kFloats[a.components - 1] + (a.integers ? "_UINT" : "_SFLOAT");
}

std::string attribute_text(const ListedAttribute& a, ShaderApi api) {
  return joined_members(
      '{',
      {member("location", size_t(a.location)), member("name", quoted(a.name)),
       api == ShaderApi::vulkan ? member("format", quoted(vulkan_attribute_format(a)))
                                : member("components", size_t(a.components)) + ", " +
                                      member("type", quoted(a.integers ? "GL_UNSIGNED_INT" : "GL_FLOAT")),
       member("of", quoted(a.per_instance ? "instances" : "vertices")), member("offset", size_t(a.offset)),
       member("stride", size_t(a.stride))},
      " ");
}

/// Uniforms and samplers of one stage of a pass: of all those that its shader reads.
class StageTexts {
 public:
  /// `unit`: OpenGL's texture unit of the stage's first sampler.
  StageTexts(const ListedPass& pass, ShaderStage stage, const std::string& text, ShaderApi api, size_t unit) {
    const ShaderInterface shader = interface_of(text);
    const std::vector<BlockMember> block = block_of(shader);
    bytes_ = block_bytes(block);
    const std::string name = stage == ShaderStage::vertex ? "vertex" : "fragment";
    for (const BlockMember& m : block) {
      std::vector<std::string> members{member("type", quoted(type_text(m.variable)))};
      for (const NamedValue& value : pass.uniforms)
        if (value.name == m.variable.name)
          members.push_back(member("value", numbers_text(value.numbers, is_integer(m.variable.type))));
      if (api == ShaderApi::vulkan)
        members.push_back(member("stage", quoted(name)) + ", " + member("offset", size_t(m.offset)));
      uniforms_.push_back(member(m.variable.name, joined_members('{', members, " ")));
    }
    for (const ShaderVariable& v : shader.uniforms) {
      if (!v.is_sampler()) continue;
      std::vector<std::string> members{member("type", quoted(v.type))};
      for (const ListedBinding& b : pass.bindings)
        if (b.sampler == v.name) members.push_back(member("reads", quoted(b.source)));
      members.push_back(api == ShaderApi::vulkan ? member("stage", quoted(name)) + ", " +
                                                       member("binding", size_t(sampler_binding(stage, shader, v.name)))
                                                 : member("unit", unit + samplers_.size()));
      samplers_.push_back(member(v.name, joined_members('{', members, " ")));
    }
  }
  std::vector<std::string> uniforms_, samplers_;
  int bytes_ = 0;

 private:
  static std::string type_text(const ShaderVariable& v) {
    return v.type + (v.elements > 0 ? "[" + std::to_string(v.elements) + "]" : "");
  }
};

std::string draw_text(const ListedDraw& d, const std::vector<ShaderVariable>& read) {
  std::vector<std::string> members;
  const auto place = [](const std::string& buffer, size_t offset) {
    return '[' + quoted(buffer) + ", " + std::to_string(offset) + ']';
  };
  if (!d.vertices.empty()) members.push_back(member("vertices", place(d.vertices, d.vertices_offset)));
  if (!d.instances.empty()) members.push_back(member("instances", place(d.instances, d.instances_offset)));
  if (!d.indices.empty()) members.push_back(member("indices", quoted(d.indices)));
  members.push_back(member("count", size_t(d.count)));
  members.push_back(member("instance_count", size_t(d.instance_count)));
  std::vector<std::string> uniforms, samplers;
  for (const ShaderVariable& v : read) {
    for (const NamedValue& value : d.uniforms)
      if (value.name == v.name) uniforms.push_back(member(v.name, numbers_text(value.numbers, is_integer(v.type))));
    for (const ListedBinding& b : d.bindings)
      if (b.sampler == v.name) samplers.push_back(member(v.name, quoted(b.source)));
  }
  members.push_back(member("uniforms", joined_members('{', uniforms, "")));
  members.push_back(member("samplers", joined_members('{', samplers, "")));
  return joined_members('{', members, " ");
}

std::string topology_name(ShaderApi api, bool strip) {
  if (api == ShaderApi::vulkan)
    return quoted(strip ? "VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP" : "VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST");
  return quoted(strip ? "GL_TRIANGLE_STRIP" : "GL_TRIANGLES");
}

std::string constants_text(ShaderApi api) {
  std::string text;
  for (const ApiNumber& constant : api_numbers(api))
    text += (text.empty() ? "" : ", ") + member(std::string(constant.name), constant.number);
  return '{' + text + '}';
}

std::string pass_text(const FrameList& list, const ListedPass& pass, ShaderApi api) {
  const auto text_of = [&](const std::string& name) -> const std::string& {
    return std::find_if(list.shaders.begin(), list.shaders.end(), [&](const auto& s) { return s.first == name; })
        ->second;
  };
  const StageTexts vertex(pass, ShaderStage::vertex, text_of(pass.vert), api, 0),
      fragment(pass, ShaderStage::fragment, text_of(pass.frag), api, vertex.samplers_.size());
  std::vector<std::string> uniforms = vertex.uniforms_, samplers = vertex.samplers_, attributes, draws;
  std::vector<ShaderVariable> read;
  std::vector<Format> formats;
  uniforms.insert(uniforms.end(), fragment.uniforms_.begin(), fragment.uniforms_.end());
  samplers.insert(samplers.end(), fragment.samplers_.begin(), fragment.samplers_.end());
  for (const std::string& file : {pass.vert, pass.frag})
    for (const ShaderVariable& v : interface_of(text_of(file)).uniforms)
      if (std::find(read.begin(), read.end(), v) == read.end()) read.push_back(v);
  for (const std::string& name : pass.colors)
    for (const ListedPicture& p : list.pictures)
      if (p.name == name) formats.push_back(p.format);
  for (const ListedAttribute& a : pass.attributes) attributes.push_back(attribute_text(a, api));
  for (const ListedDraw& d : pass.draws) draws.push_back(draw_text(d, read));
  std::vector<std::string> members{
      member("name", quoted(pass.name)),
      member("shaders", names_text({pass.vert, pass.frag})),
      member("colors", names_text(pass.colors)),
      member("depth", pass.depth.empty() ? "null" : quoted(pass.depth)),
      member("clears", names_text(pass.cleared)),
      member("state", api == ShaderApi::vulkan ? vulkan_state(pass.state, formats)
                                               : strings_of(gl_calls(api, pass.state, int(pass.colors.size())))),
      member("topology", topology_name(api, pass.strip)),
      member("attributes", joined_members('[', attributes, "\n      ")),
      member("uniforms", joined_members('{', uniforms, "\n      ")),
      member("samplers", joined_members('{', samplers, "\n      "))};
  if (api == ShaderApi::vulkan)
    members.push_back(member("blocks", "{" + member("vertex", size_t(vertex.bytes_)) + ", " +
                                           member("fragment", size_t(fragment.bytes_)) + "}"));
  std::vector<std::string> blocks;
  for (const ListedBinding& b : pass.blocks)
    blocks.push_back(member(
        b.sampler, "{" + member("reads", quoted(b.source)) +
                       (api == ShaderApi::vulkan ? ", " + member("binding", kParameterBinding) : std::string()) + "}"));
  if (!blocks.empty()) members.push_back(member("uniform_blocks", joined_members('{', blocks, " ")));
  members.push_back(member("draws", joined_members('[', draws, "\n      ")));
  return joined_members('{', members, "\n    ");
}

}  // namespace

FrameFiles frame_files(const FrameList& list, ShaderApi api, const std::string& file) {
  FileBytes bytes;
  std::vector<std::string> pictures, buffers, textures, passes;
  for (const ListedPicture& p : list.pictures) pictures.push_back(picture_text(p, api));
  for (const ListedBuffer& b : list.buffers) buffers.push_back(buffer_text(b, api, bytes));
  for (const ListedTexture& t : list.textures) textures.push_back(texture_text(t, api, bytes));
  for (const ListedPass& p : list.passes) passes.push_back(pass_text(list, p, api));
  return {"  " + member("file", quoted(file)) + ",\n  " + member("pictures", joined_members('[', pictures, "\n    ")) +
              ",\n  " + member("buffers", joined_members('{', buffers, "\n    ")) + ",\n  " +
              member("textures", joined_members('{', textures, "\n    ")) + ",\n  " +
              member("passes", joined_members('[', passes, "\n    ")) + ",\n  " +
              member("constants", constants_text(api)),
          std::move(bytes.bytes_)};
}

}  // namespace trueshade::oracle
