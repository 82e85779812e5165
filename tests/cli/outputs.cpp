// What the command writes, read back by OpenImageIO and hashed from what was read.
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/sha256.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

/// Output of a run that must succeed, and say nothing else but which files it wrote.
std::string quiet_output_of(const std::vector<std::string>& arguments, const std::string& folder = ".") {
  const Outcome outcome = run_command(arguments, folder);
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  for (size_t at = 0; at < outcome.err.size(); at = outcome.err.find('\n', at) + 1)
    CHECK(outcome.err.substr(at).starts_with("wrote "));
  return outcome.out;
}

TEST_CASE("the hash printed is that of the PNG's pixels, and is in its metadata") {
  const ScratchFolder folder;
  const std::string line =
      quiet_output_of({"render", "builtin:cornell", "--size", "61x47", "-o", "x.png", "--hash"}, folder.path(""));
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto file = OIIO::ImageInput::open(folder.path("x.png"), &config);
  REQUIRE(file);
  std::vector<uint8_t> codes(61 * 47 * 4);
  REQUIRE(file->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, codes.data()));
  Sha256 hash;
  hash.update(codes.data(), codes.size());
  const std::string hex = hash.hex();
  CHECK(line == "sha256:" + hex + "  61x47  rgba8\n");
  CHECK(file->spec().get_string_attribute("trueshade:imageHash") == "sha256:" + hex);
  CHECK(file->spec().get_string_attribute("trueshade:scene") == "builtin:cornell");
  CHECK(file->spec().get_string_attribute("trueshade:pipeline").find("\"width\":61") != std::string::npos);
  const std::string about = quiet_output_of({"info", "x.png"}, folder.path(""));
  CHECK(about.find("61x47") != std::string::npos);
  CHECK(about.find(hex) != std::string::npos);
}

TEST_CASE("A pipe that waits for a reader is refused, files behind links are replaced, and nothing else is") {
  const ScratchFolder folder;
  const std::string pipe = folder.path("pipe.png"), file = folder.path("file.png"), link = folder.path("link.png");
  const std::vector<std::string> render{"render", "builtin:cornell", "--size", "8x8", "-o"};
  const auto draw = [&](const std::string& path) {
    std::vector<std::string> arguments = render;
    arguments.push_back(path);
    return arguments;
  };
  quiet_output_of(draw(file));
  const std::string picture = contents(file);

  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  check_refused(run_command(draw(pipe)), 5, "opening it waits for a reader");
  CHECK(std::filesystem::is_fifo(pipe));

  for (const char* target : {"file.png", "absent.png"}) {  // one that is there, one that is not yet
    std::filesystem::create_symlink(target, link);
    quiet_output_of(draw(link));
    CHECK(std::filesystem::is_symlink(link));
    CHECK(contents(folder.path(target)) == picture);
    std::filesystem::remove(link);
  }
  std::filesystem::create_symlink("link.png", link);  // to itself
  check_refused(run_command(draw(link)), 5, "link");
  std::filesystem::create_directory(folder.path("folder.png"));
  check_refused(run_command(draw(folder.path("folder.png"))), 5, "folder");
}

TEST_CASE("A file that is replaced keeps its permissions, and a new one has the user's") {
  const ScratchFolder folder;
  const auto mode = [&](const char* name) { return std::filesystem::status(folder.path(name)).permissions(); };
  const auto draw = [&](const std::string& setup) {
    REQUIRE(
        run_command({"render", "builtin:cornell", "--size", "8x8", "-o", "x.png"}, folder.path(""), setup).exit_code ==
        0);
  };
  draw("umask 027");
  CHECK(mode("x.png") == std::filesystem::perms(0640));
  std::filesystem::permissions(folder.path("x.png"), std::filesystem::perms(0600));
  draw("umask 022");
  CHECK(mode("x.png") == std::filesystem::perms(0600));
}

TEST_CASE("Temporaries of processes that are gone are removed, those of others and other files stay") {
  const ScratchFolder folder;
  const pid_t gone = fork();
  if (gone == 0) _exit(0);
  REQUIRE(waitpid(gone, nullptr, 0) == gone);
  const std::string abandoned = ".trueshade-" + std::to_string(gone) + "-0.tmp",
                    held = ".trueshade-" + std::to_string(gone) + "-1.tmp",
                    owned = ".trueshade-" + std::to_string(getpid()) + "-0.tmp";
  for (const std::string& name : {abandoned, held, owned, std::string(".trueshade-x.tmp"), abandoned + "x"})
    folder.write(name, "half a picture");
  const int lock = open(folder.path(held).c_str(), O_RDONLY);  // as a process that this one's numbers do not reach
  REQUIRE(flock(lock, LOCK_EX | LOCK_NB) == 0);
  quiet_output_of({"render", "builtin:cornell", "--size", "8x8", "-o", folder.path("x.png")});
  close(lock);
  std::vector<std::string> expected = {held, owned, ".trueshade-x.tmp", abandoned + "x", "x.png"};
  std::sort(expected.begin(), expected.end());
  CHECK(folder.entries() == expected);
}

