// The cameras that options make of a scene's (scenes/camera_changes.h).
#include "scenes/camera_changes.h"

#include <algorithm>
#include <cmath>

#include "expect_error.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/lights_of_ours.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr double kAspects[] = {1.0, 2.4, 500.0 / 1200.0};

/// A crooked heap of points, off the origin.
Scene heap(uint64_t seed = 7) {
  Pcg32 random(seed, 1);
  Mesh mesh;
  for (int i = 0; i < 200; ++i)
    for (size_t k = 0; k < 3; ++k)
      mesh.position[k].push_back(float(random.between(-1, 1)) * (k == 0 ? 3.0f : k == 1 ? 0.5f : 1.0f) + float(5 * k));
  mesh.indices = {0, 1, 2};
  Scene scene;
  scene.spec = "heap";
  scene.meshes.push_back(std::move(mesh));
  scene.materials.emplace_back();
  scene.instances.emplace_back();
  scene.camera = camera_seeing(scene);
  scene.camera_of_ours = true;
  return scene;
}

/// Where the points are in the picture: each end in [-1, 1] where it is inside.
struct Seen {
  glm::dvec2 least{9.0}, most{-9.0};
  bool in_depth = true;
  double filled() const {
    return std::max({std::fabs(least.x), std::fabs(least.y), std::fabs(most.x), std::fabs(most.y)});
  }
};

Seen seen(const Scene& scene, const Camera& camera, double aspect) {
  const Matrix4 m = clip_from_world(camera, aspect);
  Seen out;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      double at[4];
      for (size_t row = 0; row < 4; ++row) {
        at[row] = m[12 + row];
        for (size_t k = 0; k < 3; ++k) at[row] += m[4 * k + row] * double(mesh.position[k][i]);
      }
      out.in_depth = out.in_depth && at[3] > 0.0 && std::fabs(at[2]) <= at[3];
      for (int k = 0; k < 2; ++k)
        out.least[k] = std::min(out.least[k], at[k] / at[3]), out.most[k] = std::max(out.most[k], at[k] / at[3]);
    }
  }
  return out;
}

Camera changed(const Scene& scene, const CameraChanges& changes, double aspect = 1.0) {
  return ChangedCamera(scene, changes, aspect).camera(scene);
}

CameraChanges orbit(double azimuth, double elevation, double distance = 100.0,
                    DistanceUnit unit = DistanceUnit::percent) {
  CameraChanges changes;
  changes.orbit = OrbitPlace{azimuth, elevation, distance, unit};
  return changes;
}

double length(const glm::dvec3& v) { return std::sqrt(dot(v, v)); }
glm::dvec3 toward(const Camera& camera) { return unit(glm::dvec3(camera.eye) - glm::dvec3(camera.target)); }
bool near(const glm::dvec3& a, const glm::dvec3& b, double by = 1e-5) { return length(a - b) < by; }

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && a.near == b.near && a.far == b.far &&
         a.fov_y_rad == b.fov_y_rad && a.fov_x_rad == b.fov_x_rad;
}

}  // namespace

TEST_CASE("an orbit sees all from the side that its angles name, and fills 85 % of any picture's width or height") {
  const Scene scene = heap();
  for (const double aspect : kAspects)
    for (const double azimuth : {-400.0, 0.0, 30.0, 90.0, 180.0, 271.5})
      for (const double elevation : {-90.0, -35.0, 0.0, 20.0, 90.0}) {
        CAPTURE(aspect, azimuth, elevation);
        const Camera camera = changed(scene, orbit(azimuth, elevation), aspect);
        const double a = azimuth * kPi / 180.0, e = elevation * kPi / 180.0;
        CHECK(near(toward(camera), {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)}));
        CHECK(near(glm::dvec3(view_from_world(camera)[0], view_from_world(camera)[4], view_from_world(camera)[8]),
                   {std::cos(a), 0.0, -std::sin(a)}));  // the picture's right
        const Seen in = seen(scene, camera, aspect);
        CHECK(in.in_depth);
        CHECK(in.filled() <= 0.851);
        for (int k = 0; k < 2; ++k) CHECK(std::fabs(in.least[k] + in.most[k]) < 0.01);  // in the middle
        CHECK(((in.least.x < -0.849 && in.most.x > 0.849) || (in.least.y < -0.849 && in.most.y > 0.849)));
      }
}

