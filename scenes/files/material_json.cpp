#include "scenes/files/material_json.h"

#include <algorithm>
#include <cstring>
#include <set>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

const json::ObjectKeys kTexture{"texture", kTextureKeys}, kPattern{"pattern", kPatternKeys}, kMap{"map", kMapKeys},
    kMaterial{"material", kMaterialKeys};

/// Texels of a decoded picture, whose rows run from the top, with the row of v = 0 first.
TextureLevel level_of(Image image, bool upper_left) {
  const size_t row = image.row_bytes(), rows = size_t(image.height);
  uint8_t* const texels = image.texels.data();
  for (size_t y = 0; y < rows / 2 && !upper_left; ++y)
    std::swap_ranges(texels + y * row, texels + (y + 1) * row, texels + (rows - 1 - y) * row);
  return {image.width, image.height, std::move(image.texels)};
}

template <class Enum>
Enum choice_or(const json::Node& node, std::string_view key, std::span<const std::string_view> names, Enum absent) {
  const auto found = node.find(key);
  return found ? Enum(found->choice(names)) : absent;
}

void read_two(const json::Node& node, std::string_view key, glm::vec2& out) {
  const auto pair = node.find(key);
  if (!pair) return;
  pair->array(2, 2);
  for (int k = 0; k < 2; ++k) out[k] = pair->element(size_t(k)).real(-kLargestUvTransform, kLargestUvTransform);
}

int side(const json::Node& node) { return int(node.integer(1, kMaxTextureSide)); }

TexturePattern read_pattern(const json::Node& node) {
  node.check_keys(kPattern);
  TexturePattern p;
  p.pattern = Pattern(node.member("type").choice(kPatternNames));
  if (const auto size = node.find("size")) {
    size->array(2, 2);
    p.width = side(size->element(0)), p.height = side(size->element(1));
  }
  p.format = choice_or(node, "format", kTextureFormatNames, p.format);
  if (const auto colors = node.find("colors")) {
    colors->array(2, 2);
    for (size_t i = 0; i < 2; ++i) p.colors[i] = colors->element(i).color();
  }
  if (const auto cells = node.find("cells")) {
    cells->array(2, 2);
    p.columns = int(cells->element(0).integer(1, 1024)), p.rows = int(cells->element(1).integer(1, 1024));
  }
  if (const auto seed = node.find("seed")) p.seed = uint64_t(seed->integer(0, 9007199254740991));
  return p;
}

void read_value(const json::Node& node, const MaterialField&, bool& value) { value = node.boolean(); }
void read_value(const json::Node& node, const MaterialField&, glm::vec4& value) { value = node.color(); }
void read_value(const json::Node& node, const MaterialField& field, glm::vec3& value) {
  value = node.vec3(float(field.least), float(field.most));
}
void read_value(const json::Node& node, const MaterialField& field, float& value) {
  value = field.integer ? float(node.integer(int64_t(field.least), int64_t(field.most)))
                        : node.real(field.least, field.most);
}

}  // namespace

TextureLevel MaterialReader::read_level(const json::Node& file, bool upper_left, TextureFormat& format,
                                        bool& has_format, const std::string& encoding) {
  const std::string where = path_ + ": " + file.pointer();
  if (!decode_) file.fail("this program reads no image files", "a pattern");
  const std::string relative = path_from_uri(file.string(), where, limits_.named_paths);
  const Bytes content = folder_.read(relative, limits_.file_bytes, where);
  Image image =
      decode_(content, where + ": " + relative, limits_.texture_bytes - std::min(bytes_, limits_.texture_bytes));
  const bool wide = image.format == Format::rgba16, codes = wide || image.format == Format::rgba8;
  if (!codes && image.format != Format::rgba16f && image.format != Format::rgba32f)
    file.fail("its texels are neither codes nor half or float with RGBA", "PNG, JPEG, or an EXR with R, G, B, A");
  if (!codes && encoding == "srgb") file.fail("a picture of floats is linear", "no encoding, or linear");
  const TextureFormat here = wide || image.format == Format::rgba32f ? TextureFormat::rgba32f
                             : image.format == Format::rgba16f       ? TextureFormat::rgba16f
                             : encoding == "linear"                  ? TextureFormat::rgba8
                                                                     : TextureFormat::srgb8_a8;
  if (has_format && format != here) file.fail("the levels have different formats", "levels of one format");
  format = here, has_format = true;
  take(texture_bytes(image.width, image.height, here, MipChain::none), file);
  TextureLevel level = level_of(std::move(image), upper_left);
  if (wide)
    level.bytes =
        float_texels_of_16_bits(level.bytes, encoding == "linear" ? CodeEncoding::linear : CodeEncoding::srgb);
  return level;
}

