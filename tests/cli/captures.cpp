// Captures as engines have them: one scene by each kind of file and each packing is judged the same, wrong maps are
// convicted or refused, and bad files are refused in one line.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "scenes/scene.h"
#include "tests/catch.hpp"
#include "tests/cli/engine_capture.h"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Words = std::vector<std::string>;

// A camera that looks askew, so that no space is another's; a background; edges, round and flat surfaces.
constexpr const char* kScene = "s.json";
constexpr const char* kSceneText = R"({
  "version": 1,
  "camera": {"eye": [3, 2.5, 5], "target": [0.2, 0.5, 0], "fov_deg": 45, "near": 0.1, "far": 50},
  "clear": [0.02, 0.02, 0.03, 1],
  "objects": [
    {"mesh": "sphere", "color": [0.9, 0.7, 0.4], "position": [0, 1, 0], "scale": 1.2},
    {"mesh": "cube", "color": [0.4, 0.6, 0.9], "position": [1.6, 0.6, -1.5], "rotation_deg": [20, 30, 0], "scale": 1.5},
    {"mesh": "plane", "color": [0.5, 0.5, 0.52], "scale": 14}
  ],
  "lights": [
    {"type": "ambient", "color": [0.05, 0.05, 0.07]},
    {"type": "point", "position": [2, 3, 3], "color": [1, 0.9, 0.8], "range": 9},
    {"type": "ring", "count": 8, "center": [0, 0.4, 0], "radius": 1.8, "range": 2.5,
     "colors": [[1, 0.2, 0.1], [0.1, 0.4, 1]], "intensity": 0.6}
  ]
})";

/// A frame of ours as c.exr and its planes as an engine holds them.
struct DrawnCapture {
  ScratchFolder folder;
  EnginePlane color, depth, position, normal, albedo, object;

  DrawnCapture() {
    folder.write(kScene, kSceneText);
    const Outcome drawn = run_command({"render", kScene, "--size", "120x90", "-o", "c.exr", "-o", "c.png", "--aov",
                                       "depth,position,normal,albedo,id.object"},
                                      folder.path(""));
    REQUIRE(drawn.exit_code == 0);
    for (const NamedImage& plane : read_planes(folder.path("c.exr"))) {
      if (plane.name == "color") color = engine_plane(plane.image);
      if (plane.name == "depth") depth = engine_plane(plane.image);
      if (plane.name == "position") position = engine_plane(plane.image);
      if (plane.name == "normal") normal = engine_plane(plane.image);
      if (plane.name == "albedo") albedo = engine_plane(plane.image);
      if (plane.name == "id.object") object = engine_plane(plane.image);
    }
  }

  bool covered(int x, int y) const { return object.at(x, y, 0) != 0; }
  std::string path(const std::string& name) const { return folder.path(name); }

  Outcome judge(Words options) const {
    Words words = {"validate", kScene, "--quick", "--json"};
    words.insert(words.end(), options.begin(), options.end());
    return run_command(words, folder.path(""));
  }

  /// Classes of pixels by stage.
  nlohmann::json counts(const Words& options) const {
    const Outcome outcome = judge(options);
    INFO(outcome.err);
    REQUIRE((outcome.exit_code == 0 || outcome.exit_code == 1));
    const auto document = nlohmann::json::parse(outcome.out);
    nlohmann::json result;
    for (const auto& stage : document["verdict"]["stages"]) result[stage["stage"].get<std::string>()] = stage["counts"];
    return result;
  }
};

uint64_t violations(const nlohmann::json& counts) {
  uint64_t sum = 0;
  for (const auto& stage : counts) sum += stage["VIOLATION"].get<uint64_t>();
  return sum;
}

struct Axes {
  double right[3], up[3], back[3], eye[3];
};

Axes axes_of(const DrawnCapture& c) {
  const Camera camera = load_scene(c.path(kScene)).camera;
  Axes a{};
  double f[3], length = 0, s[3], s_length = 0;
  for (int k = 0; k < 3; ++k) {
    a.eye[k] = double(camera.eye[k]);
    f[k] = double(camera.target[k]) - a.eye[k];
    length += f[k] * f[k];
  }
  for (double& x : f) x /= std::sqrt(length);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    s[k] = f[i] * double(camera.up[j]) - f[j] * double(camera.up[i]);
    s_length += s[k] * s[k];
  }
  for (int k = 0; k < 3; ++k) a.right[k] = s[k] / std::sqrt(s_length), a.back[k] = -f[k];
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    a.up[k] = a.right[i] * f[j] - a.right[j] * f[i];
  }
  return a;
}

double along(const double axis[3], const double* v) { return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]; }

