// Any sequence of parts: what is put together is canonical. The input is cut where a byte says how
// long the next part is.
#include <algorithm>
#include <cstdlib>
#include <span>

#include "common/replication/delta.h"
#include "common/replication/delta_format.h"
#include "tests/fuzz/target.h"

using fts::replication::is_canonical;
using fts::replication::Snapshot;
using fts::replication::SnapshotAssembler;
using fts::replication::delta_format::with_digest;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::span<const std::uint8_t> rest(data, size);
    SnapshotAssembler assembler;
    while (!rest.empty()) {
        const std::size_t bytes = std::min<std::size_t>(rest.front(), rest.size() - 1);
        const auto said = rest.subspan(1, bytes);
        const auto whole = assembler.add(Snapshot{}, with_digest(said));
        if (whole && !is_canonical(*whole)) std::abort();
        rest = rest.subspan(1 + bytes);
    }
    return 0;
}
