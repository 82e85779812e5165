#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/image.h"
#include "tests/scratch_folder.h"

namespace trueshade {

/// Values of a capture as an engine has them: `channels` numbers a pixel, rows from the top.
struct EnginePlane {
  int width = 0, height = 0, channels = 0;
  std::vector<double> values;

  double& at(int x, int y, int c) {
    return values[(size_t(y) * size_t(width) + size_t(x)) * size_t(channels) + size_t(c)];
  }
  double at(int x, int y, int c) const { return const_cast<EnginePlane*>(this)->at(x, y, c); }
};

EnginePlane engine_plane(const Image& image);

/// Another number of channels a pixel, made of those there.
EnginePlane repacked(const EnginePlane& from, int channels,
                     const std::function<void(const double* from, double* to)>& pack);
EnginePlane bottom_up(EnginePlane plane);

// Files as other programs write them. Each value has to be one that the format holds.

/// .npy of an element type such as <f4, >f2, |u1.
void write_npy(const std::string& path, const EnginePlane& plane, const std::string& type, bool fortran_order = false);

/// DDS by its DXGI number; codes of unorm formats are rounded.
void write_dds(const std::string& path, const EnginePlane& plane, int dxgi_format);

/// One part of an EXR, or a TIFF: names of channels, and their type as OpenImageIO calls it.
struct EnginePart {
  std::string name;
  std::vector<std::string> channels;
  std::string type;
  const EnginePlane* plane;
};
void write_exr_parts(const std::string& path, const std::vector<EnginePart>& parts, int tile = 0);
void write_tiff(const std::string& path, const EnginePlane& plane, const std::string& type,
                const std::string& compression, int tile = 0);

}  // namespace trueshade
