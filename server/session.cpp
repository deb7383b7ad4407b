#include "server/session.h"

namespace fts::server {

std::string Session::who() const {
    const std::string label = name.empty() ? "somebody" : "'" + name + "'";
    return label + " (key " + net::short_name(key) + ", " + net::to_string(address) + ")";
}

}  // namespace fts::server