/// Directions in the view's axes, z towards the viewer.
void to_view(const Axes& a, const double* v, double* out) {
  out[0] = along(a.right, v), out[1] = along(a.up, v), out[2] = along(a.back, v);
}

void octahedral(const double* n, double* e) {
  const double sum = std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]);
  if (sum == 0) return;
  e[0] = n[0] / sum, e[1] = n[1] / sum;
  if (n[2] >= 0) return;
  const double x = e[0];
  e[0] = (1 - std::fabs(e[1])) * (x >= 0 ? 1 : -1);
  e[1] = (1 - std::fabs(x)) * (e[1] >= 0 ? 1 : -1);
}

void spheremap(const double* n, double* e) {
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (length == 0) return;
  const double f = std::sqrt(8 * n[2] / length + 8);
  e[0] = n[0] / length / f + 0.5, e[1] = n[1] / length / f + 0.5;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

}  // namespace

TEST_CASE("One scene captured in each kind of file is judged the same") {
  const DrawnCapture c;
  const nlohmann::json expected = c.counts({"--gbuffer", "c.exr"});
  CHECK(violations(expected) == 0);
  const auto check = [&](const char* route, const Words& options) {
    INFO(route);
    CHECK(c.counts(options) == expected);
  };
  const Words xyz = {"P.X", "P.Y", "P.Z"}, nxyz = {"N.X", "N.Y", "N.Z"}, rgba = {"R", "G", "B", "A"},
              albedo = {"albedo.R", "albedo.G", "albedo.B", "albedo.A"};

  const std::vector<EnginePart> parts = {
      {"geometry", xyz, "float", &c.position},   {"normals", nxyz, "float", &c.normal},
      {"materials", albedo, "float", &c.albedo}, {"z", {"depth.Z"}, "float", &c.depth},
      {"ids", {"id.object"}, "uint", &c.object}, {"lit", rgba, "float", &c.color}};
  write_exr_parts(c.path("parts.exr"), parts);
  check("parts of an EXR", {"--gbuffer", "parts.exr"});
  write_exr_parts(c.path("tiles.exr"), parts, 32);
  check("parts of an EXR in tiles", {"--gbuffer", "tiles.exr"});
  Words files;
  for (const EnginePart& part : parts) {
    write_exr_parts(c.path(part.name + ".exr"), {{"", part.channels, part.type, part.plane}},
                    part.name == "z" ? 16 : 0);
    files.insert(files.end(), {"--gbuffer", part.name + ".exr"});
  }
  check("an EXR a plane, by usual channels", files);

  const EnginePlane position4 = repacked(c.position, 4, [](const double* from, double* to) {
    std::copy(from, from + 3, to);
    to[3] = 1;
  });
  const EnginePlane normal4 =
      repacked(c.normal, 4, [](const double* from, double* to) { std::copy(from, from + 3, to); });
  for (const auto& [name, plane] : {std::pair{"t0", &position4}, {"t1", &normal4}, {"t2", &c.albedo}, {"t3", &c.color}})
    write_exr_parts(c.path(std::string(name) + ".exr"), {{"", rgba, "float", plane}});
  write_exr_parts(c.path("t4.exr"), {{"", {"R"}, "float", &c.depth}});
  write_exr_parts(c.path("t5.exr"), {{"", {"R"}, "uint", &c.object}});
  check("an EXR a texture, as RenderDoc saves them",
        {"--gbuffer", "t0.exr", "--gbuffer", "t1.exr", "--gbuffer", "t2.exr", "--map",
         "position=t0.RGB,normal=t1.XYZ,albedo=t2.RGBA,depth=t4.exr.R,id.object=t5.exr,color=t3.exr.RGBA"});

  write_dds(c.path("p.dds"), position4, 2);
  write_dds(c.path("n.dds"), normal4, 2);
  write_dds(c.path("a.dds"), c.albedo, 28);
  write_dds(c.path("d.dds"), c.depth, 40);
  write_dds(c.path("i.dds"), c.object, 42);
  write_dds(c.path("lit.dds"), c.color, 87);
  check("DDS of RGBA32F, RGBA8, D32, R32UI and BGRA8",
        {"--map", "position=p.dds.RGB,normal=n.dds.RGB,albedo=a.dds,depth=d.dds,id.object=i.dds,color=lit.dds"});

  const std::string npy_map = "position=p.npy,normal=n.npy,albedo=a.npy,depth=d.npy,id.object=i.npy,color=lit.npy";
  for (const bool fortran : {false, true})
    for (const char* type : {"<f4", ">f4", "<f8"}) {
      INFO(type << (fortran ? ", Fortran order" : ""));
      write_npy(c.path("p.npy"), c.position, type, fortran);
      write_npy(c.path("n.npy"), c.normal, type, fortran);
      write_npy(c.path("d.npy"), c.depth, type, fortran);
      write_npy(c.path("i.npy"), c.object, fortran ? ">i8" : "|u1", fortran);
      const auto codes = [](const double* from, double* to) {
        for (int k = 0; k < 4; ++k) to[k] = std::round(255 * from[k]);
      };
      write_npy(c.path("a.npy"), repacked(c.albedo, 4, codes), "|u1", fortran);
      write_npy(c.path("lit.npy"), repacked(c.color, 4, codes), "|u1", fortran);
      check(".npy", {"--map", npy_map});
    }
  write_bytes(c.path("map.txt"),
              "# the engine's targets\nposition = p.npy\nnormal=n.npy  # world space\n"
              "albedo=a.npy\ndepth=d.npy, id.object=i.npy\ncolor=lit.npy\n");
  check("a map in a file", {"--map", "@map.txt"});
  std::filesystem::create_directory(c.path("sub"));
  for (const char* name : {"p.npy", "n.npy", "a.npy", "d.npy", "i.npy", "lit.npy", "map.txt"})
    std::filesystem::copy(c.path(name), c.path(std::string("sub/") + name));
  check("a map in a folder of its own", {"--map", "@sub/map.txt"});

  EnginePlane all{c.position.width, c.position.height, 12, {}};
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (const EnginePlane* p : {&c.position, &c.normal, &c.albedo, &c.depth, &c.object})
        for (int k = 0; k < p->channels; ++k) all.values.push_back(p->at(x, y, k));
  write_npy(c.path("all.npy"), all, "<f4");
  check("all planes in one array, by numbers, identifiers as floats",
        {"--gbuffer", "all.npy", "--map", "position=0-2,normal=3-5,albedo=all.6-9,depth=10,id.object=all.npy.11",
         "--image", "c.png"});

  for (const auto& [compression, tile] : {std::pair{"none", 0}, {"zip", 0}, {"zip", 32}}) {
    INFO(compression << ' ' << tile);
    write_tiff(c.path("p.tif"), c.position, "float", compression, tile);
    write_tiff(c.path("n.tif"), c.normal, "float", compression, tile);
    write_tiff(c.path("a.tif"), c.albedo, "uint8", compression, tile);
    write_tiff(c.path("d.tif"), c.depth, "float", compression, tile);
    write_tiff(c.path("i.tif"), c.object, "float", compression, tile);
    write_tiff(c.path("lit.tif"), c.color, "uint8", compression, tile);
    check("TIFF", {"--map", "position=p.tif,normal=n.tif,albedo=a.tif,depth=d.tif,id.object=i.tif,color=lit.tif"});
  }

  write_npy(c.path("p.npy"), bottom_up(c.position), "<f4");
  write_npy(c.path("n.npy"), bottom_up(c.normal), "<f4");
  check(
      "rows from the bottom, of two planes",
      {"--gbuffer", "c.exr", "--map", "position=p.npy:bottom_up,normal=n.npy:bottom_up,albedo,depth,id.object,color"});
  for (const auto& [name, plane] : {std::pair{"a", &c.albedo}, {"lit", &c.color}, {"d", &c.depth}, {"i", &c.object}})
    write_npy(c.path(std::string(name) + ".npy"), bottom_up(*plane), "<f4");
  check("rows from the bottom, of all", {"--map", npy_map + ",rows=bottom_up"});
}

