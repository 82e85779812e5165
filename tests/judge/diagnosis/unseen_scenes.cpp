// What goes wrong with the camera, objects, materials, textures and glass: all planes and the picture show it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "tests/judge/diagnosis/unseen_frames.h"

namespace trueshade::testing {
namespace {

using oracle::Capture;

void set_matrix(Scene& scene, const Matrix4& matrix) {
  scene.camera.clip_from_world.emplace();
  for (size_t i = 0; i < 16; ++i) (*scene.camera.clip_from_world)[i] = float(matrix[i]);
  scene.camera.matrix_has_gl_range = true;
}

double aspect_of(const Pipeline& pipeline) { return double(pipeline.width) / pipeline.height; }

Capture fov_across(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) { scene.camera.fov_x_rad = scene.camera.fov_y_rad; });
}

Capture square_aspect(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) { set_matrix(scene, clip_from_world(scene.camera, 1.0)); });
}

Capture jitter_left_on(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline& pipeline) {
    Matrix4 m = clip_from_world(scene.camera, aspect_of(pipeline));
    for (size_t c = 0; c < 4; ++c) {
      m[4 * c] += 0.25 * 2 / pipeline.width * m[4 * c + 3];
      m[4 * c + 1] -= 0.125 * 2 / pipeline.height * m[4 * c + 3];
    }
    set_matrix(scene, m);
  });
}

Capture horizon_tilted(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) {
    Camera& camera = scene.camera;
    const glm::vec3 right = glm::normalize(glm::cross(camera.target - camera.eye, camera.up));
    camera.up += 0.035f * glm::length(camera.up) * right;
  });
}

Capture object_left_behind(const Subject& s) {
  const size_t object = seen_object(s, 1);
  return drawn_with(s, [=](Scene& scene, Pipeline&) {
    glm::mat4x3& m = scene.instances[object].world_from_object;
    m[3] += 0.1f * (m[0] + m[2]);
  });
}

Capture matrices_exchanged(const Subject& s) {
  const size_t one = seen_object(s, 1), other = seen_object(s, 2);
  return drawn_with(s, [=](Scene& scene, Pipeline&) {
    std::swap(scene.instances[one].world_from_object, scene.instances[other].world_from_object);
  });
}

Capture yaw_wrong(const Subject& s) {
  const size_t object = seen_object(s, 1);
  return drawn_with(s, [=](Scene& scene, Pipeline&) {
    glm::mat4x3& m = scene.instances[object].world_from_object;
    const float c = std::cos(0.35f), n = std::sin(0.35f);
    const glm::mat3 turn(glm::vec3(c, 0, -n), glm::vec3(0, 1, 0), glm::vec3(n, 0, c));
    for (int column = 0; column < 3; ++column) m[column] = turn * m[column];
  });
}

Capture height_wrong(const Subject& s) {
  size_t rank = 0;  // of the first that has a height
  const auto mesh = [&] { return s.scene.meshes[s.scene.instances[seen_object(s, rank)].mesh]; };
  while (reach_of(mesh()).y == 0) ++rank;
  const size_t object = seen_object(s, rank);
  return drawn_with(s, [=](Scene& scene, Pipeline&) { scene.instances[object].world_from_object[1] *= 1.3f; });
}

/// Strips are read as lists, so that every second triangle is lost.
Capture triangles_lost(const Subject& s) {
  const size_t object = seen_object(s, 1);
  return drawn_with(s, [=](Scene& scene, Pipeline&) {
    Mesh mesh = scene.meshes[scene.instances[object].mesh];
    std::vector<uint32_t> kept;
    for (size_t i = 0; i < mesh.indices.size(); ++i)
      if (i / 3 % 2 == 0) kept.push_back(mesh.indices.data()[i]);
    mesh.indices = Array<uint32_t>(kept);
    scene.instances[object].mesh = uint32_t(scene.meshes.size());
    scene.meshes.push_back(mesh);
  });
}

Capture material_of_next(const Subject& s) {
  const size_t object = seen_object(s, 1);
  return drawn_with(s, [=](Scene& scene, Pipeline&) {
    uint32_t& material = scene.instances[object].material;
    material = uint32_t((material + 1) % scene.materials.size());
  });
}

