// A keyframe's part is any bytes with their digest: it decodes to a canonical snapshot that can be
// sent on unchanged and sketched, or to nothing.
#include <cstdlib>

#include "common/replication/arena_sketch.h"
#include "common/replication/delta.h"
#include "common/replication/delta_format.h"
#include "tests/fuzz/target.h"

using fts::replication::ArenaSketch;
using fts::replication::Course;
using fts::replication::course_of;
using fts::replication::decode_part;
using fts::replication::encode_delta;
using fts::replication::is_canonical;
using fts::replication::kAmplePartBytes;
using fts::replication::Snapshot;
using fts::replication::delta_format::with_digest;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto snapshot = decode_part(Snapshot{}, with_digest({data, size}));
    if (!snapshot) return 0;
    if (!is_canonical(*snapshot)) std::abort();
    if (snapshot->balls.size() + snapshot->coins.size() + snapshot->hits.size() > size)
        std::abort();
    const auto parts = encode_delta(Snapshot{}, *snapshot, 2 * size + kAmplePartBytes);
    if (parts.size() != 1 || decode_part(Snapshot{}, parts.front()) != snapshot) std::abort();
    // Told, and run on for a moment.
    static const Course kCourse = course_of(fts::physics::Disc{30.0}, {});
    constexpr fts::replication::Tick kTicksASnapshot = 2;
    ArenaSketch sketch;
    for (Snapshot told = *snapshot; told.tick < snapshot->tick + 6; told.tick += kTicksASnapshot) {
        sketch.tell(told, kCourse, kTicksASnapshot);
        if (!is_canonical(sketch.now())) std::abort();
    }
    return 0;
}
