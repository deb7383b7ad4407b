#include "tests/accuracy/cell_store.h"

namespace fts::accuracy {

CellStore::CellStore(const std::filesystem::path& file, std::string& error) {
    bool ends_with_newline = true;
    {
        std::ifstream in(file);
        for (std::string line; std::getline(in, line);) {
            ends_with_newline = !in.eof();
            const Json cell = Json::parse(line, nullptr, false);
            if (cell.is_object() && cell.contains("key") && cell["key"].is_string() &&
                cell.contains("figures")) {
                cells_[cell["key"].get<std::string>()] = cell["figures"];
            }
        }
    }
    out_.open(file, std::ios::app);
    if (!out_) {
        error =
            "cannot write '" + file.string() + "'; give a folder that you may write to (--cells)";
        return;
    }
    if (!ends_with_newline) out_ << "\n";
}

bool CellStore::has(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    return cells_.contains(key);
}

Json CellStore::find(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = cells_.find(key);
    return found == cells_.end() ? Json(nullptr) : found->second;
}

void CellStore::put(const std::string& key, const Json& figures) {
    const std::lock_guard lock(mutex_);
    out_ << Json{{"key", key}, {"figures", figures}}.dump() << std::endl;
    cells_[key] = figures;
}

}  // namespace fts::accuracy
