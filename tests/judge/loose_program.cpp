#include "tests/judge/loose_program.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace trueshade::testing {

using programs::NodeId;
using programs::Op;

namespace {

constexpr double kUlp = 0x1p-23;

}  // namespace

std::vector<double> LooseProgram::outputs(const std::function<double(const std::string&)>& input) {
  value_.assign(program_.nodes.size(), 0);
  for (NodeId id = 0; id < program_.nodes.size(); ++id) {
    const programs::ProgramNode& node = program_.nodes[id];
    if (node.op == Op::input)
      value_[id] = input(program_.inputs[node.bits].name);
    else if (node.op == Op::constant)
      value_[id] = node.type == programs::Type::f32   ? double(std::bit_cast<float>(node.bits))
                   : node.type == programs::Type::i32 ? double(int32_t(node.bits))
                                                      : double(node.bits);
    else
      value_[id] = compute(id);
  }
  std::vector<double> out;
  for (const NodeId id : program_.output) out.push_back(value_[id]);
  return out;
}

/// Either float beside a number, and now and then 0 for a tiny one.
double LooseProgram::rounded(double x) {
  if (!std::isfinite(x)) return x;
  if (std::fabs(x) < 0x1p-126 && random_.below(2) == 0) return 0;
  const float nearest = float(x);
  if (double(nearest) == x || random_.below(2) == 0) return nearest;
  return double(std::nextafter(nearest, double(nearest) < x ? HUGE_VALF : -HUGE_VALF));
}

void LooseProgram::gather(NodeId id, double sign, std::vector<double>& terms) {
  const programs::ProgramNode& node = program_.nodes[id];
  const auto& [a, b, c] = node.operand;
  if ((node.op == Op::f_add || node.op == Op::f_sub) && random_.below(3) != 0) {
    gather(a, sign, terms);
    return gather(b, node.op == Op::f_sub ? -sign : sign, terms);
  }
  const bool fused = node.op == Op::f_mul && random_.below(2) == 0;
  terms.push_back(sign * (fused ? value(a) * value(b) : value(id)));
}

double LooseProgram::sum(NodeId id) {
  const programs::ProgramNode& node = program_.nodes[id];
  std::vector<double> terms;
  gather(node.operand[0], 1, terms);
  gather(node.operand[1], node.op == Op::f_sub ? -1 : 1, terms);
  while (terms.size() > 1) {  // any two
    std::swap(terms[random_.below(uint32_t(terms.size()))], terms.back());
    const double last = terms.back();
    terms.pop_back();
    double& other = terms[random_.below(uint32_t(terms.size()))];
    other = rounded(other + last);
  }
  return rounded(terms[0]);
}

double LooseProgram::logarithm(double x) {
  const double exact = std::log2(x);
  return x >= 0.5 && x <= 2 ? rounded(exact + 0x1p-21 * 0.98 * random_.between(-1, 1))
                            : off(exact, (2.9 + more_) * kUlp);
}

double LooseProgram::exponential(double x) { return off(std::exp2(x), (2.9 + more_ + 2 * std::fabs(x)) * kUlp); }

double LooseProgram::quotient(double x, double y) { return off(x / y, (2.4 + more_) * kUlp); }

double LooseProgram::inverse_root(double x) { return off(1 / std::sqrt(x), (1.9 + more_) * kUlp); }

double LooseProgram::root(double x) { return more_ > 0 ? quotient(1, inverse_root(x)) : off(std::sqrt(x), 4.4 * kUlp); }

/// What normalize() is made of: l2 > 0 ? inversesqrt(l2) : 0.
bool LooseProgram::normalizes(const programs::ProgramNode& node) const {
  const programs::ProgramNode& otherwise = program_.nodes[node.operand[2]];
  return program_.nodes[node.operand[1]].op == Op::f_inverse_sqrt && otherwise.op == Op::constant &&
         otherwise.bits == 0;
}

double LooseProgram::compute(NodeId id) {
  const programs::ProgramNode& node = program_.nodes[id];
  const double a = node.operand[0] < value_.size() ? value(node.operand[0]) : 0;
  const double b = node.operand[1] < value_.size() ? value(node.operand[1]) : 0;
  switch (node.op) {
    case Op::f_add:
    case Op::f_sub:
      return sum(id);
    case Op::f_mul:
      return rounded(a * b);
    case Op::f_div:
      return quotient(a, b);
    case Op::f_sqrt:
      return root(a);
    case Op::f_inverse_sqrt:
      return inverse_root(a);
    case Op::f_floor:
      return std::floor(a);
    case Op::f_neg:
      return -a;
    case Op::f_abs:
      return std::fabs(a);
    case Op::f_min:
      return std::min(a, b);
    case Op::f_max:
      return std::max(a, b);
    case Op::f_eq:
    case Op::i_eq:
      return a == b;
    case Op::f_ne:
      return a != b;
    case Op::f_lt:
    case Op::i_lt:
    case Op::u_lt:
      return a < b;
    case Op::f_le:
      return a <= b;
    case Op::select:
      if (a != 0 && more_ > 0 && normalizes(node))
        return quotient(1, root(value(program_.nodes[node.operand[1]].operand[0])));
      return a != 0 ? b : value(node.operand[2]);
    case Op::b_and:
      return a != 0 && b != 0;
    case Op::b_or:
      return a != 0 || b != 0;
    case Op::b_xor:
      return (a != 0) != (b != 0);
    case Op::b_not:
      return a == 0;
    case Op::i_to_f:
    case Op::u_to_f:
      return rounded(a);
    case Op::u_rem:
      return std::fmod(a, b);
    case Op::exp2:
      return exponential(a);
    case Op::exp:
      return off(std::exp(a), (2.9 + more_ + 2 * std::fabs(a)) * kUlp);
    case Op::log2:
      return logarithm(a);
    case Op::log:
      return rounded(std::log(a) +
                     (a >= 0.5 && a <= 2 ? 0x1p-21 * 0.98 : (2.9 + more_) * kUlp * std::fabs(std::log(a))) *
                         random_.between(-1, 1));
    case Op::pow:
      return a == 0 ? 0 : exponential(rounded(b * logarithm(a)));
    case Op::sin:
      return rounded(std::sin(a) + 0x1p-11 * random_.between(-1, 1));
    case Op::cos:
      return rounded(std::cos(a) + 0x1p-11 * random_.between(-1, 1));
    case Op::atan2:
      return off(std::atan2(a, b), 4000 * kUlp);
    case Op::acos:
      return off(std::atan2(rounded(std::sqrt(std::max(0.0, 1 - a * a))), a), 4000 * kUlp);
    default:
      throw std::logic_error("the loose driver has no " + std::string(info(node.op).name));
  }
}

}  // namespace trueshade::testing
