#include <algorithm>
#include <cmath>
#include <optional>

#include "scenes/files/gltf/extras/field_writer.h"
#include "scenes/files/gltf/writing/scene_writer.h"
#include "scenes/json/json_value.h"

namespace trueshade::gltf {
namespace {

/// What glTF takes a picture's codes for.
enum class Role : uint8_t { color, number };

class MaterialWriter {
 public:
  explicit MaterialWriter(Writing& out) : out_(out), scene_(out.scene) {}

  void write() {
    find_roles();
    for (size_t i = 0; i < scene_.textures.size(); ++i) add_texture(i);
    for (const Material& material : scene_.materials) {
      out_.glb.add("materials", text_of(material));
      out_.extras.materials.push_back(extras_of(material));
    }
  }

 private:
  void find_roles() {
    roles_.assign(scene_.textures.size(), std::nullopt);
    const auto used = [&](const TextureSlot& slot, Role role) {
      if (slot.used() && !roles_[size_t(slot.texture)]) roles_[size_t(slot.texture)] = role;
    };
    for (const Material& m : scene_.materials) {
      used(m.color_map, Role::color);
      used(m.emission_map, Role::color);
      used(m.normal_map, Role::number);
      used(m.metallic_roughness_map, Role::number);
      used(m.occlusion_map, Role::number);
    }
  }

  /// The first level as glTF's readers decode it in that role: codes of 8 bits, numbers over 1 as 1.
  static Image picture_of(const Texture& texture, TextureFormat format) {
    const TextureLevel& level = texture.levels[0];
    Image image(level.width, level.height, Format::rgba8);
    image.texels.clear();
    for (int y = 0; y < level.height; ++y)
      for (int x = 0; x < level.width; ++x) append_texel(format, texel_value(texture, 0, x, y), image.texels);
    return image;
  }

  static bool is_filtered(const Texture& texture) {
    Texture built;
    built.format = texture.format;
    built.levels.push_back(texture.levels[0]);
    build_mip_chain(built);
    if (built.levels.size() != texture.levels.size()) return false;
    for (size_t i = 1; i < built.levels.size(); ++i)
      if (built.levels[i].bytes != texture.levels[i].bytes) return false;
    return true;
  }

  void add_texture(size_t index) {
    const Texture& texture = scene_.textures[index];
    const TextureFormat wanted =
        roles_[index].value_or(Role::number) == Role::color ? TextureFormat::srgb8_a8 : TextureFormat::rgba8;
    const bool by_codes = bytes_per_texel(texture.format) == 4 && (texture.format == wanted || !roles_[index]);
    Image image(texture.levels[0].width, texture.levels[0].height, Format::rgba8);
    if (by_codes)
      image.texels.assign(texture.levels[0].bytes.begin(), texture.levels[0].bytes.end());
    else
      image = picture_of(texture, wanted);
    TextureExtras extras;
    extras.name = texture.name;
    extras.format = texture.format;
    extras.image = out_.glb.add("images", "{\"mimeType\":\"image/png\",\"bufferView\":" +
                                              std::to_string(out_.glb.view(out_.encode(image))) + "}");
    images_.push_back(extras.image);
    const bool filtered = is_filtered(texture);
    extras.levels = by_codes && filtered                     ? Levels::filtered
                    : by_codes && texture.levels.size() == 1 ? Levels::one
                                                             : Levels::stored;
    if (extras.levels == Levels::stored) {
      extras.image = kNone;
      extras.width = uint32_t(texture.levels[0].width), extras.height = uint32_t(texture.levels[0].height);
      for (const TextureLevel& level : texture.levels) extras.views.push_back(out_.glb.view(level.bytes));
    }
    out_.extras.textures.push_back(std::move(extras));
  }

  // --- What glTF can say ---------------------------------------------------------------------------------------------

  static int wrap_code(Wrap wrap) {
    switch (wrap) {
      case Wrap::repeat:
        return 10497;
      case Wrap::mirrored_repeat:
        return 33648;
      default:  // glTF has no border, and mirrors again and again
        return 33071;
    }
  }

