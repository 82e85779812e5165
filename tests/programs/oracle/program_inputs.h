#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenes/builtin/pcg32.h"

namespace trueshade::testing {

/// One member of the blocks that a light program reads.
struct ProgramInput {
  std::string name;  ///< "TsSurface.ts_surface.position"
  char base = 'f';   ///< f, i or u: floats, signed or unsigned integers
  int scalars = 1;
  const char* kind = "";          ///< what plain scenes have there: see plain_value()
  int elements = 0, columns = 1;  ///< of an array (0: none), and of a matrix or of the array's matrices
};

/// All members of Surface, Light and View, and the sum, in the order of the contract.
std::span<const ProgramInput> interface_inputs();

/// How far from plain scenes inputs are.
enum class InputsLike {
  plain,  ///< unit normals, colours in [0, 1], positions and ranges of a few units, real matrices
  mixed,  ///< plain, but one member in four has zeros of either sign, denormals, NaN, infinities, huge and tiny numbers
  any_bits  ///< every scalar is 32 random bits, or one of those
};

/// Values of all inputs, 32 bits a scalar, by name. `more` are members of a block of parameters.
std::map<std::string, std::vector<uint32_t>> random_inputs(Pcg32& random, InputsLike like,
                                                           std::span<const ProgramInput> more = {});

}  // namespace trueshade::testing
