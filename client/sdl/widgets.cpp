#include "client/sdl/widgets.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include <imgui_internal.h>

namespace fts::sdl {
namespace {

bool highlights_focus() {
    return !ImGui::GetCurrentContext()->NavDisableHighlight;
}

void focus_ring(const Canvas& canvas, const Box& box) {
    const float out = canvas.px(3);
    canvas.list->AddRect({box.min.x - out, box.min.y - out}, {box.max.x + out, box.max.y + out},
                         palette::kText, canvas.px(space::kCorner) + out, 0,
                         std::max(1.5F, canvas.px(2)));
}

ImVec4 as_vec4(Colour colour) {
    return ImGui::ColorConvertU32ToFloat4(colour);
}

}  // namespace

Layer::Layer(const char* name, Canvas& canvas, bool at_bottom)
    : canvas_(canvas), previous_(canvas.list) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(canvas.size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                             ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
    if (at_bottom) flags |= ImGuiWindowFlags_NoBringToFrontOnFocus;
    ImGui::Begin(name, nullptr, flags);
    canvas_.list = ImGui::GetWindowDrawList();
}

Layer::~Layer() {
    ImGui::End();
    ImGui::PopStyleVar(2);
    canvas_.list = previous_;
}

Touch touch_area(const Canvas&, const Box& box, const char* id) {
    ImGui::SetCursorScreenPos(box.min);
    Touch touch;
    touch.pressed =
        ImGui::InvisibleButton(id, {std::max(box.width(), 1.0F), std::max(box.height(), 1.0F)});
    if (ImGui::IsItemFocused()) {
        touch.pressed |= ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
    }
    touch.focused = ImGui::IsItemHovered() || (ImGui::IsItemFocused() && highlights_focus());
    return touch;
}

bool button(const Canvas& canvas, const Box& box, const char* label, ButtonKind kind,
            bool enabled) {
    const Touch touch = touch_area(canvas, box, label);
    const bool held = ImGui::IsItemActive();
    const bool primary = kind == ButtonKind::kPrimary;
    Colour fill = primary ? palette::kAccent : palette::kCard;
    if (touch.focused) fill = primary ? mix(fill, palette::kText, 0.25) : palette::kCardHover;
    if (held) fill = mix(fill, palette::kInk, 0.2);
    Colour ink = primary ? palette::kOnAccent : palette::kText;
    if (!enabled) {
        fill = fade(palette::kCard, 0.6);
        ink = palette::kTextFaint;
    }
    canvas.panel(box, fill, primary && enabled ? fill : palette::kLine);
    if (ImGui::IsItemFocused() && highlights_focus()) focus_ring(canvas, box);
    canvas.text_middle(box.centre(), TextStyle::kStrong, ink, label, Align::kCentre);
    return touch.pressed && enabled;
}

bool text_field(const Canvas& canvas, const Box& box, const char* id, const char* hint,
                std::string& value, std::size_t max_bytes) {
    std::vector<char> buffer(max_bytes + 1, '\0');
    std::memcpy(buffer.data(), value.data(), std::min(value.size(), max_bytes));
    ImFont* font = canvas.type.font(TextStyle::kBody);
    ImGui::PushFont(font);
    const float padding = (box.height() - canvas.type.size_px(TextStyle::kBody)) / 2;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(canvas.px(14), padding));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, canvas.px(space::kCorner));
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, std::max(1.0F, canvas.px(1)));
    ImGui::PushStyleColor(ImGuiCol_FrameBg, as_vec4(palette::kField));
    ImGui::PushStyleColor(ImGuiCol_Border, as_vec4(palette::kLine));
    ImGui::PushStyleColor(ImGuiCol_Text, as_vec4(palette::kText));
    ImGui::PushStyleColor(ImGuiCol_TextDisabled, as_vec4(palette::kTextFaint));
    ImGui::PushStyleColor(ImGuiCol_TextSelectedBg, as_vec4(fade(palette::kAccent, 0.4)));
    ImGui::PushStyleColor(ImGuiCol_NavHighlight, as_vec4(fade(palette::kText, 0)));
    ImGui::SetCursorScreenPos(box.min);
    ImGui::SetNextItemWidth(box.width());
    const bool entered = ImGui::InputTextWithHint(
        id, hint, buffer.data(), buffer.size(),
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool active = ImGui::IsItemActive();
    const bool focused = ImGui::IsItemFocused() && highlights_focus();
    ImGui::PopStyleColor(6);
    ImGui::PopStyleVar(3);
    ImGui::PopFont();
    if (active) {
        canvas.list->AddRect(box.min, box.max, palette::kAccent, canvas.px(space::kCorner), 0,
                             std::max(1.5F, canvas.px(1.5F)));
    } else if (focused) {
        focus_ring(canvas, box);
    }
    value = buffer.data();
    return entered;
}

void focus_by_default() {
    ImGui::SetItemDefaultFocus();
}

float key_cap(const Canvas& canvas, ImVec2 at, const char* key) {
    const float size = canvas.px(12);
    const float text = canvas.text_width(TextStyle::kCaption, key) * size /
                       canvas.type.size_px(TextStyle::kCaption);
    const float width = std::max(text + canvas.px(12), canvas.px(22));
    const Box box{at, {at.x + width, at.y + canvas.px(20)}};
    canvas.list->AddRectFilled(box.min, box.max, fade(palette::kCard, 0.9), canvas.px(5));
    canvas.list->AddRect(box.min, box.max, palette::kLine, canvas.px(5), 0,
                         std::max(1.0F, canvas.px(1)));
    canvas.text_middle(box.centre(), TextStyle::kCaption, palette::kTextQuiet, key, Align::kCentre,
                       size);
    return width;
}

}  // namespace fts::sdl
