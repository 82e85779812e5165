#include <algorithm>
#include <cstdio>

#include "cli/json_text.h"
#include "cli/picture_rows.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

/// `3, a.txt, b.txt and 1 more`.
std::string listed(const std::set<std::string>& paths) {
  constexpr size_t kShown = 4;
  std::string text = std::to_string(paths.size());
  size_t shown = 0;
  for (const std::string& path : paths) {
    if (shown++ == kShown) return text + " and " + std::to_string(paths.size() - kShown) + " more";
    text += ", " + printable(path, Lines::one);
  }
  return text;
}

std::string row_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// What a table says of a row: its reason, and what --accept did.
std::string row_reason(const PictureRow& row) {
  if (row.is_accepted) return "accepted: the test picture is the reference now";
  return row.not_accepted.empty() ? row.reason : row.reason + "; not accepted: " + row.not_accepted;
}

}  // namespace

std::string_view name_of(RowState state) {
  switch (state) {
    case RowState::same:
      return "same";
    case RowState::within:
      return "within";
    case RowState::different:
      return "different";
    case RowState::mismatched:
      return "mismatched";
    case RowState::missing:
      return "missing";
    case RowState::extra:
      return "extra";
    case RowState::unreadable:
      return "unreadable";
  }
  return {};  // unreachable: every enumerator returns above
}

std::string verdict_of_rows(const FolderComparison& folders) {
  const size_t failures = folders.failures();
  const std::string all = std::to_string(folders.rows.size());
  const auto accepted =
      std::count_if(folders.rows.begin(), folders.rows.end(), [](const PictureRow& r) { return r.is_accepted; });
  return (failures == 0 ? "all " + all + " pictures pass"
                        : std::to_string(failures) + " of " + all +
                              (failures == 1 ? " pictures does not pass" : " pictures do not pass")) +
         (accepted > 0 ? ", " + std::to_string(accepted) + " accepted" : "");
}

std::string rows_text(const FolderComparison& folders) {
  const size_t all = folders.rows.size();
  size_t same = 0, masked = 0, name_width = 7;
  for (const PictureRow& row : folders.rows) {
    same += row.state == RowState::same ? 1 : 0;
    masked += row.state == RowState::same && row.left_out_pixels > 0 ? 1 : 0;
    if (row.state != RowState::same) name_width = std::max(name_width, printable(row.name, Lines::one).size());
  }
  std::string text = "verdict     " + verdict_of_rows(folders) + '\n';
  text += "reference   " + printable(folders.reference, Lines::one) + '\n';
  text += "test        " + printable(folders.test, Lines::one) + '\n';
  if (!folders.passed_over.empty())
    text += "note        files whose names do not end as a picture's were passed over: " + listed(folders.passed_over) +
            '\n';
  for (const std::string& pattern : folders.unused)
    text += "note        --criteria: no picture was compared by " + printable(pattern, Lines::one) + '\n';
  if (same < all) {
    char line[160];
    text += "\noutcome     unequal pixels    largest  FLIP mean  " + ("picture" + std::string(name_width - 5, ' ')) +
            "why\n";
    for (const PictureRow& row : folders.rows) {
      if (row.state == RowState::same) continue;
      std::snprintf(line, sizeof line, "%-10s  %14s  %9s  %9s  ", std::string(name_of(row.state)).c_str(),
                    row.pixels > 0 ? std::to_string(row.unequal_pixels).c_str() : "-",
                    row.pixels > 0 ? row_number(row.largest).c_str() : "-",
                    row.flip_mean ? row_number(*row.flip_mean).c_str() : "-");
      const std::string name = printable(row.name, Lines::one);
      text +=
          line + name + std::string(name_width + 2 - name.size(), ' ') + printable(row_reason(row), Lines::one) + '\n';
    }
  }
  if (same == 0) return text;
  return text + "same        " + std::to_string(same) + (same == 1 ? " picture" : " pictures") +
         (masked > 0 ? " (" + std::to_string(masked) + " with pixels left out)\n" : "\n");
}

std::string rows_json(const FolderComparison& folders) {
  JsonArray rows;
  for (const PictureRow& row : folders.rows) {
    JsonObject json;
    json.put("name", row.name).put("outcome", name_of(row.state)).put("passes", passes(row)).put("reason", row.reason);
    if (row.pixels > 0)
      json.put("pixels", row.pixels).put("unequal_pixels", row.unequal_pixels).put("largest", row.largest);
    if (row.left_out_pixels > 0) json.put("left_out_pixels", row.left_out_pixels);
    if (!row.json.empty()) json.put_raw("comparison", row.json);
    if (row.flip_mean) json.put("flip_mean", *row.flip_mean);
    if (row.exit_code != 0) json.put("exit_code", row.exit_code);
    json.put("seconds", row.seconds).put("accepted", row.is_accepted);
    if (!row.not_accepted.empty()) json.put("not_accepted", row.not_accepted);
    rows.add_raw(json.text());
  }
  JsonObject json;
  json.put("reference", folders.reference).put("test", folders.test).put("passes", folders.failures() == 0);
  json.put("failures", uint64_t(folders.failures())).put("passed_over", uint64_t(folders.passed_over.size()));
  json.put_raw("passed_over_files", strings_json(folders.passed_over));
  if (!folders.unused.empty()) json.put_raw("unused_criteria", strings_json(folders.unused));
  return json.put_raw("pictures", rows.text()).text() + '\n';
}

}  // namespace trueshade
