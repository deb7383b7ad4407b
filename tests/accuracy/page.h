// A page of the documents whose figures and tables a program writes.
#pragma once

#include <string>
#include <vector>

#include "server/lab/svg_plot.h"

namespace fts::accuracy {

struct Figure {
    std::string file;
    lab::Plot plot;
};

struct Table {
    std::string name;  // as the page's markers have it
    std::string markdown;
};

// The page with each table between its markers, "<!-- table NAME -->" and "<!-- end NAME -->",
// which stay. `error` names a table that has no markers.
std::string with_tables(std::string page, const std::vector<Table>& tables, std::string& error);

struct PageFiles {
    std::string page;     // there already, with its markers
    std::string figures;  // folder, made when it is not there
};

// Writes the figures, then the page. Gives what went wrong; empty: nothing.
std::string write_page(const PageFiles& files, const std::vector<Figure>& figures,
                       const std::vector<Table>& tables);

}  // namespace fts::accuracy
