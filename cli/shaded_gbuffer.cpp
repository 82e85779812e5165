#include "cli/shaded_gbuffer.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>

#include "cli/capture/captured_planes.h"
#include "cli/capture/stored_planes.h"
#include "cli/capture_options.h"
#include "cli/named_file.h"
#include "core/error.h"
#include "core/sha256.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

namespace fs = std::filesystem;

constexpr const char *kFiles = "trueshade:gbuffer", *kMap = "trueshade:gbufferMap", *kHash = "trueshade:gbufferHash";

const std::string* value_of(const Metadata& metadata, std::string_view key) {
  const auto found =
      std::find_if(metadata.begin(), metadata.end(), [&](const auto& entry) { return entry.first == key; });
  return found == metadata.end() ? nullptr : &found->second;
}

/// Of all planes, by name.
std::string planes_hash(const oracle::Capture& capture) {
  std::vector<std::string> lines;
  for (const NamedImage& plane : capture.planes) lines.push_back(plane.name + ' ' + image_hash(plane.image) + '\n');
  std::sort(lines.begin(), lines.end());
  Sha256 hash;
  for (const std::string& line : lines) hash.update(line.data(), line.size());
  return "sha256:" + hash.hex();
}

std::string without_folder(const std::string& path) { return fs::path(path).filename().string(); }

std::string found_file(const std::string& name, const std::string& picture) {
  if (const std::optional<std::string> file = file_named_by(picture, name)) return *file;
  throw Error(ErrorKind::bad_input, name, "the reference was shaded of this, and it is neither here nor beside it",
              "--no-judge compares values alone");
}

CaptureOptions found_files(const Metadata& metadata, const std::string& picture) {
  CaptureOptions options;
  std::istringstream names(*value_of(metadata, kFiles));
  for (std::string name; std::getline(names, name);) options.gbuffer_files.push_back(found_file(name, picture));
  if (const std::string* map = value_of(metadata, kMap))
    options.map = map->starts_with('@') ? '@' + found_file(map->substr(1), picture) : *map;
  return options;
}

/// The planes of files that a picture names. No word of a file that holds none is repeated: whoever made the picture
/// has chosen the file.
StoredPlanes planes_of_named(const CaptureOptions& files, const Limits& limits, const Scene& scene,
                             const Pipeline& pipeline) try {
  return stored_planes(capture_files_of(files, limits), scene, pipeline);
} catch (const Error& error) {
  if (error.kind() == ErrorKind::limit) throw;
  throw Error(ErrorKind::bad_input, "the reference's G-buffer", "what it names is no G-buffer of its scene",
              "--no-judge compares values alone");
}

}  // namespace

StoredPlanes stored_planes(const CaptureFiles& files, const Scene& scene, const Pipeline& pipeline) {
  CapturedPlanes planes = captured_planes(files, scene, pipeline);
  planes.capture.color = {};
  store_as(pipeline, planes.capture);
  return {std::move(planes.capture), std::move(planes.notes)};
}

Metadata gbuffer_metadata(const CaptureOptions& files, const oracle::Capture& planes) {
  std::string names;
  for (const std::string& path : files.gbuffer_files) names += (names.empty() ? "" : "\n") + without_folder(path);
  Metadata metadata = {{kFiles, names}, {kHash, planes_hash(planes)}};
  if (files.map)
    metadata.emplace_back(kMap, files.map->starts_with('@') ? '@' + without_folder(files.map->substr(1)) : *files.map);
  return metadata;
}

bool is_shaded(const Metadata& metadata) {
  return value_of(metadata, kFiles) != nullptr && value_of(metadata, kHash) != nullptr;
}

StoredPlanes found_gbuffer(const Metadata& metadata, const std::string& picture, const Limits& limits,
                           const Scene& scene, const Pipeline& pipeline) {
  StoredPlanes planes = planes_of_named(found_files(metadata, picture), limits, scene, pipeline);
  if (planes_hash(planes.capture) == *value_of(metadata, kHash)) return planes;
  throw Error(ErrorKind::bad_input, planes.capture.name,
              "it is another G-buffer today than the reference was shaded of", "--no-judge compares values alone");
}

}  // namespace trueshade
