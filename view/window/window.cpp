#include "view/window/window.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"
#include "view/window/panels.h"

namespace trueshade::viewer {
namespace {

constexpr uint32_t kBackground = 0x0c0d0f;
constexpr int kLeastSide = 64;

double ms_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double, std::milli>(b - a).count();
}

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

/// Whether Wayland may be there. Its library complains on standard error by itself where no folder for it is named.
bool has_wayland() { return is_set("WAYLAND_DISPLAY") || is_set("XDG_RUNTIME_DIR"); }

Error no_display(const std::string& reason) {
  return {ErrorKind::io, "display", "a window cannot be opened: " + reason,
          "run it in a desktop, or under xvfb-run; trueshade render needs no display"};
}

/// Whether the display takes words 0x00RRGGBB from memory. By itself SDL draws a window's memory by OpenGL, which
/// without a GPU works on the cores that draw the pictures. Wayland has no other way, nor have displays of other words.
bool has_shared_words() {
  SDL_DisplayMode mode{};
  return std::string_view(SDL_GetCurrentVideoDriver()) == "x11" && SDL_GetDesktopDisplayMode(0, &mode) == 0 &&
         (mode.format == SDL_PIXELFORMAT_RGB888 || mode.format == SDL_PIXELFORMAT_ARGB8888);
}

/// The picture in its place, nearest pixels where it is not shown one to one.
void compose(const DrawnPicture& picture, const PicturePlace& place, const Canvas& canvas) {
  const int width = picture.frame.color.width, height = picture.frame.color.height;
  const int x0 = std::max(place.x, 0), x1 = std::min(place.x + place.width, canvas.width);
  std::vector<uint32_t> words(place.scale == 1.0 ? 0 : size_t(width));
  std::vector<int> columns(place.scale == 1.0 ? 0 : size_t(x1 - x0));
  for (size_t i = 0; i < columns.size(); ++i) columns[i] = std::clamp(place.column(x0 + int(i)), 0, width - 1);
  for (int y = 0; y < canvas.height; ++y) {
    uint32_t* const row = canvas.row(y);
    if (y < place.y || y >= place.y + place.height) {
      std::fill(row, row + canvas.width, kBackground);
      continue;
    }
    std::fill(row, row + x0, kBackground);
    std::fill(row + x1, row + canvas.width, kBackground);
    const int line = std::clamp(place.line(y), 0, height - 1);
    if (place.scale == 1.0) {
      read_words(picture.frame.color, picture.words, x0 - place.x, line, {row + x0, row + x1});
      continue;
    }
    read_words(picture.frame.color, picture.words, 0, line, words);
    for (int x = x0; x < x1; ++x) row[x] = words[size_t(columns[size_t(x - x0)])];
  }
}

}  // namespace

Display::Display() {
  SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");
  // Without this hint SDL falls back to its driver "offscreen" where there is no display, and nobody sees the window.
  if (!is_set("SDL_VIDEODRIVER"))
    SDL_SetHintWithPriority(SDL_HINT_VIDEODRIVER, has_wayland() ? "x11,wayland" : "x11", SDL_HINT_OVERRIDE);
  if (SDL_Init(SDL_INIT_VIDEO) != 0) throw no_display(SDL_GetError());
  if (has_shared_words()) SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
  wake_event_ = SDL_RegisterEvents(1);
}

Display::~Display() { SDL_Quit(); }

void Display::wake() const {
  SDL_Event event{};
  event.type = wake_event_;
  SDL_PushEvent(&event);
}

double Display::text_scale() const {
  float dots = 96.0f;
  if (SDL_GetDisplayDPI(0, nullptr, &dots, nullptr) != 0) return 1.0;
  return std::clamp(std::round(double(dots) / 96.0 * 4.0) / 4.0, 1.0, 3.0);
}

