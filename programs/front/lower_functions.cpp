#include "programs/front/lowering.h"

namespace trueshade::programs {

void Lowering::extended(const SpirvInstruction& one) {
  if (m_.glsl_functions == 0 || one.word(2) != m_.glsl_functions) return;  // non-semantic, as spirv_module() has seen
  glsl_function(GlslFunction(one.word(3)), one);
}

namespace {

/// The name of a function of GLSL.std.450 that is refused.
std::string refused_name(uint32_t function) {
  switch (function) {
    case 59:
      return "PackDouble2x32";
    case 65:
      return "UnpackDouble2x32";
    case 76:
      return "InterpolateAtCentroid";
    case 77:
      return "InterpolateAtSample";
    case 78:
      return "InterpolateAtOffset";
    case 79:
      return "NMin";
    case 80:
      return "NMax";
    case 81:
      return "NClamp";
    default:
      return "function " + std::to_string(function);
  }
}

}  // namespace

void Lowering::glsl_function(GlslFunction function, const SpirvInstruction& one) {
  if (elementwise_function(function, one) || vector_function(function, one) || packing_function(function, one)) return;
  refuse("calls " + refused_name(uint32_t(function)) + " of GLSL.std.450, which a light program cannot have",
         "write it without");
}

/// Functions of each component by itself.
bool Lowering::elementwise_function(GlslFunction function, const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32, kI = Kind::i32;
  const auto f1 = [&](Op op) { return map_1(one, 4, kF, kF, op), true; };
  const auto f2 = [&](Op op) { return map_2(one, 4, kF, kF, op), true; };
  /// Each component of the arguments, one after the other.
  const auto each = [&](Kind kind, size_t arguments, const auto& made) {
    const size_t count = result_count(one, kind);
    for (size_t a = 0; a < arguments; ++a) operand(one, 4 + a, kind, count);
    Scalars out;
    for (size_t i = 0; i < count; ++i) out.push_back(made([&](size_t a) { return value(one.word(4 + a)).scalars[i]; }));
    return define(one.word(1), one.word(0), std::move(out)), true;
  };
  const auto integers = [&](bool is_signed, bool least) {
    return each(kI, 2, [&](const auto& x) { return c_.chosen_int(x(0), x(1), is_signed, least); });
  };
  const auto clamped = [&](bool is_signed) {
    return each(kI, 3, [&](const auto& x) {
      return c_.chosen_int(c_.chosen_int(x(0), x(1), is_signed, false), x(2), is_signed, true);
    });
  };
  switch (function) {
    case GlslFunction::kRound:
    case GlslFunction::kRoundEven:
      return f1(Op::f_round);
    case GlslFunction::kTrunc:
      return f1(Op::f_trunc);
    case GlslFunction::kFloor:
      return f1(Op::f_floor);
    case GlslFunction::kCeil:
      return f1(Op::f_ceil);
    case GlslFunction::kFAbs:
      return f1(Op::f_abs);
    case GlslFunction::kSin:
      return f1(Op::sin);
    case GlslFunction::kCos:
      return f1(Op::cos);
    case GlslFunction::kTan:
      return f1(Op::tan);
    case GlslFunction::kAsin:
      return f1(Op::asin);
    case GlslFunction::kAcos:
      return f1(Op::acos);
    case GlslFunction::kAtan:
      return f1(Op::atan);
    case GlslFunction::kSinh:
      return f1(Op::sinh);
    case GlslFunction::kCosh:
      return f1(Op::cosh);
    case GlslFunction::kTanh:
      return f1(Op::tanh);
    case GlslFunction::kAsinh:
      return f1(Op::asinh);
    case GlslFunction::kAcosh:
      return f1(Op::acosh);
    case GlslFunction::kAtanh:
      return f1(Op::atanh);
    case GlslFunction::kExp:
      return f1(Op::exp);
    case GlslFunction::kLog:
      return f1(Op::log);
    case GlslFunction::kExp2:
      return f1(Op::exp2);
    case GlslFunction::kLog2:
      return f1(Op::log2);
    case GlslFunction::kSqrt:
      return f1(Op::f_sqrt);
    case GlslFunction::kAtan2:
      return f2(Op::atan2);
    case GlslFunction::kPow:
      return f2(Op::pow);
    case GlslFunction::kFMin:
      return f2(Op::f_min);
    case GlslFunction::kFMax:
      return f2(Op::f_max);
    case GlslFunction::kFSign:
      return each(kF, 1, [&](const auto& x) { return c_.sign(x(0)); });
    case GlslFunction::kFract:
      return each(kF, 1, [&](const auto& x) { return c_.fract(x(0)); });
    case GlslFunction::kRadians:
      return each(kF, 1, [&](const auto& x) { return c_.degrees_of(x(0), 0.017453292519943295f); });
    case GlslFunction::kDegrees:
      return each(kF, 1, [&](const auto& x) { return c_.degrees_of(x(0), 57.29577951308232f); });
    case GlslFunction::kInverseSqrt:
      return each(kF, 1, [&](const auto& x) { return c_.inverse_root(x(0)); });
    case GlslFunction::kFClamp:
      return each(kF, 3, [&](const auto& x) { return c_.clamp(x(0), x(1), x(2)); });
    case GlslFunction::kFMix:
      return each(kF, 3, [&](const auto& x) { return c_.mix(x(0), x(1), x(2)); });
    case GlslFunction::kStep:
      return each(kF, 2, [&](const auto& x) { return c_.step(x(0), x(1)); });
    case GlslFunction::kSmoothStep:
      return each(kF, 3, [&](const auto& x) { return c_.smoothstep(x(0), x(1), x(2)); });
    case GlslFunction::kFma:
      return each(kF, 3, [&](const auto& x) { return b_.make(Op::f_fma, x(0), x(1), x(2)); });
    case GlslFunction::kSAbs:
      return each(kI, 1, [&](const auto& x) { return c_.int_abs(x(0)); });
    case GlslFunction::kSSign:
      return each(kI, 1, [&](const auto& x) { return c_.int_sign(x(0)); });
    case GlslFunction::kUMin:
      return integers(false, true);
    case GlslFunction::kSMin:
      return integers(true, true);
    case GlslFunction::kUMax:
      return integers(false, false);
    case GlslFunction::kSMax:
      return integers(true, false);
    case GlslFunction::kUClamp:
      return clamped(false);
    case GlslFunction::kSClamp:
      return clamped(true);
    case GlslFunction::kFindILsb:
      return map_1(one, 4, kI, kI, Op::lowest_bit), true;
    case GlslFunction::kFindUMsb:
      return map_1(one, 4, kI, kI, Op::highest_bit), true;
    case GlslFunction::kFindSMsb:
      return each(kI, 1, [&](const auto& x) { return c_.int_highest_bit(x(0)); });
    default:
      return false;
  }
}

/// Functions of whole vectors and matrices.
bool Lowering::vector_function(GlslFunction function, const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32;
  const auto made = [&](Scalars scalars) { return define(one.word(1), one.word(0), std::move(scalars)), true; };
  const auto first = [&]() -> const Scalars& { return operand(one, 4, kF); };
  const auto other = [&](size_t i) -> const Scalars& { return operand(one, 4 + i, kF, first().size()); };
  const auto matrix_size = [&]() -> size_t {
    const SpirvType& type = m_.type(value(one.word(4)).type);
    if (type.kind != Kind::matrix || m_.type(type.element).count != type.count)
      refuse_damage("a matrix that is no square");
    return type.count;
  };
  switch (function) {
    case GlslFunction::kLength:
      return made({c_.length(first())});
    case GlslFunction::kDistance:
      return made({c_.length(c_.difference(first(), other(1)))});
    case GlslFunction::kCross:
      return made(c_.cross(operand(one, 4, kF, 3), operand(one, 5, kF, 3)));
    case GlslFunction::kNormalize:
      return made(c_.normalize(first()));
    case GlslFunction::kFaceForward:
      return made(c_.face_forward(first(), other(1), other(2)));
    case GlslFunction::kReflect:
      return made(c_.reflect(first(), other(1)));
    case GlslFunction::kRefract:
      return made(c_.refract(first(), other(1), operand(one, 6, kF, 1)[0]));
    case GlslFunction::kDeterminant:
      return made({c_.determinant(first(), matrix_size())});
    case GlslFunction::kMatrixInverse:
      return made(c_.inverse(first(), matrix_size()));
    default:
      return false;
  }
}

bool Lowering::packing_function(GlslFunction function, const SpirvInstruction& one) {
  constexpr Kind kF = Kind::f32, kI = Kind::i32;
  const auto made = [&](Scalars scalars) { return define(one.word(1), one.word(0), std::move(scalars)), true; };
  const auto packed = [&](size_t codes, bool is_signed) {
    return made({c_.packed_fixed(operand(one, 4, kF, codes), is_signed)});
  };
  const auto unpacked = [&](size_t codes, bool is_signed) {
    return made(c_.unpacked_fixed(operand(one, 4, kI, 1)[0], codes, is_signed));
  };
  switch (function) {
    case GlslFunction::kPackSnorm4x8:
      return packed(4, true);
    case GlslFunction::kPackUnorm4x8:
      return packed(4, false);
    case GlslFunction::kPackSnorm2x16:
      return packed(2, true);
    case GlslFunction::kPackUnorm2x16:
      return packed(2, false);
    case GlslFunction::kUnpackSnorm4x8:
      return unpacked(4, true);
    case GlslFunction::kUnpackUnorm4x8:
      return unpacked(4, false);
    case GlslFunction::kUnpackSnorm2x16:
      return unpacked(2, true);
    case GlslFunction::kUnpackUnorm2x16:
      return unpacked(2, false);
    case GlslFunction::kPackHalf2x16:
      return made({c_.packed_halves(operand(one, 4, kF, 2))});
    case GlslFunction::kUnpackHalf2x16:
      return made(c_.unpacked_halves(operand(one, 4, kI, 1)[0]));
    case GlslFunction::kLdexp: {
      const Scalars& x = operand(one, 4, kF);
      const Scalars& n = operand(one, 5, kI, x.size());
      Scalars out;
      for (size_t i = 0; i < x.size(); ++i) out.push_back(b_.make(Op::ldexp, x[i], n[i]));
      return made(std::move(out));
    }
    case GlslFunction::kModf:
    case GlslFunction::kModfStruct:
    case GlslFunction::kFrexp:
    case GlslFunction::kFrexpStruct:
      return two_results(function, one), true;
    default:
      return false;
  }
}

/// modf and frexp: the second result is the structure's second member, or goes where a pointer says.
void Lowering::two_results(GlslFunction function, const SpirvInstruction& one) {
  const bool splits = function == GlslFunction::kModf || function == GlslFunction::kModfStruct;
  Scalars first, second;
  for (const NodeId x : operand(one, 4, Kind::f32)) {
    const NodeId whole = splits ? b_.make(Op::f_trunc, x) : b_.make(Op::f_exponent, x);
    first.push_back(splits ? b_.make(Op::f_sub, x, whole) : b_.make(Op::f_significand, x));
    second.push_back(whole);
  }
  if (function == GlslFunction::kModfStruct || function == GlslFunction::kFrexpStruct) {
    first.insert(first.end(), second.begin(), second.end());
  } else {
    const Pointer& to = pointer_of(one.word(5));
    if (m_.type(m_.type(value(one.word(5)).type).element).scalars != second.size())
      refuse_damage("a result of another size");
    store(to, second);
  }
  define(one.word(1), one.word(0), std::move(first));
}

}  // namespace trueshade::programs
