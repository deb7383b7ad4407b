#include "common/net/identity.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace fts::net {
namespace {

namespace fs = std::filesystem;

class Identity : public testing::Test {
  protected:
    Identity() {
        std::string pattern = (fs::temp_directory_path() / "fts-identity-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
        path = (folder / "player.key").string();
    }
    ~Identity() override {
        fs::permissions(folder, fs::perms::owner_all);
        fs::remove_all(folder);
    }
    void write(const std::string& text) const { std::ofstream(path) << text; }
    std::string contents() const {
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        return text.str();
    }

    fs::path folder;
    std::string path;
    std::string error;
};

TEST_F(Identity, is_made_once_and_is_the_same_ever_after) {
    const auto made = load_or_create_key_pair(path, error);
    ASSERT_TRUE(made) << error;
    const auto loaded = load_or_create_key_pair(path, error);
    ASSERT_TRUE(loaded) << error;
    EXPECT_EQ(made->public_key, loaded->public_key);
    EXPECT_EQ(made->secret_key, loaded->secret_key);
    EXPECT_NE(made->public_key, PublicKey{});
}

TEST_F(Identity, can_be_read_by_nobody_else_and_leaves_nothing_else_behind) {
    ASSERT_TRUE(load_or_create_key_pair(path, error)) << error;
    struct stat status {};
    ASSERT_EQ(::stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(Identity, folders_that_are_missing_are_made) {
    path = (folder / "a" / "b" / "player.key").string();
    EXPECT_TRUE(load_or_create_key_pair(path, error)) << error;
}

TEST_F(Identity, a_damaged_file_is_named_and_left_as_it_is) {
    ASSERT_TRUE(load_or_create_key_pair(path, error));
    const std::string good = contents();
    const std::string one_digit_wrong = good.substr(0, good.size() - 2) + "x\n";
    for (const std::string& bad :
         {std::string(), std::string("hello"), good + "\n", good + good, good.substr(1),
          good.substr(0, good.size() - 1), one_digit_wrong}) {
        write(bad);
        error.clear();
        EXPECT_FALSE(load_or_create_key_pair(path, error)) << bad;
        EXPECT_NE(error.find(path), std::string::npos) << error;
        EXPECT_EQ(contents(), bad);
    }
}

TEST_F(Identity, a_path_where_no_file_can_be_is_explained) {
    write("a file, not a folder");
    const std::string below = path + "/player.key";
    EXPECT_FALSE(load_or_create_key_pair(below, error));
    EXPECT_NE(error.find(below), std::string::npos) << error;
    error.clear();
    EXPECT_FALSE(load_or_create_key_pair(folder.string(), error)) << "a folder is not a key file";
    EXPECT_NE(error.find(folder.string()), std::string::npos) << error;
}

TEST_F(Identity, a_folder_that_cannot_be_written_is_explained) {
    fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
    if (::geteuid() == 0) path = "/proc/player.key";  // where not even root may write
    EXPECT_FALSE(load_or_create_key_pair(path, error));
    EXPECT_NE(error.find(path), std::string::npos) << error;
    EXPECT_NE(error.find("writable"), std::string::npos) << error;
}

TEST(ShortName, is_the_first_eight_bytes_in_hex) {
    EXPECT_EQ(short_name({0x00, 0x1f, 0xa0, 0xff, 0x10, 0x20, 0x30, 0x4b, 0x99}),
              "001fa0ff1020304b");
}

}  // namespace
}  // namespace fts::net
