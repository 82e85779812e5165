#include <algorithm>
#include <fstream>
#include <sstream>

#include "asset.h"
#include "core/error.h"
#include "tests/catch.hpp"

// The corpus of the glTF-Validator: 372 files and what the validator finds in each.
namespace trueshade {
namespace {

struct Entry {
  std::string file, codes;
  int errors = 0;
};

std::vector<Entry> entries(const std::string& corpus) {
  std::ifstream table(corpus + "/EXPECTED.csv");
  std::vector<Entry> out;
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream cells(line);
    Entry entry;
    std::string errors, warnings;
    std::getline(cells, entry.file, ','), std::getline(cells, errors, ','), std::getline(cells, warnings, ','),
        std::getline(cells, entry.codes, ',');
    entry.errors = std::stoi(errors);
    out.push_back(entry);
  }
  return out;
}

/// What a file's codes say is broken so that nothing certain is left of it.
bool is_broken(const std::string& codes) {
  constexpr std::string_view kStructural[] = {
      "GLB_",          "INVALID_JSON",    "UNDEFINED_PROPERTY", "TYPE_MISMATCH", "UNRESOLVED_",  "TOO_LONG",
      "_LOOP",         "PARENT_OVERRIDE", "INDEX_OOB",          "ONE_OF_",       "OUT_OF_RANGE", "VALUE_NOT_IN_RANGE",
      "MAJOR_VERSION", "BYTE_LENGTH",     "MISSING_GLB_DATA",   "INVALID_FORMAT"};
  return std::any_of(std::begin(kStructural), std::end(kStructural),
                     [&](std::string_view code) { return codes.find(code) != std::string::npos; });
}

/// Broken parts that no reader of ours looks at: extensions that are not implemented, and joints of a mesh that no node
/// gives a skin.
bool is_unread(const std::string& file) {
  constexpr std::string_view kRead[] = {"ext/KHR_lights_punctual",    "ext/KHR_texture_transform",
                                        "ext/KHR_materials_unlit",    "ext/KHR_materials_emissive_strength",
                                        "ext/KHR_mesh_quantization",  "ext/EXT_mesh_gpu_instancing",
                                        "ext/EXT_meshopt_compression"};
  if (file == "base/data/mesh_data/joints_weights_complex.gltf") return true;
  return file.starts_with("ext/") && std::none_of(std::begin(kRead), std::end(kRead),
                                                  [&](std::string_view folder) { return file.starts_with(folder); });
}

/// Files without errors that are refused all the same, and why.
constexpr std::pair<std::string_view, std::string_view> kRefused[] = {
    {"base/data/asset/min_version_valid.gltf", "a reader of glTF 2.1 is needed"},  // it says so itself
    {"base/data/buffer/non_relative_uri.gltf", "the path has a scheme"},           // nothing is fetched from a network
    {"base/data/root/named_objects.gltf", "buffer 0 has no data"},                 // and a drawn mesh needs them
    {"base/data/root/unused_objects.gltf", "buffer 0 has no data"}};

TEST_CASE("the glTF-Validator's corpus ends cleanly: valid files load, broken ones are refused") {
  const char* given = std::getenv("TRUESHADE_ASSETS");
  const std::string folder = given ? given : TRUESHADE_SOURCE_DIR "/../shared/assets",
                    corpus = folder + "/gltf-validator";
  if (!std::filesystem::exists(corpus + "/EXPECTED.csv")) {
    WARN("SKIPPED: " << corpus << " is absent; TRUESHADE_ASSETS names the folder of assets");
    return;
  }
  const std::vector<Entry> all = entries(corpus);
  CHECK(all.size() == 372);
  for (const Entry& entry : all) {
    std::string refusal;
    try {
      load_scene(corpus + "/" + entry.file, {}, [](std::span<const uint8_t>, const std::string&, uint64_t) {
        return Image(1, 1, Format::rgba8);  // of pictures only the names are tested here
      });
    } catch (const Error& error) {
      refusal = error.what();
      CHECK((error.kind() == ErrorKind::bad_input || error.kind() == ErrorKind::io));
      CHECK_THAT(refusal, Catch::StartsWith(corpus + "/" + entry.file + ": "));
    }
    INFO(entry.file << " [" << entry.codes << "] " << refusal);
    const auto exception = std::find_if(std::begin(kRefused), std::end(kRefused),
                                        [&](const auto& pair) { return pair.first == entry.file; });
    if (exception != std::end(kRefused))
      CHECK(refusal.find(exception->second) != std::string::npos);
    else if (entry.errors == 0)
      CHECK(refusal.empty());
    else if (is_broken(entry.codes) && !is_unread(entry.file))
      CHECK(!refusal.empty());
  }
}

}  // namespace
}  // namespace trueshade
