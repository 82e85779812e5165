// Instructions that glslang does not make of light programs, which other compilers may; and what is refused.
#include <spirv-tools/libspirv.h>

#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "oracle/spirv_interpreter.h"
#include "tests/catch.hpp"

using namespace trueshade::oracle;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

uint32_t bits(float value) { return std::bit_cast<uint32_t>(value); }

std::vector<uint32_t> assembled(const std::string& text) {
  const spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_1);
  spv_binary binary = nullptr;
  spv_diagnostic diagnostic = nullptr;
  const spv_result_t result = spvTextToBinary(context, text.c_str(), text.size(), &binary, &diagnostic);
  const std::string said = diagnostic != nullptr ? diagnostic->error : "";
  std::vector<uint32_t> words;
  if (result == SPV_SUCCESS) words.assign(binary->code, binary->code + binary->wordCount);
  spvDiagnosticDestroy(diagnostic);
  spvBinaryDestroy(binary);
  spvContextDestroy(context);
  if (result != SPV_SUCCESS) throw std::logic_error(said + "\n" + text);
  return words;
}

/// A module that reads the members x (float), i (int), u (uint) and v (vec4) of the block In as %x, %i, %u, %v, and
/// stores %r, which has the type %of, into the one member r of the block Out.
std::string module_text(const std::string& of, const std::string& body, const std::string& more_types = "") {
  return R"(OpCapability Shader
%glsl = OpExtInstImport "GLSL.std.450"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main"
OpExecutionMode %main LocalSize 1 1 1
OpName %In "In"
OpMemberName %In 0 "x"
OpMemberName %In 1 "i"
OpMemberName %In 2 "u"
OpMemberName %In 3 "v"
OpName %Out "Out"
OpMemberName %Out 0 "r"
OpDecorate %In Block
OpDecorate %Out Block
%void = OpTypeVoid
%procedure = OpTypeFunction %void
%bool = OpTypeBool
%float = OpTypeFloat 32
%int = OpTypeInt 32 1
%uint = OpTypeInt 32 0
%vec4 = OpTypeVector %float 4
%fx = OpTypeStruct %float %int
%ff = OpTypeStruct %float %float
%p_float_f = OpTypePointer Function %float
%p_int_f = OpTypePointer Function %int
%p_vec4_f = OpTypePointer Function %vec4
%0 = OpConstant %int 0
%1 = OpConstant %int 1
%2 = OpConstant %int 2
%3 = OpConstant %int 3
%u0 = OpConstant %uint 0
%u1 = OpConstant %uint 1
%f0 = OpConstant %float 0
%f1 = OpConstant %float 1
)" + more_types +
         R"(
%In = OpTypeStruct %float %int %uint %vec4
%Out = OpTypeStruct )" +
         of + R"(
%p_In = OpTypePointer Uniform %In
%p_Out = OpTypePointer StorageBuffer %Out
%p_float = OpTypePointer Uniform %float
%p_int = OpTypePointer Uniform %int
%p_uint = OpTypePointer Uniform %uint
%p_vec4 = OpTypePointer Uniform %vec4
%p_r = OpTypePointer StorageBuffer )" +
         of + R"(
%in = OpVariable %p_In Uniform
%out = OpVariable %p_Out StorageBuffer
%main = OpFunction %void None %procedure
%start = OpLabel
%cell = OpVariable %p_float_f Function
%int_cell = OpVariable %p_int_f Function
%vec4_cell = OpVariable %p_vec4_f Function
%at_x = OpAccessChain %p_float %in %0
%x = OpLoad %float %at_x
%at_i = OpInBoundsAccessChain %p_int %in %1
%i = OpLoad %int %at_i
%at_u = OpAccessChain %p_uint %in %2
%u = OpLoad %uint %at_u
%at_v = OpAccessChain %p_vec4 %in %3
%v = OpLoad %vec4 %at_v
)" + body +
         R"(
%to = OpAccessChain %p_r %out %0
OpStore %to %r
OpReturn
OpFunctionEnd
)";
}

struct Given {
  float x = 0;
  int32_t i = 0;
  uint32_t u = 0;
  std::vector<float> v = {1, 2, 3, 4};
};

std::vector<uint32_t> result_of(const std::string& text, const Given& given = {}, uint64_t most_steps = 10000) {
  SpirvScalars inputs{{"In.x", {bits(given.x)}}, {"In.i", {uint32_t(given.i)}}, {"In.u", {given.u}}, {"In.v", {}}};
  for (const float value : given.v) inputs["In.v"].push_back(bits(value));
  return run_spirv(spirv_module(assembled(text)), inputs, most_steps).at("Out.r");
}