Window::Window(const Display& display, Session& session, const Look& look)
    : display_(display), session_(session), fixed_picture_(look.fixed_picture), scale_(look.scale) {
  const std::string title = session.facts().name + " - trueshade";
  window_ = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, look.width, look.height,
                             SDL_WINDOW_RESIZABLE);
  if (window_ == nullptr || SDL_GetWindowSurface(window_) == nullptr) throw no_display(SDL_GetError());
  SDL_SetWindowMinimumSize(window_, kLeastSide, kLeastSide);
  SDL_DisplayMode mode{};
  if (SDL_GetWindowDisplayMode(window_, &mode) == 0 && mode.refresh_rate >= 50)
    shortest_ = std::chrono::duration<double>(1.0 / mode.refresh_rate - 0.0005);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  fonts_ = set_style(scale_);
  ImGui::GetIO().Fonts->Build();
  input_.emplace(window_, WindowInput::Handlers{[this](Action action) { session_.act(action); },
                                                [this](int x, int y) { click(x, y); },
                                                [this](double steps) { session_.change_speed(steps); }});
  SDL_StopTextInput();
  fit_picture();
  last_pass_ = last_new_picture_ = Clock::now();
}

Window::~Window() {
  ImGui::DestroyContext();
  SDL_DestroyWindow(window_);
}

void Window::fit_picture() {
  if (fixed_picture_) return;
  int width = 0, height = 0;
  SDL_GetWindowSize(window_, &width, &height);
  if (!session_.desk().hidden) height -= bar_rows(scale_);
  session_.set_size(std::max(width, kLeastSide), std::max(height, kLeastSide));
}

/// Above the bar; where a picture that fits the window does not fit there, the bar covers its last rows.
PicturePlace Window::place_of(const Image& image, int width, int height) const {
  const int above = height - bar_rows(scale_);
  const bool fits_window = image.width <= width && image.height <= height;
  const bool has_all = session_.desk().hidden || above < kLeastSide || (fits_window && image.height > above);
  return {image.width, image.height, width, has_all ? height : above};
}

void Window::set_size(int width, int height) {
  SDL_SetWindowSize(window_, width, height);
  SDL_PumpEvents();
  fit_picture();
}

void Window::click(int x, int y) {
  if (!shown_) return;
  int width = 0, height = 0;
  SDL_GetWindowSize(window_, &width, &height);
  const Image& image = shown_->frame.color;
  const PicturePlace place = place_of(image, width, height);
  const int column = place.column(x), line = place.line(y);
  if (column < 0 || line < 0 || column >= image.width || line >= image.height) return;
  session_.desk().panel = Panel::pixel;
  session_.click(column, line);
}

void Window::take(const SDL_Event& event) {
  if (event.type == display_.wake_event()) return;  // who is woken looks for what is new
  frames_to_show_ = kSettlingFrames;
  if (event.type == SDL_QUIT) session_.desk().ends = true;
  input_->take(event);
}

void Window::take_events(std::chrono::milliseconds longest) {
  SDL_Event event;
  if (SDL_WaitEventTimeout(&event, int(std::max<int64_t>(longest.count(), 1))) == 0) return;
  do {
    try {
      take(event);
    } catch (const Error& error) {
      session_.tell(error.what(), true);
    }
  } while (SDL_PollEvent(&event) != 0);
}

void Window::pass_time() {
  const Clock::time_point now = Clock::now();
  const bool was_moving = std::exchange(was_moving_, session_.moves() || input_->holds());
  const double longest = was_moving ? 0.1 : 1.0 / 60.0;  // a first step is not as long as the rest before it
  const double passed = std::chrono::duration<double>(now - last_pass_).count();
  last_pass_ = now;
  int width = 0, height = 0;
  SDL_GetWindowSize(window_, &width, &height);
  CameraInput input = input_->camera_input(session_.field_of_view() / std::max(height, 1));
  const CameraInput also = std::exchange(scripted, {});
  input.turn += also.turn, input.orbit += also.orbit, input.nearer += also.nearer;
  session_.pass(input, input.rests() && !session_.moves() ? passed : std::min(passed, longest));
  for (const std::string& problem : session_.take_problems())
    std::fprintf(stderr, "trueshade: note: %s\n", printable(problem, Lines::one).c_str());
}

bool Window::is_due() const {
  return shown_ != session_.picture() || frames_to_show_ > 0 || shown_hash_ != session_.hash() || session_.notice() ||
         shown_model_ != session_.model_revision();
}

