#include "tests/judge/drivers.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/catch.hpp"

namespace trueshade::testing {

using oracle::Capture;

namespace {

constexpr const char* kHandOver = "TRUESHADE_TEST_HAND_OVER";  // the file a drawer writes

void write(std::ostream& out, const std::string& text) { out << text.size() << '\n' << text; }

std::string read(std::istream& in) {
  size_t size = 0;
  in >> size;
  in.get();
  std::string text(size, '\0');
  in.read(text.data(), std::streamsize(size));
  return text;
}

void write(std::ostream& out, const Image& image) {
  out << image.width << ' ' << image.height << ' ' << int(image.format) << '\n';
  out.write(reinterpret_cast<const char*>(image.texels.data()), std::streamsize(image.texels.size()));
}

Image read_image(std::istream& in) {
  int width = 0, height = 0, format = 0;
  in >> width >> height >> format;
  in.get();
  Image image(width, height, Format(format));
  in.read(reinterpret_cast<char*>(image.texels.data()), std::streamsize(image.texels.size()));
  return image;
}

}  // namespace

bool is_elsewhere() { return std::getenv(kHandOver) != nullptr; }

void hand_over(const Capture& capture) {
  std::ofstream out(std::getenv(kHandOver), std::ios::binary);
  write(out, capture.driver);
  write(out, capture.color);
  out << capture.planes.size() << '\n';
  for (const NamedImage& plane : capture.planes) {
    write(out, plane.name);
    write(out, plane.image);
  }
}

std::optional<Capture> drawn_elsewhere(const std::string& drawer) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string file =
      (std::filesystem::temp_directory_path() / ("trueshade_" + std::to_string(getpid()) + ".capture")).string();
  const std::string command =
      std::string(kHandOver) + "='" + file + "' '" + self + "' '" + drawer + "' >'" + file + ".log' 2>&1";
  const int status = std::system(command.c_str());
  std::optional<Capture> capture;
  if (std::ifstream in(file, std::ios::binary); in) {
    capture.emplace();
    capture->driver = read(in);
    capture->color = read_image(in);
    size_t planes = 0;
    in >> planes;
    in.get();
    for (size_t i = 0; i < planes && in; ++i) {
      std::string name = read(in);
      capture->planes.push_back({std::move(name), read_image(in)});
    }
    CHECK(in.good());
  }
  std::ifstream log(file + ".log");
  const std::string said{std::istreambuf_iterator<char>(log), {}};
  std::filesystem::remove(file);
  std::filesystem::remove(file + ".log");
  INFO(said);
  CHECK(status == 0);
  if (!capture) {
    const size_t reason = said.find("SKIPPED:");
    REQUIRE(reason != std::string::npos);
    WARN(said.substr(reason, said.find('\n', reason) - reason));
  }
  return capture;
}

}  // namespace trueshade::testing
