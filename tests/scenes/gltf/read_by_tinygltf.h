#pragma once
#include <tiny_gltf.h>

#include <string>

#include "tests/catch.hpp"

namespace trueshade {

/// A .gltf or .glb file as tinygltf reads it, which must find nothing to complain about. Pictures are not decoded.
inline tinygltf::Model read_by_tinygltf(const std::string& path) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
                           void*) { return true; },
                        nullptr);
  std::string error, warning;
  const bool good = path.ends_with(".glb") ? loader.LoadBinaryFromFile(&model, &error, &warning, path)
                                           : loader.LoadASCIIFromFile(&model, &error, &warning, path);
  INFO(error);
  REQUIRE(good);
  CHECK(error.empty());
  CHECK(warning.empty());
  return model;
}

}  // namespace trueshade
