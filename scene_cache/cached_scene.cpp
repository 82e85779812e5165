#include "scene_cache/cached_scene.h"

#include <malloc.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "core/error.h"
#include "core/file_notes.h"
#include "core/fp_env.h"
#include "core/memory_cap.h"
#include "core/sha256.h"
#include "core/threads/parallel_for.h"
#include "scene_cache/checked_clusters.h"
#include "scene_cache/checked_file.h"
#include "scene_cache/origin.h"
#include "scene_cache/scene_values.h"
#include "scene_cache/tables.h"
#include "scenes/both_faces.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade {
namespace {

/// Makes the folder if it is not there, and refuses one in which other users could put files.
void check_folder(const std::string& folder) {
  if (mkdir(folder.c_str(), S_IRWXU | S_IRWXG | S_IRWXO) == 0) chmod(folder.c_str(), S_IRWXU);
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0)
    throw Error(ErrorKind::io, folder, std::string("the cache folder: ") + std::strerror(errno),
                "a folder that exists, or that can be made in one that does");
  if (!S_ISDIR(status.st_mode)) throw Error(ErrorKind::bad_input, folder, "this is no folder", "a folder for --cache");
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0 || (status.st_uid != geteuid() && status.st_uid != 0))
    throw Error(ErrorKind::bad_input, folder, "other users can put files into the cache folder",
                "a folder of your own, chmod go-w");
}

std::string cache_path(const std::string& folder, const std::string& spec) {
  Sha256 sha;
  sha.update(spec.data(), spec.size());
  std::string name = spec.substr(spec.rfind('/') + 1).substr(0, 64);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_') c = '_';
  return folder + (folder.ends_with('/') ? "" : "/") + name + '-' + sha.hex().substr(0, 16) + ".cache";
}

/// Another text for other parts, and for another way to read a file; nothing of what is taken unasked.
std::string text_of(const SceneParts& parts, const SceneLimits& limits) {
  std::string text;
  if (limits.leniency == Leniency::asked) text += std::string(1, '\0') + "lenient";
  if (limits.named_paths == NamedPaths::any) text += std::string(1, '\0') + "trust-paths";
  for (const auto& [option, value] : {std::pair{"camera", &parts.camera}, {"animation", &parts.animation}})
    if (*value) text += std::string(1, '\0') + option + '=' + **value;
  return text;
}

bool has_many_uv_sets(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return !m.more_uv.empty(); });
}

/// What is read of each mesh for every frame. It lies together, so that it is read from disk at once.
struct CullingData {
  Array<Cluster> clusters;
  ClusterBoxes boxes;
};

void each_member(auto& visit, Same<CullingData> auto& value) {
  auto& [clusters, boxes] = value;
  each_of(visit, clusters, boxes);
}

/// Puts the scene and its clusters into the file. A mesh is given up once it is there.
void write_cache(const std::string& path, const SceneOrigin& origin, Scene& scene) {
  CheckedFileWriter file(path);
  TableWriter tables(file);
  tables(origin);
  const bool digested = scene.timeline.posed.empty() && !has_many_uv_sets(scene);
  std::optional<SceneDigests> digests;
  if (digested) digests = digests_of(scene);
  tables(uint64_t(scene.meshes.size()));
  std::vector<CullingData> culled;
  std::vector<uint8_t> is_wound;
  for (Mesh& mesh : scene.meshes) {
    is_wound.push_back(is_wound_by_normals(mesh));
    ClusteredMesh clusters = cluster_mesh(mesh);
    culled.push_back({std::move(clusters.clusters), std::move(clusters.boxes)});
    tables(mesh);
    tables(clusters);
    mesh = Mesh();
  }
  tables(culled);
  tables(is_wound);
  tables(scene);
  tables(digests);
  file.finish(tables.bytes());
}

/// Everything of a scene that is read as a whole, whatever the view is: without digests all of it.
void check_what_is_read_whole(const CheckedFile& file, const CachedScene& cached) {
  if (!cached.scene.digests) return file.check_all();
  std::vector<std::span<const uint8_t>> parts;
  const auto add = [&parts](const auto& array) {
    parts.emplace_back(reinterpret_cast<const uint8_t*>(array.data()), array.size() * sizeof array[0]);
  };
  for (const ClusteredMesh& mesh : cached.clusters->meshes) {
    add(mesh.clusters);
    for (const auto* ends : {&mesh.boxes.center, &mesh.boxes.half_size})
      for (const auto& stream : *ends) add(stream);
  }
  for (const Texture& texture : cached.scene.textures)
    for (const TextureLevel& level : texture.levels)
      if (cached.scene.digests->textures.empty()) add(level.bytes);
  for (const auto& part : parts) file.fetch(part.data(), part.size());
  parallel_for(int(parts.size()), 0, [&](int i) { file.check(parts[size_t(i)].data(), parts[size_t(i)].size()); });
}

