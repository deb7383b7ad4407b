// The study's figures and tables, from the cells that are there.
#pragma once

#include <string>
#include <vector>

#include "server/lab/svg_plot.h"
#include "tests/accuracy/cell_store.h"

namespace fts::accuracy {

struct Figure {
    std::string file;
    lab::Plot plot;
};

std::vector<Figure> figures_of(const CellStore& cells);

struct Table {
    std::string name;  // as the page's markers have it
    std::string markdown;
};

std::vector<Table> tables_of(const CellStore& cells);

// What was measured on: processor, cores, compiler and optimisation.
std::string machine();

// The page with each table between its markers, "<!-- table NAME -->" and "<!-- end NAME -->",
// which stay. `error` names a table that has no markers.
std::string with_tables(std::string page, const std::vector<Table>& tables, std::string& error);

}  // namespace fts::accuracy
