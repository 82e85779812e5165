#include "../expect_error.h"
#include "asset.h"
#include "scenes/pipeline/ignored_fields.h"
#include "scenes/pipeline/presets.h"

namespace trueshade {
namespace {

std::string data_uri(const std::string& bytes, const std::string& type = "image/png") {
  return "data:" + type + ";base64," + base64(bytes);
}

/// A triangle with two sets of texture coordinates and a material, whose JSON this is, and further lists.
std::string textured(const std::string& material, const std::string& more) {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  return asset.gltf(one_primitive(R"("attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 1}, "material": 0)",
                                  "", R"("materials": [{)" + material + "}]" + (more.empty() ? "" : ", " + more)));
}

std::string one_image(const std::string& members) {
  return R"("textures": [{"source": 0}], "images": [{)" + members + "}]";
}
const std::string kColorMap = R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0}})";
const std::string kGoodImage = R"("uri": ")" + data_uri(plain_picture(2, 1)) + '"';

TEST_CASE("materials keep what the format says, and its defaults") {
  const Material plain = load_gltf(textured("", "")).materials.at(0);
  CHECK(plain.base_color == glm::vec4(1));
  CHECK(plain.metallic == 1.0f);
  CHECK(plain.roughness == 1.0f);
  CHECK(!plain.double_sided);
  CHECK(!plain.transparent);
  const Material m =
      load_gltf(
          textured(
              R"("name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0, 0.75], "metallicFactor": 0.5, "roughnessFactor": 0.25},
    "emissiveFactor": [1, 0.5, 0], "alphaMode": "BLEND", "doubleSided": true,
    "extensions": {"KHR_materials_unlit": {}, "KHR_materials_emissive_strength": {"emissiveStrength": 4}})",
              ""))
          .materials.at(0);
  CHECK(m.name == "m");
  CHECK(m.base_color == glm::vec4(0.5f, 0.25f, 0.0f, 0.75f));
  CHECK(m.metallic == 0.5f);
  CHECK(m.roughness == 0.25f);
  CHECK(m.emission == glm::vec3(4, 2, 0));
  CHECK(m.transparent);
  CHECK(m.unlit);
  CHECK(m.double_sided);
  CHECK(m.alpha_cutoff == 0.0f);
  const Material mask =
      load_gltf(textured(R"("alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]})", ""))
          .materials.at(0);
  CHECK(mask.alpha_cutoff == 0.5f);
  CHECK(mask.base_color.w == 0.5f);
  const Material opaque =
      load_gltf(textured(R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]})", "")).materials.at(0);
  CHECK(opaque.base_color.w == 1.0f);  // the alpha of OPAQUE is not read
  CHECK(
      load_gltf(textured(R"("alphaMode": "MASK", "alphaCutoff": 1.5)", "")).instances.empty());  // no alpha is as high
}

TEST_CASE("maps know their texture, format, sampler, set and transform") {
  const std::string lists =
      R"("images": [{)" + kGoodImage + R"(}, {"uri": ")" + data_uri(plain_picture(2, 1, "abcd")) + R"("}],
    "samplers": [{"magFilter": 9728, "minFilter": 9985, "wrapS": 33071, "wrapT": 33648}, {"minFilter": 9729}],
    "textures": [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 1}, {"source": 1}])";
  const Scene scene = load_gltf(textured(
      R"("pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}, "metallicRoughnessTexture": {"index": 1}},
    "normalTexture": {"index": 1, "scale": 2}, "occlusionTexture": {"index": 1, "strength": 0.5},
    "emissiveTexture": {"index": 2, "texCoord": 1, "extensions": {"KHR_texture_transform": {"offset": [1, 2], "rotation": 0.5, "scale": [3, 4], "texCoord": 0}}})",
      lists));
  const Material& m = scene.materials.at(0);
  REQUIRE(scene.textures.size() == 3);  // image 0 and image 1 of colours, image 1 of numbers
  CHECK(scene.textures[size_t(m.color_map.texture)].format == TextureFormat::srgb8_a8);
  CHECK(scene.textures[size_t(m.emission_map.texture)].format == TextureFormat::srgb8_a8);
  CHECK(scene.textures[size_t(m.normal_map.texture)].format == TextureFormat::rgba8);
  CHECK(m.normal_map.texture == m.occlusion_map.texture);
  CHECK(m.normal_map.texture == m.metallic_roughness_map.texture);
  CHECK(m.color_map.texture != m.emission_map.texture);
  CHECK(m.normal_scale == 2.0f);
  CHECK(m.occlusion_strength == 0.5f);
  CHECK(m.color_map.uv_set == 2);  // behind the first set as it is, and transformed
  CHECK(m.emission_map.uv_set == 1);
  CHECK(m.metallic_roughness_map.uv_set == 0);
  CHECK(m.normal_map.uv_set == 0);
  const Sampler& s = m.color_map.sampler;
  CHECK(s.mag_filter == Filter::nearest);
  CHECK(s.min_filter == Filter::linear);
  CHECK(s.mip_filter == MipFilter::nearest);
  CHECK(s.wrap[0] == Wrap::clamp_to_edge);
  CHECK(s.wrap[1] == Wrap::mirrored_repeat);
  CHECK(m.normal_map.sampler.mip_filter == MipFilter::none);
  CHECK(m.emission_map.sampler == Sampler());
  CHECK(scene.textures[size_t(m.color_map.texture)].levels.size() == 2);
  CHECK(scene.textures[size_t(m.normal_map.texture)].levels.size() == 1);
  const auto count = [](const Scene& of, std::string_view field) {
    const auto ignored = ignored_fields(of, default_pipeline(of));
    return std::count_if(ignored.begin(), ignored.end(), [&](const IgnoredField& f) { return f.field == field; });
  };
  for (const char* field : {"metallic_roughness_map", "emission_map", "occlusion_map"}) CHECK(count(scene, field) == 0);
  Scene dark = scene;  // without the ambient light of the lights that stand in
  dark.lights.clear();
  CHECK(count(dark, "occlusion_map") == 1);
}