TEST_CASE("A capture whose values are packed is judged by what its codes say, and no pixel is convicted", "[slow]") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  const uint64_t pixels = uint64_t(c.normal.width) * uint64_t(c.normal.height);
  const nlohmann::json expected = c.counts({"--gbuffer", "c.exr"});
  const std::string rest = "position,albedo,depth,id.object";

  // The picture of packed planes is lit from what the codes say; it is made by our light pass, judged by the judge.
  const auto check = [&](const std::string& map, bool lights_again, uint64_t least_exact) {
    INFO(map);
    Words options = {"--gbuffer", "c.exr", "--map", map, "--image", "c.exr"};
    if (lights_again) {
      const Outcome lit =
          run_command({"shade", "c.exr", "--map", map, "--lights", kScene, "-o", "lit.png", "-q"}, c.path(""));
      INFO(lit.err);
      REQUIRE(lit.exit_code == 0);
      options.back() = "lit.png";
    }
    const nlohmann::json counts = c.counts(options);
    INFO(counts.dump());
    CHECK(violations(counts) == 0);
    for (const auto& stage : counts)
      CHECK(stage["EXACT"].get<uint64_t>() + stage["STORE-2"].get<uint64_t>() >= least_exact);
    return counts;
  };
  const uint64_t most = pixels - pixels / 50;

  const auto half_of = [](const double* n, double* e) {
    for (int k = 0; k < 3; ++k) e[k] = double(float(n[k] * 0.5 + 0.5));
  };
  write_npy(c.path("n01.npy"), repacked(c.normal, 3, half_of), "<f4");
  check(rest + ",normal=n01.npy:unorm", true, most);
  const EnginePlane half4 = repacked(c.normal, 4, half_of);
  write_dds(c.path("n8.dds"), half4, 28);
  check(rest + ",normal=n8.dds.RGB:unorm", true, most);
  write_dds(c.path("n16.dds"), half4, 11);
  check(rest + ",normal=n16.dds.RGB:unorm", true, most);
  const auto rounded = [](const double* n, double* e) {
    for (int k = 0; k < 3; ++k) e[k] = std::round(255 * n[k]) / 255;
  };
  const EnginePlane codes8 = repacked(half4, 3, rounded);
  write_exr_parts(c.path("n8.exr"), {{"", {"R", "G", "B"}, "half", &codes8}});
  check(rest + ",normal=n8.exr.RGB:unorm8", true, most);

  const EnginePlane signed_codes = repacked(c.normal, 2, octahedral);
  const EnginePlane unsigned_codes =
      repacked(signed_codes, 2, [](const double* n, double* e) { e[0] = n[0] * 0.5 + 0.5, e[1] = n[1] * 0.5 + 0.5; });
  write_npy(c.path("oct.npy"), signed_codes, "<f4");
  check(rest + ",normal=oct.npy:octahedral", true, most);
  write_npy(c.path("oct2.npy"), signed_codes, "<f2");
  check(rest + ",normal=oct2.npy:octahedral", true, most);
  write_dds(c.path("oct8.dds"), unsigned_codes, 49);
  check(rest + ",normal=oct8.dds:octahedral:unorm", true, most);
  write_dds(c.path("oct16.dds"), unsigned_codes, 35);
  check(rest + ",normal=oct16.dds:octahedral:unorm", true, most);
  write_dds(c.path("octs.dds"), signed_codes, 51);
  check(rest + ",normal=octs.dds:octahedral", true, most);

  const EnginePlane view_normal = repacked(c.normal, 3, [&](const double* n, double* e) { to_view(axes, n, e); });
  const EnginePlane view_position = repacked(c.position, 3, [&](const double* p, double* e) {
    const double from_eye[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
    to_view(axes, from_eye, e);
  });
  write_npy(c.path("vn.npy"), view_normal, "<f4");
  write_npy(c.path("vp.npy"), view_position, "<f4");
  check("normal=vn.npy:view,position=vp.npy:view,albedo,depth,id.object", false, most);
  const auto away = [](const double* v, double* e) { e[0] = v[0], e[1] = v[1], e[2] = -v[2]; };
  const auto down = [](const double* v, double* e) { e[0] = v[0], e[1] = -v[1], e[2] = -v[2]; };
  write_npy(c.path("vn.npy"), repacked(view_normal, 3, away), "<f4");
  write_npy(c.path("vp.npy"), repacked(view_position, 3, down), "<f4");
  check("normal=vn.npy:view_z_away,position=vp.npy:view_y_down_z_away,albedo,depth,id.object", false, most);

  const EnginePlane sphere = repacked(view_normal, 2, spheremap);
  write_npy(c.path("sphere.npy"), sphere, "<f4");
  check(rest + ",normal=sphere.npy:spheremap:view", true, most);
  write_dds(c.path("sphere.dds"), sphere, 49);
  check(rest + ",normal=sphere.dds:spheremap:view", true, most);

  EnginePlane reversed = c.depth, linear = c.depth, distance = c.depth;
  for (int y = 0; y < c.depth.height; ++y)
    for (int x = 0; x < c.depth.width; ++x) {
      reversed.at(x, y, 0) = double(float(1 - c.depth.at(x, y, 0)));
      double v[3], length = 0;
      for (int k = 0; k < 3; ++k) {
        v[k] = c.position.at(x, y, k) - axes.eye[k];
        length += v[k] * v[k];
      }
      linear.at(x, y, 0) = c.covered(x, y) ? double(float(-along(axes.back, v))) : 1e9;
      distance.at(x, y, 0) = c.covered(x, y) ? double(float(std::sqrt(length))) : 0;
    }
  write_npy(c.path("reversed.npy"), reversed, "<f4");
  write_npy(c.path("linear.npy"), linear, "<f4");
  write_npy(c.path("distance.npy"), distance, "<f4");
  const std::string but_depth = "position,normal,albedo,id.object,";
  const nlohmann::json by_reversed = check(but_depth + "depth=reversed.npy:reversed", false, most);
  CHECK(by_reversed["lighting"] == expected["lighting"]);
  check(but_depth + "depth=linear.npy:linear", false, most);
  check(but_depth + "depth=distance.npy:distance", false, most);
  const std::string but_position = "depth,normal,albedo,id.object,";
  check(but_position + "position=linear.npy:linear", false, most);
  check(but_position + "position=distance.npy:distance", false, most);
  check(but_position + "position=c.depth.Z:window", true, most);
  check(but_position + "position=reversed.npy:reversed", true, most);
  check("position,normal,albedo=c.albedo.RGB,depth,color=c.png.RGB", false, most);
}

