#include "cli/page.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/image_files/image_io.h"

namespace trueshade {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: dark; --page: #14161b; --card: #1d2027; --line: #2c313b; --text: #e7e9ee; --quiet: #9aa3b2; --accent: #ffb454; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--text); font: 15px/1.5 system-ui, "Segoe UI", Roboto, sans-serif; }
main { max-width: 1280px; margin: 0 auto; padding: 28px 24px 64px; }
h1 { margin: 0; font-size: 26px; font-weight: 650; letter-spacing: -0.01em; overflow-wrap: anywhere; }
h2 { margin: 36px 0 12px; font-size: 17px; font-weight: 600; }
.note { border-left: 3px solid var(--accent); padding-left: 12px; }
.quiet { color: var(--quiet); }
code, pre { font: 13px/1.5 ui-monospace, "Cascadia Mono", Menlo, Consolas, monospace; overflow-wrap: anywhere; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 12px; margin: 20px 0; }
.fact { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 12px 16px; }
.fact b { display: block; font-size: 22px; font-weight: 600; font-variant-numeric: tabular-nums; }
.fact span { color: var(--quiet); font-size: 13px; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; background: #000; }  /* transparent pixels stand on black */
img.small { image-rendering: pixelated; }  /* magnified to the page's width: a pixel stays a square */
figcaption { padding: 10px 14px; font-size: 13px; color: var(--quiet); }
figcaption b { color: var(--text); font-weight: 600; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(300px, 1fr)); gap: 16px; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(540px, 100%), 1fr)); gap: 16px; }
.chart { padding: 14px 18px; }
.chart svg { display: block; max-width: 720px; }
.verdict { font-size: 19px; font-weight: 600; }
.chart b { display: block; margin-bottom: 10px; font-weight: 600; }
.ramp { display: flex; align-items: center; gap: 10px; margin-top: 8px; }
.ramp i { flex: 1; height: 10px; border-radius: 5px; }
table { border-collapse: collapse; width: 100%; max-width: 640px; }
td { padding: 5px 0; border-bottom: 1px solid var(--line); }
td + td { text-align: right; font-variant-numeric: tabular-nums; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 14px; white-space: pre-wrap; }
summary { cursor: pointer; color: var(--accent); }
)";

/// RFC 4648, section 4.
std::string base64(std::span<const uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t k) { return i + k < bytes.size() ? uint32_t(bytes[i + k]) : 0u; };
    const uint32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += kDigits[bits >> 18];
    text += kDigits[(bits >> 12) & 63];
    text += i + 1 < bytes.size() ? kDigits[(bits >> 6) & 63] : '=';
    text += i + 2 < bytes.size() ? kDigits[bits & 63] : '=';
  }
  return text;
}

}  // namespace

std::string page_head(std::string_view title) {
  return "<!doctype html>\n<html lang=en>\n<meta charset=utf-8>\n<meta name=viewport content=\"width=device-width, "
         "initial-scale=1\">\n<title>" +
         escaped(title) + " \xe2\x80\x93 Trueshade</title>\n<style>" + std::string(kStyle) + "</style>\n<main>\n";
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

std::string figure(const Image& image, const std::string& name, const std::string& about) {
  constexpr int kSmall = 600;  // pixels; a column of pictures is about as wide
  const std::string kind = image.width < kSmall ? "<figure><img class=small alt=" : "<figure><img alt=";
  return kind + "\"" + escaped(name) + "\" src=\"data:image/png;base64," + base64(encode_png(image, {})) +
         "\"><figcaption><b>" + escaped(name) + "</b> " + about + "</figcaption></figure>\n";
}

std::string notes_part(std::span<const std::string> lines) {
  std::string html;
  for (const std::string& line : lines) html += "<p class=note>Note: " + escaped(line) + ".</p>\n";
  return html;
}

std::string fact(const std::string& value, const std::string& name) {
  return "<div class=fact><b>" + escaped(value) + "</b><span>" + escaped(name) + "</span></div>\n";
}

}  // namespace trueshade
