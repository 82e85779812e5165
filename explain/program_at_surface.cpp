#include "explain/program_at_surface.h"

#include <algorithm>
#include <bit>

#include "programs/run/code.h"

namespace trueshade {
namespace {

using programs::Op;
using programs::ProgramNode;
using programs::Rate;

/// The bits of a surface's value of a field of the interface's `Surface`, by its full name, such as `surface.normal.x`:
/// an integer of ids and places, else a float. Any other name is taken for occlusion: programs that read `uv1`,
/// `tangent` or `user` do not come here.
uint32_t of_surface(std::string_view name, const SurfacePlanes& s, WindowPixel pixel) {
  const size_t component = std::string_view("xyzw").find(name.back());
  const size_t c = component == std::string_view::npos ? 0 : component;
  const auto is = [name](std::string_view field) { return name.starts_with(field); };
  if (name == "surface.object") return s.object;
  if (name == "surface.material") return s.material;
  if (name == "surface.pixel_x") return uint32_t(pixel.x);
  if (name == "surface.pixel_y") return uint32_t(pixel.y);
  const float value = is("surface.position")        ? s.position[c]
                      : is("surface.normal")        ? s.normal[c]
                      : is("surface.albedo")        ? s.albedo[c]
                      : is("surface.specular")      ? s.specular[c]
                      : is("surface.emission")      ? s.emission[c]
                      : is("surface.uv")            ? s.uv[c]
                      : name == "surface.shininess" ? s.specular[3]
                      : name == "surface.metallic"  ? s.specular[0]
                      : name == "surface.roughness" ? s.specular[1]
                                                    : s.emission[3];  // occlusion
  return std::bit_cast<uint32_t>(value);
}

}  // namespace

float ProgramAtSurface::as_float(uint32_t bits) { return std::bit_cast<float>(bits); }

ProgramAtSurface::ProgramAtSurface(std::shared_ptr<const ProgramFrame> frame, const SurfacePlanes& surface,
                                   WindowPixel pixel)
    : frame_(std::move(frame)),
      place_(program().inputs.size()),
      of_surface_(program().nodes.size()),
      unlit_(surface.material > 0 && frame_->is_unlit(surface.material - 1)) {
  for (const Rate rate : {Rate::constant, Rate::light, Rate::surface, Rate::pair, Rate::sum}) {
    const std::vector<uint32_t>& inputs = frame_->executable().at(rate).inputs;
    for (size_t i = 0; i < inputs.size(); ++i) place_[inputs[i]] = uint32_t(i);
  }
  compute({Rate::constant, Rate::surface}, of_surface_, [&](uint32_t input) {
    if (program().inputs[input].rate == Rate::surface) return of_surface(program().inputs[input].name, surface, pixel);
    return std::bit_cast<uint32_t>(frame_->constants().data()[place_[input]]);
  });
}

/// Sets the bits of the nodes of these rates, in the order of the nodes, whose operands have theirs already.
///   input: gives the bits of an input by its number
template <class Input>
void ProgramAtSurface::compute(std::initializer_list<Rate> rates, NodeBits& bits, Input input) const {
  const std::vector<ProgramNode>& nodes = program().nodes;
  for (size_t id = 0; id < nodes.size(); ++id) {
    const ProgramNode& node = nodes[id];
    if (std::find(rates.begin(), rates.end(), node.rate) == rates.end()) continue;
    if (node.op == Op::constant || node.op == Op::input) {
      bits[id] = node.op == Op::constant ? node.bits : input(node.bits);
      continue;
    }
    uint32_t of[3] = {};
    for (size_t i = 0; i < node.operands().size(); ++i) of[i] = bits[node.operand[i]];
    bits[id] = programs::applied(node.op, node.type, of[0], of[1], of[2]);
  }
}

NodeBits ProgramAtSurface::at_light(size_t light) const {
  NodeBits bits = of_surface_;
  compute({Rate::light, Rate::pair}, bits,
          [&](uint32_t input) { return std::bit_cast<uint32_t>(frame_->lights().planes()[place_[input]][light]); });
  return bits;
}

NodeBits ProgramAtSurface::at_sum(const std::array<float, 3>& sum) const {
  NodeBits bits = of_surface_;
  compute({Rate::sum}, bits, [&](uint32_t input) {
    return std::bit_cast<uint32_t>(sum[std::string_view("xyz").find(program().inputs[input].name.back())]);
  });
  return bits;
}

}  // namespace trueshade
