// Sets of texture coordinates and their transforms: what bake_uv() makes of them.
#include <cmath>

#include "../expect_error.h"
#include "asset.h"
#include "scenes/pipeline/ignored_fields.h"
#include "scenes/pipeline/presets.h"

namespace trueshade {
namespace {

using Floats = std::vector<float>;

const Floats kSets[] = {{0, 0, 1, 0, 0, 1}, {0.25f, 0.5f, -3, 7, 1e-3f, 12}, {5, 6, 7, 8, 9, 10}};

/// A triangle with three sets of texture coordinates whose primitives have the materials of this JSON, one each.
std::string with_materials(const std::vector<std::string>& materials, const std::string& primitive_more = "") {
  Asset asset;
  asset.accessor(kTriangle, "VEC3");
  for (const Floats& set : kSets) asset.accessor(set, "VEC2");
  std::string primitives, list;
  for (size_t i = 0; i < materials.size(); ++i) {
    const std::string comma = i == 0 ? "" : ", ";
    primitives += comma +
                  R"({"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2, "TEXCOORD_2": 3}, "material": )" +
                  std::to_string(i) + primitive_more + "}";
    list += comma + "{" + materials[i] + "}";
  }
  return asset.gltf(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" + primitives +
                    R"(]}], "materials": [)" + list +
                    R"(], "textures": [{"source": 0}], "images": [{"uri": "data:image/png;base64,)" +
                    base64(plain_picture(1, 1, "aaaa")) + R"("}])");
}

std::string texture(const std::string& more) { return R"({"index": 0)" + (more.empty() ? "" : ", " + more) + "}"; }
std::string transform(const std::string& members) {
  return R"("extensions": {"KHR_texture_transform": {)" + members + "}}";
}
std::string color(const std::string& more) {
  return R"("pbrMetallicRoughness": {"baseColorTexture": )" + texture(more) + "}";
}
std::string normal(const std::string& more) { return R"("normalTexture": )" + texture(more); }

/// u, v, u, v ... of a set.
Floats side_by_side(const UvStreams& set) {
  Floats out;
  for (size_t v = 0; v < set[0].size(); ++v) out.insert(out.end(), {set[0][v], set[1][v]});
  return out;
}

/// What the extension says, in double: translation * rotation * scale of (u, v, 1), the rotation counter-clockwise in a
/// picture whose v runs down.
std::array<double, 2> formula(double u, double v, const std::array<double, 5>& t) {
  const double x = t[2] * u, y = t[3] * v, c = std::cos(t[4]), s = std::sin(t[4]);
  return {t[0] + (c * x + s * y), t[1] + (c * y - s * x)};
}

TEST_CASE("texture coordinates are those of the transform's formula in double, rounded once") {
  const std::array<double, 5> transforms[] = {
      {0.5, -2, 1, 1, 0}, {0, 0, 3, -0.25, 0}, {0, 0, 1, 1, 1}, {0.125, 7, -2, 0.5, -2.5}, {1, 2, 100, 300, 31.25}};
  for (const auto& t : transforms) {
    const std::string text =
        transform("\"offset\": [" + std::to_string(t[0]) + ", " + std::to_string(t[1]) + "], \"scale\": [" +
                  std::to_string(t[2]) + ", " + std::to_string(t[3]) + "], \"rotation\": " + std::to_string(t[4]));
    const Scene scene = load_gltf(with_materials({color("\"texCoord\": 1, " + text)}));
    CHECK(scene.materials.at(0).color_map.uv_set == 0);
    CHECK(scene.meshes.at(0).more_uv.empty());
    const Floats uv = side_by_side(scene.meshes[0].uv);
    REQUIRE(uv.size() == 6);
    for (size_t i = 0; i < 6; i += 2) {
      const auto expected = formula(double(kSets[1][i]), double(kSets[1][i + 1]), t);
      for (size_t k = 0; k < 2; ++k) {
        const double size = std::fabs(t[0]) + std::fabs(t[1]) + std::fabs(expected[k]) + 1;  // of what may cancel
        CHECK(std::fabs(double(uv[i + k]) - expected[k]) <= 0x1p-24 * std::fabs(expected[k]) + size * 0x1p-42);
      }
    }
  }
}

