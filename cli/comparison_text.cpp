#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/compared_pictures.h"
#include "cli/json_text.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

using compare::ChannelDifferences;
using compare::Comparison;
using compare::Outcome;
using compare::PixelValues;

constexpr size_t kMostChannelsShown = 16;  ///< of which a pixel's values are shown although they are equal

std::string number_of(double value, const char* form = "%.6g") {
  char text[40];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

std::string count_of(uint64_t count, const char* one, const char* many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

std::string line_of(const std::string& name, const std::string& value) {
  return name + std::string(name.size() < 12 ? 12 - name.size() : 1, ' ') + printable(value, Lines::one) + '\n';
}

}  // namespace

std::string steps_text(double steps) { return number_of(steps, steps == std::floor(steps) ? "%.0f" : "%.4g"); }

namespace {

/// Columns as wide as their widest cell; the first and the last are set to the left.
std::string table_of(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string room(widths[i] - row[i].size(), ' ');
      const bool last = i + 1 == row.size();
      if (last && row[i].empty()) continue;
      text += i == 0 ? row[i] + room : last ? "  " + row[i] : "  " + room + row[i];
    }
    text += '\n';
  }
  return text;
}

std::string place_text(const compare::Place& place) { return std::to_string(place.x) + ',' + std::to_string(place.y); }

std::string channel_table(const std::vector<ChannelDifferences>& channels) {
  std::vector<std::vector<std::string>> rows = {
      {"channel", "unequal", "mean", "RMS", "largest", "ULP", "at", "PSNR dB", "not finite", "stored as"}};
  for (const ChannelDifferences& c : channels) {
    const std::string storage =
        c.reference_storage == c.test_storage ? c.reference_storage : c.reference_storage + " and " + c.test_storage;
    const uint64_t not_finite = c.not_finite_reference + c.not_finite_test;
    rows.push_back(
        {printable(c.name, Lines::one), std::to_string(c.unequal), number_of(c.mean(), "%.4g"),
         number_of(c.rms(), "%.4g"), number_of(c.largest), steps_text(c.largest_ulp),
         c.largest > 0 ? place_text(c.worst) : "-", number_of(c.psnr(), "%.2f"),
         not_finite == 0 ? "-" : std::to_string(c.not_finite_reference) + " and " + std::to_string(c.not_finite_test),
         storage});
  }
  return table_of(rows);
}

std::string pixel_text(const char* name, const std::optional<PixelValues>& pixel) {
  if (!pixel) return {};
  std::vector<std::vector<std::string>> rows = {{"  channel", "reference", "test", ""}};
  for (const PixelValues::Value& v : pixel->values)
    if (!v.numbers.equal || pixel->values.size() <= kMostChannelsShown)
      rows.push_back({"  " + printable(v.channel, Lines::one), v.reference, v.test, v.numbers.equal ? "" : "differs"});
  const std::string part = pixel->part.empty() ? "" : " of part " + printable(pixel->part, Lines::one);
  std::string text = std::string(name) + " at " + std::to_string(pixel->x) + ',' + std::to_string(pixel->y) + part +
                     ", from the top left\n";
  return text + table_of(rows);
}

std::string flip_line(const compare::FlipResult& flip) {
  std::string line = "mean " + number_of(flip.mean) + ", weighted median " + number_of(flip.weighted_median) +
                     ", quartiles " + number_of(flip.weighted_first_quartile) + " and " +
                     number_of(flip.weighted_third_quartile) + ", least " + number_of(flip.least) + ", largest " +
                     number_of(flip.largest);
  if (!flip.exposures) return line + " (LDR)";
  return line + " (HDR, " + std::to_string(flip.exposures->count) + " exposures from " +
         number_of(flip.exposures->start, "%.4f") + " to " + number_of(flip.exposures->stop, "%.4f") + ")";
}

/// `12 of 6144 pixels differ, by 0.25 at most`.
std::string extent_text(const compare::Differences& d) {
  double largest = 0.0;
  for (const ChannelDifferences& channel : d.channels) largest = std::max(largest, channel.largest);
  const std::string text = std::to_string(d.unequal_pixels) + " of " + count_of(d.pixels, "pixel", "pixels");
  return text + (d.unequal_pixels == 1 ? " differs" : " differ") +
         (d.unequal_pixels > 0 ? ", by " + number_of(largest) + " at most" : "");
}

/// `; 120 are left out`, of what is.
std::string left_out_text(const compare::Differences& d) {
  if (d.left_out == 0) return "";
  return "; " + std::to_string(d.left_out) + (d.left_out == 1 ? " is" : " are") + " left out";
}

std::string window_json(const compare::WorstWindow& worst, const Comparison& c) {
  const LocalWindow& w = worst.window;
  JsonObject json;
  json.put("side", w.side).put("part", c.pairing.parts[worst.part].name).put("x", w.x).put("y", w.y);
  json.put("width", w.width).put("height", w.height).put("pixels", w.seen).put("pixels_beyond", w.found);
  return json.put("share", worst.share).put("mean", w.mean()).put("largest", w.largest).text();
}

