// Any sequence of parts: what is put together is canonical. The input is cut where a byte says how
// long the next part is.
#include <algorithm>
#include <cstdlib>
#include <span>

#include "common/replication/delta.h"
#include "tests/fuzz/target.h"

using fts::replication::is_canonical;
using fts::replication::Snapshot;
using fts::replication::SnapshotAssembler;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::span<const std::uint8_t> rest(data, size);
    SnapshotAssembler assembler;
    while (!rest.empty()) {
        const std::size_t bytes = std::min<std::size_t>(rest.front(), rest.size() - 1);
        const auto whole = assembler.add(Snapshot{}, rest.subspan(1, bytes));
        if (whole && !is_canonical(*whole)) std::abort();
        rest = rest.subspan(1 + bytes);
    }
    return 0;
}