TEST_CASE(
    "Faults in a packed capture are convicted: normals a few codes off, and a picture that is not what they say") {
  const DrawnCapture c;
  const std::string map = "position,albedo,depth,id.object,normal=oct.dds:octahedral:unorm";
  EnginePlane codes = repacked(c.normal, 2, octahedral);
  for (double& e : codes.values) e = std::round(255 * (e * 0.5 + 0.5)) / 255;
  const auto counts = [&](const Words& picture) {
    write_dds(c.path("oct.dds"), codes, 49);
    Words options = {"--gbuffer", "c.exr", "--map", map};
    options.insert(options.end(), picture.begin(), picture.end());
    return c.counts(options);
  };
  // The picture was lit from the normals before they were packed: codes of 8 bits say another one.
  const nlohmann::json unpacked = counts({"--image", "c.exr"});
  CHECK(unpacked["gbuffer"]["VIOLATION"] == 0);
  CHECK(unpacked["lighting"]["VIOLATION"].get<int>() > 100);
  const auto light = [&] {
    write_dds(c.path("oct.dds"), codes, 49);
    const Outcome lit =
        run_command({"shade", "c.exr", "--lights", kScene, "--map", map, "-o", "lit.png", "-q"}, c.path(""));
    INFO(lit.err);
    REQUIRE(lit.exit_code == 0);
  };
  light();
  Image picture = read_planes(c.path("lit.png")).front().image;
  picture.texel(60, 70)[1] = uint8_t(picture.texel(60, 70)[1] + 2);
  write_image(c.path("off.png"), picture, {}, {});
  const nlohmann::json off = counts({"--image", "off.png"});
  CHECK(off["gbuffer"]["VIOLATION"] == 0);
  CHECK(off["lighting"]["VIOLATION"] == 1);
  codes.at(60, 60, 0) += 8.0 / 255;
  light();
  const nlohmann::json bent = counts({"--image", "lit.png"});
  CHECK(bent["gbuffer"]["VIOLATION"] == 1);
  CHECK(bent["lighting"]["VIOLATION"] == 0);
}

