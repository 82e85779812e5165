#include <algorithm>

#include "programs/front/lowering.h"

namespace trueshade::programs {
namespace {

constexpr size_t kStepsForEachNode = 50, kStepsBetweenLooks = 4096, kMostCalls = 128, kMostOpenLoops = 64;

}  // namespace

/// Counts what unrolling costs, so that loops in loops which make no nodes end too.
void Lowering::work(size_t steps) {
  steps_ += steps;
  const size_t most = limits_.nodes * kStepsForEachNode;
  if (steps_ > most)
    throw Refusal{"takes more steps to unroll than " + std::to_string(kStepsForEachNode) + " for each of " +
                      std::to_string(limits_.nodes) + " operations on scalars",
                  "write shorter loops, or raise --max-program-nodes", ErrorKind::limit};
  if (steps_ < next_look_) return;
  next_look_ = steps_ + kStepsBetweenLooks;
  if (std::chrono::steady_clock::now() - start_ > std::chrono::seconds(limits_.seconds))
    throw Refusal{"takes more than " + std::to_string(limits_.seconds) + " s to unroll",
                  "write shorter loops, or raise --max-program-time", ErrorKind::limit};
}

const BlockOrder& Lowering::order_of(const SpirvFunction& function) {
  const auto found = orders_.find(function.id);
  return found != orders_.end() ? found->second : orders_.emplace(function.id, block_order(m_, function)).first->second;
}

Scalars Lowering::call(uint32_t id, std::span<const uint32_t> arguments) {
  const auto found = m_.functions.find(m_.checked(id));
  if (found == m_.functions.end()) refuse_damage("a call of what is no function");
  const SpirvFunction& function = found->second;
  for (const Frame& open : frames_)
    if (open.function == &function) refuse("calls a function from within itself", "use a loop");
  if (frames_.size() >= kMostCalls) refuse("calls functions too deep", "flatten them");
  const SpirvType& type = m_.type(function.type);
  if (type.kind != Kind::function || arguments.size() != type.members.size() ||
      arguments.size() != function.parameters.size())
    refuse_damage("a call with other arguments than the function has");
  for (size_t i = 0; i < arguments.size(); ++i) {
    const Value& given = value(arguments[i]);
    if (given.type != type.members[i]) refuse_damage("an argument of another type");
    values_[function.parameters[i]] = Value(given);
  }
  Frame next;
  next.function = &function;
  next.order = &order_of(function);
  next.call = calls_++;
  next.call_mask = frames_.empty() ? b_.truth(true) : frame().mask;
  for (const uint32_t outliving : next.order->outlives_loop) kept_.erase(outliving);  // of an earlier call
  next.present = b_.truth(true);
  next.edges.resize(next.order->block.size());
  next.edges[0].push_back({b_.truth(true), {}});
  frames_.push_back(std::move(next));
  const uint32_t line = line_;
  run_blocks(0, frame().order->block.size());
  line_ = line;
  const bool nowhere = frame().returns.empty();
  Scalars out = !nowhere ? returned() : m_.type(type.element).scalars > 0 ? zeros(type.element) : Scalars{};
  frames_.pop_back();
  return out;
}

/// Runs the blocks at these positions, each once, loops until no lane is left in them.
void Lowering::run_blocks(size_t first, size_t end) {
  for (size_t i = first; i < end; ++i) {
    const std::optional<NodeId> mask = close_constructs(i);
    const SpirvBlock& block = frame().function->blocks[frame().order->block[i]];
    if (frame().edges[i].empty()) {
      if (block.continue_label != 0) i = frame().order->at(block.merge) - 1;  // the loop's blocks have no lanes either
      continue;
    }
    if (block.continue_label == 0) {
      run_block(i, mask);
    } else {
      run_loop(i);
      i = frame().order->at(block.merge) - 1;
    }
  }
}

void Lowering::run_loop(size_t header) {
  const SpirvBlock& block = frame().function->blocks[frame().order->block[header]];
  const size_t end = frame().order->at(block.merge), go_on = frame().order->at(block.continue_label);
  if (++frame().loops > kMostOpenLoops) refuse("has loops nested too deep", "flatten them");
  NodeId entered = frame().edges[header][0].mask;
  for (const Edge& edge : frame().edges[header]) entered = b_.either(entered, edge.mask);
  frame().constructs.push_back({header, end, entered});
  for (size_t trips = 0; !frame().edges[header].empty(); ++trips) {
    if (trips > limits_.trips)
      throw Refusal{"has a loop that does not end for certain within " + std::to_string(limits_.trips) + " trips",
                    "give it a constant bound, or raise --max-loop-trips", ErrorKind::limit};
    NodeId mask = frame().edges[header][0].mask;
    for (const Edge& edge : frame().edges[header]) mask = b_.either(mask, edge.mask);
    if (go_on > header) frame().constructs.push_back({header, go_on, mask});  // where `continue` leads
    run_block(header, mask);
    run_blocks(header + 1, end);
  }
  --frame().loops;
  const auto outliving = frame().order->outliving.find(end);
  if (outliving == frame().order->outliving.end()) return;
  for (const uint32_t id : outliving->second)
    if (const auto kept = kept_.find(id); kept != kept_.end()) values_[id].scalars = kept->second;
}

/// Ends the constructs that come out at a position; the mask of those that do.
std::optional<NodeId> Lowering::close_constructs(size_t position) {
  std::optional<NodeId> mask;
  auto& constructs = frame().constructs;
  while (!constructs.empty() && constructs.back().end == position) {
    mask = constructs.back().mask;
    constructs.pop_back();
  }
  return mask;
}

/// The mask and the phis of a block, from the edges that lead to it.
void Lowering::begin_block(size_t position, std::optional<NodeId> known_mask) {
  const std::vector<Edge> edges = std::move(frame().edges[position]);
  frame().edges[position].clear();
  NodeId mask = edges[0].mask;
  for (const Edge& edge : edges) mask = b_.either(mask, edge.mask);
  mask = known_mask.value_or(mask);
  frame().mask = mask;
  const SpirvBlock& block = frame().function->blocks[frame().order->block[position]];
  for (size_t i = 0; i < edges[0].phi.size(); ++i) {
    const SpirvInstruction& phi = m_.instructions[block.first + i];
    Scalars merged = edges.back().phi[i];
    for (size_t e = 0; e + 1 < edges.size(); ++e) {
      const NodeId from_here = b_.mask_under(mask, edges[e].mask);
      for (size_t k = 0; k < merged.size(); ++k) merged[k] = b_.select(from_here, edges[e].phi[i][k], merged[k]);
    }
    work(edges.size() * merged.size());
    define(phi.word(1), phi.word(0), std::move(merged));
  }
}

void Lowering::run_block(size_t position, std::optional<NodeId> known_mask) {
  begin_block(position, known_mask);
  if (b_.is_false(frame().mask)) return;
  const SpirvBlock& block = frame().function->blocks[frame().order->block[position]];
  const bool ours = main_is_ours_ && frames_.size() == 1;
  frame().label = block.label;
  if (block.merge != 0 && block.continue_label == 0)
    frame().constructs.push_back({position, frame().order->at(block.merge), frame().mask});
  for (size_t i = block.first; i + 1 < block.end; ++i) {
    line_ = ours ? 0 : m_.line[i];
    work(1);
    instruction(m_.instructions[i]);
  }
  line_ = ours ? 0 : m_.line[block.end - 1];
  terminate(m_.instructions[block.end - 1]);
}

void Lowering::terminate(const SpirvInstruction& one) {
  switch (one.op()) {
    case SpirvOp::kBranch:
      return go(one.word(0), frame().mask);
    case SpirvOp::kBranchConditional: {
      const NodeId condition = operand(one, 0, Kind::boolean, 1)[0], mask = frame().mask;
      go(one.word(1), b_.both(mask, condition));
      return go(one.word(2), b_.both(mask, b_.negation(condition)));
    }
    case SpirvOp::kSwitch:
      return run_switch(one);
    case SpirvOp::kReturn:
      return leave(nullptr);
    case SpirvOp::kReturnValue: {
      const Value& result = value(one.word(0));
      if (result.type != frame().function->result_type) refuse_damage("a function returns another type");
      return leave(&result.scalars);
    }
    case SpirvOp::kUnreachable:
      return leave(nullptr);
    default:
      refuse_damage("a block does not end");
  }
}

void Lowering::run_switch(const SpirvInstruction& one) {
  const NodeId selector = operand(one, 0, Kind::i32, 1)[0];
  NodeId rest = frame().mask;
  for (size_t i = 2; i < one.size(); i += 2) {
    const NodeId is_case = b_.make(Op::i_eq, selector, b_.integer(int32_t(one.word(i))));
    go(one.word(i + 1), b_.both(rest, is_case));
    rest = b_.both(rest, b_.negation(is_case));
    work(1);
  }
  go(one.word(1), rest);
}

/// Sends lanes to a block, with what they bring to its phis.
void Lowering::go(uint32_t label, NodeId mask) {
  if (b_.is_false(mask)) return;
  Frame& f = frame();
  const size_t to = f.order->at(label);
  for (size_t i = f.constructs.size(); i-- > 0;) {
    Construct& open = f.constructs[i];
    if (to == open.end || (open.first <= to && to < open.end)) break;
    open.mask = b_.both(open.mask, b_.negation(mask));
  }
  const SpirvBlock& target = f.function->blocks[f.order->block[to]];
  Edge edge{mask, {}};
  for (size_t i = target.first; i < target.end && m_.instructions[i].op() == SpirvOp::kPhi; ++i) {
    const SpirvInstruction& phi = m_.instructions[i];
    Scalars brought;
    for (size_t k = 2; k + 1 < phi.size() && brought.empty(); k += 2)
      if (phi.word(k + 1) == f.label) brought = value(phi.word(k)).scalars;
    if (brought.size() != m_.type(phi.word(0)).scalars || brought.empty()) refuse_damage("a phi lacks a value");
    edge.phi.push_back(std::move(brought));
  }
  f.edges[to].push_back(std::move(edge));
}

/// Takes the block's lanes out of the function.
void Lowering::leave(const Scalars* value) {
  Frame& f = frame();
  for (Construct& open : f.constructs) open.mask = b_.both(open.mask, b_.negation(f.mask));
  f.present = b_.both(f.present, b_.negation(f.mask));
  if (value == nullptr) return;
  work(value->size());
  f.returns.push_back({f.mask, *value, line_, b_.origin()});
}

/// What the function returns: the first value, and over it the others, each where its own lanes are. Where some lanes
/// return 0, as light() does of surfaces that turn away, 0 takes the place of the first value, so that no choice is made
/// for these lanes.
Scalars Lowering::returned() {
  const std::vector<Return>& all = frame().returns;
  Scalars out = all.front().value;
  for (size_t i = 0; i < out.size(); ++i) {
    work(all.size());
    const auto is_zero = [&](const Return& r) { return b_.is_constant(r.value[i]) && b_.node(r.value[i]).bits == 0; };
    const auto zero = std::find_if(all.begin(), all.end(), is_zero);
    if (zero != all.end()) out[i] = zero->value[i];
    for (const Return& r : all) {
      b_.set_source(r.line, r.origin);
      if (zero != all.end() ? !is_zero(r) : &r != &all.front()) out[i] = b_.select(r.mask, r.value[i], out[i]);
    }
  }
  return out;
}

}  // namespace trueshade::programs
