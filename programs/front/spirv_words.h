#pragma once
#include <cstdint>

// Numbers of the SPIR-V specification, version 1.3, section 3, under its names: those that light programs may have.
namespace trueshade::programs {

inline constexpr uint32_t kSpirvMagic = 0x07230203;

// clang-format off
enum class SpirvOp : uint32_t {
  kNop = 0, kUndef = 1, kSourceContinued = 2, kSource = 3, kSourceExtension = 4, kName = 5, kMemberName = 6,
  kString = 7, kLine = 8, kExtension = 10, kExtInstImport = 11, kExtInst = 12, kMemoryModel = 14, kEntryPoint = 15,
  kExecutionMode = 16, kCapability = 17, kTypeVoid = 19, kTypeBool = 20, kTypeInt = 21, kTypeFloat = 22,
  kTypeVector = 23, kTypeMatrix = 24, kTypeArray = 28, kTypeStruct = 30, kTypePointer = 32, kTypeFunction = 33,
  kConstantTrue = 41, kConstantFalse = 42, kConstant = 43, kConstantComposite = 44, kConstantNull = 46,
  kSpecConstantTrue = 48, kSpecConstantFalse = 49, kSpecConstant = 50, kSpecConstantComposite = 51, kFunction = 54,
  kFunctionParameter = 55, kFunctionEnd = 56, kFunctionCall = 57, kVariable = 59, kLoad = 61, kStore = 62,
  kCopyMemory = 63, kAccessChain = 65, kInBoundsAccessChain = 66, kDecorate = 71, kMemberDecorate = 72,
  kVectorExtractDynamic = 77, kVectorInsertDynamic = 78, kVectorShuffle = 79, kCompositeConstruct = 80,
  kCompositeExtract = 81, kCompositeInsert = 82, kCopyObject = 83, kTranspose = 84, kConvertFToU = 109,
  kConvertFToS = 110, kConvertSToF = 111, kConvertUToF = 112, kUConvert = 113, kSConvert = 114, kBitcast = 124,
  kSNegate = 126, kFNegate = 127, kIAdd = 128, kFAdd = 129, kISub = 130, kFSub = 131, kIMul = 132, kFMul = 133,
  kUDiv = 134, kSDiv = 135, kFDiv = 136, kUMod = 137, kSRem = 138, kSMod = 139, kFRem = 140, kFMod = 141,
  kVectorTimesScalar = 142, kMatrixTimesScalar = 143, kVectorTimesMatrix = 144, kMatrixTimesVector = 145,
  kMatrixTimesMatrix = 146, kOuterProduct = 147, kDot = 148, kIAddCarry = 149, kISubBorrow = 150,
  kUMulExtended = 151, kSMulExtended = 152, kAny = 154, kAll = 155, kIsNan = 156, kIsInf = 157, kLogicalEqual = 164,
  kLogicalNotEqual = 165, kLogicalOr = 166, kLogicalAnd = 167, kLogicalNot = 168, kSelect = 169, kIEqual = 170,
  kINotEqual = 171, kUGreaterThan = 172, kSGreaterThan = 173, kUGreaterThanEqual = 174, kSGreaterThanEqual = 175,
  kULessThan = 176, kSLessThan = 177, kULessThanEqual = 178, kSLessThanEqual = 179, kFOrdEqual = 180,
  kFUnordEqual = 181, kFOrdNotEqual = 182, kFUnordNotEqual = 183, kFOrdLessThan = 184, kFUnordLessThan = 185,
  kFOrdGreaterThan = 186, kFUnordGreaterThan = 187, kFOrdLessThanEqual = 188, kFUnordLessThanEqual = 189,
  kFOrdGreaterThanEqual = 190, kFUnordGreaterThanEqual = 191, kShiftRightLogical = 194, kShiftRightArithmetic = 195,
  kShiftLeftLogical = 196, kBitwiseOr = 197, kBitwiseXor = 198, kBitwiseAnd = 199, kNot = 200, kBitFieldInsert = 201,
  kBitFieldSExtract = 202, kBitFieldUExtract = 203, kBitReverse = 204, kBitCount = 205, kPhi = 245, kLoopMerge = 246,
  kSelectionMerge = 247, kLabel = 248, kBranch = 249, kBranchConditional = 250, kSwitch = 251, kKill = 252,
  kReturn = 253,
  kReturnValue = 254, kUnreachable = 255, kNoLine = 317, kModuleProcessed = 330, kExecutionModeId = 331,
  kDecorateId = 332, kCopyLogical = 400, kDecorateString = 5632, kMemberDecorateString = 5633,
};

/// The extended instruction set GLSL.std.450.
enum class GlslFunction : uint32_t {
  kRound = 1, kRoundEven = 2, kTrunc = 3, kFAbs = 4, kSAbs = 5, kFSign = 6, kSSign = 7, kFloor = 8, kCeil = 9,
  kFract = 10, kRadians = 11, kDegrees = 12, kSin = 13, kCos = 14, kTan = 15, kAsin = 16, kAcos = 17, kAtan = 18,
  kSinh = 19, kCosh = 20, kTanh = 21, kAsinh = 22, kAcosh = 23, kAtanh = 24, kAtan2 = 25, kPow = 26, kExp = 27,
  kLog = 28, kExp2 = 29, kLog2 = 30, kSqrt = 31, kInverseSqrt = 32, kDeterminant = 33, kMatrixInverse = 34,
  kModf = 35, kModfStruct = 36, kFMin = 37, kUMin = 38, kSMin = 39, kFMax = 40, kUMax = 41, kSMax = 42, kFClamp = 43,
  kUClamp = 44, kSClamp = 45, kFMix = 46, kStep = 48, kSmoothStep = 49, kFma = 50, kFrexp = 51, kFrexpStruct = 52,
  kLdexp = 53, kPackSnorm4x8 = 54, kPackUnorm4x8 = 55, kPackSnorm2x16 = 56, kPackUnorm2x16 = 57, kPackHalf2x16 = 58,
  kUnpackSnorm2x16 = 60, kUnpackUnorm2x16 = 61, kUnpackHalf2x16 = 62, kUnpackSnorm4x8 = 63, kUnpackUnorm4x8 = 64,
  kLength = 66, kDistance = 67, kCross = 68, kNormalize = 69, kFaceForward = 70, kReflect = 71, kRefract = 72,
  kFindILsb = 73, kFindSMsb = 74, kFindUMsb = 75,
};
// clang-format on

enum class SpirvStorage : uint32_t { uniform = 2, output = 3, private_ = 6, function = 7, storage_buffer = 12 };

inline constexpr uint32_t kDecorationNoContraction = 42;
inline constexpr uint32_t kModelGlCompute = 5;

}  // namespace trueshade::programs
