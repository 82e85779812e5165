#include "cli/pages/page.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "cli/pages/embedded.h"
#include "cli/pages/layer.h"
#include "core/fp_env.h"
#include "core/image_files/image_io.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

/// Texels of a square of the image, averaged: fixed point by its codes, floats by their values.
void average(const Image& image, int x0, int y0, int side, int x, int y, Image& out) {
  const FormatInfo layout = info(image.format);
  const int columns = std::min(side, image.width - x0), rows = std::min(side, image.height - y0);
  const double pixels = double(columns) * rows;
  for (int k = 0; k < 4; ++k) {
    const int channel = layout.channels == 1 ? 0 : k;
    double sum = k == 3 ? pixels : 0;  // alpha is 1 where there is none
    if (layout.number_class == NumberClass::floating) {
      if (k < 3 && channel < layout.channels) {
        sum = 0;
        for (int i = 0; i < columns * rows; ++i) sum += image.value(x0 + i % columns, y0 + i / columns, channel);
      }
      out.set_code(x, y, k, std::bit_cast<uint32_t>(float(sum / pixels)));
    } else {
      if (k < 3 && channel < layout.channels) {
        sum = 0;
        for (int i = 0; i < columns * rows; ++i)
          sum += double(image.code(x0 + i % columns, y0 + i / columns, channel)) / layout.largest_code(channel);
      }
      out.set_code(x, y, k, uint32_t(sum / pixels * 255 + 0.5));
    }
  }
}

}  // namespace

std::string page_head(std::string_view title) {
  // The theme that was chosen before is set before anything is drawn. Nothing may be loaded from anywhere.
  return "<!doctype html>\n<html lang=en>\n<meta charset=utf-8>\n<meta name=viewport content=\"width=device-width, "
         "initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
         "data:; "
         "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>" +
         escaped(title) + " \xe2\x80\x93 Trueshade</title>\n<style>" + std::string(kPageStyle) +
         "</style>\n<script>document.documentElement.classList.add('has-script');\ntry { "
         "const theme = localStorage.getItem('trueshade-theme'); if (theme) document.documentElement.dataset.theme = "
         "theme; } catch { /* pages from files may have no storage */ }</script>\n<main>\n";
}

std::string heading_part(std::string_view title) {
  return "<div class=top><h1>" + escaped(title) +
         "</h1><button type=button id=theme title=\"Light or dark\">Light / dark</button></div>\n";
}

std::string page_end() {
  std::string html = "<script>\"use strict\";\n(() => {\n";
  for (const std::string_view part : kPageScript) html += part;
  return html + "})();\n</script>\n</main>\n</html>\n";
}

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) switch (c) {
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '&':
        html += "&amp;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  return html;
}

std::string grouped(const std::string& number) {
  const size_t digits = std::min(number.find('.'), number.size());
  std::string text;
  for (size_t i = 0; i < number.size(); ++i) {
    if (i != 0 && i < digits && (digits - i) % 3 == 0) text += "\xe2\x80\x89";
    text += number[i];
  }
  return text;
}

Image reduced_picture(const Image& image, int largest_side) {
  const int side = (std::max(image.width, image.height) + largest_side - 1) / largest_side;
  if (side <= 1) return image;
  const bool is_float = info(image.format).number_class == NumberClass::floating;
  Image out((image.width + side - 1) / side, (image.height + side - 1) / side,
            is_float ? Format::rgba32f : Format::rgba8);
  parallel_for(out.height, 0, [&](int y) {
    const FpScope exact_arithmetic;
    for (int x = 0; x < out.width; ++x) average(image, x * side, y * side, side, x, y, out);
  });
  return out;
}

std::string figure(const Image& image, const std::string& name, const std::string& about) {
  constexpr int kSmall = 600;  // pixels; a column of pictures is about as wide
  const Image picture = reduced_picture(image);
  const std::string kind = image.width < kSmall ? "<figure><img class=small alt=" : "<figure><img alt=";
  const std::string note = picture.width == image.width ? ""
                                                        : " (here reduced to " + std::to_string(picture.width) +
                                                              " \xc3\x97 " + std::to_string(picture.height) + ")";
  return kind + "\"" + escaped(name) + "\" src=\"data:image/png;base64," + base64(encode_png(picture, {})) +
         "\"><figcaption><b>" + escaped(name) + "</b> " + about + note + "</figcaption></figure>\n";
}

std::string notes_part(std::span<const std::string> lines) {
  std::string html;
  for (const std::string& line : lines) html += "<p class=note>Note: " + escaped(line) + ".</p>\n";
  return html;
}

std::string fact(const std::string& value, const std::string& name, const std::string& meaning) {
  return "<div class=fact><b>" + escaped(value) + "</b><span>" + escaped(name) + "</span><small>" + escaped(meaning) +
         "</small></div>\n";
}

std::string reproduce_part(const std::string& command) {
  if (command.empty()) return {};
  return "<h2>The command</h2>\n<p class=quiet>Run again, it makes this page.</p>\n<div class=command><code>" +
         escaped(command) + "</code></div>\n";
}

std::string pipeline_part(const std::string& json) {
  return "<h2>Pipeline</h2>\n<details><summary>All that may change a pixel beside the scene</summary><pre>" +
         escaped(json) + "</pre></details>\n";
}

}  // namespace trueshade
