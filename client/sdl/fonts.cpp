#include "client/sdl/fonts.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <system_error>

namespace fts::sdl {
namespace {

constexpr float kMinUnit = 0.5F, kMaxUnit = 4.0F;
constexpr float kReferenceWidth = 1280.0F, kReferenceHeight = 720.0F;

using Candidates = std::initializer_list<const char*>;
constexpr const char* kDejaVu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kDejaVuBold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
const Candidates kRegular = {"/usr/share/fonts/opentype/inter/Inter-Regular.otf", kDejaVu};
const Candidates kSemiBold = {"/usr/share/fonts/opentype/inter/Inter-SemiBold.otf", kDejaVuBold};
const Candidates kDisplay = {"/usr/share/fonts/opentype/inter/InterDisplay-Bold.otf", kDejaVuBold};

// Names and chat may be in any alphabet Inter has; signs used in formulas come along.
constexpr ImWchar kReadingRanges[] = {
    0x0020, 0x017f,  // Latin
    0x0370, 0x03ff,  // Greek
    0x0400, 0x045f,  // Cyrillic
    0x2010, 0x2044,  // dashes, quotes, ellipsis
    0x2070, 0x208e,  // superscripts, subscripts
    0x2190, 0x2193,  // arrows
    0x2200, 0x2265,  // sums, differences
    0,
};
constexpr ImWchar kDisplayRanges[] = {0x0020, 0x00ff, 0x2010, 0x2026, 0x2190, 0x2193, 0};

ImFont* add_font(ImFontAtlas& atlas, const Candidates& candidates, float size_px,
                 const ImWchar* ranges) {
    ImFontConfig config;
    config.OversampleH = 2;
    config.OversampleV = 1;
    for (const char* path : candidates) {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored)) continue;
        if (ImFont* font = atlas.AddFontFromFileTTF(path, size_px, &config, ranges)) return font;
    }
    config.SizePixels = size_px;
    return atlas.AddFontDefault(&config);
}

const Candidates& candidates_for(TextStyle style) {
    switch (style) {
        case TextStyle::kCaption:
        case TextStyle::kBody:
            return kRegular;
        case TextStyle::kStrong:
        case TextStyle::kHeading:
            return kSemiBold;
        case TextStyle::kTitle:
        case TextStyle::kDisplay:
            return kDisplay;
    }
    return kRegular;
}

}  // namespace

float unit_for(ImVec2 window_size_px) {
    const float fit =
        std::min(window_size_px.x / kReferenceWidth, window_size_px.y / kReferenceHeight);
    return std::clamp(fit, kMinUnit, kMaxUnit);
}

TypeScale build_type_scale(float unit, float pixel_ratio) {
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    io.Fonts->Flags |= ImFontAtlasFlags_NoBakedLines;
    TypeScale scale;
    scale.unit = unit;
    for (std::size_t i = 0; i < kTextStyleCount; ++i) {
        const auto style = static_cast<TextStyle>(i);
        const bool reading = style <= TextStyle::kHeading;
        ImFont* font =
            add_font(*io.Fonts, candidates_for(style), scale.size_px(style) * pixel_ratio,
                     reading ? kReadingRanges : kDisplayRanges);
        scale.fonts[i] = font;
    }
    io.Fonts->Build();
    for (ImFont* font : scale.fonts) font->Scale = 1.0F / pixel_ratio;
    io.FontDefault = scale.font(TextStyle::kBody);
    return scale;
}

}  // namespace fts::sdl
