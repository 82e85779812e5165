// make_terrain FOLDER PATCHES QUADS: a terrain as scene.json and PATCHES x PATCHES binary PLY files of 2 QUADS x QUADS
// triangles, none of which is drawn twice.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace {

double height(double x, double z) {
  return 0.3 * std::sin(1.3 * x) * std::cos(1.7 * z) + 0.02 * std::sin(31 * x + 3 * z) * std::sin(37 * z) +
         0.002 * std::sin(301 * x) * std::sin(313 * z);
}

/// x, y, z and the normal.
std::array<float, 6> vertex(double x, double z) {
  constexpr double kStep = 1e-4;
  const double dx = (height(x + kStep, z) - height(x - kStep, z)) / (2 * kStep),
               dz = (height(x, z + kStep) - height(x, z - kStep)) / (2 * kStep), l = std::sqrt(dx * dx + dz * dz + 1);
  return {float(x), float(height(x, z)), float(z), float(-dx / l), float(1 / l), float(-dz / l)};
}

std::string header(size_t vertices, size_t triangles) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) + '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) text += std::string("property float ") + name + '\n';
  return text + "element face " + std::to_string(triangles) + "\nproperty list uchar uint vertex_indices\nend_header\n";
}

void append(std::vector<char>& file, const void* values, size_t bytes) {
  const auto* const from = static_cast<const char*>(values);
  file.insert(file.end(), from, from + bytes);
}

bool write_file(const std::string& path, const void* bytes, size_t size) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return false;
  const bool whole = std::fwrite(bytes, 1, size, file) == size;
  return std::fclose(file) == 0 && whole;
}

std::vector<char> patch(int px, int pz, uint32_t quads) {
  const uint32_t side = quads + 1;
  const std::string text = header(size_t(side) * side, 2 * size_t(quads) * quads);
  std::vector<char> file(text.begin(), text.end());
  for (uint32_t j = 0; j < side; ++j)
    for (uint32_t i = 0; i < side; ++i) {
      const std::array<float, 6> v = vertex(px + double(i) / quads, pz + double(j) / quads);
      append(file, v.data(), sizeof v);
    }
  for (uint32_t j = 0; j < quads; ++j)
    for (uint32_t i = 0; i < quads; ++i) {
      const uint32_t p = j * side + i, r = p + side;
      for (const std::array<uint32_t, 3>& corners : {std::array{p, r, p + 1}, std::array{p + 1, r, r + 1}}) {
        file.push_back(3);
        append(file, corners.data(), sizeof corners);
      }
    }
  return file;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const std::string folder = std::string(arguments[1]) + '/';
  const int patches = std::stoi(arguments[2]), quads = std::stoi(arguments[3]);
  std::string objects;
  for (int pz = 0; pz < patches; ++pz)
    for (int px = 0; px < patches; ++px) {
      const std::string name = "patch" + std::to_string(pz) + '_' + std::to_string(px) + ".ply";
      const std::vector<char> file = patch(px, pz, uint32_t(quads));
      if (!write_file(folder + name, file.data(), file.size())) return 1;
      objects +=
          (objects.empty() ? "" : ",\n") + std::string(R"({"geometry": ")") + name + R"(", "color": [0.6, 0.5, 0.4]})";
    }
  char camera[256];
  const double n = patches;
  std::snprintf(camera, sizeof camera, R"({"eye": [%g, %g, %g], "target": [%g, 0, %g]})", -0.1 * n, 0.6 * n, -0.1 * n,
                0.5 * n, 0.5 * n);
  const std::string scene =
      std::string(R"({"version": 1, "camera": )") + camera +
      R"(, "lights": [{"type": "directional", "direction": [0.4, -0.8, 0.3], "color": [1, 1, 1]}], "objects": [)" +
      objects + "]}\n";
  return write_file(folder + "scene.json", scene.data(), scene.size()) ? 0 : 1;
}
