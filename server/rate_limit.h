// A bucket of tokens: so many a second in the long run, so many at once.
#pragma once

#include <algorithm>

namespace fts::server {

class RateLimit {
  public:
    RateLimit(double per_s, double burst) : per_s_(per_s), burst_(burst), tokens_(burst) {}

    // Whether one more is within the limit at `now_s`, and takes it if so.
    bool allow(double now_s) {
        if (now_s > last_s_) {
            tokens_ = std::min(burst_, tokens_ + (now_s - last_s_) * per_s_);
            last_s_ = now_s;
        }
        if (tokens_ < 1.0) return false;
        tokens_ -= 1.0;
        return true;
    }

  private:
    double per_s_, burst_, tokens_;
    double last_s_ = 0.0;
};

}  // namespace fts::server