const char* word_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::same:
      return "same";
    case Outcome::within:
      return "within";
    case Outcome::different:
      return "different";
    case Outcome::mismatched:
      return "mismatched";
  }
  return "";  // unreachable: every enumerator returns above
}

std::string channel_json(const ChannelDifferences& c) {
  JsonObject json;
  json.put("name", c.name).put("reference_storage", c.reference_storage).put("test_storage", c.test_storage);
  json.put("pixels", c.pixels).put("unequal", c.unequal).put("mean", c.mean()).put("rms", c.rms());
  json.put("largest", c.largest).put("largest_ulp", c.largest_ulp).put("psnr", c.psnr()).put("peak", c.peak);
  if (c.largest > 0) json.put("worst_x", c.worst.x).put("worst_y", c.worst.y);
  json.put("not_finite_reference", c.not_finite_reference).put("not_finite_test", c.not_finite_test);
  return json.text();
}

std::string pixel_json(const PixelValues& pixel) {
  JsonArray values;
  for (const PixelValues::Value& v : pixel.values)
    values.add_raw(JsonObject()
                       .put("channel", v.channel)
                       .put("reference", v.reference)
                       .put("test", v.test)
                       .put("reference_value", v.numbers.reference)
                       .put("test_value", v.numbers.test)
                       .put("equal", v.numbers.equal)
                       .text());
  return JsonObject()
      .put("part", pixel.part)
      .put("x", pixel.x)
      .put("y", pixel.y)
      .put_raw("values", values.text())
      .text();
}

std::string flip_json(const compare::FlipResult& flip) {
  JsonObject json;
  json.put("mean", flip.mean).put("weighted_median", flip.weighted_median);
  json.put("weighted_first_quartile", flip.weighted_first_quartile);
  json.put("weighted_third_quartile", flip.weighted_third_quartile);
  json.put("least", flip.least).put("largest", flip.largest).put("range", flip.exposures ? "high" : "low");
  if (flip.exposures)
    json.put("start_exposure", flip.exposures->start)
        .put("stop_exposure", flip.exposures->stop)
        .put("exposures", flip.exposures->count);
  return json.text();
}

}  // namespace

std::string about_picture(const PictureFile& picture) {
  const ChannelFile& first = picture.parts.front();
  std::string line =
      std::string(picture.kind) + ", " + std::to_string(first.width) + 'x' + std::to_string(first.height);
  if (picture.parts.size() > 1) line += ", " + std::to_string(picture.parts.size()) + " parts";
  std::string storage;
  size_t channels = 0;
  for (const ChannelFile& part : picture.parts)
    for (const Channel& channel : part.channels) {
      const std::string stored = compare::storage_text(channel);
      if (++channels > kMostChannelsShown) continue;
      if (stored != storage && !storage.empty()) line += ' ' + storage;
      line += (channels == 1 || stored != storage ? ", " : " ") + channel.name;
      storage = stored;
    }
  line += ' ' + storage;
  return channels <= kMostChannelsShown ? line : line + ", " + std::to_string(channels) + " channels in all";
}

std::string mask_line(const ComparedPictures& pictures) {
  const compare::Differences& d = pictures.comparison.differences;
  const uint64_t all = d.pixels + d.left_out;
  return pictures.left_out_by + ": " + std::to_string(d.left_out) + " of " + count_of(all, "pixel", "pixels") +
         " left out, " + number_of(all > 0 ? 100.0 * double(d.left_out) / double(all) : 0.0, "%.3g") + " %";
}

std::string window_line(const compare::WorstWindow& worst, const Comparison& comparison) {
  const LocalWindow& w = worst.window;
  const double delta = comparison.differences.delta;
  std::string delta_text = number_of(delta);
  for (const compare::Judged& row : comparison.criteria)
    if (!row.criterion.delta_text.empty()) delta_text = row.criterion.delta_text;
  return std::to_string(w.side) + 'x' + std::to_string(w.side) + " at " + std::to_string(w.x) + ',' +
         std::to_string(w.y) + ": " + std::to_string(w.found) + " of " + count_of(w.seen, "pixel", "pixels") +
         (w.found == 1 ? " differs" : " differ") + (delta > 0 ? " by more than " + delta_text : "") + ", mean error " +
         number_of(w.mean(), "%.4g") + ", largest " + number_of(w.largest, "%.4g");
}

bool passes(const ComparedPictures& pictures) {
  return pictures.judged.validation ? passes(*pictures.judged.validation) : pictures.comparison.passes();
}