uint32_t real_result(const std::string& body, const Given& given = {}) {
  return result_of(module_text("%float", body), given)[0];
}
uint32_t int_result(const std::string& body, const Given& given = {}) {
  return result_of(module_text("%int", body), given)[0];
}

/// 1 where a comparison of x with 1 holds.
uint32_t compared(const std::string& opcode, float x) {
  return real_result("%c = " + opcode + " %bool %x %f1\n%r = OpSelect %float %c %f1 %f0", {x, 0, 0, {1, 2, 3, 4}}) ==
         bits(1);
}

}  // namespace

TEST_CASE("ordered comparisons of NaN are false in the oracle's interpreter, and unordered ones true") {
  for (const char* name : {"Equal", "NotEqual", "LessThan", "GreaterThan", "LessThanEqual", "GreaterThanEqual"}) {
    INFO(name);
    CHECK(compared(std::string("OpFOrd") + name, kNaN) == 0);
    CHECK(compared(std::string("OpFUnord") + name, kNaN) == 1);
    const std::string which = name;
    for (const float x : {0.5f, 1.0f, 2.0f}) {
      const bool holds = which == "Equal"           ? x == 1
                         : which == "NotEqual"      ? x != 1
                         : which == "LessThan"      ? x < 1
                         : which == "GreaterThan"   ? x > 1
                         : which == "LessThanEqual" ? x <= 1
                                                    : x >= 1;
      CHECK(compared(std::string("OpFOrd") + name, x) == holds);
      CHECK(compared(std::string("OpFUnord") + name, x) == holds);
    }
  }
}

TEST_CASE("remainders in the oracle's interpreter have the sign of the dividend, moduli that of the divisor") {
  const Given given{-5.5f, -7, 0, {1, 2, 3, 4}};
  CHECK(real_result("%three = OpFAdd %float %f1 %f1\n%t = OpFAdd %float %three %f1\n%r = OpFRem %float %x %t", given) ==
        bits(-2.5f));
  CHECK(real_result("%three = OpFAdd %float %f1 %f1\n%t = OpFAdd %float %three %f1\n%r = OpFMod %float %x %t", given) ==
        bits(0.5f));
  CHECK(int_result("%r = OpSRem %int %i %3", given) == uint32_t(-1));
  CHECK(int_result("%r = OpSMod %int %i %3", given) == 2);
  CHECK(int_result("%r = OpSRem %int %i %0", given) == 0);
}

TEST_CASE("the oracle's interpreter writes parts of composites") {
  CHECK(result_of(module_text("%vec4", "%r = OpVectorInsertDynamic %vec4 %v %x %u"), {9, 0, 77, {1, 2, 3, 4}})[3] ==
        bits(9));
  CHECK(result_of(module_text("%vec4", "%r = OpCompositeInsert %vec4 %x %v 1"), {9, 0, 0, {1, 2, 3, 4}})[1] == bits(9));
  CHECK(result_of(module_text("%vec4", "OpCopyMemory %vec4_cell %at_v\n%r = OpLoad %vec4 %vec4_cell"))[2] == bits(3));
  CHECK(result_of(module_text("%vec4", "%r = OpVectorShuffle %vec4 %v %v 7 0 0xFFFFFFFF 2")) ==
        std::vector<uint32_t>{bits(4), bits(1), 0, bits(3)});
  CHECK(result_of(module_text("%vec4", "%r = OpUndef %vec4")) == std::vector<uint32_t>(4, 0));
  CHECK(real_result("%r = OpLoad %float %cell") == 0);
  CHECK(result_of(module_text("%vec4", "%r = OpCopyObject %vec4 %n", "%n = OpConstantNull %vec4")) ==
        std::vector<uint32_t>(4, 0));
}

TEST_CASE("modf and frexp of the oracle's interpreter write through a pointer as well") {
  const Given given{-2.75f, 0, 0, {1, 2, 3, 4}};
  CHECK(real_result("%r = OpExtInst %float %glsl Modf %x %cell", given) == bits(-0.75f));
  CHECK(real_result("%m = OpExtInst %float %glsl Modf %x %cell\n%r = OpLoad %float %cell", given) == bits(-2));
  CHECK(real_result("%r = OpExtInst %float %glsl Frexp %x %int_cell", given) == bits(-0.6875f));
  CHECK(int_result("%m = OpExtInst %float %glsl Frexp %x %int_cell\n%r = OpLoad %int %int_cell", given) == 2);
  CHECK(real_result("%m = OpExtInst %ff %glsl ModfStruct %x\n%r = OpCompositeExtract %float %m 1", given) == bits(-2));
  CHECK(int_result("%m = OpExtInst %fx %glsl FrexpStruct %x\n%r = OpCompositeExtract %int %m 1", given) == 2);
}

