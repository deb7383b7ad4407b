// The few controls that screens are made of. Each works with mouse, keyboard and gamepad (ImGui's
// navigation) and is drawn in the house style.
#pragma once

#include <cstddef>
#include <string>

#include "client/sdl/canvas.h"

namespace fts::sdl {

// A window-filling layer that takes controls; drawing goes to it while it lives. The layer that
// appeared last lies on top and has the focus; a layer made with `at_bottom` stays below.
class Layer {
  public:
    Layer(const char* name, Canvas& canvas, bool at_bottom = false);
    ~Layer();
    Layer(const Layer&) = delete;
    Layer& operator=(const Layer&) = delete;

  private:
    Canvas& canvas_;
    ImDrawList* previous_;
};

enum class ButtonKind : std::uint8_t { kPrimary, kPlain };

// True in the frame it is pressed; a disabled one never is.
bool button(const Canvas& canvas, const Box& box, const char* label, ButtonKind kind,
            bool enabled = true);

// An invisible button over `box`: for cards. `focused` tells mouse, keyboard or gamepad is on it.
struct Touch {
    bool pressed = false;
    bool focused = false;
};
Touch touch_area(const Canvas& canvas, const Box& box, const char* id);

// A line to type in. `value` never grows beyond `max_bytes`. True when Enter was pressed in it.
bool text_field(const Canvas& canvas, const Box& box, const char* id, const char* hint,
                std::string& value, std::size_t max_bytes);

// The last control made has the keyboard and gamepad focus when its layer appears: Enter presses
// it.
void focus_by_default();

// A key as it is printed on a keyboard. Returns its width.
float key_cap(const Canvas& canvas, ImVec2 at, const char* key);

}  // namespace fts::sdl
