#include "server/lab/text_table.h"

#include <algorithm>

namespace fts::lab {
namespace {

std::string padded(const std::string& cell, std::size_t width, bool left) {
    const std::string gap(width - std::min(width, columns_of(cell)), ' ');
    return left ? cell + gap : gap + cell;
}

}  // namespace

std::size_t columns_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

std::string TextTable::text() const {
    std::vector<std::size_t> widths;
    for (const std::string& head : heads_) widths.push_back(columns_of(head));
    for (const auto& row : rows_) {
        for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i) {
            widths[i] = std::max(widths[i], columns_of(row[i]));
        }
    }
    const auto line_of = [&](const std::vector<std::string>& cells) {
        std::string line;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (i > 0) line += "  ";
            line += i < widths.size() ? padded(cells[i], widths[i], i == 0) : cells[i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        return line + "\n";
    };
    std::string out = line_of(heads_);
    for (const auto& row : rows_) out += line_of(row);
    return out;
}

std::string TextTable::markdown() const {
    const auto line_of = [](const std::vector<std::string>& cells) {
        std::string line = "|";
        for (const std::string& cell : cells) line += " " + cell + " |";
        return line + "\n";
    };
    std::string out = line_of(heads_) + "|";
    for (std::size_t i = 0; i < heads_.size(); ++i) out += i == 0 ? " --- |" : " ---: |";
    out += "\n";
    for (const auto& row : rows_) out += line_of(row);
    return out;
}

}  // namespace fts::lab
