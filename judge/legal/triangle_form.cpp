#include "judge/legal/triangle_form.h"

namespace trueshade::oracle {

TriangleForm::TriangleForm(const Projector& projector, uint32_t instance, uint32_t triangle)
    : projector_(projector),
      instance_(instance),
      triangle_(triangle),
      values_(triangle_values(projector, instance, triangle)) {
  projector.pieces(instance, triangle, pieces_);
  forms_.reserve(pieces_.size());
  for (const Piece& piece : pieces_)
    forms_.push_back({PieceShape(piece, projector.profile(), projector.window_reach()), {}});
}

const VertexAttribute& TriangleForm::attribute(size_t piece, size_t index, Interpolation interpolation) const {
  KnownAttribute& known = forms_[piece].attributes[index];
  if (known.interpolation == interpolation) return known.attribute;
  VertexAttribute& a = known.attribute;
  piece_values(pieces_[piece], values_, index, interpolation, a.value, a.error);
  a.plane_error = plane_error_of(pieces_[piece], forms_[piece].shape, a.value, interpolation);
  known.interpolation = interpolation;
  return a;
}

const TangentFrame& TriangleForm::tangents() const {
  if (!tangents_) {
    const Scene& scene = projector_.scene();
    const Material& material = scene.materials[scene.instances[instance_].material];
    const bool of_vertices = scene.meshes[scene.instances[instance_].mesh].has_tangents();
    tangents_ = of_vertices ? vertex_frame(projector_, instance_, triangle_)
                            : tangent_frame(projector_, instance_, triangle_, values_, material.normal_map.uv_set);
  }
  return *tangents_;
}

const std::shared_ptr<const TriangleForm>& TriangleForms::of(uint32_t instance, uint32_t triangle) {
  Slot& slot = slots_[(size_t(instance) * 37 + triangle) % kSlots];
  if (!slot.form || slot.instance != instance || slot.triangle != triangle)
    slot = {instance, triangle, std::make_shared<const TriangleForm>(projector_, instance, triangle)};
  return slot.form;
}

}  // namespace trueshade::oracle
