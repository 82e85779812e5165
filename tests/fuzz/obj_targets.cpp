#include <cmath>
#include <cstring>
#include <set>
#include <string>

#include "scenes/files/obj/obj_scene.h"
#include "scenes/files/obj/read_mtl.h"
#include "scenes/files/obj/read_obj.h"
#include "tests/fuzz/promises.h"

// OBJ files beside a library of every statement, and MTL files beside an OBJ file that draws each of their materials.
namespace trueshade::fuzz {
namespace {

constexpr std::string_view kLibrary =
    "newmtl a\nKd 0.5 0.4 0.3\nmap_Kd a.png\nmap_d b.png\nmap_Ks a.png\nbump -bm 2 grey.png\n"
    "newmtl b\nd 0.5\nmap_Ke -s 2 3 -o 0.5 0.25 b.png\nnorm n.png\nmap_Pr r.png\nmap_Pm -s 4 m.png\n"
    "newmtl c\nillum 0\nKe 3\n";

/// A file beside an OBJ file: a picture is named by its ending and holds its name, all else is a library.
obj::FileReader files_with(std::string_view library) {
  return [library](const std::string& name, uint64_t limit, const std::string& where) {
    if (name.find("missing") != std::string::npos) throw Error(ErrorKind::io, where + ": " + name, "no file", "a file");
    const std::string_view content = name.ends_with(".png") ? std::string_view(name) : library;
    if (content.size() > limit) throw Error(ErrorKind::limit, where, "it is large", "a smaller one");
    return std::vector<uint8_t>(content.begin(), content.end());
  };
}

/// A small picture whose size, format and texels follow from its name.
Image picture_of_name(Bytes content, const std::string&, uint64_t) {
  constexpr Format kFormats[] = {Format::rgba8, Format::rgba8, Format::rgba16f, Format::rgba32f, Format::rgba16};
  uint32_t hash = 2166136261u;
  for (const uint8_t byte : content) hash = (hash ^ byte) * 16777619u;
  const bool grey = text_of(content).find("grey") != std::string_view::npos;
  Image image(1 + int(hash % 4), 1 + int(hash / 4 % 4), grey ? Format::rgba8 : kFormats[hash / 16 % 5]);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(hash >> (grey ? i / 4 % 24 : i % 24));
  const float half = 0.5f;
  if (image.format == Format::rgba32f)
    for (size_t i = 0; i < image.texels.size(); i += 4) std::memcpy(&image.texels[i], &half, sizeof half);
  if (image.format == Format::rgba16f)
    for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = i % 2 == 0 ? 0x00 : 0x38;
  return image;
}

bool all_within(std::span<const float> values, float most) {
  for (const float value : values)
    if (!(std::fabs(value) <= most)) return false;
  return true;
}

bool is_below(int32_t index, size_t count) { return index >= 0 && size_t(index) < count; }

void check_polygons(const obj::ObjDocument& d) {
  promise(d.polygon_lines.size() == d.polygon_count(), "a polygon has a line");
  uint32_t begin = 0;
  for (const uint32_t end : d.polygon_ends) {
    promise(end >= begin + 3, "a polygon has corners");
    begin = end;
  }
  promise(begin == d.corners.size(), "a corner is a polygon's");
  for (const obj::Corner& c : d.corners) {
    promise(is_below(c.position, d.position_count()), "the index of a position is in range");
    promise(c.uv < 0 || is_below(c.uv, d.uvs.size() / 2), "the index of a texture coordinate is in range");
    promise(c.normal < 0 || is_below(c.normal, d.normals.size() / 3), "the index of a normal is in range");
  }
  for (size_t i = 0; i < d.runs.size(); ++i) {
    promise(i == 0 ? d.runs[i].first_polygon == 0 : d.runs[i].first_polygon > d.runs[i - 1].first_polygon,
            "runs ascend");
    promise(d.runs[i].first_polygon < d.polygon_count(), "a run has polygons");
    promise(d.runs[i].material < int64_t(d.material_names.size()), "a run's material has a name");
    promise(d.runs[i].object < int64_t(d.object_names.size()), "a run's object has a name");
  }
}

void check_document(const obj::ObjDocument& d) {
  promise(d.positions.size() % 3 == 0 && d.normals.size() % 3 == 0 && d.uvs.size() % 2 == 0, "vectors are whole");
  promise(d.colors.empty() || d.colors.size() == 4 * d.position_count(), "every vertex has a colour, or none");
  for (const auto* values : {&d.positions, &d.normals, &d.uvs, &d.colors})
    promise(all_within(*values, 1e18f), "numbers are finite");
  check_polygons(d);
}

void check_meshes(const Scene& scene, size_t triangles) {
  for (const Mesh& mesh : scene.meshes) {
    for (const uint32_t index : mesh.indices) promise(index < mesh.vertex_count(), "indices of meshes are in range");
    for (int k = 0; k < 3; ++k) {
      promise(all_within(mesh.position[size_t(k)], 1e18f), "positions of meshes are finite");
      promise(all_within(mesh.normal[size_t(k)], 1e18f), "normals of meshes are finite");
    }
    promise(mesh.triangle_count() <= triangles, "triangles are the file's");
    triangles -= mesh.triangle_count();
  }
  promise(triangles == 0, "every triangle is in a mesh");
}

void check_source(const std::optional<obj::MapSource>& map) {
  if (!map) return;
  promise(!map->file.empty(), "a map has a file");
  const float numbers[] = {map->offset.x, map->offset.y, map->scale.x, map->scale.y, map->bump};
  promise(all_within(numbers, 1e6f), "numbers of options are in range");
}

bool is_share(const std::optional<float>& value) { return !value || (*value >= 0.0f && *value <= 1.0f); }

void check_library(const obj::MtlDocument& document) {
  std::set<std::string_view> names;
  for (const obj::MtlMaterial& m : document.materials) {
    promise(names.insert(m.name).second, "materials have different names");
    promise(is_share(m.d) && is_share(m.pr) && is_share(m.pm), "shares are from 0 to 1");
    promise(m.illum >= 0 && m.illum <= 10 && (!m.ns || *m.ns >= 0.0f), "numbers are in range");
    for (const auto* color : {&m.kd, &m.ks, &m.ke})
      for (int k = 0; *color && k < 3; ++k)
        promise((**color)[k] >= 0.0f && (**color)[k] <= 1e18f, "colours are in range");
    for (const auto* map : {&m.map_kd, &m.map_ks, &m.map_ke, &m.map_d, &m.map_bump, &m.norm, &m.map_pr, &m.map_pm})
      check_source(*map);
  }
}

}  // namespace

void run_obj(Bytes bytes) {
  for (const MissingNormals missing : {MissingNormals::smooth, MissingNormals::creased, MissingNormals::flat})
    for (const Leniency leniency : kEachWay)
      read([&] {
        const SceneLimits limits = small_limits(leniency);
        Faults faults(leniency);
        const obj::ObjDocument document = obj::read_obj(bytes, "m.obj", limits, faults);
        check_document(document);
        Scene scene = scene_from_obj(bytes, "m.obj", limits, picture_of_name, missing, files_with(kLibrary));
        check_meshes(scene, document.corners.size() - 2 * document.polygon_count());
        check_scene(std::move(scene));
      });
}

void run_mtl(Bytes bytes) {
  for (const Leniency leniency : kEachWay)
    read([&] {
      Faults faults(leniency);
      const obj::MtlDocument document = obj::read_mtl(bytes, "m.mtl", faults);
      check_library(document);
      std::string file = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 2\n";
      for (const obj::MtlMaterial& material : document.materials)
        file += "usemtl " + material.name + " \nf 1/1 2/1 3/1\n";  // a name may end in a backslash, which joins lines
      const std::vector<uint8_t> content(file.begin(), file.end());
      Scene scene = scene_from_obj(content, "m.obj", small_limits(leniency), picture_of_name, MissingNormals::flat,
                                   files_with(text_of(bytes)));
      check_meshes(scene, document.materials.size());
      check_scene(std::move(scene));
    });
}

}  // namespace trueshade::fuzz