TEST_CASE("the camera of ours fills 85 % of pictures of any shape, also by another lens, and stays in a square one") {
  const Scene scene = heap();
  CHECK(same(changed(scene, {}), scene.camera));
  for (const double aspect : kAspects)
    for (const double fov : {0.0, 20.0, 45.0}) {
      CameraChanges changes;
      if (fov > 0.0) changes.fov_y_deg = fov;
      CAPTURE(aspect, fov);
      const Camera camera = changed(scene, changes, aspect);
      const Seen in = seen(scene, camera, aspect);
      CHECK(in.in_depth);
      CHECK(in.filled() == Approx(0.85).margin(0.001));
      if (fov > 0.0) CHECK(camera.fov_y_rad == float(fov * (kPi / 180.0)));
    }
  Scene of_file = scene;
  of_file.camera_of_ours = false;
  CHECK(same(changed(of_file, {}, 2.4), scene.camera));
}

TEST_CASE("an orbit's distance is a share of the one that frames all, or scene units from the centre") {
  const Scene scene = heap();
  const Camera all = changed(scene, orbit(30, 20)), twice = changed(scene, orbit(30, 20, 200.0));
  CHECK(all.target == twice.target);
  CHECK(length(glm::dvec3(twice.eye) - glm::dvec3(twice.target)) ==
        Approx(2.0 * length(glm::dvec3(all.eye) - glm::dvec3(all.target))));
  for (const double distance : {0.5, 40.0}) {
    const Camera units = changed(scene, orbit(30, 20, distance, DistanceUnit::scene_units));
    CHECK(near(glm::dvec3(units.target), bounds_of(scene).centre));
    CHECK(length(glm::dvec3(units.eye) - glm::dvec3(units.target)) == Approx(distance));
  }
  CameraChanges around = orbit(30, 20);
  around.target = {1.0f, 5.0f, 12.0f};
  const Camera aside = changed(scene, around, 2.4);
  CHECK(aside.target == *around.target);
  CHECK(seen(scene, aside, 2.4).filled() == Approx(0.85).margin(0.001));
}

TEST_CASE("an orbit keeps the lens of the scene's camera, and goes around z where that camera has z up") {
  Scene scene = heap();
  scene.camera_of_ours = false;
  scene.camera.fov_y_rad = 1.0f;
  CHECK(changed(scene, orbit(10, 10)).fov_y_rad == 1.0f);
  scene.camera.fov_x_rad = 1.2f;
  for (const double aspect : kAspects) {
    const Camera camera = changed(scene, orbit(10, 10), aspect);
    CHECK(camera.fov_x_rad == 1.2f);
    CHECK(seen(scene, camera, aspect).filled() == Approx(0.85).margin(0.001));
  }
  scene.camera.up = {0.0f, 0.0f, 1.0f};
  CHECK(near(toward(changed(scene, orbit(0, 0))), {0, -1, 0}));
  CHECK(near(toward(changed(scene, orbit(90, 0))), {1, 0, 0}));
  CHECK(near(toward(changed(scene, orbit(0, 90))), {0, 0, 1}));
}

TEST_CASE("an eye and a place to look at replace those of the scene's camera, and near and far hold the scene") {
  Scene scene = heap();
  scene.camera_of_ours = false;
  scene.camera.near = 3.0f, scene.camera.far = 3.5f;
  for (const glm::vec3 eye : {glm::vec3(300, 20, 10), glm::vec3(0, 5, 16), glm::vec3(0, 400, 10)}) {
    CameraChanges changes;
    changes.eye = eye, changes.target = {0.0f, 5.0f, 10.0f};
    const Camera camera = changed(scene, changes);
    CHECK(camera.eye == eye);
    CHECK(camera.target == *changes.target);
    CHECK((camera.up == scene.camera.up || eye.y == 400.0f));
    CHECK(seen(scene, camera, 1.0).in_depth);
  }
  CameraChanges above;  // along the camera's own up: the top of the picture is away from the scene's front
  above.eye = {0.0f, 400.0f, 10.0f}, above.target = {0.0f, 5.0f, 10.0f};
  above.target->y = 0.0f;
  CHECK(near(glm::dvec3(changed(scene, above).up), {0, 0, -1}));
  CameraChanges eye_alone, fov_alone;
  eye_alone.eye = {9.0f, 9.0f, 30.0f}, fov_alone.fov_y_deg = 33.0;
  CHECK(changed(scene, eye_alone).target == scene.camera.target);
  const Camera narrow = changed(scene, fov_alone);
  CHECK(narrow.fov_y_rad == float(33.0 * (kPi / 180.0)));
  CHECK((narrow.eye == scene.camera.eye && narrow.near == 3.0f && narrow.far == 3.5f));
  scene.cameras = {{"Side", "", 0.8}};  // a glTF camera looks along an axis, at no place
  CHECK(near(glm::dvec3(changed(scene, eye_alone).target), bounds_of(scene).centre));
}

