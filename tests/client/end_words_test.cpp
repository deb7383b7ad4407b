// Every way a session can end is told in words that name the server and a remedy.
#include "client/core/end_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fts::client {
namespace {

using net::DisconnectReason;
using testing::HasSubstr;
using testing::Not;

net::Address server() {
    return {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 10, 0, 0, 1}, 7801};
}

std::string words(DisconnectReason reason, const std::string& detail = "",
                  std::uint16_t their_version = 0) {
    return words_for({0, reason, detail, their_version}, server(), 3, 5.0);
}

TEST(EndWords, name_the_server_whatever_the_reason) {
    for (int i = 0; i <= static_cast<int>(DisconnectReason::kKicked); ++i) {
        const std::string text = words(static_cast<DisconnectReason>(i));
        EXPECT_THAT(text, HasSubstr("10.0.0.1:7801")) << i;
        EXPECT_TRUE(text.ends_with('.') || text.ends_with('?')) << text;
    }
}

TEST(EndWords, ask_for_server_and_port_when_nothing_answers) {
    EXPECT_EQ(words(DisconnectReason::kUnreachable),
              "No answer from 10.0.0.1:7801. Is the server running, and UDP port 7801 open?");
}

TEST(EndWords, say_that_a_server_is_full) {
    EXPECT_THAT(words(DisconnectReason::kServerFull), HasSubstr("is full"));
}

TEST(EndWords, name_both_versions_and_who_must_update) {
    const std::string newer = words(DisconnectReason::kWrongVersion, "", 4);
    EXPECT_THAT(newer, HasSubstr("version 4"));
    EXPECT_THAT(newer, HasSubstr("version 3"));
    EXPECT_THAT(newer, HasSubstr("Update this program"));
    EXPECT_THAT(words(DisconnectReason::kWrongVersion, "", 2), HasSubstr("update the server"));
}

TEST(EndWords, point_at_the_pin_when_a_key_has_changed) {
    EXPECT_THAT(words(DisconnectReason::kKeyChanged), HasSubstr("known_servers"));
}

TEST(EndWords, say_how_long_nothing_arrived) {
    EXPECT_THAT(words(DisconnectReason::kTimeout), HasSubstr("5 s"));
}

TEST(EndWords, pass_on_what_the_other_end_wrote_but_no_control_characters) {
    const std::string text = words(DisconnectReason::kKicked, "go\x1b[2J away\n");
    EXPECT_THAT(text, HasSubstr("go?[2J away?"));
    EXPECT_THAT(words(DisconnectReason::kRefused, std::string(5000, 'x')),
                Not(HasSubstr(std::string(300, 'x'))));
}

TEST(Printable, cuts_between_characters_of_several_bytes) {
    EXPECT_EQ(printable("\xc3\xa4\xc3\xb6\xc3\xbc", 5), "\xc3\xa4\xc3\xb6");
    EXPECT_EQ(printable("abc", 3), "abc");
    EXPECT_EQ(printable("", 3), "");
    EXPECT_EQ(printable("\xbf\xbf\xbf\xbf", 2), "");
}

}  // namespace
}  // namespace fts::client
