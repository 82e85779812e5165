// A page of two folders: each picture with its verdict, those that do not pass as reference, test and difference. All
// pictures of the page have a number of bytes together, so that a page of some hundred of them still opens at once.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "cli/pages/channel_layers.h"
#include "cli/pages/page.h"
#include "cli/picture_rows.h"
#include "cli/version.h"
#include "compare/error_colors.h"
#include "core/error.h"
#include "core/fp_env.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostBytes = 14'000'000;  // of all pictures; base64 makes a third more of them
constexpr size_t kMostPassing = 12'000;    // of a picture that passes
constexpr size_t kMostFailing = 600'000;   // of each of the three of one that does not
constexpr int kLargestSide = 640, kLeastSide = 48;
constexpr double kGain = 16;  // of differences

/// What is seen of a row.
struct Seen {
  std::optional<Image> reference, test, difference;
};

/// The largest difference of a channel at each pixel, as a share of the largest code, or of 1; times kGain.
Image differences(const PageLayer& from, const PageLayer& to) {
  const FpScope exact_arithmetic;
  const size_t channels = from.channels(), width = size_t(from.width);
  std::vector<uint32_t> a(width * channels), b(a.size());
  std::vector<float> map(width * size_t(from.height), 0.0f);
  for (int y = 0; y < from.height; ++y) {
    from.read(0, y, from.width, a.data());
    to.read(0, y, from.width, b.data());
    for (size_t i = 0; i < a.size(); ++i) {
      if (a[i] == b[i]) continue;
      const size_t k = i % channels;
      const double off = from.is_float ? std::fabs(from.value(a[i], int(k)) - to.value(b[i], int(k)))
                                       : std::fabs(double(a[i]) - double(b[i])) / std::ldexp(1.0, from.widths[k]);
      float& most = map[size_t(y) * width + i / channels];
      most = std::max(most, float(std::isfinite(off) ? std::min(1.0, kGain * off) : 1.0));
    }
  }
  return compare::error_picture(map, from.width, from.height);
}

/// The first channels of two pictures, and how far they are apart where they fit together. Nothing of files that cannot
/// be read.
Seen seen(const std::string& reference, const std::string& test, const CompareOptions& options) {
  try {
    const ComparedPictures pictures = compared_pictures(reference, test, options, std::nullopt);
    const compare::Comparison& c = pictures.comparison;
    const std::vector<ChannelGroup> groups = channel_groups(c.pairing);
    if (groups.empty()) return {};
    const GroupLayers both = layers_of(groups.front(), c.decoding, "group");
    return {picture_of_layer(both.reference), picture_of_layer(both.test), differences(both.reference, both.test)};
  } catch (const Error&) {
    return {};
  }
}

Seen seen(const PictureRow& row, const FolderComparison& folders, const CompareOptions& options) {
  const std::string reference = (fs::path(folders.reference) / row.name).string(),
                    test = (fs::path(folders.test) / row.name).string();
  Seen both;
  if (row.state == RowState::different || row.state == RowState::within) both = seen(reference, test, options);
  // A picture beside itself is seen alone.
  if (!both.reference && row.state != RowState::extra) both.reference = seen(reference, reference, options).reference;
  if (!both.test && row.state != RowState::missing && row.state != RowState::same)
    both.test = seen(test, test, options).test;
  return both;
}

/// A PNG of at most so many bytes, if a side of kLeastSide allows that; `side` is what it was reduced to.
std::string png_within(const Image& image, size_t bytes, int& side) {
  for (;;) {
    const Image small = reduced_picture(image, side);
    const std::vector<uint8_t> png = encode_png(small, {});
    const int now = std::max(small.width, small.height);
    if (png.size() <= bytes || now <= kLeastSide) return "data:image/png;base64," + base64(png);
    side = std::max(kLeastSide, std::min(now - 1, int(now * std::sqrt(double(bytes) / double(png.size())))));
  }
}

std::string picture_part(const std::optional<Image>& image, const std::string& name, size_t bytes, int& side) {
  if (!image) return "";
  return "<figure data-side=\"" + name + "\"><img loading=lazy decoding=async alt=\"" + name +
         "\" width=" + std::to_string(image->width) + " height=" + std::to_string(image->height) + " src=\"" +
         png_within(*image, bytes, side) + "\"><figcaption>" + name + "</figcaption></figure>\n";
}

/// Bytes as they stand in a URL's path.
std::string as_path(const std::string& name) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string url;
  for (const char c : name) {
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", unsigned(uint8_t(c)));
    url += kPlain.find(c) != std::string_view::npos ? std::string(1, c) : code;
  }
  return url;
}

