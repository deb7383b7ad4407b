#include "client/core/end_words.h"

#include <algorithm>
#include <cmath>

namespace fts::client {
namespace {

constexpr std::size_t kMaxDetailBytes = 200;

// ": it is late", or nothing when the other end gave no reason.
std::string reason_given(const net::Disconnected& what) {
    const std::string detail = printable(what.detail, kMaxDetailBytes);
    return detail.empty() ? "" : ": " + detail;
}

std::string wrong_version(const net::Disconnected& what, const std::string& server,
                          std::uint16_t own_version) {
    const bool ours_is_older = own_version < what.peer_version;
    return "The server " + server + " speaks protocol version " +
           std::to_string(what.peer_version) + ", this program version " +
           std::to_string(own_version) +
           (ours_is_older ? ". Update this program." : ". Ask its host to update the server.");
}

std::string sentence(std::string words) {
    const char last = words.back();
    if (last != '.' && last != '?' && last != '!') words += '.';
    return words;
}

}  // namespace

std::string printable(std::string_view text, std::size_t max_bytes) {
    std::size_t end = std::min(text.size(), max_bytes);
    // Never cut within a UTF-8 character.
    while (end > 0 && end < text.size() &&
           (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    std::string result(text.substr(0, end));
    for (char& c : result) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20U || byte == 0x7FU) c = '?';
    }
    return result;
}

std::string words_for(const net::Disconnected& what, const net::Address& server_address,
                      std::uint16_t own_version, double timeout_s) {
    using enum net::DisconnectReason;
    const std::string server = net::to_string(server_address);
    const std::string port = std::to_string(server_address.port);
    switch (what.reason) {
        case kClosed:
            return sentence("The server " + server + " ended the session" + reason_given(what));
        case kTimeout:
            return "Lost " + server + ": nothing arrived for " +
                   std::to_string(std::lround(timeout_s)) +
                   " s. Check the network, and whether the server still runs, then join again.";
        case kUnreachable:
            return "No answer from " + server + ". Is the server running, and UDP port " + port +
                   " open?";
        case kServerFull:
            return "The server " + server + " is full. Try again later, or join another one.";
        case kWrongVersion:
            return wrong_version(what, server, own_version);
        case kRefused:
            return sentence("The server " + server + " refused to let you in" + reason_given(what));
        case kKeyChanged:
            return "The server at " + server +
                   " has another key than the one it had before: it was set up anew, or somebody "
                   "poses as it. If its host confirms the new key, remove the line of " +
                   server + " from known_servers in the data folder and join again.";
        case kProtocolError:
            return sentence("The session with " + server +
                            " broke: a packet that makes no sense arrived" + reason_given(what));
        case kKicked:
            return sentence("The host of " + server + " removed you" + reason_given(what));
    }
    return sentence("The session with " + server + " ended" + reason_given(what));
}

}  // namespace fts::client