TEST_CASE("View space and distances are told from an engine's matrix too, Vulkan's and Direct3D's among them") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  struct Convention {
    const char *pipeline, *word;
    bool z_away, y_down, zero_to_one, upper_left;
  };
  constexpr Convention kConventions[] = {
      {R"({"geometry": {}})", "view", false, false, false, false},
      {R"({"geometry": {"clip_depth": "zero_to_one"}})", "view_z_away", true, false, true, false},
      {R"({"geometry": {"clip_depth": "zero_to_one", "clip_origin": "upper_left"}})", "view_y_down_z_away", true, true,
       true, true}};
  for (const Convention& convention : kConventions) {
    INFO(convention.pipeline);
    // Rows of the matrix: projection times view, z from 0.1 to 50.
    const double g = 1 / std::tan(0.5 * 45 * 3.14159265358979323846 / 180), near = 0.1, far = 50;
    const double x_scale = g * 90 / 120, y_scale = convention.upper_left ? -g : g;
    const double z_scale = convention.zero_to_one ? -far / (far - near) : -(far + near) / (far - near);
    const double z_offset = (convention.zero_to_one ? -1 : -2) * far * near / (far - near);
    double rows[4][4] = {};
    for (int k = 0; k < 3; ++k) {
      rows[0][k] = x_scale * axes.right[k], rows[1][k] = y_scale * axes.up[k];
      rows[2][k] = z_scale * axes.back[k], rows[3][k] = -axes.back[k];
    }
    rows[0][3] = -x_scale * along(axes.right, axes.eye), rows[1][3] = -y_scale * along(axes.up, axes.eye);
    rows[2][3] = -z_scale * along(axes.back, axes.eye) + z_offset, rows[3][3] = along(axes.back, axes.eye);
    auto scene = nlohmann::json::parse(kSceneText);
    nlohmann::json matrix = nlohmann::json::array();
    for (int column = 0; column < 4; ++column)
      for (const auto& row : rows) matrix.push_back(double(float(row[column])));
    scene["camera"] = {{"eye", {3, 2.5, 5}}, {"clip_from_world", matrix}};
    write_bytes(c.path("m.json"), scene.dump());
    write_bytes(c.path("p.json"), convention.pipeline);
    const Outcome drawn = run_command({"render", "m.json", "--pipeline", "p.json", "--size", "120x90", "-o", "m.exr",
                                       "-q", "--aov", "depth,position,normal,albedo,id.object"},
                                      c.path(""));
    INFO(drawn.err);
    REQUIRE(drawn.exit_code == 0);
    EnginePlane position, normal;
    for (const NamedImage& plane : read_planes(c.path("m.exr"))) {
      if (plane.name == "position") position = engine_plane(plane.image);
      if (plane.name == "normal") normal = engine_plane(plane.image);
    }
    const double y = convention.y_down ? -1 : 1, z = convention.z_away ? -1 : 1;
    write_npy(c.path("n.npy"),
              repacked(normal, 3,
                       [&](const double* n, double* e) {
                         to_view(axes, n, e);
                         e[1] *= y, e[2] *= z;
                       }),
              "<f4");
    write_npy(c.path("p.npy"),
              repacked(position, 3,
                       [&](const double* p, double* e) {
                         const double from_eye[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
                         to_view(axes, from_eye, e);
                         e[1] *= y, e[2] *= z;
                       }),
              "<f4");
    write_npy(c.path("d.npy"),
              repacked(position, 1,
                       [&](const double* p, double* e) {
                         const double from_eye[] = {p[0] - axes.eye[0], p[1] - axes.eye[1], p[2] - axes.eye[2]};
                         e[0] = p[0] == 0 && p[1] == 0 && p[2] == 0 ? 0 : -along(axes.back, from_eye);
                       }),
              "<f4");
    const std::string word = convention.word;
    const Outcome judged =
        run_command({"validate", "m.json", "--pipeline", "p.json", "--quick", "--gbuffer", "m.exr", "--map",
                     "position=p.npy:" + word + ",normal=n.npy:" + word + ",depth=d.npy:linear,albedo,id.object,color"},
                    c.path(""));
    INFO(judged.out << judged.err);
    CHECK(judged.exit_code == 0);
  }
}

