// Lookup: the address behind a server's name, asked for in a thread of its own, since a name server
// may take its time and the window must go on.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/net/transport.h"

namespace fts::sdl {

class Lookup {
  public:
    explicit Lookup(const std::string& host_and_port);

    // The answer once it is there; never blocks. A lookup that is dropped before ends by itself.
    std::optional<net::Resolved> poll() const;

  private:
    struct Answer;
    std::shared_ptr<Answer> answer_;
};

}  // namespace fts::sdl
