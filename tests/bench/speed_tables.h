// The tables and figures of the speed page, from what fts-bench left.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/accuracy/page.h"
#include "tests/bench/kept_results.h"

namespace fts::bench {

// A set that was not measured has a sentence for its tables, and no figure. In tables "-" is what
// is left out, and "not measured" what is missing.
std::vector<accuracy::Table> speed_tables(const std::map<std::string, KeptSet>& sets);
std::vector<accuracy::Figure> speed_figures(const std::map<std::string, KeptSet>& sets);

}  // namespace fts::bench