TEST_CASE("the extension's examples read the quarter they say, and turn v round") {
  // KHR_texture_transform, "Example JSON": the lower left quadrant of the picture, turned by 90 degrees clockwise.
  const Scene quarter = load_gltf(
      with_materials({color(transform(R"("offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5])"))}));
  const Floats uv = side_by_side(quarter.meshes.at(0).uv);
  const double expected[] = {0, 1, 0, 0.5, 0.5, 1};  // v runs down: the lower half is above 0.5
  for (size_t i = 0; i < 6; ++i) CHECK(double(uv.at(i)) == Approx(expected[i]).margin(1e-7));
  const Scene turned = load_gltf(with_materials({color(transform(R"("offset": [0, 1], "scale": [1, -1])"))}));
  CHECK(side_by_side(turned.meshes.at(0).uv) == Floats{0, 1, 1, 1, 0, 0});
}

TEST_CASE("maps that share a source read the first set, others one set each, by the numbers of the file's sets") {
  const Scene shared = load_gltf(with_materials({color(R"("texCoord": 2)") + ", " + normal(R"("texCoord": 2)")}));
  CHECK(shared.materials.at(0).color_map.uv_set == 0);
  CHECK(shared.materials[0].normal_map.uv_set == 0);
  CHECK(side_by_side(shared.meshes.at(0).uv) == kSets[2]);
  CHECK(shared.meshes[0].more_uv.empty());
  const Scene apart =
      load_gltf(with_materials({color(R"("texCoord": 2)") + ", " + normal("") + R"(, "emissiveTexture": )" +
                                texture(R"("texCoord": 2, )" + transform(R"("scale": [2, 4])"))}));
  const Material& m = apart.materials.at(0);
  CHECK(m.normal_map.uv_set == 0);
  CHECK(m.color_map.uv_set == 1);
  CHECK(m.emission_map.uv_set == 2);
  const Mesh& mesh = apart.meshes.at(0);
  REQUIRE(mesh.more_uv.size() == 2);
  CHECK(side_by_side(mesh.uv) == kSets[0]);
  CHECK(side_by_side(mesh.more_uv[0]) == kSets[2]);
  CHECK(side_by_side(mesh.more_uv[1]) == Floats{10, 24, 14, 32, 18, 40});
}

TEST_CASE("a mesh that materials of different sources draw is one mesh for each, and no more") {
  const std::string moved = color(transform(R"("offset": [1, 0])"));
  const Scene scene = load_gltf(with_materials({color(""), moved, moved, color(R"("texCoord": 1)")}));
  REQUIRE(scene.instances.size() == 4);
  CHECK(scene.meshes.size() == 3);
  const auto uv_of = [&](size_t i) { return side_by_side(scene.meshes.at(scene.instances[i].mesh).uv); };
  CHECK(uv_of(0) == kSets[0]);
  CHECK(uv_of(1) == Floats{1, 0, 2, 0, 1, 1});
  CHECK(scene.instances[1].mesh == scene.instances[2].mesh);
  CHECK(uv_of(3) == kSets[1]);
}

TEST_CASE("sets that are read as they stand keep the hash of the file that does not transform them") {
  const std::string lists = color("") + ", " + normal(R"("texCoord": 1)");
  const Scene plain = load_gltf(with_materials({lists}));
  CHECK(plain.materials.at(0).normal_map.uv_set == 1);
  const std::string nothing = transform(R"("offset": [0, 0], "rotation": 0, "scale": [1, 1])");
  const Scene said = load_gltf(
      with_materials({color(nothing) + ", " +
                      normal(R"("texCoord": 0, )" + nothing.substr(0, nothing.size() - 2) + R"(, "texCoord": 1}})")}));
  CHECK(scene_hash(plain) == scene_hash(said));
}

TEST_CASE("posed meshes keep the coordinates that were baked") {
  const std::string text =
      with_materials({color(transform(R"("scale": [2, 3])"))}, R"(, "targets": [{"POSITION": 0}])");
  Scene scene = load_gltf(text);
  const Floats before = side_by_side(scene.meshes.at(0).uv);
  CHECK(before == Floats{0, 0, 2, 0, 0, 3});
  set_time(scene, 1.0);
  CHECK(side_by_side(scene.meshes[0].uv) == before);
  CHECK(scene.notes.empty());
  const Scene moved = load_gltf(with_materials({color("")}, R"(, "targets": [{"TEXCOORD_0": 1}])"));
  REQUIRE(moved.notes.size() == 1);
  CHECK_STARTS_WITH(moved.notes[0], "1 primitive has morph targets of texture coordinates or colours");
}

TEST_CASE("copies of meshes for their texture coordinates are counted as geometry") {
  std::vector<std::string> materials;
  for (int i = 0; i < 50; ++i) materials.push_back(color(transform("\"offset\": [" + std::to_string(i) + ", 0]")));
  SceneLimits limits;
  CHECK(load_gltf(with_materials(materials), limits).meshes.size() == 50);
  limits.geometry_bytes = 8000;
  CHECK_STARTS_WITH(gltf_refusal(with_materials(materials), ErrorKind::limit, limits), ": /meshes: ");
  limits.geometry_bytes = 2000;
  CHECK(load_gltf(with_materials({color("")}), limits).meshes.size() == 1);
}

TEST_CASE("a scene file transforms the coordinates of its meshes for each material that draws them") {
  const ScratchFolder scratch;
  const auto load = [&](const std::string& first, const std::string& second) {
    return load_scene(scratch.write(
        "s.json",
        R"({"version": 1, "textures": [{"name": "t", "pattern": {"type": "checker"}}], "materials": [
          {"name": "a", "color": [1, 1, 1], "color_map": {"texture": "t")" +
            first + R"(}}, {"name": "b", "color": [1, 1, 1], "color_map": {"texture": "t")" + second + R"(}}],
          "objects": [{"mesh": "plane", "material": "a"}, {"mesh": "plane", "material": "b"}, {"mesh": "plane"}]})"));
  };
  const Scene plain = load("", "");
  CHECK(plain.meshes.size() == 1);
  const Scene scene = load(R"(, "uv_offset": [0.5, 0], "uv_scale": [2, 4])", "");
  REQUIRE(scene.instances.size() == 3);
  CHECK(scene.meshes.size() == 2);
  CHECK(scene.instances[1].mesh == scene.instances[2].mesh);
  const UvStreams &from = plain.meshes[0].uv, &a = scene.meshes[scene.instances[0].mesh].uv;
  for (size_t v = 0; v < from[0].size(); ++v) {
    REQUIRE(a[0][v] == 0.5f + 2.0f * from[0][v]);
    REQUIRE(a[1][v] == 4.0f * from[1][v]);
  }
  CHECK(scene.meshes[scene.instances[1].mesh].uv == from);
  const Scene absent = load(R"(, "uv_set": 1)", "");
  CHECK(absent.meshes[absent.instances[0].mesh].uv[0].empty());
  const auto ignored = ignored_fields(absent, default_pipeline(absent));
  CHECK(std::count_if(ignored.begin(), ignored.end(), [](const IgnoredField& f) { return f.field == "maps"; }) == 1);
}

}  // namespace
}  // namespace trueshade
