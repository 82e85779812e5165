#include "programs/front/block_order.h"

#include <algorithm>

namespace trueshade::programs {

size_t BlockOrder::at(uint32_t label) const {
  const auto found = position.find(label);
  if (found == position.end()) refuse_damage("a branch leads to no block");
  return found->second;
}

bool has_result(SpirvOp op) {
  switch (op) {
    case SpirvOp::kStore:
    case SpirvOp::kCopyMemory:
    case SpirvOp::kSelectionMerge:
    case SpirvOp::kLoopMerge:
    case SpirvOp::kBranch:
    case SpirvOp::kBranchConditional:
    case SpirvOp::kSwitch:
    case SpirvOp::kReturn:
    case SpirvOp::kReturnValue:
    case SpirvOp::kUnreachable:
      return false;
    default:
      return true;
  }
}

std::vector<uint32_t> targets_of(const SpirvInstruction& terminator) {
  switch (terminator.op()) {
    case SpirvOp::kBranch:
      return {terminator.word(0)};
    case SpirvOp::kBranchConditional:
      return {terminator.word(1), terminator.word(2)};
    case SpirvOp::kSwitch: {
      std::vector<uint32_t> out{terminator.word(1)};
      for (size_t i = 2; i < terminator.size(); i += 2) out.push_back(terminator.word(i + 1));
      return out;
    }
    default:
      return {};
  }
}

namespace {

/// Depth first, merge and continue blocks before the others, so that in the reverse order of leaving they come last.
class OrderMaker {
 public:
  OrderMaker(const SpirvModule& module, const SpirvFunction& function) : module_(module), function_(function) {
    for (size_t i = 0; i < function.blocks.size(); ++i)
      if (!number_.emplace(function.blocks[i].label, i).second) refuse_damage("a label stands twice");
  }

  BlockOrder make() {
    visit();
    std::reverse(out_.block.begin(), out_.block.end());
    for (size_t i = 0; i < out_.block.size(); ++i) out_.position[function_.blocks[out_.block[i]].label] = i;
    check();
    find_outliving();
    return std::move(out_);
  }

 private:
  struct Visit {
    size_t block;
    std::vector<uint32_t> next;  // labels, the first to visit last
  };

  size_t number_of(uint32_t label) const {
    const auto found = number_.find(label);
    if (found == number_.end()) refuse_damage("a branch leads to no block");
    return found->second;
  }

  Visit visit_of(size_t block) const {
    const SpirvBlock& b = function_.blocks[block];
    Visit out{block, targets_of(module_.instructions[b.end - 1])};
    if (b.continue_label != 0) out.next.push_back(b.continue_label);
    if (b.merge != 0) out.next.push_back(b.merge);
    return out;
  }

  void visit() {
    std::vector<bool> seen(function_.blocks.size());
    std::vector<Visit> open;
    seen[0] = true;
    open.push_back(visit_of(0));
    while (!open.empty()) {
      if (open.back().next.empty()) {
        out_.block.push_back(open.back().block);
        open.pop_back();
        continue;
      }
      const size_t next = number_of(open.back().next.back());
      open.back().next.pop_back();
      if (seen[next]) continue;
      seen[next] = true;
      open.push_back(visit_of(next));
    }
  }

  /// Headers lie before their continue and merge blocks, and only loops go back.
  void check() const {
    for (size_t i = 0; i < out_.block.size(); ++i) {
      const SpirvBlock& b = function_.blocks[out_.block[i]];
      if (b.merge != 0 && out_.at(b.merge) <= i) refuse_damage("a construct ends before it begins");
      if (b.continue_label != 0 && (out_.at(b.continue_label) < i || out_.at(b.continue_label) >= out_.at(b.merge)))
        refuse_damage("a loop goes on outside itself");
      for (const uint32_t target : targets_of(module_.instructions[b.end - 1])) {
        const size_t to = out_.at(target);
        if (to <= i && function_.blocks[out_.block[to]].continue_label == 0) refuse_damage("a branch goes back");
      }
    }
  }

  void find_outliving() {
    std::unordered_map<uint32_t, size_t> end_of;  // for each id made in a loop, where the innermost such loop ends
    std::vector<size_t> ends;
    for (size_t i = 0; i < out_.block.size(); ++i) {
      const SpirvBlock& b = function_.blocks[out_.block[i]];
      while (!ends.empty() && ends.back() <= i) ends.pop_back();
      if (b.continue_label != 0) ends.push_back(out_.at(b.merge));
      for (size_t k = b.first; k < b.end; ++k) {
        const SpirvInstruction& one = module_.instructions[k];
        for (const uint32_t word : one.operands)
          if (const auto found = end_of.find(word); found != end_of.end() && found->second <= i)
            if (out_.outlives_loop.insert(word).second) out_.outliving[found->second].push_back(word);
        if (has_result(one.op()) && !ends.empty() && one.size() > 1) end_of[one.word(1)] = ends.back();
      }
    }
  }

  const SpirvModule& module_;
  const SpirvFunction& function_;
  std::unordered_map<uint32_t, size_t> number_;
  BlockOrder out_;
};

}  // namespace

BlockOrder block_order(const SpirvModule& module, const SpirvFunction& function) {
  if (function.blocks.empty()) refuse("calls a function without a body", "define it");
  return OrderMaker(module, function).make();
}

}  // namespace trueshade::programs