bool Window::step(std::chrono::milliseconds longest) {
  const bool moving = session_.moves() || input_->holds() || !session_.state().camera;
  const bool fresh = shown_ != session_.picture();
  const auto patience = frames_to_show_ > 0 || fresh ? std::chrono::milliseconds(1)
                        : moving                     ? std::chrono::milliseconds(16)
                                                     : std::chrono::milliseconds(session_.notice() ? 50 : 200);
  const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(last_show_ + shortest_ - Clock::now());
  if (rest.count() > 0) SDL_Delay(uint32_t(rest.count()));
  take_events(std::min(patience, longest));
  fit_picture();
  pass_time();
  if (std::exchange(full_screen_, session_.desk().full_screen) != session_.desk().full_screen)
    SDL_SetWindowFullscreen(window_, session_.desk().full_screen ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
  if (is_due()) show();
  return !session_.desk().ends;
}

void Window::draw_panels(const Canvas& canvas) {
  const Image& image = shown_->frame.color;
  const Clock::time_point now = Clock::now();
  input_->begin_ui_frame(canvas.width, canvas.height, std::chrono::duration<double>(now - last_show_).count());
  ImGui::NewFrame();
  const PanelContext context{session_,
                             fonts_,
                             times_,
                             *shown_,
                             place_of(image, canvas.width, canvas.height),
                             float(scale_),
                             float(canvas.width),
                             float(canvas.height)};
  try {
    if (!session_.desk().hidden) {
      draw_marks(context);
      draw_status(context);
      draw_scale(context);
      draw_bar(context);
      draw_panel(context);
    }
    draw_broken_model(context);
    draw_notice(context);
    draw_help(context);
  } catch (const Error& error) {
    ImGui::ErrorCheckEndFrameRecover(nullptr);  // ends what a panel has begun and not ended
    session_.tell(error.what(), true);
  }
  ImGui::Render();
  draw_ui(*ImGui::GetDrawData(), *ImGui::GetIO().Fonts, canvas);
}

void Window::show() {
  const std::shared_ptr<const DrawnPicture> picture = session_.picture();
  if (!picture) return;
  const bool is_new = picture != shown_;
  shown_ = picture;
  shown_hash_ = session_.hash();
  if (std::exchange(shown_model_, session_.model_revision()) != session_.model_revision())
    frames_to_show_ = kSettlingFrames;
  frames_to_show_ = is_new ? std::max(frames_to_show_, 1) : frames_to_show_;
  frames_to_show_ = std::max(frames_to_show_ - 1, 0);
  SDL_Surface* const surface = SDL_GetWindowSurface(window_);
  if (surface == nullptr || surface->format->BytesPerPixel != 4) throw no_display("its pixels are not of 32 bits");
  const Clock::time_point begin = Clock::now();
  const Canvas canvas{static_cast<uint32_t*>(surface->pixels), surface->w, surface->h, surface->pitch / 4};
  compose(*picture, place_of(picture->frame.color, canvas.width, canvas.height), canvas);
  const Clock::time_point composed = Clock::now();
  draw_panels(canvas);
  const Clock::time_point drawn = Clock::now();
  SDL_UpdateWindowSurface(window_);
  const Clock::time_point end = Clock::now();
  last_show_ = begin;
  if (!is_new) return;
  PictureTimes times;
  times[Part::interval] = ms_between(last_new_picture_, end);
  times[Part::draw] = picture->draw_ms, times[Part::convert] = picture->convert_ms;
  times[Part::compose] = ms_between(begin, composed);
  times[Part::panels] = ms_between(composed, drawn);
  times[Part::present] = ms_between(drawn, end);
  times.core_ms = picture->frame.stats.core_ms;
  last_new_picture_ = end;
  times_.add(times);
}

void Window::save_screenshot(const std::string& path) {
  const SDL_Surface* const surface = SDL_GetWindowSurface(window_);
  if (surface == nullptr) throw no_display(SDL_GetError());
  Image image(surface->w, surface->h, Format::rgba8);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const uint32_t word = static_cast<const uint32_t*>(surface->pixels)[y * (surface->pitch / 4) + x];
      const uint8_t rgba[4] = {uint8_t(word >> 16), uint8_t(word >> 8), uint8_t(word), 255};
      std::memcpy(image.texel(x, y), rgba, 4);
    }
  write_image(path, image, {}, {});
}

}  // namespace trueshade::viewer