  uint32_t texture(const TextureSlot& slot) {
    const Sampler& s = slot.sampler;
    const int min = int(s.min_filter) + (s.mip_filter == MipFilter::none      ? 9728
                                         : s.mip_filter == MipFilter::nearest ? 9984
                                                                              : 9986);
    const uint32_t sampler =
        out_.glb.add_once("samplers", "{\"wrapS\":" + std::to_string(wrap_code(s.wrap[0])) +
                                          ",\"wrapT\":" + std::to_string(wrap_code(s.wrap[1])) +
                                          ",\"magFilter\":" + std::to_string(9728 + int(s.mag_filter)) +
                                          ",\"minFilter\":" + std::to_string(min) + "}");
    return out_.glb.add_once("textures", "{\"source\":" + std::to_string(images_[size_t(slot.texture)]) +
                                             ",\"sampler\":" + std::to_string(sampler) + "}");
  }

  /// A map as a member, with a comma before it; nothing where there is none.
  std::string map(const char* name, const TextureSlot& slot, const std::string& more = "") {
    if (!slot.used()) return {};
    std::string text = std::string(",\"") + name + "\":{\"index\":" + std::to_string(texture(slot)) + more;
    if (slot.uv_set != 0) text += ",\"texCoord\":" + std::to_string(int(slot.uv_set));
    return text + '}';
  }

  static std::string number_member(const char* name, float value) {
    std::string text = std::string(",\"") + name + "\":";
    append_json(text, value);
    return text;
  }

  /// The roughness whose highlight is as wide as that of a Blinn-Phong exponent.
  float roughness(const Material& m) const {
    if (scene_.photometric || m.roughness != Material().roughness) return m.roughness;
    return float(std::sqrt(std::sqrt(2.0 / (double(m.shininess) + 2.0))));
  }

  std::string metallic_roughness(const Material& m) {
    std::vector<float> color;
    for (int k = 0; k < 4; ++k) color.push_back(std::clamp(m.base_color[k], 0.0f, 1.0f));
    std::string text = "\"pbrMetallicRoughness\":{\"baseColorFactor\":";
    append_json(text, std::span<const float>(color));
    text += number_member("metallicFactor", m.metallic) + number_member("roughnessFactor", roughness(m));
    return text + map("baseColorTexture", m.color_map) + map("metallicRoughnessTexture", m.metallic_roughness_map) +
           '}';
  }

  std::string text_of(const Material& m) {
    std::string text = '{' + metallic_roughness(m);
    text += map("normalTexture", m.normal_map, number_member("scale", m.normal_scale));
    text += map("occlusionTexture", m.occlusion_map, number_member("strength", m.occlusion_strength));
    text += map("emissiveTexture", m.emission_map);
    const float brightest = std::max({m.emission.x, m.emission.y, m.emission.z});
    std::string extensions;
    if (brightest > 0.0f) {
      const glm::vec3 factor = brightest > 1.0f ? m.emission / brightest : m.emission;
      const float clamped[] = {std::min(factor.x, 1.0f), std::min(factor.y, 1.0f), std::min(factor.z, 1.0f)};
      append_json(text += ",\"emissiveFactor\":", std::span<const float>(clamped));
      if (brightest > 1.0f) {
        out_.glb.use("KHR_materials_emissive_strength");
        extensions = "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":";
        append_json(extensions, brightest);
        extensions += '}';
      }
    }
    if (m.unlit) {
      out_.glb.use("KHR_materials_unlit");
      extensions += std::string(extensions.empty() ? "" : ",") + "\"KHR_materials_unlit\":{}";
    }
    if (m.transparent)
      text += ",\"alphaMode\":\"BLEND\"";
    else if (m.masked())
      text += ",\"alphaMode\":\"MASK\"" + number_member("alphaCutoff", m.alpha_cutoff);
    if (m.double_sided) text += ",\"doubleSided\":true";
    if (!extensions.empty()) text += ",\"extensions\":{" + extensions + '}';
    if (!m.name.empty()) json::append_string(text += ",\"name\":", m.name);
    return text + '}';
  }

  static std::optional<MapExtras> map_extras(const TextureSlot& slot) {
    if (!slot.used()) return std::nullopt;
    return MapExtras{uint32_t(slot.texture), slot.uv_set, slot};
  }

  static MaterialExtras extras_of(const Material& m) {
    return {m,
            map_extras(m.color_map),
            map_extras(m.specular_map),
            map_extras(m.normal_map),
            map_extras(m.metallic_roughness_map),
            map_extras(m.emission_map),
            map_extras(m.occlusion_map)};
  }

  Writing& out_;
  const Scene& scene_;
  std::vector<std::optional<Role>> roles_;  ///< of each texture; nothing where glTF has no use for it
  std::vector<uint32_t> images_;            ///< of each texture, into the document's images
};

}  // namespace

void write_materials(Writing& out) { MaterialWriter(out).write(); }

}  // namespace trueshade::gltf