Capture maps_decoded(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) {
    for (Texture& texture : scene.textures)
      if (texture.format == TextureFormat::srgb8_a8 || texture.format == TextureFormat::rgba8)
        texture.format = texture.format == TextureFormat::rgba8 ? TextureFormat::srgb8_a8 : TextureFormat::rgba8;
  });
}

Capture no_mipmaps(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) {
    for (Material& material : scene.materials)
      if (material.color_map.used()) material.color_map.sampler.mip_filter = MipFilter::none;
  });
}

Capture tiles_doubled(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) {
    for (Mesh& mesh : scene.meshes)
      for (float& v : mesh.uv[1]) v *= 2;
  });
}

Capture nearest_first(const Subject& s) {
  return drawn_with(s, [](Scene& scene, Pipeline&) {
    const glm::vec3 eye = scene.camera.eye;
    std::stable_sort(scene.instances.begin(), scene.instances.end(), [&](const Instance& a, const Instance& b) {
      if (!scene.materials[a.material].transparent || !scene.materials[b.material].transparent)
        return !scene.materials[a.material].transparent && scene.materials[b.material].transparent;
      return glm::distance(a.world_from_object[3], eye) < glm::distance(b.world_from_object[3], eye);
    });
  });
}

Capture alpha_squared(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    for (Material& material : scene.materials)
      if (material.transparent) material.base_color.a *= material.base_color.a;
  });
}

Capture pane_forgotten(const Subject& s) {
  return lit_with(s, [](Scene& scene, Pipeline&) {
    scene.meshes.emplace_back();
    for (Instance& instance : scene.instances) {
      if (!scene.materials[instance.material].transparent) continue;
      instance.mesh = uint32_t(scene.meshes.size() - 1);
      break;
    }
  });
}

Capture glass_in_albedo(const Subject& s) {
  return lit_with(s, [](Scene&, Pipeline& p) { p.transparency.mode = TransparencyMode::into_albedo; });
}

}  // namespace

std::vector<UnseenFault> unseen_faults_of_scenes() {
  const std::string_view all = "city cornell lecture";
  return {
      {"fov-across-for-fov-up", "the camera's angle up is taken for that across", "camera-angle", all, fov_across},
      {"square-aspect", "the projection is that of a square window", "camera-aspect", all, square_aspect},
      {"jitter-left-on", "an offset of (0.25, -0.125) pixels is left on", "picture-jitter", "city cornell atrium",
       jitter_left_on},
      {"horizon-tilted", "the camera is rolled by 2 degrees", "camera-turned", all, horizon_tilted},
      {"object-left-behind", "an object stands where it was before it moved", "object-moved", all, object_left_behind},
      {"matrices-exchanged", "two objects have each other's matrix", "- object-moved", all, matrices_exchanged},
      {"yaw-wrong", "an object is turned by 20 degrees about the world's y", "object-turned", all, yaw_wrong},
      {"height-wrong", "an object is 1.3 times as high", "object-scaled", all, height_wrong},
      {"triangles-lost", "every second triangle of an object is lost", "- triangles-missing", all, triangles_lost},
      {"material-of-the-next", "an object has the next material", "object-material object-color", all,
       material_of_next},
      {"maps-decoded", "maps of sRGB codes are read as linear, or linear ones decoded", "texture-srgb", "lecture",
       maps_decoded},
      {"no-mipmaps", "colour maps are read from their first level alone", "texture-filter", "lecture", no_mipmaps},
      {"tiles-doubled", "v is twice what it should be", "uv-scaled", "lecture", tiles_doubled},
      {"nearest-glass-first", "glass is drawn from the nearest to the farthest", "glass-reversed glass-near-first",
       "box atrium", nearest_first},
      {"glass-alpha-squared", "alpha is multiplied by itself", "- glass-alpha-srgb-decoded", "box atrium",
       alpha_squared},
      {"pane-forgotten", "the first transparent object is not drawn", "glass-object-missing", "box atrium",
       pane_forgotten},
      {"glass-in-albedo", "glass is blended into the albedo before it is lit", "-", "box atrium", glass_in_albedo},
  };
}

}  // namespace trueshade::testing
