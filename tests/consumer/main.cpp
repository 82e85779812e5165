#include <cstdio>

#include "core/image_files/image_io.h"
#include "shading/frame.h"

int main(int, char** arguments) {
  trueshade::Scene scene;
  trueshade::Mesh triangle;
  triangle.position = {{{-1, 1, 0}, {-1, -1, 1}, {0, 0, 0}}};
  triangle.normal = {{{0, 0, 0}, {0, 0, 0}, {1, 1, 1}}};
  triangle.indices = {0, 1, 2};
  scene.meshes = {triangle};
  scene.materials.resize(1);
  scene.instances.resize(1);
  scene.lights.resize(1);
  scene.lights[0].position = {0, 0, 2};
  scene.lights[0].range = 4;
  trueshade::Pipeline pipeline;
  pipeline.width = pipeline.height = 64;
  const trueshade::Frame frame = trueshade::render_frame(scene, pipeline);
  trueshade::write_image(arguments[1], frame.color, {}, {});
  std::printf("%s %d\n", trueshade::image_hash(frame.color).c_str(), int(frame.stats.lit_pixel_lights));
}
