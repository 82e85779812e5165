#include "gl/lists/frame_values.h"

#include "gl/emit/light_text.h"
#include "oracle/exact_coverage.h"
#include "oracle/matrices.h"

namespace trueshade::oracle {

namespace {

double rounded(double value) { return double(float(value)); }

/// What takes window coordinates to normalized device coordinates.
void add_window_values(const Pipeline& pipeline, int shift_x, int shift_y, std::vector<NamedValue>& out) {
  const GeometryState& g = pipeline.geometry;
  const Viewport v = resolved_viewport(g, pipeline.width, pipeline.height);
  const double up = g.clip_origin == ClipOrigin::upper_left ? -1 : 1;
  out.push_back({"ndc_from_window",
                 {double(float(v.x + shift_x)), double(float(v.y + shift_y)), rounded(2.0 / v.width),
                  up * rounded(2.0 / v.height)}});
  out.push_back({"ndc_origin", {1, up}});
  const bool zero_to_one = g.clip_depth == ClipDepth::zero_to_one;
  const double near = double(g.depth_near), far = double(g.depth_far);
  const double scale = zero_to_one ? far - near : (far - near) * 0.5, offset = zero_to_one ? near : (near + far) * 0.5;
  out.push_back({"depth_to_ndc", {rounded(offset), rounded(1.0 / scale)}});
}

/// A matrix's rows.
std::vector<double> rows_of(const Matrix4& matrix) {
  std::vector<double> rows;
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) rows.push_back(rounded(matrix[4 * c + r]));
  return rows;
}

/// What a light program may read besides.
void add_program_values(const Scene& scene, const Pipeline& pipeline, std::vector<NamedValue>& out) {
  const std::shared_ptr<const LightText> text = light_text_of(pipeline);
  if (text == nullptr) return;
  check_camera(scene.camera, pipeline.light_program.file, text->outline.inputs);
  check_lights(scene.lights, pipeline.light_program.file, text->outline.inputs);
  const bool is_matrix = scene.camera.clip_from_world.has_value();
  const Matrix4 lens = lens_matrix(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
  out.push_back({"view_from_world", rows_of(is_matrix ? Matrix4{} : view_matrix(scene.camera))});
  out.push_back({"clip_from_view", rows_of(is_matrix ? Matrix4{} : lens)});
  constexpr uint32_t kPart = 1u << 16;  // floats hold each part
  const uint32_t frame = frame_at(scene);
  out.push_back({"moment", {rounded(scene.time), double(frame / kPart), double(frame % kPart)}});
}

}  // namespace

std::vector<NamedValue> frame_values(const Scene& scene, const Pipeline& pipeline, int shift_x, int shift_y) {
  check_lights(scene.lights, pipeline);
  const Matrix4 clip = projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
  const Matrix4 inverse = inverse_of(clip);
  const auto axis = view_axis(clip);
  const glm::vec3& eye = scene.camera.eye;
  std::vector<NamedValue> out{{"eye", {double(eye.x), double(eye.y), double(eye.z)}},
                              {"view_axis", {rounded(axis[0]), rounded(axis[1]), rounded(axis[2])}},
                              {"clip_from_world", rows_of(clip)},
                              {"world_from_clip", {}}};
  for (size_t i = 0; i < 16; ++i) out[3].numbers.push_back(rounded(inverse[i]));
  add_window_values(pipeline, shift_x, shift_y, out);
  out.push_back({"view_projection", rows_of(clip)});
  out.push_back({"picture_place", {double(shift_x), double(shift_y), double(pipeline.width), double(pipeline.height)}});
  add_program_values(scene, pipeline, out);
  return out;
}

}  // namespace trueshade::oracle
