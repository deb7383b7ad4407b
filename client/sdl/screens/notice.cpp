#include "client/sdl/screens/notice.h"

#include <cmath>

#include "client/sdl/draw_arena.h"
#include "client/sdl/widgets.h"

namespace fts::sdl {
namespace {

void draw_spinner(const Canvas& canvas, ImVec2 centre) {
    const float radius = canvas.px(30), line = canvas.px(4);
    canvas.ring(centre, radius, fade(palette::kAccent, 0.18), line);
    const auto turn = static_cast<float>(std::fmod(canvas.time_s * 4.0, 6.2831853));
    canvas.list->PathArcTo(centre, radius, turn, turn + 1.6F, 24);
    canvas.list->PathStroke(palette::kAccent, 0, line);
}

// Two balls in elastic contact, for the head of the card.
void draw_mark(const Canvas& canvas, ImVec2 centre) {
    const float r = canvas.px(13);
    canvas.ring({centre.x - r, centre.y}, r, palette::kBad, canvas.px(3));
    canvas.ring({centre.x + r + canvas.px(14), centre.y}, r, palette::kTextFaint, canvas.px(3));
    canvas.dashed_line({centre.x + canvas.px(2), centre.y}, {centre.x + canvas.px(14), centre.y},
                       palette::kTextFaint, canvas.px(2), canvas.px(3));
}

}  // namespace

bool draw_connecting(Canvas& canvas, const std::string& server, bool joining) {
    const Layer layer("connecting", canvas);
    draw_background(canvas);
    const Box box = canvas.centred(460, 290);
    canvas.panel(box);
    const float middle = box.centre().x;
    draw_spinner(canvas, {middle, box.min.y + canvas.px(72)});
    canvas.text_middle({middle, box.min.y + canvas.px(140)}, TextStyle::kHeading, palette::kText,
                       joining ? "Joining the arena" : "Calling the server", Align::kCentre);
    canvas.text_middle({middle, box.min.y + canvas.px(172)}, TextStyle::kBody, palette::kTextQuiet,
                       canvas.elided(TextStyle::kBody, server, box.width() - canvas.px(48)),
                       Align::kCentre);
    const float top = box.max.y - canvas.px(24 + space::kButtonHeight);
    const Box box_of_button{{middle - canvas.px(90), top},
                            {middle + canvas.px(90), top + canvas.px(space::kButtonHeight)}};
    const bool cancelled = button(canvas, box_of_button, "Cancel", ButtonKind::kPlain);
    focus_by_default();
    return cancelled;
}

NoticeChoice draw_ended(Canvas& canvas, const std::string& title, const std::string& words) {
    const Layer layer("ended", canvas);
    draw_background(canvas);
    const Box box = canvas.centred(560, 340);
    canvas.panel(box);
    const float middle = box.centre().x;
    draw_mark(canvas, {middle - canvas.px(7), box.min.y + canvas.px(54)});
    canvas.text_middle({middle, box.min.y + canvas.px(104)}, TextStyle::kHeading, palette::kText,
                       canvas.elided(TextStyle::kHeading, title, box.width() - canvas.px(64)),
                       Align::kCentre);
    canvas.paragraph({middle, box.min.y + canvas.px(132)}, box.width() - canvas.px(80),
                     TextStyle::kBody, palette::kTextQuiet, words, Align::kCentre);
    const float top = box.max.y - canvas.px(28 + space::kButtonHeight);
    const float bottom = top + canvas.px(space::kButtonHeight);
    const float width = canvas.px(200), gap = canvas.px(8);
    NoticeChoice choice = NoticeChoice::kNone;
    if (button(canvas, {{middle - gap - width, top}, {middle - gap, bottom}}, "Back",
               ButtonKind::kPlain)) {
        choice = NoticeChoice::kBack;
    }
    if (button(canvas, {{middle + gap, top}, {middle + gap + width, bottom}}, "Try again",
               ButtonKind::kPrimary)) {
        choice = NoticeChoice::kRetry;
    }
    focus_by_default();
    return choice;
}

}  // namespace fts::sdl