TEST_CASE("a storage block marked in the way of SPIR-V 1.0 is an output as well") {
  std::string text = module_text("%float", "%r = OpFAdd %float %x %x");
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"OpDecorate %Out Block", "OpDecorate %Out BufferBlock"},
        {"%p_Out = OpTypePointer StorageBuffer", "%p_Out = OpTypePointer Uniform"},
        {"%p_r = OpTypePointer StorageBuffer", "%p_r = OpTypePointer Uniform"},
        {"%out = OpVariable %p_Out StorageBuffer", "%out = OpVariable %p_Out Uniform"}})
    text.replace(text.find(from), from.size(), to);
  CHECK(result_of(text, {3, 0, 0, {1, 2, 3, 4}})[0] == bits(6));
}

TEST_CASE("all phis of a block are read before one of them is written") {
  // a, b = 1, 2 change places twice three times; then r = 10 a + b with the last change undone: 10 * 2 + 1.
  const std::string swap = R"(OpBranch %head
%head = OpLabel
%a = OpPhi %int %1 %start %b %next
%b = OpPhi %int %2 %start %a %next
%n = OpPhi %int %0 %start %n1 %next
OpLoopMerge %done %next None
OpBranch %test
%test = OpLabel
%more = OpSLessThan %bool %n %3
OpBranchConditional %more %next %done
%next = OpLabel
%n1 = OpIAdd %int %n %1
OpBranch %head
%done = OpLabel
%ten = OpIMul %int %a %c10
%r = OpIAdd %int %ten %b)";
  CHECK(result_of(module_text("%int", swap, "%c10 = OpConstant %int 10"))[0] == 21);
}

TEST_CASE("the oracle's interpreter refuses what light programs do not have, by a message") {
  const auto refused = [](const std::string& text, const std::string& why) {
    INFO(text);
    CHECK_THROWS_WITH(result_of(text), Catch::Contains(why));
  };
  const std::string real = "%r = OpFAdd %float %x %x";
  refused(module_text("%float", real, "%double = OpTypeFloat 64"), "32 bits");
  refused(module_text("%float", real, "%short = OpTypeInt 16 0"), "32 bits");
  refused(module_text("%float", "%r = OpDPdx %float %x"), "opcode 207");
  refused(module_text("%float", real, "%image = OpTypeImage %float 2D 0 0 0 1 Unknown"), "opcode 25");
  refused(module_text("%float", "OpControlBarrier %u1 %u1 %u0\n" + real), "opcode 224");
  refused(module_text("%uint", "%r = OpAtomicIAdd %uint %at_u %u1 %u0 %u1"), "opcode 234");
  refused(module_text("%float", "%r = OpExtInst %float %glsl NMin %x %x"), "function 79");
  refused(module_text("%float", "%r = OpExtInst %float %glsl InterpolateAtCentroid %cell"), "function 76");
  refused(module_text("%float", "OpKill\n%dead = OpLabel\n" + real), "opcode 252");
  refused(
      module_text("%float",
                  "OpBranch %again\n%again = OpLabel\nOpLoopMerge %end %next None\nOpBranch %next\n%next = OpLabel\n"
                  "OpBranch %again\n%end = OpLabel\n" +
                      real),
      "does not end");
}

TEST_CASE("the oracle's interpreter refuses words that are no module and inputs that do not fit") {
  CHECK_THROWS_AS(spirv_module(std::vector<uint32_t>{}), std::runtime_error);
  CHECK_THROWS_AS(spirv_module(std::vector<uint32_t>(9, 0)), std::runtime_error);
  std::vector<uint32_t> words = assembled(module_text("%float", "%r = OpFAdd %float %x %x"));
  // Without OpFunctionEnd, and in the middle of the OpStore before OpReturn.
  CHECK_THROWS_WITH(spirv_module(std::span(words).first(words.size() - 1)), Catch::Contains("within a function"));
  CHECK_THROWS_WITH(spirv_module(std::span(words).first(words.size() - 3)), Catch::Contains("length is wrong"));
  const SpirvModule module = spirv_module(words);
  const SpirvScalars all{{"In.x", {bits(3)}}, {"In.i", {0}}, {"In.u", {0}}, {"In.v", {0, 0, 0, 0}}, {"Other.z", {5}}};
  CHECK(run_spirv(module, all).at("Out.r") == std::vector<uint32_t>{bits(6)});
  CHECK(run_spirv(module, {{"In", {bits(4), 0, 0, 0, 0, 0, 0}}}).at("Out.r") == std::vector<uint32_t>{bits(8)});
  SpirvScalars one_less = all, longer = all;
  one_less.erase("In.u"), longer["In.u"] = {0, 0};
  CHECK_THROWS_WITH(run_spirv(module, one_less), Catch::Contains("In lacks an input"));
  CHECK_THROWS_WITH(run_spirv(module, longer), Catch::Contains("In.u is of another length"));
}
