// One part of a snapshot as bits, private to snapshot_codec.cpp: every function here is the
// encoder's and the decoder's at once (range_coder.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/replication/prediction.h"
#include "common/replication/residual_model.h"
#include "common/replication/thrust_model.h"

namespace fts::replication::residual_part {

// What else than motion there is in a snapshot; absent, it costs nothing.
inline constexpr std::uint8_t kSomeJoin = 0x01;
inline constexpr std::uint8_t kSomeLeave = 0x02;
inline constexpr std::uint8_t kSomeBodyChanges = 0x04;  // whatever is neither motion nor control
inline constexpr std::uint8_t kSomeControlChanges = 0x08;
inline constexpr std::uint8_t kPartOfSeveral = 0x10;
inline constexpr std::uint8_t kKnownFlags = 0x1F;

// Which numbers are alike enough to learn from each other.
enum ExactKind : std::uint8_t { kMoving, kNewControl, kUnpushed, kPushed, kExactKinds };
enum SpeedBank : std::uint8_t { kFree, kAcross, kAcrossFar, kAfterFree, kSettled, kSpeedBanks };
enum PlaceBank : std::uint8_t { kTimed, kUntimed, kTimedByOther, kPlaceBanks };

struct Models {
    using ByDoubt = std::array<NumberModel, kDoubts>;
    using ExactBits = std::array<std::array<AdaptiveBit, kDoubts>, kDoubts>;

    std::array<ExactBits, kExactKinds> exact;  // by the doubts of speed and place
    std::array<ByDoubt, kSpeedBanks> speed;
    std::array<ByDoubt, kPlaceBanks> place;
    AdaptiveBit joins{0x0800, 8}, leaves{0x0800, 8}, changes_body{0x0800, 8};
    std::array<AdaptiveBit, 2> changes_control{AdaptiveBit{0x0200, 8}, AdaptiveBit{0x3000, 8}};
    ThrustModel thrust;
    NumberModel id_gap, x, y, vx, vy, mass, handling;

    static const Models& priors();
};

struct Residual {
    std::array<std::int32_t, 2> place{}, speed{};  // by axis
};

template <typename Coder>
class PartCoder {
  public:
    PartCoder(Coder& coder, const Prediction& expected, std::uint8_t flags);

    bool joins_before(bool join) {
        return (flags_ & kSomeJoin) != 0 && coder_.bit(models_.joins, join);
    }
    bool leaves(bool leave) {
        return (flags_ & kSomeLeave) != 0 && coder_.bit(models_.leaves, leave);
    }
    // A ball that was expected. An encoder is told it, a decoder finds it in `ball`.
    void expected_ball(const Expectation& expected, BallState& ball);
    // A ball that was not; gives back how many ids were passed over since the last one. It takes a
    // plain bit at least, so that a part never says more than eight balls a byte.
    std::uint32_t new_ball(std::uint32_t id_gap, BallState& ball);

  private:
    // Of balls that are together in what they can do to each other.
    struct Group {
        std::uint32_t to_come = 0;
        bool alone = true;
        std::array<std::uint64_t, 2> gained{};  // momentum, wrapping
    };

    void body(BallState& ball);
    bool control(const Expectation& expected, BallState& ball);
    void motion(const Expectation& expected, bool control_changed, BallState& ball);
    void speeds(const Expectation& expected, Group& group, Residual& residual);
    void settled_speeds(const Expectation& expected, const Group& group, Residual& residual);
    void places(const Expectation& expected, Residual& residual);
    std::int32_t number(NumberModel& model, std::int32_t value, std::int32_t mean, bool last);

    Coder& coder_;
    std::uint8_t flags_;
    Models models_;
    std::vector<Group> groups_;
    BallState last_new_;
    bool as_expected_ = true;  // every number so far of the ball at hand
};

}  // namespace fts::replication::residual_part