TEST_CASE("a camera of options is checked as a scene's is, and of a matrix no part is replaced") {
  Scene scene = heap();
  CameraChanges inside;
  inside.eye = inside.target = {1.0f, 2.0f, 3.0f};
  CHECK_STARTS_WITH(error_of(ErrorKind::usage, [&] { changed(scene, inside); }),
                    "--eye: eye, target and up leave no direction");
  CameraChanges huge = orbit(0, 0, 1e18, DistanceUnit::scene_units);
  CHECK_STARTS_WITH(error_of(ErrorKind::usage, [&] { changed(scene, huge); }), "--orbit: ");
  scene.camera_of_ours = false;
  scene.camera.clip_from_world.emplace();
  CameraChanges changes;
  changes.fov_y_deg = 40.0;
  CHECK_STARTS_WITH(error_of(ErrorKind::usage, [&] { changed(scene, changes); }),
                    "--fov: the camera of heap is a matrix");
  changes.eye = {0.0f, 5.0f, 40.0f};
  CHECK_STARTS_WITH(error_of(ErrorKind::usage, [&] { changed(scene, changes); }),
                    "--eye: the camera of heap is a matrix");
  changes.target = {0.0f, 5.0f, 10.0f};
  CHECK(seen(scene, changed(scene, changes), 1.0).in_depth);
  CHECK(seen(scene, changed(scene, orbit(20, 20)), 1.0).filled() == Approx(0.85).margin(0.001));
}

TEST_CASE("the pictures of a turntable are orbits at even steps from one distance that cuts nothing off") {
  const Scene scene = heap();
  for (const double aspect : kAspects) {
    const std::vector<CameraChanges> all = turntable(scene, orbit(350, 15), 8, aspect);
    REQUIRE(all.size() == 8);
    double fullest = 0.0;
    for (size_t i = 0; i < all.size(); ++i) {
      CHECK(all[i].orbit->azimuth_deg == Approx(i == 0 ? 350.0 : 45.0 * double(i) - 10.0));
      CHECK(all[i].orbit->elevation_deg == 15.0);
      CHECK(all[i].orbit->distance == all[0].orbit->distance);
      const Camera camera = changed(scene, all[i], aspect);
      CHECK(near(glm::dvec3(camera.target), bounds_of(scene).centre));
      const Seen in = seen(scene, camera, aspect);
      CHECK((in.in_depth && in.filled() <= 0.851));
      fullest = std::max(fullest, in.filled());
    }
    CHECK(fullest == Approx(0.85).margin(0.001));
  }
  CHECK(turntable(scene, {}, 1, 1.0)[0].orbit->elevation_deg == 20.0);
  const std::vector<CameraChanges> far = turntable(scene, orbit(0, 0, 300.0), 4, 1.0);
  CHECK(far[0].orbit->distance == Approx(3.0 * turntable(scene, orbit(0, 0), 4, 1.0)[0].orbit->distance));
}

TEST_CASE("lamps of ours go around with an orbit, whatever was seen before, and stay for other eyes") {
  Scene scene = heap();
  Light own;
  own.position = {1.0f, 2.0f, 3.0f};
  scene.lights.push_back(own);
  add_lights_of_ours(scene);
  const std::vector<Light> placed = scene.lights;
  const glm::dvec3 centre = bounds_of(scene).centre;
  const bool z_up = GENERATE(false, true);
  if (z_up) scene.camera_of_ours = false, scene.camera.up = {0.0f, 0.0f, 1.0f};
  const glm::dvec3 right(1.0, 0.0, 0.0), up = z_up ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
  const Camera loaded = scene.camera;
  for (const double azimuth : {0.0, 90.0, 180.0, 33.0, -90.0, 0.0}) {
    scene.camera = loaded;
    ChangedCamera(scene, orbit(azimuth, 20.0), 1.0).see(scene);
    const double angle = azimuth / 180.0 * kPi;
    const glm::dvec3 side = right * std::cos(angle) - cross(right, up) * std::sin(angle);
    for (size_t i = 1; i < placed.size(); ++i) {
      const glm::dvec3 was = glm::dvec3(placed[i].position) - centre,
                       is = glm::dvec3(scene.lights[i].position) - centre;
      const bool is_lamp = placed[i].type != LightType::ambient;
      INFO(azimuth << ' ' << i);
      if (!is_lamp) CHECK(scene.lights[i].position == placed[i].position);
      if (is_lamp) CHECK(dot(is, up) == Approx(dot(was, up)).margin(1e-5));
      if (is_lamp) CHECK(dot(is, side) == Approx(dot(was, right)).margin(1e-5));
      if (is_lamp) CHECK(dot(is, cross(side, up)) == Approx(dot(was, cross(right, up))).margin(1e-5));
      if (is_lamp && azimuth == 0.0 && !z_up) CHECK(scene.lights[i].position == placed[i].position);
    }
    CHECK(scene.lights[0].position == own.position);
  }
  const glm::vec3 turned = scene.lights[1].position;
  CameraChanges beside;
  beside.eye = {30.0f, 0.0f, 0.0f};
  ChangedCamera(scene, beside, 1.0).see(scene);
  CHECK(scene.lights[1].position == turned);
}

