// The study's figures and tables, from the cells that are there.
#pragma once

#include <string>
#include <vector>

#include "tests/accuracy/cell_store.h"
#include "tests/accuracy/page.h"

namespace fts::accuracy {

std::vector<Figure> figures_of(const CellStore& cells);
std::vector<Table> tables_of(const CellStore& cells);

// What was measured on: processor, cores, compiler and optimisation.
std::string machine();

}  // namespace fts::accuracy
