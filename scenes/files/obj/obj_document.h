#pragma once
#include <cstdint>
#include <string>
#include <vector>

// What an OBJ file says, as plain values.
namespace trueshade::obj {

/// Indices from 0 on; below 0 where the file gives none.
struct Corner {
  int32_t position, uv, normal;
};

/// What holds from one polygon on.
struct Run {
  uint32_t first_polygon = 0;
  int32_t material = -1;   ///< into ObjDocument::material_names; below 0: none
  int32_t object = -1;     ///< into object_names; below 0: none
  int32_t smoothing = -1;  ///< a group's number, 0 for none; below 0: the file has not said
};

struct ObjDocument {
  std::string file;                     ///< stands in errors
  std::vector<float> positions;         ///< x, y, z each
  std::vector<float> colors;            ///< R, G, B, A each, for every position, or empty where no vertex has a colour
  std::vector<float> uvs, normals;      ///< u, v and x, y, z each
  std::vector<Corner> corners;          ///< of all polygons
  std::vector<uint32_t> polygon_ends;   ///< into `corners`
  std::vector<uint32_t> polygon_lines;  ///< of the file
  std::vector<Run> runs;                ///< ascending; the first begins with polygon 0
  std::vector<std::string> material_names, object_names;
  struct Library {
    std::string name;
    uint32_t line;
  };
  std::vector<Library> libraries;                 ///< mtllib, each name once
  uint64_t points = 0, lines = 0, free_form = 0;  ///< statements that draw what is no polygon

  size_t position_count() const { return positions.size() / 3; }
  size_t polygon_count() const { return polygon_ends.size(); }
};

}  // namespace trueshade::obj
