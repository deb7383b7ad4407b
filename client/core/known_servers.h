// KnownServers: the key of each server, pinned on first use, in a text file of lines "address key"
// with the key as 64 hexadecimal digits; lines that start with # are remarks. A line that makes no
// sense is reported, kept, and pins nothing. Servers on this machine are not pinned: many come and
// go at the same address, and whoever can listen there has the machine already.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/net/connection.h"

namespace fts::client {

class KnownServers {
  public:
    // A file that does not exist is an empty one. Problems come as messages with line and remedy.
    static KnownServers load(const std::filesystem::path& path);

    const std::vector<std::string>& problems() const { return problems_; }
    std::optional<net::PublicKey> find(const net::Address& server) const;
    // Pins and writes the file at once; a server that has a pin keeps it. False with `error` set.
    bool pin(const net::Address& server, const net::PublicKey& key, std::string& error);

  private:
    struct Line {
        std::string text;     // as in the file
        std::string address;  // empty when it pins nothing
        net::PublicKey key{};
    };
    std::filesystem::path path_;
    std::vector<Line> lines_;
    std::vector<std::string> problems_;
};

std::string to_hex(const net::PublicKey& key);

}  // namespace fts::client
