#pragma once
// Faults that were written before anybody who wrote them knew how the diagnosis looks for faults: a trial of what it
// says of a renderer that it was not made for.
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// A scene and the pipeline that draws it as it should be.
struct Subject {
  std::string_view name;
  Scene scene;
  Pipeline pipeline;
};

struct UnseenFault {
  std::string_view name;
  std::string_view what;      ///< what the engineer did
  std::string_view accepted;  ///< names that a fair reader takes for right, without numbers; `-`: none that is known
  std::string_view subjects;  ///< names of those where it can happen
  std::function<oracle::Capture(const Subject&)> draw;
};

std::vector<UnseenFault> unseen_faults_of_scenes();
std::vector<UnseenFault> unseen_faults_of_lights();
std::vector<UnseenFault> unseen_faults_of_planes();
std::vector<UnseenFault> unseen_faults_of_pictures();
std::vector<UnseenFault> unseen_faults();  ///< all of them
/// More of them, by somebody who had read how the diagnosis looks for faults.
std::vector<UnseenFault> unseen_faults_of_the_second_list();

Subject subject_named(std::string_view name);  ///< city, cornell, lecture, atrium or box, cornell with glass

/// What the judge says of a fault.
struct Trial {
  int changed = 0;  ///< pixels of the picture or of a plane that differ from those of the right frame
  bool convicted = false;
  std::string first = "no fault that is known";
  double explained = 0;   ///< the share that the first name explains
  bool accepted = false;  ///< the first name, or one that is said to be as good, is one that a fair reader takes
  bool misnamed() const { return convicted && !accepted && explained > 0.5; }
};
Trial tried(const UnseenFault& fault, const Subject& subject);

}  // namespace trueshade::testing
