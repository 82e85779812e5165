#pragma once
#include <string>

#include "cli/pages/viewer.h"
#include "cli/validation.h"

namespace trueshade {

// Parts of a validation's page that a comparison's page shows too, where its test was judged.

/// What explains a capture that does not pass; nothing where nothing does.
std::string diagnosis_part(const Validation& validation);

/// Each stage: its classes, the tests of the whole image, the worst pixels.
std::string stages_part(const Validation& validation);

/// Adds the maps of classes, the places worth a look and what the judge knows of single pixels. `under`: the layer that
/// classes which are switched off show; or empty. The validation must outlive the viewer.
void add_judgement(const Validation& validation, PageViewer& viewer, const std::string& under);

}  // namespace trueshade
