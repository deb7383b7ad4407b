// JsonReader: one object of a JSON file, whose members are asked for by name and kind. The first
// thing that is wrong is kept as a message with file, place, value and remedy; what is read after
// it is empty.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace fts::bot {

// Shared by all readers of one file.
struct JsonError {
    std::string file;
    std::string message;  // empty: nothing is wrong so far
    void set(const std::string& place, const std::string& problem);
};

class JsonReader {
  public:
    // Both must outlive the reader. `place` is where the object is, as "$.steps[2]".
    JsonReader(const nlohmann::json& object, std::string place, JsonError& error);

    bool has(const std::string& name) const;
    // Absent members are absent; those of the wrong kind or out of range are errors.
    std::optional<double> number(const std::string& name, double low, double high);
    std::optional<int> integer(const std::string& name, int low, int high);
    std::optional<bool> boolean(const std::string& name);
    std::optional<std::string> text(const std::string& name);
    std::vector<JsonReader> objects(const std::string& name);
    std::optional<JsonReader> object(const std::string& name);

    // Empty with an error when it is missing.
    std::string required_text(const std::string& name);

    std::vector<std::string> names() const;
    // An error for every member that nobody asked for.
    void expect_nothing_else();
    void fail(const std::string& name, const std::string& problem);
    bool ok() const { return error_->message.empty(); }

  private:
    const nlohmann::json* member(const std::string& name);

    const nlohmann::json* object_;
    std::string place_;
    JsonError* error_;
    std::set<std::string> asked_;
};

// To six digits.
std::string in_words(double value);

// A value as it stands in the file, cut short.
std::string quoted(const nlohmann::json& value);

}  // namespace fts::bot
