#include "scenes/files/gltf/lights_and_cameras.h"

#include <cmath>

#include "scenes/trig.h"

namespace trueshade::gltf {

Light light_of(const Document& document, uint32_t index) {
  const LightSource& from = document.lights[index];
  const std::string pointer = pointer_to("extensions", "KHR_lights_punctual", "lights", index);
  if (!from.type)
    document.fail(pointer + "/type", "this type is not in KHR_lights_punctual", "directional, point, spot");
  Light light;
  light.type = *from.type;
  for (int k = 0; k < 3; ++k) light.color[k] = float(double(from.color[k]) * from.intensity);
  if (is_directional(light.type)) return light;
  light.range = from.range;
  if (!is_spot(light.type)) return light;
  light.cone_rad = float(from.inner_rad);
  light.penumbra_rad = float(from.outer_rad - from.inner_rad);
  return light;
}

Lens lens_of(const Document& document, uint32_t index) {
  constexpr float kFar = 1e18f;
  const CameraSource& from = document.cameras[index];
  const std::string pointer = pointer_to("cameras", index);
  Lens lens;
  Camera& camera = lens.camera;
  const double near = from.near, far = from.far.value_or(double(kFar));
  switch (from.type) {
    case CameraSource::Type::perspective:
      if (!(from.fov_y_rad < kPi)) document.fail(pointer + "/perspective/yfov", "the angle is pi or more", "below pi");
      camera.fov_y_rad = float(from.fov_y_rad);
      camera.near = float(near);
      camera.far = float(far);
      if (!(camera.near > 0.0f && camera.near < camera.far))
        document.fail(pointer + "/perspective", "znear and zfar are too close", "0 < znear < zfar, as floats");
      break;
    case CameraSource::Type::orthographic: {
      Matrix4 m{};
      m[0] = 1.0 / from.x_mag;
      m[5] = 1.0 / from.y_mag;
      m[10] = 2.0 / (near - far);
      m[14] = (far + near) / (near - far);
      m[15] = 1.0;
      lens.clip_from_view = m;
      break;
    }
    case CameraSource::Type::unknown:
      document.fail(pointer + "/type", "this type is not in glTF", "perspective or orthographic");
  }
  return lens;
}

}  // namespace trueshade::gltf