/// Whether instances and materials name what is there. A file of this program does; indices of vertices and those of
/// the timeline are taken as they are.
bool names_exist(const Scene& scene) {
  for (const Instance& instance : scene.instances)
    if (instance.mesh >= scene.meshes.size() || instance.material >= scene.materials.size()) return false;
  for (const Material& material : scene.materials)
    for (const TextureSlot* slot : maps_of(material))
      if (slot->used() && size_t(slot->texture) >= scene.textures.size()) return false;
  return true;
}

/// The scene in a cache file; nothing if there is none of this origin. Error(bad_input) for a file that is forged.
std::optional<CachedScene> read_cache(const std::string& path, const std::string& spec, const SceneLimits& limits) try {
  const std::shared_ptr<const CheckedFile> file = CheckedFile::open(path);
  if (!file) return std::nullopt;
  TableReader tables(file);
  const auto origin = tables.taken<SceneOrigin>();
  if (origin.spec != spec || !within(origin.limits, limits) || !is_unchanged(origin)) return std::nullopt;
  require_memory(file->tables().size(), spec, "the scene");
  CachedScene cached{{}, std::make_unique<ClusteredScene>(), {}, {}};
  Scene& scene = cached.scene;
  const auto meshes = tables.taken<uint64_t>();
  for (uint64_t i = 0; i < meshes; ++i) {
    scene.meshes.push_back(tables.taken<Mesh>());
    cached.clusters->meshes.push_back(tables.taken<ClusteredMesh>());
  }
  auto culled = tables.taken<std::vector<CullingData>>();
  if (culled.size() != meshes) return std::nullopt;
  for (size_t i = 0; i < culled.size(); ++i) {
    cached.clusters->meshes[i].clusters = std::move(culled[i].clusters);
    cached.clusters->meshes[i].boxes = std::move(culled[i].boxes);
  }
  cached.is_wound = tables.taken<std::vector<uint8_t>>();
  if (cached.is_wound.size() != meshes) return std::nullopt;
  tables(scene);
  if (!names_exist(scene))
    throw Error(ErrorKind::bad_input, path, "it names what it does not hold, so it is not of this program",
                "remove it, and see who can write to its folder");
  const auto digests = tables.taken<std::optional<SceneDigests>>();
  if (digests) scene.digests = std::make_shared<SceneDigests>(*digests);
  check_what_is_read_whole(*file, cached);
  for (const FileState& made_of : origin.files) {
    FilesRead::note(made_of.path);
    note_read_from_disk(made_of.path);
  }
  cached.clusters->source = std::make_shared<CheckedClusters>(file, scene.textures.size());
  return cached;
} catch (const BadTables&) {
  return std::nullopt;
} catch (const Error& error) {
  if (error.kind() != ErrorKind::io) throw;
  return std::nullopt;
}

int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Whether a file changed while it was read, or so shortly before that another change then would have left its times.
bool changed_lately(const SceneOrigin& origin, int64_t start_ns) {
  constexpr int64_t kClockStep = 50000000;  // several ticks of the clock that file systems use
  return std::any_of(origin.files.begin(), origin.files.end(),
                     [&](const FileState& file) { return file.changed_ns + kClockStep > start_ns; });
}

}  // namespace

void check_all(const CachedScene& cached) {
  if (cached.clusters && cached.clusters->source) cached.clusters->source->check_all();
}

CachedScene cached_scene(const std::string& folder, const std::string& spec, const SceneLimits& limits,
                         const SceneParts& parts, const std::function<Scene()>& load) {
  const FpScope fp;
  check_folder(folder);
  if (spec == "-") return {load(), nullptr, {}, {}};
  const std::string whole_spec = absolute_spec(spec) + text_of(parts, limits), path = cache_path(folder, whole_spec);
  if (auto cached = read_cache(path, whole_spec, limits)) return std::move(*cached);

  const int64_t start_ns = now_ns();
  CachedScene loaded;
  SceneOrigin origin{whole_spec, limits, {}, {}};
  {
    const FilesRead files;
    loaded.scene = load();
    for (const std::string& file : files.paths()) origin.files.push_back(file_state(absolute_spec(file)));
  }
  for (const std::string& file : program_files()) origin.program.push_back(file_state(file));
  if (changed_lately(origin, start_ns)) return loaded;
  try {
    write_cache(path, origin, loaded.scene);
  } catch (const Error& error) {
    loaded.note = std::string("There is no cache file: ") + error.what();
    loaded.scene = load();
    return loaded;
  }
  loaded.scene = Scene();
  malloc_trim(0);  // the meshes' memory, which the frame may need
  if (auto cached = read_cache(path, whole_spec, limits)) return std::move(*cached);
  loaded.scene = load();  // another process has put a file of another state there
  return loaded;
}

}  // namespace trueshade
