#include "core/format.h"
#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

void draw_how(const PanelContext& context, float width) {
  Session& session = context.session;
  Pipeline pipeline = session.state().pipeline;
  const std::vector<std::string_view> names = preset_names();
  row_name(context, "Preset");
  if (const auto chosen = choice("##preset", names, preset_index(pipeline.preset), width))
    session.set_preset(names[*chosen]);
  row_name(context, "Strategy");
  if (const auto chosen = choice("##strategy", kStrategyNames, size_t(pipeline.strategy), width)) {
    pipeline.strategy = Strategy(*chosen);
    session.set_pipeline(pipeline);
  }
  row_name(context, "View");
  if (const auto chosen = choice("##view", kViewNames, size_t(pipeline.view), width)) {
    pipeline.view = ImageView(*chosen);
    session.set_pipeline(pipeline);
  }
  std::vector<std::string_view> targets;
  size_t now = 0;
  for (const Format format : kTargetFormats) {
    if (format == pipeline.target) now = targets.size();
    targets.push_back(info(format).name);
  }
  row_name(context, "Target");
  if (const auto chosen = choice("##target", targets, now, width)) {
    pipeline.target = kTargetFormats[*chosen];
    session.set_pipeline(pipeline);
  }
}

void draw_exposure(const PanelContext& context, float width) {
  Session& session = context.session;
  auto stops = float(session.state().exposure);
  row_name(context, "Exposure");
  ImGui::SetNextItemWidth(width);
  if (ImGui::SliderFloat("##exposure", &stops, -8.0f, 8.0f, "%+.2f stops")) session.set_exposure(double(stops));
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) session.set_exposure(0.0);
}

void draw_light(const PanelContext& context, float width) {
  Session& session = context.session;
  if (!session.state().pipeline.light_program.used()) draw_exposure(context, width);
  Pipeline pipeline = session.state().pipeline;
  PostChain& post = pipeline.post;
  bool changed = false;
  constexpr std::string_view kToneMaps[] = {"none", "reinhard"};
  row_name(context, "Tone map");
  if (const auto chosen = choice("##tone", kToneMaps, size_t(post.tone_map), width)) {
    post.tone_map = PostChain::ToneMap(*chosen);
    changed = true;
  }
  if (post.tone_map != PostChain::ToneMap::none) {
    row_name(context, "Key");
    ImGui::SetNextItemWidth(width);
    changed |= ImGui::SliderFloat("##key", &post.key, 0.01f, 1.0f, "%.3f",
                                  ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  }
  row_name(context, "Bloom");
  ImGui::SetNextItemWidth(width);
  changed |= ImGui::SliderFloat("##bloom", &post.bloom.strength, 0.0f, 1.0f,
                                post.bloom.strength > 0.0f ? "%.2f" : "off", ImGuiSliderFlags_AlwaysClamp);
  row_name(context, "Samples");
  ImGui::SetNextItemWidth(width);
  constexpr std::string_view kSamples[] = {"1", "4", "9", "16", "25", "36", "49", "64"};
  if (const auto chosen = choice("##samples", kSamples, size_t(post.samples - 1), width)) {
    post.samples = int(*chosen) + 1;
    changed = true;
  }
  row_name(context, "Edges");
  changed |= ImGui::Checkbox("smoothed##edges", &post.edge_filter);
  if (changed) session.set_pipeline(pipeline);
}

void draw_camera(const PanelContext& context, float width) {
  Session& session = context.session;
  auto degrees = float(session.field_of_view() * kDegrees);
  row_name(context, "Field of view");
  ImGui::SetNextItemWidth(width);
  if (ImGui::SliderFloat("##fov", &degrees, 10.0f, 120.0f, "%.1f\xC2\xB0"))
    session.set_field_of_view(double(degrees) / kDegrees);
  const Camera& camera = context.picture.camera;
  row_name(context, "Eye");
  ImGui::Text("%.4g  %.4g  %.4g", double(camera.eye.x), double(camera.eye.y), double(camera.eye.z));
  row_name(context, "Target");
  ImGui::Text("%.4g  %.4g  %.4g", double(camera.target.x), double(camera.target.y), double(camera.target.z));
  row_name(context, "Speed");
  ImGui::Text("%.3g units a second", session.speed());
}

}  // namespace

void draw_picture_panel(const PanelContext& context) {
  Session& session = context.session;
  const float width = ImGui::GetContentRegionAvail().x - context.size(104) + ImGui::GetStyle().WindowPadding.x;
  heading(context, "Picture");
  draw_how(context, width);
  heading(context, "Light");
  draw_light(context, width);
  heading(context, "Camera");
  draw_camera(context, width);
  ImGui::Dummy({0, context.size(2)});
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Save picture", {half, 0})) session.save_picture();
  ImGui::SameLine();
  if (ImGui::Button("Save scene", {half, 0})) session.save_scene();
}

}  // namespace trueshade::viewer