TEST_CASE("rows of pictures run from the top, where v is 0") {
  const std::string rows = std::string("\x89PNG\r\n\x1a\n\x01\x02") + "aaaabbbb";
  const Scene scene = load_gltf(textured(kColorMap, one_image(R"("uri": ")" + data_uri(rows) + '"')));
  CHECK(scene.textures.at(0).levels[0].bytes == std::vector<uint8_t>{'a', 'a', 'a', 'a', 'b', 'b', 'b', 'b'});
}

TEST_CASE("pictures come from files, views and data URIs alike") {
  const std::string expected = scene_hash(load_gltf(textured(kColorMap, one_image(kGoodImage))));
  const ScratchFolder scratch;
  scratch.write("sub/p.png", plain_picture(2, 1));
  CHECK(scene_hash(load_scene(scratch.write("s.gltf", textured(kColorMap, one_image(R"("uri": "sub/p.png")"))), {},
                              decode_plain)) == expected);
  Asset asset;
  const std::string bytes = plain_picture(2, 1);
  asset.accessor(kTriangle, "VEC3");
  asset.accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  const int view = asset.view(std::vector<char>(bytes.begin(), bytes.end()));
  const std::string rest =
      one_primitive(R"("attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 1}, "material": 0)", "",
                    R"("materials": [{)" + kColorMap + "}], " +
                        one_image(R"("mimeType": "image/png", "bufferView": )" + std::to_string(view)));
  CHECK(scene_hash(load_gltf(asset.gltf(rest))) == expected);
  CHECK(scene_hash(load_gltf(asset.glb(rest), {}, ".glb")) == expected);
}

TEST_CASE("a media type that is not what the picture is is told, by the image") {
  const auto notes = [](const std::string& images) {
    const std::vector<std::string> all = load_gltf(textured(kColorMap, images)).notes;
    return all.empty() ? std::string() : all.at(0);
  };
  CHECK(notes(one_image(kGoodImage)).empty());
  CHECK(notes(one_image(kGoodImage + R"(, "mimeType": "image/png")")).empty());
  const std::string told = "the media type of /images/0 is image/jpeg, and its picture is PNG, which is read";
  CHECK(notes(one_image(kGoodImage + R"(, "mimeType": "image/jpeg")")) == told);
  const std::string of_uri = R"("uri": ")" + data_uri(plain_picture(2, 1), "image/jpeg") + '"';
  CHECK(notes(one_image(of_uri)) == told);
  const std::string two = R"(, "normalTexture": {"index": 1})";
  CHECK(load_gltf(textured(kColorMap + two, R"("textures": [{"source": 0}, {"source": 1}], "images": [{)" + of_uri +
                                                R"(, "mimeType": "image/jpeg"}, {)" + of_uri + "}]"))
            .notes.at(0) == told + "; so it is with 1 other image");
}

