// What was measured already, one JSON object a line in a file that only grows. A line that was cut
// off by a crash is passed over, and so is measured again.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace fts::accuracy {

using Json = nlohmann::ordered_json;

class CellStore {
  public:
    // Reads what the file holds. `error` is set when it cannot be written to.
    CellStore(const std::filesystem::path& file, std::string& error);

    bool has(const std::string& key) const;
    // Null when it is not there.
    Json find(const std::string& key) const;
    // On disk when it returns. Several threads may put.
    void put(const std::string& key, const Json& figures);
    std::size_t size() const { return cells_.size(); }

  private:
    std::map<std::string, Json> cells_;
    std::ofstream out_;
    mutable std::mutex mutex_;
};

}  // namespace fts::accuracy
