#include "scenes/files/obj/obj_scene.h"

#include <algorithm>
#include <memory>
#include <set>

#include "core/error.h"
#include "core/file_ending.h"
#include "core/fp_env.h"
#include "scenes/files/obj/obj_materials.h"
#include "scenes/files/obj/obj_meshes.h"
#include "scenes/files/obj/read_mtl.h"
#include "scenes/files/obj/read_obj.h"
#include "scenes/files/obj/statements.h"

namespace trueshade {
namespace obj {
namespace {

constexpr glm::vec4 kGrey{0.7f, 0.7f, 0.7f, 1.0f};

/// The materials that a document's libraries define, and the scene's of those that are drawn.
class Libraries {
 public:
  Libraries(const ObjDocument& document, const SceneLimits& limits, const ImageDecoder& decode, const FileReader& read,
            Faults& faults, Scene& scene)
      : document_(document), faults_(faults), scene_(scene), pictures_(read, decode, limits, faults, scene) {
    uint64_t left = limits.file_bytes;
    for (const ObjDocument::Library& library : document.libraries) {
      const std::string where = document.file + ": line " + std::to_string(library.line);
      try {
        const std::string path = path_beside("", library.name, where, limits.named_paths);
        const Bytes text = read(path, left, where);
        left -= std::min<uint64_t>(left, text.size());
        documents_.push_back(std::make_unique<MtlDocument>(read_mtl(text, path, faults)));
      } catch (const Error& error) {
        faults.pass(Fault::library, library.name, error);
        continue;
      }
      define(*documents_.back());
    }
    drawn_.resize(document.material_names.size() + 1, -1);
  }

  /// Decodes the pictures of the materials that polygons are drawn in, by all cores, of which one does `meanwhile`.
  void decode_pictures(const std::function<void()>& meanwhile) {
    std::vector<WantedPicture> wanted;
    std::set<int32_t> seen;
    for (size_t i = 0; i < document_.runs.size(); ++i) {
      const Run& run = document_.runs[i];
      const size_t end =
          i + 1 < document_.runs.size() ? document_.runs[i + 1].first_polygon : document_.polygon_count();
      if (run.first_polygon == end || run.material < 0 || !seen.insert(run.material).second) continue;
      const auto found = defined_.find(document_.material_names[size_t(run.material)]);
      if (found == defined_.end()) continue;
      for (const MapSource* map : maps_of(*found->second.material)) wanted.push_back({found->second.document, map});
    }
    pictures_.decode_ahead(wanted, meanwhile);
  }

  void build_levels() { pictures_.build_levels(); }

  /// Index in the scene of one of the document's materials; below 0 stands for none.
  uint32_t material(int32_t index) {
    int32_t& known = drawn_[size_t(index + 1)];
    if (known < 0) {
      Material material = made(index);
      known = int32_t(scene_.materials.size());
      const auto found = index < 0 ? defined_.end() : defined_.find(document_.material_names[size_t(index)]);
      uv_sources_.resize(scene_.materials.size());
      uv_sources_.push_back(found == defined_.end() ? UvSources() : uv_sources_of(*found->second.material));
      scene_.materials.push_back(std::move(material));
    }
    return uint32_t(known);
  }

  /// What the scene leaves out.
  void add_notes() {
    std::map<std::string, uint64_t> passed_over;
    for (const auto& document : documents_)
      for (const auto& [name, count] : document->passed_over) passed_over[name] += count;
    std::string names;
    for (const auto& [name, count] : passed_over)
      names += (names.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ')';
    if (!names.empty()) scene_.notes.push_back("What the material library says by these words is not drawn: " + names);
    add_note(mirrors_, "material asks", "materials ask",
             " for reflection or refraction (illum 3 to 9), which is not drawn: Their highlights are");
    if (drawn_.front() >= 0 && document_.libraries.empty() && !document_.uvs.empty())
      scene_.notes.push_back(
          "The file has texture coordinates and names no material (mtllib), so it is grey: A scene "
          "file gives it a texture (docs/obj.md)");
    const std::string undefined =
        " grey, because no library of the file (mtllib) defines " + std::string(undefined_ == 1 ? "it: " : "them: ");
    add_note(undefined_, "material is", "materials are",
             (undefined + undefined_names_ + (undefined_ > kMostNamed ? " and more" : "")).c_str());
  }

  void add_note(uint64_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) scene_.notes.push_back(std::to_string(count) + ' ' + (count == 1 ? one : many) + rest);
  }

