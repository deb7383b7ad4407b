#include "client/core/known_servers.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

#include "client/core/data_folder.h"

namespace fts::client {
namespace {

constexpr std::string_view kHeading =
    "# Keys of servers, pinned on first use. Remove a line to accept a server's new key.";

std::optional<net::PublicKey> key_from_hex(std::string_view hex) {
    net::PublicKey key{};
    if (hex.size() != 2 * key.size()) return std::nullopt;
    for (std::size_t i = 0; i < key.size(); ++i) {
        const char* digits = hex.data() + 2 * i;
        const auto [end, error] = std::from_chars(digits, digits + 2, key[i], 16);
        if (error != std::errc{} || end != digits + 2) return std::nullopt;
    }
    return key;
}

bool is_remark(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    return first == std::string_view::npos || text[first] == '#';
}

}  // namespace

std::string to_hex(const net::PublicKey& key) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string hex;
    for (const std::uint8_t byte : key) {
        hex += kDigits[byte >> 4U];
        hex += kDigits[byte & 15U];
    }
    return hex;
}

KnownServers KnownServers::load(const std::filesystem::path& path) {
    KnownServers known;
    known.path_ = path;
    std::error_code failure;
    if (!std::filesystem::exists(path, failure) && !failure) return known;
    std::ifstream file(path);
    if (!file) {
        known.problems_.push_back("Cannot read " + path.string() +
                                  "; no server is known from it. Make it readable.");
        return known;
    }
    std::string text;
    while (std::getline(file, text)) {
        Line line{text, "", {}};
        std::istringstream words(text);
        std::string address, hex, rest;
        const bool two_words = (words >> address >> hex) && !(words >> rest);
        if (const auto key = two_words ? key_from_hex(hex) : std::nullopt) {
            line.address = address;
            line.key = *key;
        } else if (!is_remark(text)) {
            known.problems_.push_back(path.string() + ":" +
                                      std::to_string(known.lines_.size() + 1) +
                                      " is not an address and a key of 64 hexadecimal digits; "
                                      "it is ignored. Correct or remove the line.");
        }
        known.lines_.push_back(std::move(line));
    }
    return known;
}

std::optional<net::PublicKey> KnownServers::find(const net::Address& server) const {
    if (net::is_loopback(server)) return std::nullopt;
    const auto line = std::ranges::find(lines_, net::to_string(server), &Line::address);
    if (line == lines_.end()) return std::nullopt;
    return line->key;
}

bool KnownServers::pin(const net::Address& server, const net::PublicKey& key, std::string& error) {
    if (net::is_loopback(server) || find(server)) return true;
    if (lines_.empty()) lines_.push_back({std::string(kHeading), "", {}});
    const std::string address = net::to_string(server);
    lines_.push_back({address + " " + to_hex(key), address, key});
    std::string text;
    for (const Line& line : lines_) text += line.text + "\n";
    return write_file_atomically(path_, text, error);
}

}  // namespace fts::client
