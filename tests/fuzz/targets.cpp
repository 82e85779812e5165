#include "tests/fuzz/targets.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/image_files/exr_layout.h"
#include "core/image_files/jpeg_pixels.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_pixels.h"
#include "core/picture_kind.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/files/gltf/data_uri.h"
#include "scenes/files/gltf/writing/glb_scene.h"
#include "scenes/files/gltf_scene.h"
#include "scenes/files/light_buffers.h"
#include "scenes/files/load_geometry.h"
#include "scenes/files/scene_json.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "tests/fuzz/promises.h"

namespace trueshade::fuzz {
namespace {

constexpr uint64_t kMostBytes = uint64_t(8) << 20;
constexpr int kMostSide = 512;

/// A file in an empty folder, so that nothing but the bytes is read.
const std::string& path_of(const char* name) {
  static const std::string folder = [] {
    std::string made = (std::filesystem::temp_directory_path() / "trueshade-fuzz-XXXXXX").string();
    if (mkdtemp(made.data()) == nullptr) std::abort();
    return made;
  }();
  static thread_local std::string path;
  path = folder + '/' + name;
  return path;
}

Image png_of(Bytes content, const std::string& where) {
  const ImageFileInfo header = png_header(where, content);
  if (header.width > kMostSide || header.height > kMostSide)
    throw Error(ErrorKind::limit, where, "it is large", "a smaller one");
  return png_pixels(where, content);
}

Image decode(Bytes content, const std::string& where, uint64_t) {
  if (picture_kind(content) == "PNG") return png_of(content, where);
  jpeg_size(where, content);
  return Image(1, 1, Format::rgba8);
}

void run_gltf(Bytes bytes) {
  for (const Leniency leniency : kEachWay)
    read([&] { check_scene(scene_from_gltf(bytes, path_of("s.gltf"), small_limits(leniency), decode)); });
}

void run_glb(Bytes bytes) {
  for (const Leniency leniency : kEachWay)
    read([&] { check_scene(scene_from_gltf(bytes, path_of("s.glb"), small_limits(leniency), decode)); });
}

/// Codes as they are, behind what PNG files begin with and the size: what export writes where the test encodes.
std::vector<uint8_t> stored_picture(const Image& image) {
  std::vector<uint8_t> bytes{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  bytes.resize(16);
  std::memcpy(&bytes[8], &image.width, 4);
  std::memcpy(&bytes[12], &image.height, 4);
  bytes.insert(bytes.end(), image.texels.begin(), image.texels.end());
  return bytes;
}

Image loaded_picture(Bytes content, const std::string&, uint64_t) {
  int32_t sides[2] = {};
  promise(content.size() >= 16, "a written picture has a size");
  std::memcpy(sides, &content[8], sizeof sides);
  Image image(sides[0], sides[1], Format::rgba8);
  promise(content.size() == 16 + image.texels.size(), "a written picture is whole");
  std::copy(content.begin() + 16, content.end(), image.texels.begin());
  return image;
}

/// What was read is written as a file that is read as the same.
void run_exported(Bytes bytes) {
  read([&] {
    const std::string& path = path_of("e.gltf");
    Scene scene = scene_from_gltf(bytes, path, small_limits(), decode);
    scene.spec = "scene";
    validate(scene, small_limits());
    const GlbFile file = glb_of_scene(scene, stored_picture);
    try {
      const Scene again = scene_from_gltf(file.bytes, path, {}, loaded_picture);
      promise(scene_hash(again) == scene_hash(scene), "an exported scene is the scene");
    } catch (const Error& error) {
      promise(false, error.what());
    }
    check_scene(std::move(scene));
  });
}

/// What a scene of the fuzzer refers to, whatever its name: lights that move in every way, and a camera that does.
Scene referred(const std::string&) {
  constexpr const char* kText = R"({"version": 1, "objects": [{"mesh": "cube"}], "lights": [
    {"type": "point", "steps": [{"time": 0, "color": [1, 0, 0], "position": [0, 1, 0], "intensity": 2},
                                {"time": 2, "color": [0, 1, 0], "position": [4, 1, 0], "intensity": 4}]},
    {"type": "ambient", "color": [0.1, 0.1, 0.1]}, {"type": "ring", "count": 3, "radius": 2, "turn_s": 4}],
    "camera": {"steps": [{"time": 0, "eye": [0, 2, 4]}, {"time": 2, "eye": [4, 2, 0]}]}})";
  static const Scene scene = scene_from_json(kText, path_of("r.json"), small_limits());
  return scene;
}