  std::vector<UvSources>& uv_sources() { return uv_sources_; }

 private:
  struct Defined {
    const MtlDocument* document;
    const MtlMaterial* material;
  };

  void define(const MtlDocument& library) {
    for (const MtlMaterial& material : library.materials)
      if (!defined_.emplace(material.name, Defined{&library, &material}).second)
        faults_.pass(Fault::statement, library.file + ": line " + std::to_string(material.line),
                     "a material of this name exists in another library", "another name");
  }

  Material made(int32_t index) {
    if (index < 0) return {"grey", kGrey};
    const std::string& name = document_.material_names[size_t(index)];
    const auto found = defined_.find(name);
    if (found != defined_.end()) {
      mirrors_ += found->second.material->illum >= 3 && found->second.material->illum <= 9;
      return material_of(*found->second.document, *found->second.material, pictures_);
    }
    if (++undefined_ <= kMostNamed) undefined_names_ += (undefined_ == 1 ? "" : ", ") + shown_word(name);
    return {name, kGrey};
  }

  const ObjDocument& document_;
  Faults& faults_;
  Scene& scene_;
  ObjPictures pictures_;
  std::vector<std::unique_ptr<MtlDocument>> documents_;
  std::map<std::string, Defined> defined_;
  std::vector<int32_t> drawn_;         ///< by index in the document + 1
  std::vector<UvSources> uv_sources_;  ///< by index in the scene
  static constexpr uint64_t kMostNamed = 8;
  uint64_t mirrors_ = 0, undefined_ = 0;
  std::string undefined_names_;
};

}  // namespace
}  // namespace obj

bool is_obj_name(std::string_view name) { return has_ending(name, ".obj") || has_ending(name, ".obj.gz"); }

Scene scene_from_obj(std::span<const uint8_t> file, const std::string& path, const SceneLimits& limits,
                     const ImageDecoder& decode, MissingNormals missing_normals, const obj::FileReader& read) {
  const FpScope fp;
  Scene scene;
  scene.spec = path;
  Faults faults(limits.leniency);
  obj::ObjDocument document = obj::read_obj(file, path, limits, faults);
  obj::Libraries libraries(document, limits, decode, read, faults, scene);
  std::vector<obj::ObjPart> parts;
  libraries.decode_pictures([&] { parts = obj::parts_of(document, missing_normals, limits); });
  if (parts.empty())
    throw Error(ErrorKind::bad_input, path, "the file has no faces", "f statements: nothing else is drawn");
  for (obj::ObjPart& part : parts) {
    Instance instance;
    instance.mesh = uint32_t(scene.meshes.size());
    instance.material = libraries.material(part.material);
    part.mesh.name = part.object < 0 ? path : document.object_names[size_t(part.object)];
    scene.meshes.push_back(std::move(part.mesh));
    scene.instances.push_back(instance);
  }
  libraries.build_levels();
  libraries.uv_sources().resize(scene.materials.size());
  bake_uv(scene, libraries.uv_sources(), [](uint64_t) {});  // no mesh is drawn twice, so none is copied
  libraries.add_note(document.points, "statement of points (p) is", "statements of points (p) are",
                     " not drawn, because only faces are drawn");
  libraries.add_note(document.lines, "statement of lines (l) is", "statements of lines (l) are",
                     " not drawn, because only faces are drawn");
  libraries.add_note(document.free_form, "curve or surface is", "curves and surfaces are",
                     " not drawn, because only faces are drawn");
  libraries.add_notes();
  faults.tell(scene);
  return scene;
}

Scene scene_from_obj(std::span<const uint8_t> file, const std::string& path, const SceneLimits& limits,
                     const ImageDecoder& decode, MissingNormals missing_normals) {
  const SceneFolder folder(path, limits.named_paths);
  const obj::FileReader read = [&](const std::string& relative, uint64_t limit, const std::string& where) {
    return folder.read(relative, limit, where);
  };
  if (!has_ending(path, ".gz")) return scene_from_obj(file, path, limits, decode, missing_normals, read);
  const Bytes unpacked = gunzipped(file, limits, path);
  return scene_from_obj(unpacked, path, limits, decode, missing_normals, read);
}

}  // namespace trueshade
