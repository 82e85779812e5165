#include "view/window/window_input.h"

#include <imgui.h>

#include <cstdlib>
#include <utility>

namespace trueshade::viewer {
namespace {

constexpr int kDragPixels = 4;  // from which on a press is no click

const char* clipboard_text(void*) {
  static char* text = nullptr;
  SDL_free(std::exchange(text, SDL_GetClipboardText()));
  return text;
}

void set_clipboard_text(void*, const char* text) { SDL_SetClipboardText(text); }

#if IMGUI_VERSION_NUM < 18700  // Debian 12's
constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeyPadEnter;
#else
constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeypadEnter;
#endif

void set_key_map() {
  constexpr std::pair<ImGuiKey, SDL_Scancode> kMap[] = {{ImGuiKey_Tab, SDL_SCANCODE_TAB},
                                                        {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
                                                        {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
                                                        {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
                                                        {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
                                                        {ImGuiKey_PageUp, SDL_SCANCODE_PAGEUP},
                                                        {ImGuiKey_PageDown, SDL_SCANCODE_PAGEDOWN},
                                                        {ImGuiKey_Home, SDL_SCANCODE_HOME},
                                                        {ImGuiKey_End, SDL_SCANCODE_END},
                                                        {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
                                                        {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
                                                        {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
                                                        {kKeypadEnter, SDL_SCANCODE_KP_ENTER},
                                                        {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
                                                        {ImGuiKey_A, SDL_SCANCODE_A},
                                                        {ImGuiKey_C, SDL_SCANCODE_C},
                                                        {ImGuiKey_V, SDL_SCANCODE_V},
                                                        {ImGuiKey_X, SDL_SCANCODE_X},
                                                        {ImGuiKey_Y, SDL_SCANCODE_Y},
                                                        {ImGuiKey_Z, SDL_SCANCODE_Z}};
  for (const auto& [key, scancode] : kMap) ImGui::GetIO().KeyMap[key] = scancode;
}

int button_index(uint8_t button) {
  return button == SDL_BUTTON_LEFT ? 0 : button == SDL_BUTTON_RIGHT ? 1 : button == SDL_BUTTON_MIDDLE ? 2 : -1;
}

}  // namespace

WindowInput::WindowInput(SDL_Window* window, Handlers handlers) : window_(window), handlers_(std::move(handlers)) {
  set_key_map();
  ImGui::GetIO().GetClipboardTextFn = clipboard_text;
  ImGui::GetIO().SetClipboardTextFn = set_clipboard_text;
}

void WindowInput::let_go() {
  held_.clear();
  drag_ = Drag::none;
  for (bool& down : ImGui::GetIO().KeysDown) down = false;
}

void WindowInput::take_key(const SDL_KeyboardEvent& key) {
  ImGuiIO& io = ImGui::GetIO();
  const bool down = key.type == SDL_KEYDOWN;
  if (key.keysym.scancode < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[key.keysym.scancode] = down;
  const auto mod = [&key](int which) { return (key.keysym.mod & which) != 0; };
  io.KeyCtrl = mod(KMOD_CTRL), io.KeyShift = mod(KMOD_SHIFT), io.KeyAlt = mod(KMOD_ALT);
  const std::optional<Key> known = key_named(SDL_GetKeyName(key.keysym.sym));
  if (!known) return;
  if (!down) held_.erase(known->action);
  if (!down || io.WantTextInput) return;
  if (known->held)
    held_.insert(known->action);
  else if (key.repeat == 0 || known->action == Action::step_ahead || known->action == Action::step_back)
    handlers_.act(known->action);
}

void WindowInput::take_button(const SDL_MouseButtonEvent& button) {
  const int index = button_index(button.button);
  if (index < 0) return;
  const bool down = button.type == SDL_MOUSEBUTTONDOWN;
  pointer_x_ = float(button.x), pointer_y_ = float(button.y);
  buttons_[index] = down;
  pressed_[index] = pressed_[index] || down;
  if (down && !ImGui::GetIO().WantCaptureMouse && drag_ == Drag::none) {
    const bool orbits = index == 2 || (SDL_GetModState() & KMOD_ALT) != 0;
    drag_ = orbits ? Drag::orbit : Drag::look;
    drag_button_ = button.button;
    pressed_x_ = button.x, pressed_y_ = button.y;
    moved_ = false;
  } else if (!down && drag_ != Drag::none && button.button == drag_button_) {
    drag_ = Drag::none;
    if (!moved_ && index == 0) handlers_.click(button.x, button.y);
  }
}

void WindowInput::take_motion(const SDL_MouseMotionEvent& motion) {
  pointer_x_ = float(motion.x), pointer_y_ = float(motion.y);
  if (drag_ == Drag::none) return;
  if (!moved_ && std::abs(motion.x - pressed_x_) + std::abs(motion.y - pressed_y_) < kDragPixels) return;
  moved_ = true;
  dragged_ += glm::dvec2(motion.xrel, -motion.yrel);
}

void WindowInput::take_wheel(double steps) {
  ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse)
    io.MouseWheel += float(steps);
  else if ((SDL_GetModState() & KMOD_ALT) != 0 || drag_ == Drag::orbit)
    nearer_ += steps;
  else
    handlers_.wheel(steps);
}

void WindowInput::take(const SDL_Event& event) {
  switch (event.type) {
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      return take_key(event.key);
    case SDL_TEXTINPUT:
      if (std::string_view(event.text.text) == "?" && !ImGui::GetIO().WantTextInput) return;  // the key beside Shift
      return ImGui::GetIO().AddInputCharactersUTF8(event.text.text);
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      return take_button(event.button);
    case SDL_MOUSEMOTION:
      return take_motion(event.motion);
    case SDL_MOUSEWHEEL:
      return take_wheel(event.wheel.preciseY);
    case SDL_WINDOWEVENT:
      if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) let_go();
      if (event.window.event == SDL_WINDOWEVENT_LEAVE && !drags()) pointer_x_ = pointer_y_ = -1e9f;
      return;
    default:
      return;
  }
}

CameraInput WindowInput::camera_input(double radians) {
  const auto axis = [this](Action plus, Action minus) {
    return double(held_.count(plus)) - double(held_.count(minus));
  };
  CameraInput input;
  input.fly = {axis(Action::right, Action::left), axis(Action::up, Action::down), axis(Action::forward, Action::back)};
  input.pace = (held_.count(Action::faster) != 0 ? 4.0 : 1.0) * (held_.count(Action::slower) != 0 ? 0.25 : 1.0);
  const glm::dvec2 dragged = std::exchange(dragged_, glm::dvec2(0.0)) * radians;
  (drag_ == Drag::orbit ? input.orbit : input.turn) = drag_ == Drag::orbit ? 3.0 * dragged : dragged;
  input.nearer = std::exchange(nearer_, 0.0);
  return input;
}

void WindowInput::begin_ui_frame(int width, int height, double seconds) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {float(width), float(height)};
  io.DeltaTime = float(std::max(seconds, 1e-4));
  io.MousePos = drags() && moved_ ? ImVec2(-1e9f, -1e9f) : ImVec2(pointer_x_, pointer_y_);
  for (int i = 0; i < 3; ++i) {
    const bool of_panel = drag_ == Drag::none || button_index(drag_button_) != i;
    io.MouseDown[i] = of_panel && (buttons_[i] || pressed_[i]);  // a press that is shorter than a frame counts too
    pressed_[i] = false;
  }
  if (io.WantTextInput != (SDL_IsTextInputActive() == SDL_TRUE))
    io.WantTextInput ? SDL_StartTextInput() : SDL_StopTextInput();
}

}  // namespace trueshade::viewer
