#include "client/sdl/lookup.h"

#include <mutex>
#include <thread>

#include "client/core/endpoint.h"

namespace fts::sdl {

struct Lookup::Answer {
    std::mutex mutex;
    std::optional<net::Resolved> resolved;
};

Lookup::Lookup(const std::string& host_and_port) : answer_(std::make_shared<Answer>()) {
    std::thread([answer = answer_, host_and_port] {
        net::Resolved resolved = client::resolve_server(host_and_port);
        const std::lock_guard lock(answer->mutex);
        answer->resolved = std::move(resolved);
    }).detach();
}

std::optional<net::Resolved> Lookup::poll() const {
    const std::lock_guard lock(answer_->mutex);
    return answer_->resolved;
}

}  // namespace fts::sdl