TEST_CASE("a ground of ours is not framed, and is seen as far as it goes") {
  Scene scene = heap();
  add_ground(scene);
  for (const double aspect : kAspects)
    for (const double elevation : {0.0, 30.0}) {
      const Camera camera = changed(scene, orbit(40, elevation), aspect);
      Scene alone = heap();
      CHECK(seen(alone, camera, aspect).filled() == Approx(0.85).margin(0.001));
      const double reach = length(glm::dvec3(camera.eye) - bounds_of(alone).centre) + 8.0 * bounds_of(alone).radius;
      CHECK(camera.far > reach);
    }
}

TEST_CASE("an eye below a ground of ours sees no ground, and one above it does again") {
  Scene scene = heap();
  add_ground(scene);
  const std::string hash = scene_hash(scene);
  const auto ground_seen = [&](const CameraChanges& changes) {
    ChangedCamera(scene, changes, 1.0).see(scene);
    Scene ground = scene;
    ground.instances.erase(ground.instances.begin());
    const double y = double(ground.instances[0].world_from_object[3].y);
    const Matrix4 m = clip_from_world(scene.camera, 1.0);
    const Mesh& disc = scene.meshes[ground.instances[0].mesh];
    bool in_depth = false;  // of any of its points
    for (size_t i = 0; i < disc.vertex_count(); ++i) {
      double z = m[14], w = m[15];
      const double at[] = {double(disc.position[0][i]), double(disc.position[1][i]) + y, double(disc.position[2][i])};
      for (size_t k = 0; k < 3; ++k) z += m[4 * k + 2] * at[k], w += m[4 * k + 3] * at[k];
      in_depth = in_depth || std::fabs(z) <= w;
    }
    return in_depth;
  };
  CHECK(ground_seen(orbit(30, 20)));
  CHECK_FALSE(ground_seen(orbit(30, -20)));
  CHECK(ground_seen(orbit(30, 20)));
  CameraChanges under;
  under.eye = {0.0f, -9.0f, 30.0f};
  CHECK_FALSE(ground_seen(under));
  ChangedCamera(scene, {}, 1.0).see(scene);
  CHECK(scene.instances.back().world_from_object[3].y < 0.0f);  // without changes all stays as it is
  CHECK(ground_seen(orbit(30, 20)));
  scene.camera = heap().camera, see_ground(scene.camera, bounds_without_ground(scene));
  CHECK(scene_hash(scene) == hash);
}

TEST_CASE("a camera of options does not follow what moves, but replaces parts of a camera that does") {
  Scene scene = heap();
  scene.timeline.camera.push_back({CameraProperty::target, Track{{0.0, 1.0}, {{0, 5, 10, 0}, {3, 5, 10, 0}}}});
  scene.camera_of_ours = false;
  CameraChanges narrow;
  narrow.fov_y_deg = 20.0;
  const ChangedCamera orbiting(scene, orbit(30, 10), 1.5), narrowed(scene, narrow, 1.5);
  const Camera first = orbiting.camera(scene);
  set_time(scene, 1.0);
  CHECK(narrowed.camera(scene).target.x == 3.0f);
  narrowed.see(scene);
  CHECK(same(narrowed.camera(scene), scene.camera));  // once more changes nothing
  CHECK(same(orbiting.camera(scene), first));
}

TEST_CASE("changes are told as the options that make them") {
  CHECK(option_text({}).empty());
  CHECK(option_text(orbit(30, -20.5)) == " --orbit 30,-20.5");
  CHECK(option_text(orbit(30, 20, 150)) == " --orbit 30,20,150%");
  CameraChanges all = orbit(0, 90, 2.5, DistanceUnit::scene_units);
  all.target = {1.0f, 0.5f, -2.0f}, all.fov_y_deg = 40.0;
  CHECK(option_text(all) == " --orbit 0,90,2.5 --look-at 1,0.5,-2 --fov 40");
}

}  // namespace trueshade
