#include "tests/fuzz/targets.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/image_files/exr_layout.h"
#include "core/image_files/jpeg_pixels.h"
#include "core/image_files/png_header.h"
#include "core/image_files/png_pixels.h"
#include "core/picture_kind.h"
#include "scenes/files/gltf/data_uri.h"
#include "scenes/files/gltf/gltf_scene.h"
#include "scenes/files/light_buffers.h"
#include "scenes/files/load_geometry.h"
#include "scenes/files/scene_files.h"
#include "scenes/files/scene_json.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::fuzz {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr uint64_t kMostBytes = uint64_t(8) << 20;
constexpr int kMostSide = 512;

/// Limits under which an input takes milliseconds.
SceneLimits small_limits() {
  SceneLimits limits;
  limits.lights = limits.instances = limits.nodes = 2000;
  limits.file_bytes = limits.json_bytes = limits.texture_bytes = limits.buffer_bytes = limits.geometry_bytes =
      kMostBytes;
  return limits;
}

std::string_view text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

void promise(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

/// A refusal is one line.
template <typename Job>
void read(Job job) {
  try {
    job();
  } catch (const Error& error) {
    promise(std::string_view(error.what()).ends_with(")"), "an error says what to do");
  }
}

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

/// A scene that was read is in range, and stays so at any time or says so.
void check_scene(Scene scene) {
  scene.spec = "scene";
  validate(scene, small_limits());
  read([&] { set_time(scene, 0.25); });
  read([&] { set_time(scene, 1e5); });
}

void run_gltf(Bytes bytes) {
  read([&] { check_scene(scene_from_gltf(bytes, path_of("s.gltf"), small_limits(), decode)); });
}

void run_glb(Bytes bytes) {
  read([&] { check_scene(scene_from_gltf(bytes, path_of("s.glb"), small_limits(), decode)); });
}

/// But for scenes with our two large meshes, which are made in a tenth of a second, and in more than one under
/// sanitizers.
void run_scene(Bytes bytes) {
  for (const std::string_view large : {"rabbit", "knot"})
    if (text_of(bytes).find(large) != std::string_view::npos) return;
  read([&] { check_scene(scene_from_json(text_of(bytes), path_of("s.json"), small_limits(), decode)); });
}

void run_geometry(Bytes bytes, const char* name) {
  read([&] {
    Scene scene;
    scene.meshes.push_back(mesh_from_file({bytes.begin(), bytes.end()}, name, small_limits(), MissingNormals::smooth));
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
    const std::string path = relative_path_from_uri(text_of(bytes), "scene");
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

constexpr Target kTargets[] = {
    {"gltf", run_gltf}, {"glb", run_glb},       {"scene_json", run_scene}, {"pipeline_json", run_pipeline},
    {"ply", run_ply},   {"ply_gz", run_ply_gz}, {"uri", run_uri},          {"png", run_png},
    {"jpeg", run_jpeg}, {"exr", run_exr},       {"csv", run_csv}};

}  // namespace

std::span<const Target> targets() { return kTargets; }

const Target* target_named(std::string_view name) {
  for (const Target& target : kTargets)
    if (target.name == name) return &target;
  return nullptr;
}

}  // namespace trueshade::fuzz
