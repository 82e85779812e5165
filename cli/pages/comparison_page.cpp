#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/compared_pictures.h"
#include "cli/pages/channel_layers.h"
#include "cli/pages/page.h"
#include "cli/pages/validation_parts.h"
#include "cli/pages/viewer.h"
#include "cli/version.h"

namespace trueshade {
namespace {

using compare::ChannelDifferences;
using compare::Comparison;
using compare::PixelValues;

constexpr size_t kMostGroups = 12;      // of channels that are in a page: an EXR may have thousands
constexpr size_t kLargestPlaces = 100;  // of the pixels that differ most
constexpr int kGain = 16;

std::string digits(double value, const char* format = "%.6g") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// The pixels of a group that differ most, those first.
Places largest_differences(const PageLayer& from, const PageLayer& to, const PixelMask& mask) {
  struct Apart {
    double distance;
    int x, y;
  };
  std::vector<Apart> found;
  const auto is_larger = [](const Apart& a, const Apart& b) { return a.distance > b.distance; };
  std::vector<uint32_t> a(size_t(from.width) * from.channels()), b(a.size());
  for (int y = 0; y < from.height; ++y) {
    from.read(0, y, from.width, a.data());
    to.read(0, y, from.width, b.data());
    for (int x = 0; x < from.width; ++x) {
      if (mask.has(x, y)) continue;
      double most = 0;
      for (size_t i = size_t(x) * from.channels(); i < size_t(x + 1) * from.channels(); ++i) {
        if (a[i] == b[i]) continue;
        const int k = int(i % from.channels());
        const double distance =
            from.is_float ? std::fabs(from.value(a[i], k) - to.value(b[i], k)) : std::fabs(double(a[i]) - double(b[i]));
        most = std::max(most, std::isnan(distance) ? HUGE_VAL : distance);
      }
      if (most > 0) found.push_back({most, x, y});
    }
    if (found.size() < 64 * kLargestPlaces) continue;
    std::nth_element(found.begin(), found.begin() + kLargestPlaces, found.end(), is_larger);
    found.resize(kLargestPlaces);
  }
  std::stable_sort(found.begin(), found.end(), is_larger);
  Places places{"Largest differences", "Pixels in which a channel differs most, the largest difference first.", {}};
  for (size_t i = 0; i < std::min(found.size(), kLargestPlaces); ++i) places.pixels.push_back({found[i].x, found[i].y});
  return places;
}

/// Values of a pixel, channel by channel, of those that differ.
PixelExplanation explained(const PixelValues& pixel, const std::string& title) {
  std::string text;
  for (const PixelValues::Value& v : pixel.values)
    if (!v.numbers.equal) text += v.channel + ": reference " + v.reference + ", test " + v.test + "\n";
  return {pixel.x, pixel.y, title, text, {}};
}

void add_pixel(PageViewer& viewer, const std::optional<PixelValues>& pixel, const PixelValues* unlike,
               const std::string& name, const std::string& about) {
  if (!pixel || (unlike != nullptr && unlike->part != pixel->part)) return;
  viewer.places.push_back({name, about, {{pixel->x, pixel->y}}});
  viewer.explanations.push_back(explained(*pixel, name));
}

/// Which pixels the mask leaves out.
PageLayer mask_layer(const ComparedPictures& pictures) {
  const PixelMask& mask = pictures.mask;
  PageLayer layer;
  layer.id = "mask", layer.name = "Mask", layer.about = "What was left out: " + pictures.left_out_by + ".";
  layer.look = Look::classes, layer.reduction = Reduction::largest;
  layer.channel_names = {""}, layer.widths = {8};
  layer.width = mask.width, layer.height = mask.height;
  const uint64_t count = mask.count();
  layer.classes = {{"looked at", "Every figure is of these pixels.", {38, 44, 56}, mask.left_out.size() - count, 0},
                   {"left out", "In none of the figures.", {200, 160, 60}, count, 1}};
  layer.read = [&mask](int x, int y, int count_of, uint32_t* codes) {
    for (int i = 0; i < count_of; ++i) codes[i] = mask.has(x + i, y) ? 1 : 0;
  };
  return layer;
}

/// The middle of each worst window.
Places window_places(const Comparison& c) {
  Places places{"Worst windows", "The middle of each window with the most pixels that differ.", {}};
  for (const compare::WorstWindow& w : c.differences.windows)
    if (w.part == 0) places.pixels.push_back({w.window.x + w.window.width / 2, w.window.y + w.window.height / 2});
  return places;
}

std::string about_values(const ChannelGroup& group) {
  const std::string reference = compare::storage_text(*group.channels[0]->reference),
                    test = compare::storage_text(*group.channels[0]->test);
  if (reference == test) return "Values as they are stored: " + reference + ".";
  return "Stored as " + reference + " and " + test + "; these are the values that both stand for.";
}

std::string viewer_of(const ComparedPictures& pictures) {
  const Comparison& c = pictures.comparison;
  std::vector<ChannelGroup> groups = channel_groups(c.pairing);
  if (groups.empty()) return "";
  // A page shows pictures of one size: those of the first group's.
  std::erase_if(groups, [first = groups.front()](const ChannelGroup& g) {
    return g.width != first.width || g.height != first.height;
  });
  if (groups.size() > kMostGroups) groups.resize(kMostGroups);
  PageViewer viewer;
  viewer.gain = kGain;
  std::string figures = "<div class=pictures>\n";
  for (size_t i = 0; i < groups.size(); ++i) {
    GroupLayers both = layers_of(groups[i], c.decoding, "group" + std::to_string(i));
    const std::string what = name_suffix(groups[i]);
    PageLayer difference =
        layer_of_difference("Difference" + what, "How far test and reference are apart, channel by channel, enlarged.",
                            both.reference, both.test, "group" + std::to_string(i) + "-difference");
    if (i == 0) {
      viewer.compared = Compared{both.reference.id, both.test.id, about_values(groups[i])};
      viewer.places.push_back(largest_differences(both.reference, both.test, pictures.mask));
      figures += figure(picture_of_layer(both.reference), "Reference", escaped(pictures.reference.path)) +
                 figure(picture_of_layer(both.test), "Test", escaped(pictures.test.path)) +
                 figure(picture_of_layer(difference), "Difference", "how far both are apart, not enlarged");
    }
    viewer.add(std::move(both.reference));
    viewer.add(std::move(both.test));
    viewer.add(std::move(difference));
  }
  if (!pictures.mask.empty() && !pictures.judged.validation)  // whose maps of classes show it
    viewer.add(mask_layer(pictures));
  if (!c.differences.windows.empty()) viewer.places.push_back(window_places(c));
  add_pixel(viewer, c.worst, nullptr, "Worst pixel", "The pixel with the largest difference of any channel.");
  add_pixel(viewer, c.first, nullptr, "First pixel", "The first pixel that differs, row by row from the top.");
  add_pixel(viewer, c.first_not_finite, nullptr, "First that is not finite",
            "The first pixel with an infinity or NaN.");
  if (const auto& judged = pictures.judged.validation) add_judgement(*judged, viewer, "group0-test");
  return viewer_part(viewer, figures + "</div>\n", 0);
}

std::string criteria_part(const ComparedPictures& pictures) {
  if (pictures.judged.validation || pictures.comparison.criteria.empty()) return "";
  std::string html =
      "<h2>Criteria</h2>\n<p class=quiet>All must hold. Where "
      "none was asked for, every stored value must be "
      "equal.</p>\n<table>\n";
  for (const compare::Judged& row : pictures.comparison.criteria)
    html += "<tr><td>" + escaped(compare::text_of(row)) + "<td class=\"" +
            (row.holds ? "good\">holds" : "bad\">does not hold") + '\n';
  return html + "</table>\n";
}

std::string channel_row(const ChannelDifferences& c) {
  const std::string place = c.largest > 0 && c.worst.part == 0
                                ? "<a href=\"#" + std::to_string(c.worst.x) + ',' + std::to_string(c.worst.y) +
                                      "\" data-pixel=\"" + std::to_string(c.worst.x) + ',' + std::to_string(c.worst.y) +
                                      "\">" + std::to_string(c.worst.x) + ", " + std::to_string(c.worst.y) + "</a>"
                                : "";
  const std::string storage =
      c.reference_storage == c.test_storage ? c.reference_storage : c.reference_storage + " and " + c.test_storage;
  return "<tr><td>" + escaped(c.name) + "<td class=number>" + grouped(std::to_string(c.unequal)) + "<td class=number>" +
         digits(c.mean(), "%.4g") + "<td class=number>" + digits(c.rms(), "%.4g") + "<td class=number>" +
         digits(c.largest) + "<td class=number>" + steps_text(c.largest_ulp) + "<td>" + place +
         "<td class=number>" + digits(c.psnr(), "%.2f") + "<td class=number>" + std::to_string(c.not_finite_reference) +
         " | " + std::to_string(c.not_finite_test) + "<td>" + escaped(storage) + '\n';
}

std::string channels_part(const Comparison& c) {
  if (c.differences.channels.empty()) return "";
  std::string html =
      "<h2>Channels</h2>\n<p class=quiet>Unequal: pixels whose stored values "
      "differ. Mean, RMS (root of the mean "
      "square) "
      "and largest: of the values' differences, codes as shares of the largest "
      "code. ULP: steps of the storage between "
      "two values. At: where the largest is. PSNR: signal to noise, in dB; "
      "higher is nearer. Not finite: values that "
      "are "
      "infinite or no number, in the reference | in the test.</p>\n<div "
      "class=scroll><table><thead><tr><th>channel<th "
      "class=number>unequal<th class=number>mean<th class=number>RMS<th "
      "class=number>largest<th "
      "class=number>ULP<th>at<th "
      "class=number>PSNR<th class=number>not finite<th>stored as</thead>\n";
  for (const ChannelDifferences& channel : c.differences.channels) html += channel_row(channel);
  return html + "</table></div>\n";
}

std::string windows_part(const Comparison& c) {
  if (c.differences.windows.empty()) return "";
  std::string html =
      "<h2>Worst windows</h2>\n<p class=quiet>Where pixels that differ lie closest together, of each size of window; a "
      "pixel's error is its largest difference.</p>\n<ul>\n";
  for (const compare::WorstWindow& w : c.differences.windows)
    html += "<li>" + escaped(window_line(w, c)) + '\n';
  return html + "</ul>\n";
}

std::string facts_of(const Comparison& c) {
  double largest = 0;
  for (const ChannelDifferences& channel : c.differences.channels) largest = std::max(largest, channel.largest);
  std::string html =
      "<div class=facts>" +
      fact(grouped(std::to_string(c.differences.unequal_pixels)), "pixels differ",
           "Of " + std::to_string(c.differences.pixels) + "; a channel of each has another stored value.") +
      fact(digits(largest), "largest difference", "Of any channel; codes as shares of the largest code.") +
      fact(grouped(std::to_string(c.differences.not_finite_pixels)), "pixels not finite",
           "With an infinity or a value that is no number, in either picture.");
  if (c.differences.left_out > 0)
    html += fact(grouped(std::to_string(c.differences.left_out)), "pixels left out",
                 "By the mask or for what they show; in none of the figures.");
  if (c.flip)
    html += fact(digits(c.flip->mean), c.flip->exposures ? "HDR-FLIP, mean" : "FLIP, mean",
                 "How much people see the difference when they flip between "
                 "both: 0 not at all, 1 at most.");
  return html + "</div>\n";
}

std::string paragraph(const std::string& text) { return text.empty() ? "" : "<p>" + escaped(text) + ".</p>\n"; }

}  // namespace

std::string comparison_page(const ComparedPictures& pictures, const std::string& command) {
  const Comparison& c = pictures.comparison;
  std::string html = page_head(kComparisonTitle) + heading_part(kComparisonTitle) +
                     "<p class=\"verdict " + (passes(pictures) ? "good" : "bad") +
                     "\">Verdict: " + escaped(verdict_line(pictures)) + ".</p>\n";
  html += "<p class=quiet>reference " + escaped(pictures.reference.path + ": " + about_picture(pictures.reference)) +
          "<br>test " + escaped(pictures.test.path + ": " + about_picture(pictures.test)) + "</p>\n";
  for (const std::string& failure : c.failures) html += "<p class=note>" + escaped(failure) + ".</p>\n";
  if (const auto& judged = pictures.judged.validation) html += diagnosis_part(*judged);
  html += viewer_of(pictures) + facts_of(c) + criteria_part(pictures) + windows_part(c) + channels_part(c);
  if (const auto& judged = pictures.judged.validation) html += stages_part(*judged);
  html += "<h2>About this comparison</h2>\n" + paragraph("Colours: " + c.colors);
  if (!pictures.left_out_by.empty()) html += paragraph("Mask: " + mask_line(pictures));
  for (const std::string& note : c.notes) html += paragraph(note);
  if (!c.no_flip.empty()) html += paragraph("FLIP was not measured: " + c.no_flip);
  if (!pictures.judged.why_not.empty()) html += paragraph("Not judged: " + pictures.judged.why_not);
  return html + "<p class=quiet>trueshade " + kVersion + "</p>\n" + reproduce_part(command) + page_end();
}

}  // namespace trueshade