TEST_CASE("A wrong map is convicted or refused") {
  const DrawnCapture c;
  const Axes axes = axes_of(c);
  const std::string rest = "albedo,id.object,color";
  const auto check_convicted = [&](const std::string& map) {
    INFO(map);
    const Outcome outcome = c.judge({"--gbuffer", "c.exr", "--map", map});
    INFO(outcome.err);
    CHECK(outcome.exit_code == 1);
  };
  const auto check_map_refused = [&](const std::string& map, int code, const std::string& about) {
    INFO(map);
    check_refused(c.judge({"--gbuffer", "c.exr", "--map", map, "-o", "v.html"}), code, about);
    CHECK_FALSE(std::filesystem::exists(c.path("v.html")));
  };
  write_npy(c.path("n01.npy"),
            repacked(c.normal, 3,
                     [](const double* n, double* e) {
                       for (int k = 0; k < 3; ++k) e[k] = n[k] * 0.5 + 0.5;
                     }),
            "<f4");
  check_convicted(rest + ",depth,position,normal=n01.npy");
  check_map_refused(rest + ",depth,position,normal=c.N.XYZ:unorm", 3, "and unorm numbers are from 0 to 1");
  check_map_refused(rest + ",depth,position,normal=n01.npy:unorm8", 3, "which is no code of 8 bits");
  check_convicted(rest + ",depth,position,normal=c.N.XY:octahedral");
  check_convicted(rest + ",depth,position,normal=c.N.XYZ:view");
  check_convicted(rest + ",depth,normal,position=c.P.XYZ:view");
  check_convicted(rest + ",depth,normal,position=c.P.XYZ:bottom_up");
  check_convicted(rest + ",depth,normal,position=c.P.ZYX");
  check_convicted(rest + ",depth=c.Z,position,normal");
  check_convicted(rest + ",depth=c.depth.Z:reversed,position,normal");
  check_convicted(rest + ",depth=c.depth.Z:linear,position,normal");
  check_convicted(rest + ",depth,normal,position=c.depth.Z:linear");
  EnginePlane view = repacked(c.normal, 3, [&](const double* n, double* e) { to_view(axes, n, e); });
  write_npy(c.path("vn.npy"), view, "<f4");
  check_convicted(rest + ",depth,position,normal=vn.npy");
  check_convicted(rest + ",depth,position,normal=vn.npy:view_z_away");
  check_map_refused("position,nromal=c.N.XYZ", 2, "there is no plane 'nromal' of a capture");
  check_map_refused("position=c.P.XYZ:octahedral", 2, "'octahedral' is not said of plane position");
  check_map_refused("normal=c.N.XY:octahedral:spheremap", 2, "contradict each other");
  check_map_refused("normal=c.N.XYZ:octahedral", 3, "plane normal takes 2 channels, not 3");
  check_map_refused("normal=c.N.XYW", 3, "there are no channels 'N.XYW' for plane normal");
  check_map_refused("normal=none.exr.RGB", 5, "none.exr");
  check_map_refused("normal=c.N.XYZ,normal=c.N.XYZ", 2, "plane normal is named twice");
  check_map_refused("@none.txt", 5, "none.txt");
  write_bytes(c.path("map.txt"), "position\nnormal=c.N.XYZ:wiev\n");
  check_map_refused("@map.txt", 3, "map.txt: line 2: there is no word 'wiev'");
}