/// A link to a page or a map that the comparison has written, from the gallery.
std::string link_to(const fs::path& file, const fs::path& gallery, const std::string& what) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return "";
  const fs::path folder = gallery.has_parent_path() ? gallery.parent_path() : fs::path(".");
  return " <a href=\"" + as_path(fs::relative(file, folder, unknown).generic_string()) + "\">" + what + "</a>";
}

std::string row_part(const PictureRow& row, const FolderComparison& folders, const CompareOptions& options,
                     const std::string& gallery, size_t bytes) {
  const Seen pictures = seen(row, folders, options);
  const std::string state(name_of(row.state)), verdict = passes(row) ? "good" : "bad";
  const std::string name = printable(row.name, Lines::one);  // a name of a file may be no text
  std::string html = "<article class=\"pair " + verdict + "\" data-state=" + state + " data-name=\"" + escaped(name) +
                     "\"><h3>" + escaped(name) + " <span class=" + verdict + ">" + state +
                     (row.is_accepted ? ", accepted" : "") + "</span></h3>\n";
  int side = kLargestSide;
  if (passes(row)) {
    html += picture_part(pictures.test ? pictures.test : pictures.reference, "Test", bytes, side);
    return html + "</article>\n";
  }
  html += "<p class=\"quiet small\">" + escaped(row.reason);
  for (const std::string& folder : options.outputs) {
    const fs::path path = fs::path(folder) / row.name;
    html += link_to(path.string() + ".html", gallery, "its page") +
            link_to(path.string() + ".flip.png", gallery, "its map of FLIP");
  }
  html += "</p>\n<div class=sides>\n" + picture_part(pictures.reference, "Reference", bytes, side) +
          picture_part(pictures.test, "Test", bytes, side) +
          picture_part(pictures.difference, "Difference", bytes, side);
  html += "</div>\n";
  if (!row.details.empty())
    html += "<details><summary>Figures</summary><pre>" + escaped(row.details) + "</pre></details>\n";
  return html + "</article>\n";
}

/// A button a state that a picture has, and a field for a part of a name.
std::string filters_part(const FolderComparison& folders) {
  std::array<size_t, 7> counts{};
  for (const PictureRow& row : folders.rows) ++counts[size_t(row.state)];
  std::string html =
      "<div class=bar id=filters><div class=segments role=group aria-label=\"Verdicts\">"
      "<button type=button aria-pressed=true data-state=\"\">all " +
      std::to_string(folders.rows.size()) + "</button>";
  for (size_t state = counts.size(); state-- > 0;)
    if (counts[state] > 0) {
      const std::string name(name_of(RowState(state)));
      html += "<button type=button aria-pressed=false data-state=" + name + ">" + name + ' ' +
              std::to_string(counts[state]) + "</button>";
    }
  return html +
         "</div><input type=search id=part placeholder=\"part of a name\" aria-label=\"Part of a name\">"
         "<output id=shown class=quiet></output></div>\n";
}

}  // namespace

std::string gallery_page(const FolderComparison& folders, const CompareOptions& given, const std::string& gallery) {
  CompareOptions options = given;  // of what is compared again for its pictures
  options.rules.wants_flip = false, options.no_judge = true;
  const size_t failing = folders.failures(), passing = folders.rows.size() - failing;
  const size_t of_passing = std::min(kMostPassing, kMostBytes / 3 / std::max<size_t>(1, passing));
  const size_t of_failing =
      std::min(kMostFailing, (kMostBytes - passing * of_passing) / std::max<size_t>(1, 3 * failing));
  const std::string verdict = verdict_of_rows(folders);
  std::string html = page_head(verdict) + heading_part("Two folders of pictures") + "<p class=\"verdict " +
                     (failing == 0 ? "good" : "bad") + "\">" + escaped(verdict) + "</p>\n<p class=quiet>reference " +
                     escaped(folders.reference) + "<br>test " + escaped(folders.test) + "</p>\n" +
                     filters_part(folders);
  html += "<p class=\"quiet small\">Differences are " + std::to_string(int(kGain)) +
          " times as large as they are, from black over violet and orange to pale yellow. A click on a picture lays "
          "the test over the reference, with a slider between them.</p>\n<section id=gallery>\n";
  for (const PictureRow& row : folders.rows)
    html += row_part(row, folders, options, gallery, passes(row) ? of_passing : of_failing);
  return html + "</section>\n<p class=quiet>trueshade " + kVersion + "</p>\n" +
         reproduce_part("trueshade" + given.command_line) + page_end();
}

}  // namespace trueshade
