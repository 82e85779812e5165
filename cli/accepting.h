#pragma once
#include <string>

#include "core/image_files/picture_file.h"

namespace trueshade {

/// Copies a test picture over its reference, byte by byte, whole or not at all; makes the reference's folder. Writes
/// through no link: references may come from anybody, and a link may lead to any file of the user. `within`: the folder
/// of all references, out of which none may lie; empty for one that the user has named. Error(io) where it cannot,
/// Error(bad_input) for a link.
void accept_picture(const std::string& test, const std::string& reference, const std::string& within = "");

/// Why a picture must not become a reference: it has values that are not finite. Empty where it may.
std::string why_not_acceptable(const PictureFile& picture, bool allow_not_finite);

}  // namespace trueshade
