#include "scenes/files/gltf/reading.h"

// Images, samplers, textures and materials.
namespace trueshade::gltf {
namespace {

ImageSource read_image(const json::Node& node, const Counts& counts) {
  ImageSource image;
  if (const auto uri = node.find("uri")) image.uri = uri->string();
  image.view = index_or_none(node, "bufferView", counts.views, "buffer view");
  image.mime = string_or_empty(node, "mimeType");
  if (image.uri.has_value() == (image.view != kNone))
    node.fail("an image has 'uri' or 'bufferView', one of them", "say where its bytes are");
  if (image.view != kNone && image.mime.empty()) node.fail("'mimeType' is missing", "image/png or image/jpeg");
  return image;
}

Wrap wrap_of(const json::Node& sampler, std::string_view key) {
  const auto node = sampler.find(key);
  if (!node) return Wrap::repeat;
  switch (node->integer(0, kLargestCount)) {
    case 10497:
      return Wrap::repeat;
    case 33071:
      return Wrap::clamp_to_edge;
    case 33648:
      return Wrap::mirrored_repeat;
    default:
      node->fail("this is no wrap mode of glTF", "10497, 33071 or 33648");
  }
}

Sampler read_sampler(const json::Node& node) {
  constexpr int64_t kNearest = 9728, kLinear = 9729, kNearestMipmapNearest = 9984, kLinearMipmapLinear = 9987;
  Sampler sampler;
  sampler.wrap = {wrap_of(node, "wrapS"), wrap_of(node, "wrapT")};
  if (const auto mag = node.find("magFilter")) sampler.mag_filter = Filter(mag->integer(kNearest, kLinear) - kNearest);
  const auto min = node.find("minFilter");
  if (!min) return sampler;
  const int64_t filter = min->integer(kNearest, kLinearMipmapLinear);
  if (filter > kLinear && filter < kNearestMipmapNearest)
    min->fail("this is no filter of glTF", "9728, 9729 or 9984 to 9987");
  sampler.min_filter = Filter(filter & 1);
  sampler.mip_filter = filter <= kLinear                    ? MipFilter::none
                       : filter < kNearestMipmapNearest + 2 ? MipFilter::nearest
                                                            : MipFilter::linear;
  return sampler;
}

TextureSource read_texture(const json::Node& node, const Counts& counts, const std::vector<Sampler>& samplers) {
  constexpr std::string_view kOtherFormats[] = {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif",
                                                "MSFT_texture_dds"};
  TextureSource texture;
  texture.image = index_or_none(node, "source", counts.images, "image");
  if (const uint32_t i = index_or_none(node, "sampler", counts.samplers, "sampler"); i != kNone)
    texture.sampler = samplers[i];
  const auto extensions = extensions_of(node);
  if (!extensions) return texture;
  for (const std::string_view name : kOtherFormats)
    if (const auto other = extensions->find(name)) {
      index_or_none(*other, "source", counts.images, "image");
      texture.other_image = name;
    }
  return texture;
}

UvTransform read_transform(const json::Node& node) {
  UvTransform transform;
  const auto two = [&](std::string_view key, glm::vec2& out) {
    const auto pair = node.find(key);
    if (!pair) return;
    pair->array(2, 2);
    for (int k = 0; k < 2; ++k) out[k] = pair->element(size_t(k)).real(-kLargestUvTransform, kLargestUvTransform);
  };
  two("offset", transform.offset);
  two("scale", transform.scale);
  transform.rotation_rad = float(number_or(node, "rotation", 0.0, -1e5, 1e5));
  return transform;
}

TextureInfo read_info(const json::Node& node, const Counts& counts) {
  TextureInfo info;
  info.texture = index(node.member("index"), counts.textures, "texture");
  info.uv.set = uint32_t(whole_or(node, "texCoord", 0, 0, 1 << 20));
  const auto extensions = extensions_of(node);
  const auto transform = extensions ? extensions->find("KHR_texture_transform") : std::nullopt;
  if (!transform) return info;
  info.uv.transform = read_transform(*transform);
  info.uv.set = uint32_t(whole_or(*transform, "texCoord", info.uv.set, 0, 1 << 20));
  return info;
}

void read_metallic_roughness(const json::Node& node, const Counts& counts, MaterialSource& out) {
  if (const auto color = node.find("baseColorFactor")) {
    color->array(4, 4);
    for (int k = 0; k < 4; ++k) out.base_color[k] = color->element(size_t(k)).real(0.0, 1.0);
  }
  out.metallic = float(number_or(node, "metallicFactor", 1.0, 0.0, 1.0));
  out.roughness = float(number_or(node, "roughnessFactor", 1.0, 0.0, 1.0));
  if (const auto map = node.find("baseColorTexture")) out.base_color_map = read_info(*map, counts);
  if (const auto map = node.find("metallicRoughnessTexture")) out.metallic_roughness_map = read_info(*map, counts);
}

MaterialSource read_material(const json::Node& node, const Counts& counts) {
  constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
  MaterialSource out;
  out.name = string_or_empty(node, "name");
  if (const auto metallic = node.find("pbrMetallicRoughness")) read_metallic_roughness(*metallic, counts, out);
  if (const auto map = node.find("normalTexture")) {
    out.normal_map = read_info(*map, counts);
    out.normal_scale = float(number_or(*map, "scale", 1.0, -1000.0, 1000.0));
  }
  if (const auto map = node.find("occlusionTexture")) {
    out.occlusion_map = read_info(*map, counts);
    out.occlusion_strength = float(number_or(*map, "strength", 1.0, 0.0, 1.0));
  }
  if (const auto map = node.find("emissiveTexture")) out.emission_map = read_info(*map, counts);
  if (const auto factor = node.find("emissiveFactor")) out.emission = factor->vec3(0.0, 1.0);
  if (const auto mode = node.find("alphaMode")) out.alpha_mode = AlphaMode(known_or_other(*mode, kAlphaModes));
  out.alpha_cutoff = float(number_or(node, "alphaCutoff", 0.5, 0.0, kLargest));
  out.double_sided = boolean_or(node, "doubleSided", false);
  const auto extensions = extensions_of(node);
  if (!extensions) return out;
  out.unlit = extensions->find("KHR_materials_unlit").has_value();
  if (const auto strength = extensions->find("KHR_materials_emissive_strength"))
    out.emission_strength = float(number_or(*strength, "emissiveStrength", 1.0, 0.0, kLargest));
  return out;
}

}  // namespace

void read_materials(const json::Node& root, const Counts& counts, Document& document) {
  std::vector<Sampler> samplers;
  for_each(root, "images",
           [&](const json::Node& node, size_t) { document.images.push_back(read_image(node, counts)); });
  for_each(root, "samplers", [&](const json::Node& node, size_t) { samplers.push_back(read_sampler(node)); });
  for_each(root, "textures",
           [&](const json::Node& node, size_t) { document.textures.push_back(read_texture(node, counts, samplers)); });
  for_each(root, "materials",
           [&](const json::Node& node, size_t) { document.materials.push_back(read_material(node, counts)); });
}

}  // namespace trueshade::gltf