TEST_CASE("A device gets the bytes and stays a device") {
  const ScratchFolder folder;
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  REQUIRE(terminal >= 0);
  REQUIRE(grantpt(terminal) == 0);
  REQUIRE(unlockpt(terminal) == 0);
  const std::string device = ptsname(terminal), link = folder.path("device.png");
  std::filesystem::create_symlink(device, link);
  const int other_end = open(device.c_str(), O_RDWR | O_NOCTTY);  // keeps what was written until it is read
  REQUIRE(other_end >= 0);
  quiet_output_of({"render", "builtin:cornell", "--size", "8x8", "-o", link});
  char first[4] = {};
  CHECK(read(terminal, first, 4) == 4);
  CHECK(std::string(first + 1, 3) == "PNG");
  CHECK(std::filesystem::is_character_file(device));
  CHECK(std::filesystem::is_symlink(link));
  close(other_end);
  close(terminal);
}

TEST_CASE("an EXR has the planes asked for under their channel names") {
  const ScratchFolder folder;
  quiet_output_of(
      {"render", "builtin:cornell", "--size", "33x21", "--target", "rgba16f", "-o", "x.exr", "--aov",
       "light.count,depth,position,normal,albedo,uv,id.object,id.material,specular,emission,light.1,light.tile,"
       "light.intensity,overdraw,light.boxes"},
      folder.path(""));
  const auto file = OIIO::ImageInput::open(folder.path("x.exr"));
  REQUIRE(file);
  std::vector<std::string> names = file->spec().channelnames;
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"A",
                                          "B",
                                          "G",
                                          "N.X",
                                          "N.Y",
                                          "N.Z",
                                          "P.X",
                                          "P.Y",
                                          "P.Z",
                                          "R",
                                          "Z",
                                          "albedo.A",
                                          "albedo.B",
                                          "albedo.G",
                                          "albedo.R",
                                          "depth.Z",
                                          "emission.A",
                                          "emission.B",
                                          "emission.G",
                                          "emission.R",
                                          "id.material",
                                          "id.object",
                                          "light.0001.B",
                                          "light.0001.G",
                                          "light.0001.R",
                                          "light.boxes.A",
                                          "light.boxes.B",
                                          "light.boxes.G",
                                          "light.boxes.R",
                                          "light.count",
                                          "light.intensity",
                                          "light.tile",
                                          "overdraw",
                                          "specular.A",
                                          "specular.B",
                                          "specular.G",
                                          "specular.R",
                                          "uv.X",
                                          "uv.Y"});
  CHECK(file->spec().channelformat(file->spec().channelindex("R")) == OIIO::TypeDesc::HALF);
  CHECK(file->spec().channelformat(file->spec().channelindex("id.object")) == OIIO::TypeDesc::UINT32);
}

TEST_CASE("a view is the image: hashed, named in the metadata, a heat map with its scale") {
  const ScratchFolder folder;
  const std::string line = quiet_output_of({"render", "builtin:cornell", "--size", "31x23", "--target", "rgba32f",
                                            "--view", "light-count", "-o", "x.png", "--hash"},
                                           folder.path(""));
  CHECK(line.ends_with("  31x23  rgba8\n"));
  const auto file = OIIO::ImageInput::open(folder.path("x.png"));
  REQUIRE(file);
  CHECK("sha256:" + line.substr(7, 64) == std::string(file->spec().get_string_attribute("trueshade:imageHash")));
  CHECK(file->spec().get_string_attribute("trueshade:pipeline").find("\"view\":\"light-count\"") != std::string::npos);
  const int scale = std::stoi(std::string(file->spec().get_string_attribute("trueshade:viewScale")));
  CHECK(scale >= 1);
  CHECK((scale & (scale - 1)) == 0);
}

