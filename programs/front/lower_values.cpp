#include "programs/front/lowering.h"

namespace trueshade::programs {

Lowering::Lowering(const SpirvModule& module, NodeBuilder& builder, const ProgramLimits& limits, bool main_is_ours)
    : m_(module), b_(builder), c_(builder), limits_(limits), main_is_ours_(main_is_ours), values_(module.bound) {}

void Lowering::run() {
  for (const size_t i : m_.globals) {
    line_ = 0;
    global(m_.instructions[i]);
  }
  call(m_.entry_function, {});
  set_outputs();
}

const Value& Lowering::value(uint32_t id) const {
  const Value& found = values_[m_.checked(id)];
  if (found.type == 0) refuse_damage("id " + std::to_string(id) + " is used before it is made");
  return found;
}

/// Gives an id its value. What lanes that left a loop take out of it is kept beside it until the loop ends.
void Lowering::define(uint32_t id, uint32_t type, Scalars scalars) {
  if (scalars.size() != m_.type(type).scalars || scalars.empty()) refuse_damage("a result of another type");
  Value& place = values_[m_.checked(id)];
  if (!frames_.empty() && frame().order->outlives_loop.contains(id)) {
    Scalars& kept = kept_[id];
    const bool is_first = kept.size() != scalars.size();
    if (is_first) kept = scalars;
    for (size_t i = 0; i < scalars.size(); ++i) kept[i] = b_.select(frame().mask, scalars[i], kept[i]);
  }
  place.type = type;
  place.scalars = std::move(scalars);
}

Scalars Lowering::zeros(uint32_t id) {
  const SpirvType& type = m_.type(id);
  Scalars out;
  switch (type.kind) {
    case Kind::structure:
      for (const uint32_t member : type.members) {
        const Scalars part = zeros(member);
        out.insert(out.end(), part.begin(), part.end());
      }
      return out;
    case Kind::array:
    case Kind::vector:
    case Kind::matrix: {
      const Scalars part = zeros(type.element);
      for (uint32_t i = 0; i < type.count; ++i) out.insert(out.end(), part.begin(), part.end());
      return out;
    }
    case Kind::boolean:
      return {b_.truth(false)};
    case Kind::i32:
      return {b_.integer(0)};
    case Kind::u32:
      return {b_.word(0)};
    case Kind::f32:
      return {b_.number(0.0f)};
    default:
      refuse_damage("a value of what holds none");
  }
}

/// A constant, an undefined value or a variable outside functions.
void Lowering::global(const SpirvInstruction& one) {
  const uint32_t type = one.word(0), id = m_.checked(one.word(1));
  switch (one.op()) {
    case SpirvOp::kVariable:
      return variable(one, true);
    case SpirvOp::kConstantTrue:
    case SpirvOp::kSpecConstantTrue:
    case SpirvOp::kConstantFalse:
    case SpirvOp::kSpecConstantFalse:
      if (m_.type(type).kind != Kind::boolean) refuse_damage("a truth that is no boolean");
      return define(id, type, {b_.truth(one.op() == SpirvOp::kConstantTrue || one.op() == SpirvOp::kSpecConstantTrue)});
    case SpirvOp::kConstant:
    case SpirvOp::kSpecConstant: {
      const Kind kind = m_.type(type).kind;
      if (kind == Kind::i32) return define(id, type, {b_.integer(int32_t(one.word(2)))});
      if (kind == Kind::u32) return define(id, type, {b_.word(one.word(2))});
      if (kind != Kind::f32) refuse_damage("a constant that is no number");
      return define(id, type, {b_.constant(Type::f32, one.word(2))});
    }
    case SpirvOp::kConstantComposite:
    case SpirvOp::kSpecConstantComposite:
      composite(one);
      return;
    default:
      return define(id, type, zeros(type));
  }
}

/// The part of a type that the literal indices from a word on name.
Lowering::Part Lowering::part_of(uint32_t type, const SpirvInstruction& one, size_t first_index) const {
  Part out{type, 0};
  for (size_t i = first_index; i < one.size(); ++i) {
    const SpirvType& whole = m_.type(out.type);
    const uint32_t index = one.word(i);
    if (index >= whole.count) refuse_damage("a part that is not there");
    if (whole.kind == Kind::structure) {
      out.offset += whole.first[index];
      out.type = whole.members[index];
    } else {
      out.type = whole.element;
      out.offset += index * m_.type(out.type).scalars;
    }
  }
  return out;
}

void Lowering::shuffle(const SpirvInstruction& one) {
  const Kind base = base_of(one.word(0));
  Scalars both = operand(one, 2, base);
  const Scalars& second = operand(one, 3, base);
  both.insert(both.end(), second.begin(), second.end());
  Scalars out;
  for (size_t i = 4; i < one.size(); ++i) {
    const uint32_t index = one.word(i);
    if (index != ~0u && index >= both.size()) refuse_damage("a component that is not there");
    out.push_back(index == ~0u ? zeros(m_.type(one.word(0)).element)[0] : both[index]);
  }
  define(one.word(1), one.word(0), std::move(out));
}

/// Of a vector, a component whose number is no constant; beyond the last it is the last.
void Lowering::dynamic_component(const SpirvInstruction& one) {
  const bool inserts = one.op() == SpirvOp::kVectorInsertDynamic;
  const Kind base = base_of(one.word(0));
  Scalars vector = operand(one, 2, base);
  const NodeId index = operand(one, inserts ? 4 : 3, Kind::i32, 1)[0];
  const size_t last = vector.size() - 1;
  if (inserts) {
    const NodeId part = operand(one, 3, base, 1)[0];
    for (size_t k = 0; k <= last; ++k) {
      const NodeId number = b_.word(uint32_t(k));
      const NodeId here = k < last ? b_.make(Op::i_eq, index, number) : b_.negation(b_.make(Op::u_lt, index, number));
      vector[k] = b_.select(here, part, vector[k]);
    }
    return define(one.word(1), one.word(0), std::move(vector));
  }
  NodeId out = vector[last];
  for (size_t k = last; k-- > 0;) out = b_.select(b_.make(Op::i_eq, index, b_.word(uint32_t(k))), vector[k], out);
  define(one.word(1), one.word(0), {out});
}

/// Aggregates taken apart and put together; false: the instruction is none of these.
bool Lowering::composite(const SpirvInstruction& one) {
  switch (one.op()) {
    case SpirvOp::kConstantComposite:
    case SpirvOp::kSpecConstantComposite:
    case SpirvOp::kCompositeConstruct: {
      Scalars out;
      for (size_t i = 2; i < one.size(); ++i) {
        const Scalars& part = value(one.word(i)).scalars;
        out.insert(out.end(), part.begin(), part.end());
        if (out.size() > kMostScalars) refuse_damage("an aggregate of more than it holds");
      }
      work(out.size());
      define(one.word(1), one.word(0), std::move(out));
      return true;
    }
    case SpirvOp::kCompositeExtract: {
      const Value& whole = value(one.word(2));
      const Part part = part_of(whole.type, one, 3);
      if (whole.scalars.empty() || m_.type(part.type).scalars == 0) refuse_damage("a part of a pointer");
      const auto first = whole.scalars.begin() + part.offset;
      define(one.word(1), one.word(0), Scalars(first, first + m_.type(part.type).scalars));
      return true;
    }
    case SpirvOp::kCompositeInsert: {
      const Value& whole = value(one.word(3));
      const Scalars part = value(one.word(2)).scalars;
      const Part at = part_of(whole.type, one, 4);
      if (whole.scalars.empty() || part.size() != m_.type(at.type).scalars) refuse_damage("a part of another type");
      Scalars out = whole.scalars;
      for (size_t i = 0; i < part.size(); ++i) out[at.offset + i] = part[i];
      define(one.word(1), one.word(0), std::move(out));
      return true;
    }
    case SpirvOp::kVectorShuffle:
      shuffle(one);
      return true;
    case SpirvOp::kVectorExtractDynamic:
    case SpirvOp::kVectorInsertDynamic:
      dynamic_component(one);
      return true;
    case SpirvOp::kCopyObject:
    case SpirvOp::kCopyLogical: {
      const Value given = value(one.word(2));
      if (m_.type(given.type).kind == Kind::pointer) refuse("copies a pointer", "use what it points to");
      define(one.word(1), one.word(0), given.scalars);
      return true;
    }
    case SpirvOp::kUndef:
      define(one.word(1), one.word(0), zeros(one.word(0)));
      return true;
    default:
      return false;
  }
}

}  // namespace trueshade::programs