TEST_CASE("A bad file of a capture is refused in one line, and no report is left behind") {
  const DrawnCapture c;
  const auto check_bad = [&](const std::string& normal, int code, const std::string& about) {
    INFO(normal);
    const std::string map = "position,albedo,depth,id.object,color,normal=" + normal;
    check_refused(c.judge({"--gbuffer", "c.exr", "--map", map, "-o", "v.html"}), code, about);
    CHECK_FALSE(std::filesystem::exists(c.path("v.html")));
  };
  const Words rgb = {"R", "G", "B"};
  write_exr_parts(c.path("n.exr"), {{"", rgb, "float", &c.normal}});
  write_npy(c.path("n.npy"), c.normal, "<f4");
  write_tiff(c.path("n.tif"), c.normal, "float", "zip");
  write_dds(c.path("n.dds"), c.normal, 2);
  for (const std::string name : {"n.exr", "n.npy", "n.tif", "n.dds"}) {
    const std::string whole = bytes_of(c.path(name));
    for (const double share : {0.0, 0.001, 0.01, 0.5, 0.98}) {
      INFO(name << " cut to " << share);
      write_bytes(c.path("torn" + name), whole.substr(0, size_t(share * double(whole.size()))));
      check_bad("torn" + name + ".RGB", 3, "torn" + name);
    }
  }
  EnginePlane small{60, 90, 3, std::vector<double>(60 * 90 * 3)};
  write_npy(c.path("small.npy"), small, "<f4");
  check_bad("small.npy", 3, "it is 60x90, and the G-buffer 120x90");
  EnginePlane broken = c.normal;
  broken.at(60, 60, 1) = NAN;
  write_npy(c.path("nan.npy"), broken, "<f4");
  check_bad("nan.npy", 3, "normal at 60,60 is not a number");
  check_bad("nan.npy:unit", 3, "normal at 60,60 is ");
  check_bad("c.png.RGB", 3, "normal is stored in codes from 0 to 1, which hold no negative numbers (say unorm)");
  write_exr_parts(c.path("hd.exr"), {{"", {"R"}, "half", &c.depth}});
  check_refused(c.judge({"--gbuffer", "c.exr", "--map", "position,normal,depth=hd.exr.R", "-o", "v.html"}), 3,
                "depth is stored as half, and the pipeline's as d32f");
  write_bytes(c.path("x.npy"), std::string("\x93NUMPY\x01\x00\x10\x00{'descr': '<f4'}", 26));
  check_bad("x.npy", 3, "x.npy");
  write_bytes(c.path("x.jpg"), "\xff\xd8\xff\xe0 and more");
  check_refused(c.judge({"--gbuffer", "x.jpg"}), 3, "it is JPEG, which does not keep a plane's values");
}

