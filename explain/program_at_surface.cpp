#include "explain/program_at_surface.h"

#include <algorithm>
#include <bit>

#include "programs/run/code.h"
#include "programs/run/execution.h"

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
      program_(frame_, &frame_->executable().program),
      place_(program().inputs.size()),
      given_(program().inputs.size()),
      unlit_(surface.material > 0 && frame_->is_unlit(surface.material - 1)) {
  for (const Rate rate : {Rate::constant, Rate::light, Rate::surface, Rate::pair, Rate::sum}) {
    const std::vector<uint32_t>& inputs = frame_->executable().at(rate).inputs;
    for (size_t i = 0; i < inputs.size(); ++i) {
      place_[inputs[i]] = uint32_t(i);
      if (rate == Rate::surface) given_[inputs[i]] = of_surface(program().inputs[inputs[i]].name, surface, pixel);
      if (rate == Rate::constant) given_[inputs[i]] = std::bit_cast<uint32_t>(frame_->constants().data()[i]);
    }
  }
  compute_of_surface();
}

ProgramAtSurface::ProgramAtSurface(const ProgramAtSurface& at, programs::Program edited)
    : frame_(at.frame_),
      program_(std::make_shared<const programs::Program>(std::move(edited))),
      place_(at.place_),
      given_(at.given_),
      unlit_(at.unlit_) {
  compute_of_surface();
}

void ProgramAtSurface::compute_of_surface() {
  of_surface_.resize(program().nodes.size());
  compute({Rate::constant, Rate::surface}, of_surface_, [this](uint32_t input) { return given_[input]; });
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

std::vector<bool> ProgramAtSurface::needed_by_light() const {
  std::vector<bool> needed(program().nodes.size(), false);
  for (int k = programs::kLightOutput; k < programs::kReachesOutput; ++k) needed[program().output[size_t(k)]] = true;
  for (programs::NodeId id = programs::NodeId(needed.size()); id-- > 0;)
    if (needed[id])
      for (const programs::NodeId operand : program().nodes[id].operands()) needed[operand] = true;
  return needed;
}

std::vector<std::array<float, 3>> ProgramAtSurface::terms(std::span<const uint32_t> lights) const {
  using programs::Place;
  // A lane is a light, and a register a node: what depends on no light is in all of its lanes.
  const std::vector<bool> needed = needed_by_light();
  std::vector<uint32_t> place(needed.size());
  std::vector<programs::NodeId> by_light_inputs, of_all_lights;
  std::vector<programs::Instruction> code;
  uint32_t count = 0;
  for (programs::NodeId id = 0; id < needed.size(); ++id) {
    const ProgramNode& node = program().nodes[id];
    if (!needed[id]) continue;
    place[id] = count++;
    const bool is_by_light = node.rate == Rate::light || node.rate == Rate::pair;
    if (is_by_light && node.op != Op::input) {
      programs::Instruction& one = code.emplace_back(programs::Instruction{node.op, place[id], {}});
      for (size_t k = 0; k < node.operands().size(); ++k) one.from[k] = {Place::lanes, place[node.operand[k]]};
    } else {
      (is_by_light ? by_light_inputs : of_all_lights).push_back(id);
    }
  }
  thread_local std::vector<programs::LaneBlock>
      registers;  // kept, since edits of one program are tried by the thousand
  registers.resize(std::max(registers.size(), size_t(count) * programs::kBatchBlocks));
  const auto lanes_of = [&](programs::NodeId id) { return registers[size_t(place[id]) * programs::kBatchBlocks].lane; };
  const size_t batch = std::min(programs::kBatchLanes, lights.size());
  for (const programs::NodeId id : of_all_lights)
    std::fill_n(lanes_of(id), (batch + programs::kBlockLanes - 1) / programs::kBlockLanes * programs::kBlockLanes,
                as_float(programs::register_word(program().nodes[id].type, of_surface_[id])));
  const std::vector<uint32_t> none(programs::kBatchBlocks);
  std::vector<std::array<float, 3>> out(lights.size());
  for (size_t from = 0; from < lights.size(); from += programs::kBatchLanes) {
    const std::span<const uint32_t> some = lights.subspan(from, std::min(programs::kBatchLanes, lights.size() - from));
    for (const programs::NodeId id : by_light_inputs)
      for (size_t i = 0; i < some.size(); ++i)
        lanes_of(id)[i] = frame_->lights().planes()[place_[program().nodes[id].bits]][some[i]];
    const size_t blocks = (some.size() + programs::kBlockLanes - 1) / programs::kBlockLanes;
    programs::run_code({code.data(), code.size(), registers.data()->lane, nullptr, nullptr, nullptr, none.data(),
                        none.data(), blocks});
    for (size_t k = 0; k < 3; ++k)
      for (size_t i = 0; i < some.size(); ++i)
        out[from + i][k] = lanes_of(program().output[size_t(programs::kLightOutput) + k])[i];
  }
  return out;
}

NodeBits ProgramAtSurface::at_sum(const std::array<float, 3>& sum) const {
  NodeBits bits = of_surface_;
  compute({Rate::sum}, bits, [&](uint32_t input) {
    return std::bit_cast<uint32_t>(sum[std::string_view("xyz").find(program().inputs[input].name.back())]);
  });
  return bits;
}

}  // namespace trueshade
