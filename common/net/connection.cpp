#include "common/net/connection.h"

namespace fts::net {

std::string_view name_of(DisconnectReason reason) {
    switch (reason) {
        case DisconnectReason::kClosed:
            return "closed";
        case DisconnectReason::kTimeout:
            return "timeout";
        case DisconnectReason::kUnreachable:
            return "unreachable";
        case DisconnectReason::kServerFull:
            return "server full";
        case DisconnectReason::kWrongVersion:
            return "wrong version";
        case DisconnectReason::kRefused:
            return "refused";
        case DisconnectReason::kKeyChanged:
            return "key changed";
        case DisconnectReason::kProtocolError:
            return "protocol error";
        case DisconnectReason::kKicked:
            return "kicked";
    }
    return "unknown";
}

}  // namespace fts::net