/// But for scenes with our two large meshes, which are made in a tenth of a second, and in more than one under
/// sanitizers.
void run_scene(Bytes bytes) {
  for (const std::string_view large : {"rabbit", "knot"})
    if (text_of(bytes).find(large) != std::string_view::npos) return;
  for (const Leniency leniency : kEachWay)
    read([&] {
      check_scene(scene_from_json(text_of(bytes), path_of("s.json"), small_limits(leniency), decode, referred));
    });
}

void run_geometry(Bytes bytes, const char* name) {
  read([&] {
    Scene scene;
    Faults faults(small_limits().leniency);
    scene.meshes.push_back(
        mesh_from_file({bytes.begin(), bytes.end()}, name, small_limits(), MissingNormals::smooth, faults));
    scene.materials.emplace_back();
    scene.instances.emplace_back();
    check_scene(std::move(scene));
  });
}

void run_ply(Bytes bytes) { run_geometry(bytes, "m.ply"); }
void run_ply_gz(Bytes bytes) { run_geometry(bytes, "m.ply.gz"); }

/// What was read is written as a text that is read as the same.
void run_pipeline(Bytes bytes) {
  read([&] {
    const Pipeline pipeline = pipeline_from_json(text_of(bytes), "p.json", {});
    validate(pipeline);
    const std::string text = pipeline_json(pipeline);
    promise(pipeline_json(pipeline_from_json(text, "p.json", {})) == text, "a pipeline's text is its pipeline");
  });
}

/// A path never leaves its folder.
void run_uri(Bytes bytes) {
  read([&] {
    const std::string path = path_from_uri(text_of(bytes), "scene");
    const std::filesystem::path whole = (std::filesystem::path("/a/b") / path).lexically_normal();
    promise(path.find('\0') == std::string::npos && whole.string().starts_with("/a/b"), "a path stays in its folder");
  });
  if (gltf::is_data_uri(text_of(bytes)))
    read([&] {
      promise(gltf::data_of_uri(text_of(bytes), "scene", kMostBytes).bytes.size() <= bytes.size(), "no growth");
    });
}

void run_png(Bytes bytes) {
  if (picture_kind(bytes) == "PNG") read([&] { png_of(bytes, "p.png"); });
}

void run_jpeg(Bytes bytes) {
  read([&] {
    const JpegSize size = jpeg_size("p.jpg", bytes);
    promise(size.width > 0 && size.height > 0, "a picture has pixels");
  });
}

void run_exr(Bytes bytes) {
  read([&] {
    const ExrLayout layout = exr_layout("p.exr", bytes);
    promise(layout.width > 0 && layout.height > 0 && layout.pixel_bytes > 0, "a picture has pixels");
  });
}

void run_csv(Bytes bytes) {
  read([&] { promise(samples_from_csv(text_of(bytes), "l.csv", 1000).size() <= 1000, "samples are limited"); });
}

constexpr Target kTargets[] = {{"gltf", run_gltf},
                               {"glb", run_glb},
                               {"exported", run_exported},
                               {"scene_json", run_scene},
                               {"pipeline_json", run_pipeline},
                               {"ply", run_ply},
                               {"ply_gz", run_ply_gz},
                               {"obj", run_obj},
                               {"mtl", run_mtl},
                               {"uri", run_uri},
                               {"png", run_png},
                               {"jpeg", run_jpeg},
                               {"exr", run_exr},
                               {"csv", run_csv},
                               {"npy", run_npy},
                               {"dds", run_dds},
                               {"tiff", run_tiff},
                               {"hdr", run_hdr},
                               {"capture_map", run_capture_map},
                               {"light_spv", run_light_spv},
                               {"light_glsl", run_light_glsl},
                               {"light_nodes", run_light_nodes}};

}  // namespace

SceneLimits small_limits(Leniency leniency) {
  SceneLimits limits;
  limits.leniency = leniency;
  limits.lights = limits.instances = limits.nodes = 2000;
  limits.file_bytes = limits.json_bytes = limits.texture_bytes = limits.buffer_bytes = limits.geometry_bytes =
      kMostBytes;
  return limits;
}

void check_scene(Scene scene) {
  scene.spec = "scene";
  validate(scene, small_limits());
  read([&] { set_time(scene, 0.25); });
  read([&] { set_time(scene, 1e5); });
}

std::span<const Target> targets() { return kTargets; }

const Target* target_named(std::string_view name) {
  for (const Target& target : kTargets)
    if (target.name == name) return &target;
  return nullptr;
}

}  // namespace trueshade::fuzz