void MaterialReader::take(uint64_t bytes, const json::Node& node, When when) {
  bytes_ += bytes;
  if (bytes_ > limits_.texture_bytes)
    node.fail("with its " + std::to_string(bytes) + " bytes the textures are over the limit",
              within_limit(limits_.texture_bytes, "bytes in all", "--max-texture-memory"), ErrorKind::limit);
  require_memory(awaited_ + bytes, path_ + ": " + node.pointer(), "the texture");
  if (when == When::later) awaited_ += bytes;
}

void MaterialReader::read_or_lose_file(const json::Node& file, bool upper_left, const std::string& encoding,
                                       Texture& texture) try {
  bool has_format = false;
  texture.levels.push_back(read_level(file, upper_left, texture.format, has_format, encoding));
} catch (const Error& error) {
  faults_.pass(Fault::picture, file.string(), error);
  lost_.resize(scene_.textures.size() + 1, false);
  lost_.back() = true;
}

void MaterialReader::lose_pictures() {
  lost_.resize(scene_.textures.size(), false);
  lose_textures(scene_, lost_);
  faults_.tell(scene_);
}

Texture MaterialReader::read_texture(const json::Node& node) {
  node.check_keys(kTexture);
  const auto file = node.find("file"), levels = node.find("levels"), pattern = node.find("pattern");
  if (int(file.has_value()) + int(levels.has_value()) + int(pattern.has_value()) != 1)
    node.fail("a texture has 'file', 'levels' or 'pattern', one of them", "say where its texels come from");
  const auto encoding = node.find("encoding"), origin = node.find("origin");
  if (pattern) {
    if (encoding) encoding->fail("a pattern has a format", "remove it");
    if (origin) origin->fail("a pattern has its origin at uv (0, 0)", "remove it");
    const TexturePattern made = read_pattern(*pattern);
    take(texture_bytes(made.width, made.height, made.format, MipChain::none), *pattern, When::later);
    patterns_.emplace_back(scene_.textures.size(), made);
    return {{}, made.format, {{made.width, made.height, {}}}};
  }
  constexpr std::string_view kEncodings[] = {"srgb", "linear"}, kOrigins[] = {"lower_left", "upper_left"};
  const std::string how = encoding ? std::string(kEncodings[encoding->choice(kEncodings)]) : "";
  const bool upper_left = origin && origin->choice(kOrigins) == 1;
  Texture texture;
  if (file) {
    read_or_lose_file(*file, upper_left, how, texture);
    return texture;
  }
  bool has_format = false;
  const size_t count = levels->array(1, kMaxTextureLevels).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node element = levels->element(i);
    texture.levels.push_back(read_level(element, upper_left, texture.format, has_format, how));
    const TextureLevel &first = texture.levels[0], &level = texture.levels[i];
    if (level.width != std::max(1, first.width >> i) || level.height != std::max(1, first.height >> i))
      element.fail("the level has the wrong size", "half the sides of the level before it, rounded down, at least 1");
  }
  return texture;
}

