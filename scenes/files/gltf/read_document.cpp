#include "scenes/files/gltf/read_document.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "core/error.h"
#include "scenes/files/gltf/reading.h"

namespace trueshade::gltf {
namespace {

/// The extensions that are read and drawn.
constexpr std::string_view kExtensions[] = {
    "KHR_lights_punctual",   "KHR_texture_transform",   "KHR_materials_unlit",    "KHR_materials_emissive_strength",
    "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "EXT_meshopt_compression"};

struct Version {
  int major = 0, minor = 0;
  auto operator<=>(const Version&) const = default;
};

Version version_of(const json::Node& node) {
  const std::string& text = node.string();
  Version version;
  const char *first = text.data(), *last = first + text.size();
  const auto [dot, major_code] = std::from_chars(first, last, version.major);
  if (major_code != std::errc() || dot == last || *dot != '.')
    node.fail("the version is not of the form MAJOR.MINOR", "2.0");
  const auto [end, minor_code] = std::from_chars(dot + 1, last, version.minor);
  if (minor_code != std::errc() || end != last || version.major < 0 || version.minor < 0)
    node.fail("the version is not of the form MAJOR.MINOR", "2.0");
  return version;
}

void check_asset(const json::Node& root) {
  const json::Node asset = root.member("asset");
  const json::Node version_node = asset.member("version");
  const Version version = version_of(version_node);
  if (version.major != 2) version_node.fail("the version is " + std::to_string(version.major), "glTF 2");
  const auto least = asset.find("minVersion");
  if (!least) return;
  if (const Version needed = version_of(*least); needed > version)
    least->fail("minVersion is above version", "a minVersion of at most version");
  else if (needed > Version{2, 0})
    least->fail("a reader of glTF " + least->string() + " is needed", "glTF 2.0");
}

bool is_read(std::string_view extension) {
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) != std::end(kExtensions);
}

/// Whether what an extension changes is how surfaces look, or nothing that a picture shows: without it the file's
/// shapes are still there.
bool leaves_shapes(std::string_view extension) {
  constexpr std::string_view kParts[] = {"_materials_",        "_texture_", "_lights_", "_technique_",
                                         "_animation_pointer", "_xmp",      "_lod"};
  return std::any_of(std::begin(kParts), std::end(kParts),
                     [&](std::string_view part) { return extension.find(part) != std::string_view::npos; });
}

void check_required(const json::Node& name, Document& document) {
  if (is_read(name.string())) return;
  std::string quoted, all;
  json::append_string(quoted, std::string_view(name.string()).substr(0, 80));
  for (const std::string_view extension : kExtensions) all += (all.empty() ? "" : " ") + std::string(extension);
  const std::string reason = "the required extension " + quoted + " is not implemented",
                    remedy = "export without it; implemented are " + all;
  if (!leaves_shapes(name.string())) name.fail(reason, remedy);
  document.pass(Fault::extension, name.pointer(), reason, remedy);
}

void read_extensions(const json::Node& root, Document& document) {
  std::set<std::string_view> used, required;
  for_each(root, "extensionsUsed", [&](const json::Node& name, size_t) {
    if (!used.insert(name.string()).second) name.fail("an extension is named twice", "each once");
    document.extensions.push_back({name.string().substr(0, 80), false, is_read(name.string())});
  });
  for_each(root, "extensionsRequired", [&](const json::Node& name, size_t) {
    if (!required.insert(name.string()).second) name.fail("an extension is named twice", "each once");
    check_required(name, document);
    if (!used.contains(name.string())) name.fail("a required extension is not among extensionsUsed", "add it there");
  });
  for (SceneExtension& extension : document.extensions) extension.required = required.contains(extension.name);
  document.quantized = used.contains("KHR_mesh_quantization");
}

uint32_t count_of(const json::Node& object, std::string_view key) {
  const auto list = object.find(key);
  return list ? uint32_t(list->array(1, kNone - 1).size()) : 0;
}

Counts counts_of(const json::Node& root) {
  Counts counts{count_of(root, "buffers"),   count_of(root, "bufferViews"), count_of(root, "accessors"),
                count_of(root, "images"),    count_of(root, "samplers"),    count_of(root, "textures"),
                count_of(root, "materials"), count_of(root, "meshes"),      count_of(root, "nodes"),
                count_of(root, "skins"),     count_of(root, "cameras"),     0,
                count_of(root, "scenes")};
  const auto extensions = extensions_of(root);
  const auto lights = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
  if (lights) lights->member("lights");
  if (lights) counts.lights = count_of(*lights, "lights");
  return counts;
}

}  // namespace

void Document::fail(const std::string& pointer, const std::string& reason, const std::string& remedy) const {
  throw Error(ErrorKind::bad_input, file + ": " + pointer, reason, remedy);
}

void Document::pass(Fault fault, const std::string& pointer, const std::string& reason, const std::string& remedy) {
  faults.pass(fault, file + ": " + pointer, reason, remedy);
}

Document read_document(const Container& container, const std::string& file, const SceneLimits& limits) {
  if (container.json.size() > limits.json_bytes)
    throw Error(ErrorKind::limit, file, std::to_string(container.json.size()) + " bytes of JSON are over the limit",
                within_limit(limits.json_bytes, "bytes", "--max-json"));
  json::Value value = json::parse(container.json, file);
  const json::Node root(value, file);
  Document document;
  document.file = file;
  document.is_glb = container.is_glb;
  document.faults = Faults(limits.leniency);
  check_asset(root);
  read_extensions(root, document);
  const Counts counts = counts_of(root);
  if (counts.nodes > limits.nodes)
    root.member("nodes").fail(std::to_string(counts.nodes) + " nodes are over the limit",
                              within_limit(limits.nodes, "", "--max-nodes"), ErrorKind::limit);
  read_data(root, counts, document);
  read_materials(root, counts, document);
  read_meshes(root, counts, document);
  read_lights_and_cameras(root, document);
  read_nodes(root, counts, document);
  read_animations(root, counts, document);
  for (auto& [key, member] : *std::get<std::unique_ptr<json::Members>>(value.is))
    if (key == "extras") document.extras = std::move(member);
  return document;
}

// --- reading.h -----------------------------------------------------------------------------------------------------

uint32_t index(const json::Node& node, uint32_t count, std::string_view one) {
  const int64_t i = node.integer(0, kLargestCount);
  if (i >= int64_t(count))
    node.fail("there is no " + std::string(one) + ' ' + std::to_string(i),
              count == 0 ? "a document with one" : "an index below " + std::to_string(count));
  return uint32_t(i);
}

uint32_t index_or_none(const json::Node& object, std::string_view key, uint32_t count, std::string_view one) {
  const auto node = object.find(key);
  return node ? index(*node, count, one) : kNone;
}

uint64_t whole_or(const json::Node& object, std::string_view key, uint64_t absent, int64_t least, int64_t most) {
  const auto node = object.find(key);
  return node ? uint64_t(node->integer(least, most)) : absent;
}

double number_or(const json::Node& object, std::string_view key, double absent, double least, double most) {
  const auto node = object.find(key);
  return node ? node->number(least, most) : absent;
}

bool boolean_or(const json::Node& object, std::string_view key, bool absent) {
  const auto node = object.find(key);
  return node ? node->boolean() : absent;
}

std::string string_or_empty(const json::Node& object, std::string_view key) {
  const auto node = object.find(key);
  return node ? node->string() : std::string();
}

size_t known_or_other(const json::Node& node, std::span<const std::string_view> names) {
  return size_t(std::find(names.begin(), names.end(), node.string()) - names.begin());
}

std::optional<json::Node> extensions_of(const json::Node& object) {
  std::optional<json::Node> extensions = object.find("extensions");
  if (!extensions) return std::nullopt;
  extensions->find("");  // fails unless it is an object
  for (const auto& [name, member] : *std::get<std::unique_ptr<json::Members>>(extensions->value().is))
    json::Node(member, *extensions, std::string_view(name)).find("");
  return extensions;
}

}  // namespace trueshade::gltf