TEST_CASE("pictures that are neither PNG nor JPEG are refused by name") {
  const auto refused = [](const std::string& bytes, ErrorKind kind = ErrorKind::bad_input) {
    return gltf_refusal(textured(kColorMap, one_image(R"("uri": ")" + data_uri(bytes) + '"')), kind);
  };
  const std::pair<std::string, const char*> kinds[] = {
      {"GIF89a..........", "GIF"},         {"BM..............", "BMP"}, {"\xabKTX 20\xbb\r\n......", "KTX2"},
      {"RIFF....WEBPVP8 ", "WebP"},        {"DDS ............", "DDS"}, {"\x76\x2f\x31\x01............", "OpenEXR"},
      {"#?RADIANCE......", "Radiance HDR"}};
  for (const auto& [bytes, name] : kinds)
    CHECK_STARTS_WITH(refused(bytes), ": /images/0: the picture is " + std::string(name) + " (PNG or JPEG)");
  CHECK_STARTS_WITH(refused("what is this"), ": /images/0: the picture is neither PNG nor JPEG");
  CHECK_STARTS_WITH(refused(""), ": /images/0: the picture is neither PNG nor JPEG");
  CHECK_STARTS_WITH(refused("\x89PNG\r\n\x1a\n"), ": /images/0: it is cut off");
  const auto image = [](const std::string& members, const std::string& material = kColorMap,
                        ErrorKind kind = ErrorKind::bad_input) {
    return gltf_refusal(textured(material, one_image(members)), kind);
  };
  CHECK_STARTS_WITH(image(kGoodImage + R"(, "mimeType": "image/webp")"),
                    ": /images/0/mimeType: the media type is neither");
  CHECK_STARTS_WITH(image(R"("mimeType": "image/png")"), ": /images/0: an image has 'uri' or 'bufferView'");
  CHECK_STARTS_WITH(image(kGoodImage + R"(, "bufferView": 0)"), ": /images/0: an image has 'uri' or 'bufferView'");
  CHECK_STARTS_WITH(image(R"("bufferView": 0)"), ": /images/0: 'mimeType' is missing");
  CHECK_STARTS_WITH(image(R"("uri": "https://example.com/a.png")", ""), ": /images/0/uri: the path has a scheme");
  CHECK(image(R"("uri": "missing.png")", "", ErrorKind::io).find("missing.png") !=
        std::string::npos);     // though no material reads it
  const ScratchFolder scratch;  // a picture that nothing reads is looked for and not decoded
  scratch.write("p.png", "no picture");
  CHECK(load_scene(scratch.write("s.gltf", textured("", R"("images": [{"uri": "p.png"}, {"uri": "p.png"}])")), {},
                   decode_plain)
            .textures.empty());
  SceneLimits limits;
  limits.texture_bytes = 20;
  const std::string small = textured(kColorMap, one_image(R"("uri": ")" + data_uri(plain_picture(3, 1)) + '"'));
  CHECK(load_gltf(small, limits).textures.size() == 1);
  limits.texture_bytes = 15;  // with the levels below the first, 16 are needed
  CHECK_STARTS_WITH(gltf_refusal(small, ErrorKind::limit, limits), ": /images/0: too large");
  const std::string narrow = textured(kColorMap, one_image(R"("uri": ")" + data_uri(plain_picture(40, 1)) + '"'));
  limits.texture_bytes = 312;  // 40 + 20 + 10 + 5 + 2 + 1 texels
  CHECK(load_gltf(narrow, limits).textures.size() == 1);
  limits.texture_bytes = 311;
  CHECK_STARTS_WITH(gltf_refusal(narrow, ErrorKind::limit, limits), ": /images/0: with this picture");
}

TEST_CASE("what does not go together in a material is refused") {
  const auto refused = [](const std::string& material, const std::string& more = "") {
    return gltf_refusal(textured(material, one_image(kGoodImage) + more));
  };
  CHECK_STARTS_WITH(refused(R"("alphaMode": "GLASS")"), ": /materials/0/alphaMode: this mode is not in glTF");
  CHECK_STARTS_WITH(refused(R"("normalTexture": {"index": 1})"),
                    ": /materials/0/normalTexture/index: there is no texture 1");
  CHECK_STARTS_WITH(refused(R"("normalTexture": {"index": 0, "texCoord": 2})"),
                    ": /meshes/0/primitives/0: the material reads TEXCOORD_2");
  CHECK_STARTS_WITH(refused(R"("occlusionTexture": {"index": 0, "strength": 2})"),
                    ": /materials/0/occlusionTexture/strength: found 2");
  CHECK_STARTS_WITH(refused(R"("emissiveFactor": [1, 2, 0])"), ": /materials/0/emissiveFactor/1: found 2");
  CHECK_STARTS_WITH(refused(R"("pbrMetallicRoughness": {"metallicFactor": 1.1})"),
                    ": /materials/0/pbrMetallicRoughness/metallicFactor: found 1.1");
  CHECK_STARTS_WITH(refused(R"("doubleSided": 1)"), ": /materials/0/doubleSided: found 1");
  CHECK_STARTS_WITH(refused("", R"(, "samplers": [{"wrapS": 10496}])"), ": /samplers/0/wrapS: this is no wrap mode");
  CHECK_STARTS_WITH(refused("", R"(, "samplers": [{"minFilter": 9730}])"),
                    ": /samplers/0/minFilter: this is no filter");
  CHECK_STARTS_WITH(refused("", R"(, "samplers": [{"magFilter": 9984}])"), ": /samplers/0/magFilter: found 9984");
  const auto texture = [](const std::string& members) {
    return gltf_refusal(textured(kColorMap, R"("textures": [{)" + members + "}]"));
  };
  CHECK_STARTS_WITH(texture(""), ": /textures/0: the texture has no source");
  CHECK_STARTS_WITH(texture(R"("extensions": {"KHR_texture_basisu": {}})"),
                    ": /textures/0: the texture has a source of KHR_texture_basisu alone");
  CHECK_STARTS_WITH(texture(R"("source": 0)"), ": /textures/0/source: there is no image 0");
}

/// What Khronos' extensions of materials say, with a picture where they have one; but for those that are read.
constexpr std::pair<const char*, const char*> kPassedOverMaterials[] = {
    {"KHR_materials_transmission", R"("transmissionFactor": 1, "transmissionTexture": {"index": 0})"},
    {"KHR_materials_volume", R"("thicknessFactor": 1, "attenuationColor": [1, 0, 0], "attenuationDistance": 0.5)"},
    {"KHR_materials_dispersion", R"("dispersion": 0.1)"},
    {"KHR_materials_clearcoat", R"("clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0, "scale": 2})"},
    {"KHR_materials_sheen", R"("sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 0})"},
    {"KHR_materials_iridescence", R"("iridescenceFactor": 1, "iridescenceThicknessTexture": {"index": 0})"},
    {"KHR_materials_anisotropy", R"("anisotropyStrength": 0.5, "anisotropyTexture": {"index": 0})"},
    {"KHR_materials_specular", R"("specularFactor": 0, "specularTexture": {"index": 0})"},
    {"KHR_materials_ior", R"("ior": 2.4)"},
    {"KHR_materials_diffuse_transmission", R"("diffuseTransmissionFactor": 0.5)"},
    {"KHR_materials_pbrSpecularGlossiness", R"("diffuseTexture": {"index": 0})"}};

TEST_CASE("extensions of materials that are not read leave the base material, and a note names them") {
  const std::string base = R"("pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1]})",
                    image = one_image(kGoodImage);
  const std::string plain = scene_hash(load_gltf(textured(base, image)));
  std::string all, used;
  for (const auto& [name, members] : kPassedOverMaterials) {
    INFO(name);
    const std::string said = std::string("\"") + name + "\": {" + members + '}';
    const Scene scene = load_gltf(
        textured(base + R"(, "extensions": {)" + said + '}', image + R"(, "extensionsUsed": [")" + name + "\"]"));
    CHECK(scene_hash(scene) == plain);
    CHECK(scene.notes == std::vector<std::string>{
                             std::string("1 extension is not read, and the file is drawn as if it had none: ") + name});
    all += (all.empty() ? "" : ", ") + said;
    used += std::string(used.empty() ? "\"" : ", \"") + name + '"';
  }
  CHECK(scene_hash(load_gltf(textured(base + R"(, "extensions": {)" + all + '}',
                                      image + R"(, "extensionsUsed": [)" + used + ']'))) == plain);
}

TEST_CASE("variants of materials leave the material that the primitive names itself") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  const std::string lists = R"("materials": [{"name": "own"}, {"name": "other"}])";
  const auto with = [&](const std::string& primitive, const std::string& more) {
    return load_gltf(
        asset.gltf(one_primitive(R"("attributes": {"POSITION": 0}, "material": 0)" + primitive, "", lists + more)));
  };
  const Scene scene =
      with(R"(, "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}})",
           R"(, "extensionsUsed": ["KHR_materials_variants"],
          "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}]}})");
  CHECK(scene_hash(scene) == scene_hash(with("", "")));
  CHECK(scene.materials.at(0).name == "own");
}

}  // namespace
}  // namespace trueshade