TEST_CASE("equal images are equal files, however they were computed") {
  const ScratchFolder folder;
  std::vector<std::string> exr, png, hashes;
  const std::vector<std::vector<std::string>> ways = {{},
                                                      {"--threads", "1"},
                                                      {"--threads", "7", "--tile", "8"},
                                                      {"--simd", "scalar", "--tile", "48"},
                                                      {"--simd", "scalar", "--no-light-culling"}};
  for (const std::vector<std::string>& way : ways) {
    std::vector<std::string> arguments = {
        "render", "builtin:cornell",          "--size", "100x75", "-o", "x.exr", "-o", "x.png",
        "--aov",  "depth,normal,light.count", "--hash"};
    arguments.insert(arguments.end(), way.begin(), way.end());
    hashes.push_back(quiet_output_of(arguments, folder.path("")));
    exr.push_back(contents(folder.path("x.exr")));
    png.push_back(contents(folder.path("x.png")));
  }
  for (size_t i = 1; i < ways.size(); ++i) {
    INFO("way " << i);
    CHECK(hashes[i] == hashes[0]);
    CHECK((exr[i] == exr[0] && png[i] == png[0]));
  }
  CHECK(folder.entries() == std::vector<std::string>{"x.exr", "x.png"});
}

TEST_CASE("the answer in JSON is one document with all there is to know") {
  const std::string json = quiet_output_of(
      {"render", "builtin:cornell", "--size", "40x30", "--json", "--hash", "--stats", "--aov", "depth"});
  CHECK(json.find('\n') == json.size() - 1);
  for (const char* key : {"\"scene\": {", "\"pipeline\": {", "\"execution\": {", "\"stats\": {", "\"hash\": \"sha256:",
                          "\"files\": []", "\"covered_pixels\": ", "\"threads\": ", "\"name\": \"depth\""})
    CHECK(json.find(key) != std::string::npos);
}

TEST_CASE("pipelines are layered: preset, then the pipeline file, then options") {
  const ScratchFolder folder;
  std::ofstream(folder.path("p.json")) << R"({"version": 1, "width": 20, "height": 10, "target": "rgba32f"})";
  const auto line = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", "builtin:cornell", "--pipeline", "p.json", "--hash"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const std::string text = quiet_output_of(arguments, folder.path(""));
    return text.substr(text.find("  "));
  };
  CHECK(line({}) == "  20x10  rgba32f\n");
  CHECK(line({"--size", "5x6"}) == "  5x6  rgba32f\n");
  CHECK(line({"--size", "5x6", "--target", "rgba8"}) == "  5x6  rgba8\n");
}

TEST_CASE("a report is one page that needs no other file") {
  const ScratchFolder folder;
  quiet_output_of({"render", "builtin:cornell", "--size", "50x40", "-o", "report.html"}, folder.path(""));
  const std::string page = contents(folder.path("report.html"));
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(page.ends_with("</html>\n"));
  size_t pictures = 0;
  for (size_t at = 0; (at = page.find("data:image/png;base64,", at)) != std::string::npos; ++at) ++pictures;
  CHECK(pictures == 6);
  for (const char* outside : {"http:", "https:", "<script src", "<link", "@import", "url("})
    CHECK(page.find(outside) == std::string::npos);
  CHECK(page.find("default-src 'none'") != std::string::npos);
  CHECK(page.find("<code>trueshade render builtin:cornell --size 50x40 -o report.html</code>") != std::string::npos);
}

TEST_CASE("help, version and lists go to standard output") {
  CHECK(quiet_output_of({"--help"}).find("render") != std::string::npos);
  CHECK(quiet_output_of({"render", "--help"}).find("--no-light-culling") != std::string::npos);
  CHECK(quiet_output_of({"--version"}).starts_with("trueshade "));
  CHECK(quiet_output_of({"list"}).find("city") != std::string::npos);
  const std::string json = quiet_output_of({"list", "--json"});
  for (const char* key :
       {"scenes", "presets", "strategies", "profiles", "driver_profiles", "formats", "simd", "schemas"})
    CHECK(json.find('"' + std::string(key) + "\": [") != std::string::npos);
  for (const std::string& text : {quiet_output_of({"list"}), json})
    for (const char* name : {"ideal", "mesa-llvmpipe-22.3", "d3d-class"}) {
      INFO(name);
      CHECK(text.find(name) != std::string::npos);
    }
}

TEST_CASE("info on a scene says what is in it") {
  const std::string text = quiet_output_of({"info", "builtin:cornell"});
  for (const char* word : {"triangles drawn", "lights", "instances", "sha256:"})
    CHECK(text.find(word) != std::string::npos);
}

}  // namespace
}  // namespace trueshade
