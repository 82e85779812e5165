#include "cli/pages/viewer.h"

#include <algorithm>

#include "core/image_files/zlib_stream.h"

namespace trueshade {
namespace {

std::string json_of(const Compared& c) {
  JsonObject json;
  json.put("reference", c.reference).put("test", c.test).put("about", c.about);
  return json.text();
}

std::string json_of(const Places& p) {
  JsonArray pixels, color;
  for (const Places::Pixel& pixel : p.pixels) {
    JsonArray one;
    one.add_raw(std::to_string(pixel.x)).add_raw(std::to_string(pixel.y));
    if (!pixel.layer.empty()) one.add_raw(json_string(pixel.layer));
    pixels.add_raw(one.text());
  }
  for (const uint8_t code : p.color) color.add_raw(std::to_string(code));
  return JsonObject()
      .put("name", p.name)
      .put("about", p.about)
      .put("is_violations", p.are_violations)
      .put_raw("color", color.text())
      .put_raw("pixels", pixels.text())
      .text();
}

std::string json_of(const PixelExplanation& e) {
  JsonObject json;
  json.put("x", e.x).put("y", e.y).put("title", e.title).put("text", e.text);
  JsonArray legal;
  for (const auto& [low, high] : e.legal)
    legal.add_raw(JsonArray().add_raw(json_number(low)).add_raw(json_number(high)).text());
  if (!e.legal.empty()) json.put_raw("legal", legal.text());
  return json.text();
}

/// JSON that ends no element of HTML, whatever names are in it.
std::string in_html(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

}  // namespace

std::string viewer_part(const PageViewer& viewer, const std::string& pictures, int threads) {
  std::string html = "<div class=static>" + pictures + "</div>\n<div class=viewer id=viewer></div>\n";
  JsonArray layers, places, points;
  for (const PageLayer& layer : viewer.layers) {
    const auto base = std::find_if(viewer.layers.begin(), viewer.layers.end(), [&](const PageLayer& other) {
      return !layer.base.empty() && other.id == layer.base;
    });
    WrittenLayer w = written(layer, base == viewer.layers.end() ? nullptr : &*base, threads);
    layers.add_raw(w.json);
    html += w.elements;
  }
  for (const Places& p : viewer.places) places.add_raw(json_of(p));
  for (const PixelExplanation& e : viewer.explanations) points.add_raw(json_of(e));
  JsonObject manifest;
  manifest.put("width", viewer.layers.front().width).put("height", viewer.layers.front().height);
  manifest.put("tile", kTileSide).put("gain", viewer.gain).put_raw("layers", layers.text());
  if (viewer.compared) manifest.put_raw("compared", json_of(*viewer.compared));
  if (!viewer.explain_command.empty()) manifest.put("explain", viewer.explain_command);
  if (!viewer.opens.empty()) manifest.put("opens", viewer.opens);
  manifest.put_raw("marks", places.text());
  // Texts of explanations are long and alike.
  const std::string explanations = points.text();
  const std::string packed =
      base64(zlib_stream({reinterpret_cast<const uint8_t*>(explanations.data()), explanations.size()}));
  html += "<script type=\"text/plain\" id=\"viewer-explanations\">" + packed + "</script>\n";
  return html + "<script type=\"application/json\" id=\"viewer-manifest\">" + in_html(manifest.text()) + "</script>\n";
}

}  // namespace trueshade
