// Columns that line up in a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fts::lab {

class TextTable {
  public:
    explicit TextTable(std::vector<std::string> heads) : heads_(std::move(heads)) {}

    // The first column is aligned left, the others right. Cells beyond the heads run on.
    void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    std::string text() const;
    std::string markdown() const;

  private:
    std::vector<std::string> heads_;
    std::vector<std::vector<std::string>> rows_;
};

// Characters on a screen, of UTF-8.
std::size_t columns_of(const std::string& text);

}  // namespace fts::lab