void MaterialReader::read_textures(const json::Node& list) {
  const size_t count = list.array(0, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node node = list.element(i);
    Texture texture = read_texture(node);
    texture.name = node.member("name").string();
    if (!named_.emplace(texture.name, int32_t(scene_.textures.size())).second)
      node.fail("a texture of this name exists", "another name");
    scene_.textures.push_back(std::move(texture));
  }
}

TextureSlot MaterialReader::read_map(const json::Node& node, UvSource& uv) const {
  node.check_keys(kMap);
  TextureSlot slot;
  const json::Node name = node.member("texture");
  const auto found = named_.find(name.string());
  if (found == named_.end()) name.fail("no texture has this name", "a name from /textures");
  slot.texture = found->second;
  Sampler& s = slot.sampler;
  if (const auto wrap = node.find("wrap")) {
    if (wrap->is_array()) {
      wrap->array(2, 2);
      for (size_t i = 0; i < 2; ++i) s.wrap[i] = Wrap(wrap->element(i).choice(kWrapNames));
    } else {
      s.wrap.fill(Wrap(wrap->choice(kWrapNames)));
    }
  }
  s.mag_filter = choice_or(node, "mag", kFilterNames, s.mag_filter);
  s.min_filter = choice_or(node, "min", kFilterNames, s.min_filter);
  s.mip_filter = choice_or(node, "mip", kMipFilterNames, s.mip_filter);
  if (const auto bias = node.find("lod_bias")) s.lod_bias = bias->real(-16.0, 16.0);
  if (const auto low = node.find("lod_min")) s.lod_min = low->real(-1000.0, 1000.0);
  if (const auto high = node.find("lod_max")) s.lod_max = high->real(-1000.0, 1000.0);
  if (!(s.lod_min <= s.lod_max)) node.fail("lod_min is above lod_max", "lod_min <= lod_max");
  if (const auto border = node.find("border")) s.border = border->color();
  if (const auto set = node.find("uv_set")) uv.set = uint32_t(set->integer(0, kMaxUvSets - 1));
  read_two(node, "uv_offset", uv.transform.offset);
  read_two(node, "uv_scale", uv.transform.scale);
  if (const auto turn = node.find("uv_rotation_deg"))
    uv.transform.rotation_rad = float(turn->number(-36000.0, 36000.0) * (kPi / 180.0));
  return slot;
}

Material MaterialReader::read_material(const json::Node& node, UvSources& uv) const {
  node.check_keys(kMaterial);
  Material material{node.member("name").string(), glm::vec4(1.0f)};
  visit_fields(material, [&](const MaterialField& field, auto& value) {
    if (const auto found = node.find(field.key)) read_value(*found, field, value);
  });
  const auto maps = maps_of(material);
  for (size_t i = 0; i < maps.size(); ++i)
    if (const auto map = node.find(kMaterialMapKeys[i])) *maps[i] = read_map(*map, uv[i]);
  return material;
}

void MaterialReader::complete_mip_chains(const json::Node& materials) {
  std::set<int32_t> to_build;
  for (const Material& material : scene_.materials)
    for (const TextureSlot* slot : maps_of(material)) {
      if (!slot->used() || slot->sampler.mip_filter == MipFilter::none) continue;
      const Texture& texture = scene_.textures[size_t(slot->texture)];
      if (texture.levels.size() != 1 || !to_build.insert(slot->texture).second) continue;
      const auto bytes = [&](MipChain chain) {
        return texture_bytes(texture.levels[0].width, texture.levels[0].height, texture.format, chain);
      };
      take(bytes(MipChain::whole) - bytes(MipChain::none), materials, When::later);
    }
  make_patterns();
  for (const int32_t texture : to_build) build_mip_chain(scene_.textures[size_t(texture)]);
}

void MaterialReader::make_patterns() {
  for (const auto& [texture, pattern] : patterns_) scene_.textures[texture].levels = texture_of(pattern).levels;
  patterns_.clear();
  awaited_ = 0;
}

}  // namespace trueshade
