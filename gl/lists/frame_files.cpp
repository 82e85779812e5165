#include "gl/lists/frame_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/json_number.h"

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

std::string number_text(double value) {
  if (!std::isfinite(value)) return std::string(json_of_nonfinite(value));
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

template <typename Numbers>
std::string numbers_text(const Numbers& numbers) {
  std::string text;
  for (const auto value : numbers) text += (text.empty() ? "" : ", ") + number_text(double(value));
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

std::string picture_text(const ListedPicture& p, ShaderApi api) {
  std::vector<std::string> members{
      member("name", quoted(p.name)), member("format", quoted(format_name(api, p.format))),
      member("size", '[' + std::to_string(p.width) + ", " + std::to_string(p.height) + ']'),
      member("clear", numbers_text(p.clear))};
  if (!p.plane.empty()) members.push_back(member("capture", names_text(capture_channels(p))));
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
                            member("size", "[" + std::to_string(kTexelRow) + ", " + std::to_string(rows) + "]") + "}");
}

std::string texture_format_name(ShaderApi api, TextureFormat format) {
  constexpr Format kFormats[] = {Format::rgba8, Format::srgb8_a8, Format::rgba16f, Format::rgba32f};
  return format_name(api, kFormats[size_t(format)]);
}

std::string capitals(std::string_view text) {
  std::string out;
  for (const char c : text) out += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return out;
}

std::string sampler_text(const Sampler& s, ShaderApi api) {
  const bool vulkan = api == ShaderApi::vulkan;
  const auto wrap = [&](Wrap w) {
    if (!vulkan && api == ShaderApi::es31 && w >= Wrap::clamp_to_border)
      throw Error(ErrorKind::usage, "--api es31", "OpenGL ES 3.1 has no " + std::string(kWrapNames[size_t(w)]),
                  "choose another API");
    const std::string name = capitals(kWrapNames[size_t(w)]);
    return quoted(vulkan ? "VK_SAMPLER_ADDRESS_MODE_" +
                               (w == Wrap::mirror_clamp_to_edge ? std::string("MIRROR_CLAMP_TO_EDGE") : name)
                         : "GL_" + name);
  };
  std::vector<std::string> members{
      member("wrap", "[" + wrap(s.wrap[0]) + ", " + wrap(s.wrap[1]) + "]"),
      member("mag_filter", quoted((vulkan ? "VK_FILTER_" : "GL_") + capitals(kFilterNames[size_t(s.mag_filter)])))};
  const std::string min = capitals(kFilterNames[size_t(s.min_filter)]),
                    mip = capitals(kMipFilterNames[size_t(s.mip_filter)]);
  const bool levels = s.mip_filter != MipFilter::none;
  if (vulkan) members.push_back(member("mipmap_mode", levels ? quoted("VK_SAMPLER_MIPMAP_MODE_" + mip) : "null"));
  members.push_back(member(
      "min_filter", quoted(vulkan ? "VK_FILTER_" + min : "GL_" + min + (levels ? "_MIPMAP_" + mip : std::string()))));
  for (const auto& [name, value] :
       {std::pair("lod_bias", s.lod_bias), std::pair("lod_min", s.lod_min), std::pair("lod_max", s.lod_max)})
    members.push_back(member(name, number_text(double(value))));
  const float border[] = {s.border.x, s.border.y, s.border.z, s.border.w};
  members.push_back(member("border", numbers_text(border)));
  return joined_members('{', members, " ");
}

std::string texture_text(const ListedTexture& t, ShaderApi api, FileBytes& file) {
  std::vector<std::string> levels;
  for (const TextureLevel& level : t.texture.levels)
    levels.push_back("{" +
                     member("size", "[" + std::to_string(level.width) + ", " + std::to_string(level.height) + "]") +
                     ", " + file.added(level.bytes, level.bytes.size()) + "}");
  return member(t.name, "{" + member("format", quoted(texture_format_name(api, t.texture.format))) + ", " +
                            member("sampler", sampler_text(t.sampler, api)) + ", " +
                            member("levels", joined_members('[', levels, "")) + "}");
}

std::string attribute_text(const ListedAttribute& a) {
  return joined_members(
      '{',
      {member("location", size_t(a.location)), member("name", quoted(a.name)),
       member("components", size_t(a.components)), member("type", quoted(a.integers ? "uint" : "float")),
       member("of", quoted(a.per_instance ? "instances" : "vertices")), member("offset", size_t(a.offset)),
       member("stride", size_t(a.stride))},
      " ");
}

/// Uniforms and samplers of one stage of a pass: of all those that its shader reads.
class StageTexts {
 public:
  StageTexts(const ListedPass& pass, ShaderStage stage, const std::string& text, ShaderApi api) {
    const ShaderInterface shader = interface_of(text);
    const std::vector<BlockMember> block = block_of(shader);
    bytes_ = block_bytes(block);
    const std::string name = stage == ShaderStage::vertex ? "vertex" : "fragment";
    for (const BlockMember& m : block) {
      std::vector<std::string> members{member("type", quoted(type_text(m.variable)))};
      for (const NamedValue& value : pass.uniforms)
        if (value.name == m.variable.name) members.push_back(member("value", numbers_text(value.numbers)));
      if (api == ShaderApi::vulkan)
        members.push_back(member("stage", quoted(name)) + ", " + member("offset", size_t(m.offset)));
      uniforms_.push_back(member(m.variable.name, joined_members('{', members, " ")));
    }
    for (const ShaderVariable& v : shader.uniforms) {
      if (!v.is_sampler()) continue;
      std::vector<std::string> members{member("type", quoted(v.type))};
      for (const ListedBinding& b : pass.bindings)
        if (b.sampler == v.name) members.push_back(member("reads", quoted(b.source)));
      if (api == ShaderApi::vulkan)
        members.push_back(member("stage", quoted(name)) + ", " +
                          member("binding", size_t(sampler_binding(stage, shader, v.name))));
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

std::string draw_text(const ListedDraw& d, const std::vector<std::string>& read) {
  std::vector<std::string> members;
  const auto place = [](const std::string& buffer, size_t offset) {
    return '[' + quoted(buffer) + ", " + std::to_string(offset) + ']';
  };
  if (!d.vertices.empty()) members.push_back(member("vertices", place(d.vertices, d.vertices_offset)));
  if (!d.instances.empty()) members.push_back(member("instances", place(d.instances, d.instances_offset)));
  if (!d.indices.empty()) members.push_back(member("indices", quoted(d.indices)));
  members.push_back(member("count", size_t(d.count)));
  members.push_back(member("instance_count", size_t(d.instance_count)));
  const auto is_read = [&](const std::string& name) { return std::find(read.begin(), read.end(), name) != read.end(); };
  std::vector<std::string> uniforms, samplers;
  for (const NamedValue& value : d.uniforms)
    if (is_read(value.name)) uniforms.push_back(member(value.name, numbers_text(value.numbers)));
  for (const ListedBinding& b : d.bindings)
    if (is_read(b.sampler)) samplers.push_back(member(b.sampler, quoted(b.source)));
  members.push_back(member("uniforms", joined_members('{', uniforms, "")));
  members.push_back(member("samplers", joined_members('{', samplers, "")));
  return joined_members('{', members, " ");
}

std::string pass_text(const FrameList& list, const ListedPass& pass, ShaderApi api) {
  const auto text_of = [&](const std::string& name) -> const std::string& {
    return std::find_if(list.shaders.begin(), list.shaders.end(), [&](const auto& s) { return s.first == name; })
        ->second;
  };
  const StageTexts vertex(pass, ShaderStage::vertex, text_of(pass.vert), api),
      fragment(pass, ShaderStage::fragment, text_of(pass.frag), api);
  std::vector<std::string> uniforms = vertex.uniforms_, samplers = vertex.samplers_, attributes, draws, read;
  uniforms.insert(uniforms.end(), fragment.uniforms_.begin(), fragment.uniforms_.end());
  samplers.insert(samplers.end(), fragment.samplers_.begin(), fragment.samplers_.end());
  for (const std::string& file : {pass.vert, pass.frag})
    for (const ShaderVariable& v : interface_of(text_of(file)).uniforms) read.push_back(v.name);
  for (const ListedAttribute& a : pass.attributes) attributes.push_back(attribute_text(a));
  for (const ListedDraw& d : pass.draws) draws.push_back(draw_text(d, read));
  std::vector<std::string> members{
      member("name", quoted(pass.name)),
      member("shaders", names_text({pass.vert, pass.frag})),
      member("colors", names_text(pass.colors)),
      member("depth", pass.depth.empty() ? "null" : quoted(pass.depth)),
      member("clears", names_text(pass.cleared)),
      member("state", api == ShaderApi::vulkan ? vulkan_state(pass.state, int(pass.colors.size()))
                                               : strings_of(gl_calls(api, pass.state, int(pass.colors.size())))),
      member("topology", quoted(pass.strip ? "triangle_strip" : "triangles")),
      member("attributes", joined_members('[', attributes, "\n      ")),
      member("uniforms", joined_members('{', uniforms, "\n      ")),
      member("samplers", joined_members('{', samplers, "\n      "))};
  if (api == ShaderApi::vulkan)
    members.push_back(member("blocks", "{" + member("vertex", size_t(vertex.bytes_)) + ", " +
                                           member("fragment", size_t(fragment.bytes_)) + "}"));
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
              member("passes", joined_members('[', passes, "\n    ")),
          std::move(bytes.bytes_)};
}

}  // namespace trueshade::oracle
