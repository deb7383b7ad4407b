// What a client keeps on disk: identity, pinned servers, settings.
#include "client/core/data_folder.h"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/core/known_servers.h"
#include "client/core/settings.h"
#include "tests/harness/temp_folder.h"
#include "tests/net/memory_network.h"

namespace fts::client {
namespace {

using harness::TempFolder;
using testing::HasSubstr;

net::PublicKey key_of(std::uint8_t first) {
    net::PublicKey key{};
    key.front() = first;
    key.back() = 0xab;
    return key;
}

std::string content_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TEST(DataFolder, gives_the_same_player_back_the_next_time) {
    const TempFolder temp;
    std::string error;
    const auto first = DataFolder::open(temp.file("deep/inside"), error);
    ASSERT_TRUE(first) << error;
    const auto key = first->player_key(error);
    ASSERT_TRUE(key) << error;
    const auto second = DataFolder::open(temp.file("deep/inside"), error);
    ASSERT_TRUE(second) << error;
    EXPECT_EQ(second->player_key(error)->public_key, key->public_key);
    EXPECT_NE(second->player_key(error, "bot-1.key")->public_key, key->public_key);
}

TEST(DataFolder, is_for_its_owner_only) {
    const TempFolder temp;
    std::string error;
    ASSERT_TRUE(DataFolder::open(temp.file("new"), error)) << error;
    const auto mode = std::filesystem::status(temp.path() / "new").permissions();
    EXPECT_EQ(mode, std::filesystem::perms::owner_all);
}

TEST(DataFolder, says_which_path_cannot_be_used_and_what_to_do) {
    const TempFolder temp;
    std::ofstream(temp.file("file")) << "not a folder";
    std::string error;
    EXPECT_FALSE(DataFolder::open(temp.file("file"), error));
    EXPECT_THAT(error, HasSubstr(temp.file("file")));
    EXPECT_THAT(error, HasSubstr("--data"));
}

TEST(KnownServers, know_a_pinned_server_after_a_restart) {
    const TempFolder temp;
    const auto path = temp.path() / "known_servers";
    std::string error;
    KnownServers known = KnownServers::load(path);
    EXPECT_TRUE(known.problems().empty());
    EXPECT_FALSE(known.find(net::address_of(1)));
    ASSERT_TRUE(known.pin(net::address_of(1), key_of(1), error)) << error;
    ASSERT_TRUE(known.pin(net::address_of(2), key_of(2), error)) << error;
    const KnownServers again = KnownServers::load(path);
    EXPECT_EQ(again.find(net::address_of(1)), key_of(1));
    EXPECT_EQ(again.find(net::address_of(2)), key_of(2));
    EXPECT_FALSE(again.find(net::address_of(1, 7778)));
}

TEST(KnownServers, hold_no_server_of_this_machine_to_a_key) {
    const harness::TempFolder temp;
    std::string error;
    const std::filesystem::path path = temp.path() / "known_servers";
    KnownServers known = KnownServers::load(path);
    for (const char* here : {"127.0.0.1:7777", "127.1.2.3:7777", "[::1]:7777"}) {
        const net::Address server = *net::resolve(here, 0).address;
        EXPECT_TRUE(net::is_loopback(server)) << here;
        EXPECT_TRUE(known.pin(server, key_of(1), error)) << here;
        EXPECT_FALSE(known.find(server)) << here;
    }
    const net::Address elsewhere = *net::resolve("192.0.2.1:7777", 0).address;
    EXPECT_FALSE(net::is_loopback(elsewhere));
    EXPECT_TRUE(known.pin(elsewhere, key_of(1), error)) << error;
    EXPECT_TRUE(known.find(elsewhere));
}

TEST(KnownServers, keep_the_first_key_they_saw) {
    const TempFolder temp;
    const auto path = temp.path() / "known_servers";
    std::string error;
    KnownServers known = KnownServers::load(path);
    known.pin(net::address_of(1), key_of(1), error);
    known.pin(net::address_of(1), key_of(2), error);
    EXPECT_EQ(KnownServers::load(path).find(net::address_of(1)), key_of(1));
}

TEST(KnownServers, report_damaged_lines_and_keep_them) {
    const TempFolder temp;
    const auto path = temp.path() / "known_servers";
    const std::string good = net::to_string(net::address_of(1)) + " " + to_hex(key_of(1));
    const std::string damaged[] = {"10.0.0.9:1 abc", "nonsense", good + " more",
                                   "10.0.0.8:1 " + std::string(64, 'g')};
    std::ofstream file(path);
    file << "# a remark\n\n" << good << "\n";
    for (const std::string& line : damaged) file << line << "\n";
    file.close();
    KnownServers known = KnownServers::load(path);
    ASSERT_EQ(known.problems().size(), 4U);
    EXPECT_THAT(known.problems()[0], HasSubstr(path.string() + ":4"));
    EXPECT_EQ(known.find(net::address_of(1)), key_of(1));
    std::string error;
    ASSERT_TRUE(known.pin(net::address_of(2), key_of(2), error)) << error;
    for (const std::string& line : damaged) EXPECT_THAT(content_of(path), HasSubstr(line + "\n"));
}

TEST(KnownServers, leave_no_draft_behind) {
    const TempFolder temp;
    std::string error;
    KnownServers known = KnownServers::load(temp.path() / "known_servers");
    ASSERT_TRUE(known.pin(net::address_of(1), key_of(1), error)) << error;
    int files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(temp.path())) {
        ++files;
    }
    EXPECT_EQ(files, 1);
}

TEST(KnownServers, say_when_a_pin_cannot_be_written) {
    const TempFolder temp;
    KnownServers known = KnownServers::load(temp.path() / "absent" / "known_servers");
    std::string error;
    EXPECT_FALSE(known.pin(net::address_of(1), key_of(1), error));
    EXPECT_THAT(error, HasSubstr("absent"));
}

TEST(Settings, come_back_as_they_were_saved) {
    const TempFolder temp;
    const auto path = temp.path() / "settings";
    Settings settings;
    settings.player_name = "Ada = Countess";
    settings.last_server = "[::1]:7777";
    settings.others["volume"] = "0.5";
    std::string error;
    ASSERT_TRUE(save_settings(settings, path, error)) << error;
    const LoadedSettings loaded = load_settings(path);
    EXPECT_TRUE(loaded.problems.empty());
    EXPECT_EQ(loaded.settings.player_name, settings.player_name);
    EXPECT_EQ(loaded.settings.last_server, settings.last_server);
    EXPECT_EQ(loaded.settings.others, settings.others);
}

TEST(Settings, report_lines_that_make_no_sense) {
    const TempFolder temp;
    const auto path = temp.path() / "settings";
    std::ofstream(path) << "player_name = Bob\n\nwhat is this\n= nothing\n";
    const LoadedSettings loaded = load_settings(path);
    EXPECT_EQ(loaded.settings.player_name, "Bob");
    ASSERT_EQ(loaded.problems.size(), 2U);
    EXPECT_THAT(loaded.problems[0], HasSubstr(":3"));
    EXPECT_THAT(loaded.problems[1], HasSubstr(":4"));
}

TEST(Settings, cannot_be_smuggled_in_through_a_line_break) {
    const TempFolder temp;
    const auto path = temp.path() / "settings";
    Settings settings;
    settings.player_name = "x\nlast_server = evil";
    std::string error;
    ASSERT_TRUE(save_settings(settings, path, error)) << error;
    EXPECT_EQ(load_settings(path).settings.last_server, "");
}

}  // namespace
}  // namespace fts::client