TEST_CASE("A fourth channel beside a plane of three is left out where it says nothing, and refused where it does") {
  const DrawnCapture c;
  write_bytes(c.path("p.json"), R"({"gbuffer": {"albedo": {"format": "rgb16f"}}})");
  const Outcome drawn = run_command({"render", kScene, "--size", "120x90", "--pipeline", "p.json", "-o", "h.exr",
                                     "--aov", "depth,position,normal,albedo,id.object"},
                                    c.path(""));
  REQUIRE(drawn.exit_code == 0);
  std::vector<NamedImage> planes = read_planes(c.path("h.exr"));
  EnginePlane albedo;
  for (const NamedImage& plane : planes)
    if (plane.name == "albedo") albedo = engine_plane(plane.image);
  REQUIRE(albedo.channels == 3);
  EnginePlane with_alpha = repacked(albedo, 4, [](const double* from, double* to) {
    std::copy(from, from + 3, to);
    to[3] = from[0] + from[1] + from[2] > 0 ? 1 : 0;
  });
  const auto judged = [&] {
    write_exr_parts(c.path("a.exr"), {{"", {"R", "G", "B", "A"}, "half", &with_alpha}});
    return c.judge(
        {"--pipeline", "p.json", "--gbuffer", "h.exr", "--map", "depth,position,normal,id.object,color,albedo=a.exr"});
  };
  CHECK(judged().exit_code == 0);
  with_alpha.at(60, 80, 3) = 0.5;
  check_refused(judged(), 3, "and rgb16f has no alpha (leave albedo.A out, or name a format with alpha in --pipeline)");
}

TEST_CASE("shade makes of a frame's planes the picture that render made", "[slow]") {
  const ScratchFolder folder;
  for (const std::string scene : {"builtin:cornell", "builtin:city,lights=60"})
    for (const std::string preset : {"many-lights", "touchdesigner", "gl-fixed", "punctual", "lecture", "light-volumes",
                                     "light-volumes-literal", "redsdk"})
      for (const char* strategy : {"deferred-loop", "forward-loop", "deferred-volumes"}) {
        if (scene != "builtin:cornell" && preset != "many-lights" && preset != "punctual") continue;
        INFO(scene << ' ' << preset << ' ' << strategy);
        const Outcome drawn =
            run_command({"render", scene, "--preset", preset, "--strategy", strategy, "--size", "100x75", "-q", "-o",
                         "g.exr", "--aov", "depth,position,normal,albedo,specular,emission,id.object", "--hash"},
                        folder.path(""));
        REQUIRE(drawn.exit_code == 0);
        const Outcome lit = run_command(
            {"shade", "g.exr", "--lights", scene, "--preset", preset, "--strategy", strategy, "-q", "--hash"},
            folder.path(""));
        INFO(lit.err);
        CHECK(lit.out == drawn.out);
      }
}

TEST_CASE("shade rebuilds positions from depth as render does, and blends into the target as it does") {
  const DrawnCapture c;
  write_bytes(c.path("p.json"), R"({"gbuffer": {"position_from_depth": true, "normal": {"format": "rgb10_a2"},
                                    "albedo": {"format": "rgba16f"}}})");
  for (const std::string strategy : {"deferred-loop", "deferred-volumes"})
    for (const std::string profile : {"ideal", "mesa-llvmpipe-22.3"}) {
      INFO(strategy << ' ' << profile);
      const Words how = {"--pipeline", "p.json", "--strategy", strategy, "--profile", profile, "-q", "--hash"};
      Words drawn = {"render", kScene, "--size", "120x90", "-o", "g.exr", "--aov", "depth,normal,albedo,id.object"};
      Words lit = {"shade", "g.exr", "--lights", kScene};
      drawn.insert(drawn.end(), how.begin(), how.end()), lit.insert(lit.end(), how.begin(), how.end());
      const Outcome frame = run_command(drawn, c.path("")), again = run_command(lit, c.path(""));
      INFO(frame.err << again.err);
      CHECK(frame.exit_code == 0);
      CHECK(frame.out == again.out);
    }
}

TEST_CASE("shade refuses what a G-buffer cannot tell") {
  const DrawnCapture c;
  const auto refused = [&](const Words& words, int code, const std::string& about) {
    Words all = {"shade"};
    all.insert(all.end(), words.begin(), words.end());
    check_refused(run_command(all, c.path("")), code, about);
  };
  refused({"c.exr", "--lights", kScene, "--hash", "--strategy", "forward-multipass"}, 2, "no G-buffer has");
  refused({"c.exr", "--lights", kScene, "--hash", "--map", "position,normal,depth"}, 3, "plane albedo: is missing");
  refused({"c.exr", "--lights", kScene, "--hash", "--preset", "punctual"}, 3, "plane specular: is missing");
  refused({"c.exr", "--lights", kScene}, 2, "add -o FILE or --hash");
  refused({"--lights", kScene, "--hash"}, 2, "there is no G-buffer");
  refused({"c.png", "--lights", kScene, "--hash"}, 3, "there is no G-buffer in it");
  refused({"c.exr", "--lights", kScene, "-o", "x.html"}, 2, "end the name in .png or .exr");
}

}  // namespace trueshade