std::string verdict_line(const ComparedPictures& pictures) {
  const Comparison& c = pictures.comparison;
  const compare::Differences& d = c.differences;
  if (c.outcome == Outcome::same)
    return "the pictures are the same: " + count_of(d.pixels, "pixel", "pixels") + " of " +
           count_of(d.channels.size(), "channel", "channels") + ", every stored value equal" + left_out_text(d);
  if (const auto& v = pictures.judged.validation)
    return "judged by the reference's scene: " + conclusion(*v) + "; " + extent_text(d) + " from the reference";
  const std::string extent = extent_text(d) + left_out_text(d);
  if (c.outcome == Outcome::within) return "the pictures differ within what is allowed: " + extent;
  const std::string verb =
      c.outcome == Outcome::different ? "the pictures differ: " : "the pictures do not fit together: ";
  const bool by_equality = c.failures.front() == compare::text_of(c.criteria.front()) &&
                           c.criteria.front().criterion.measure == compare::Measure::unequal_pixels;
  if (by_equality) return verb + extent;
  return verb + c.failures.front() +
         (c.failures.size() > 1 ? "; and " + count_of(c.failures.size() - 1, "reason", "reasons") + " more" : "") +
         (d.pixels > 0 ? "; " + extent : "");
}

std::string comparison_text(const ComparedPictures& pictures) {
  const Comparison& c = pictures.comparison;
  std::string text = line_of("verdict", verdict_line(pictures));
  for (size_t i = 1; i < c.failures.size(); ++i) text += line_of("and", c.failures[i]);
  text += line_of("reference", pictures.reference.path + ": " + about_picture(pictures.reference));
  text += line_of("test", pictures.test.path + ": " + about_picture(pictures.test));
  if (!pictures.left_out_by.empty()) text += line_of("mask", mask_line(pictures));
  text += line_of("colours", c.colors);
  for (const std::string& note : c.notes) text += line_of("note", note);
  if (!pictures.judged.why_not.empty()) text += line_of("not judged", pictures.judged.why_not);
  if (!pictures.judged.validation && c.outcome != Outcome::mismatched)
    for (const compare::Judged& row : c.criteria)
      text += line_of("criterion", compare::text_of(row) + (row.holds ? ": holds" : ": DOES NOT HOLD"));
  if (c.flip) text += line_of("FLIP", flip_line(*c.flip));
  if (!c.no_flip.empty()) text += line_of("FLIP", "not measured: " + c.no_flip);
  for (const compare::WorstWindow& w : c.differences.windows) text += line_of("window", window_line(w, c));
  if (c.differences.channels.empty() || c.outcome == Outcome::same) return text;
  text += '\n' + channel_table(c.differences.channels);
  for (const std::string& pixel : {pixel_text("first pixel", c.first), pixel_text("worst pixel", c.worst),
                                   pixel_text("first pixel that is not finite", c.first_not_finite)})
    if (!pixel.empty()) text += '\n' + pixel;
  if (pictures.judged.validation) text += '\n' + validation_text(*pictures.judged.validation);
  return text;
}

std::string comparison_json(const ComparedPictures& pictures) {
  const Comparison& c = pictures.comparison;
  const compare::Differences& d = c.differences;
  JsonArray criteria, channels, windows;
  for (const compare::Judged& row : c.criteria) {
    JsonObject json;
    json.put("measure", compare::name_of(row.criterion.measure)).put("bound", row.criterion.bound);
    if (compare::has_delta(row.criterion.measure)) json.put("delta", row.criterion.delta);
    if (row.criterion.side > 0) json.put("side", row.criterion.side);
    criteria.add_raw(json.put("measured", row.measured).put("holds", row.holds).text());
  }
  for (const ChannelDifferences& channel : d.channels) channels.add_raw(channel_json(channel));
  for (const compare::WorstWindow& worst : d.windows) windows.add_raw(window_json(worst, c));
  JsonObject json;
  json.put("outcome", word_of(c.outcome)).put("passes", passes(pictures)).put("verdict", verdict_line(pictures));
  json.put("accepted", pictures.is_accepted);
  json.put("reference", pictures.reference.path).put("test", pictures.test.path).put("colors", c.colors);
  json.put_raw("failures", strings_json(c.failures)).put_raw("notes", strings_json(c.notes));
  json.put_raw("criteria", criteria.text()).put("pixels", d.pixels).put("unequal_pixels", d.unequal_pixels);
  json.put("left_out_pixels", d.left_out);
  if (!pictures.left_out_by.empty()) json.put("left_out_by", pictures.left_out_by);
  json.put("pixels_beyond", d.pixels_beyond).put("not_finite_pixels", d.not_finite_pixels);
  json.put_raw("channels", channels.text()).put_raw("windows", windows.text());
  if (c.first) json.put_raw("first", pixel_json(*c.first));
  if (c.worst) json.put_raw("worst", pixel_json(*c.worst));
  if (c.first_not_finite) json.put_raw("first_not_finite", pixel_json(*c.first_not_finite));
  if (c.flip) json.put_raw("flip", flip_json(*c.flip));
  if (!c.no_flip.empty()) json.put("no_flip", c.no_flip);
  if (!pictures.judged.why_not.empty()) json.put("not_judged", pictures.judged.why_not);
  if (pictures.judged.validation) json.put_raw("judged", validation_json(*pictures.judged.validation));
  return json.text();
}

}  // namespace trueshade
