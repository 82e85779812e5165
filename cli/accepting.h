#pragma once
#include <string>

#include "core/image_files/picture_file.h"

namespace trueshade {

/// Copies a test picture over its reference, byte by byte, whole or not at all; makes the reference's folder.
/// Error(io) where it cannot.
void accept_picture(const std::string& test, const std::string& reference);

/// Why a picture must not become a reference: it has values that are not finite. Empty where it may.
std::string why_not_acceptable(const PictureFile& picture, bool allow_not_finite);

}  // namespace trueshade
