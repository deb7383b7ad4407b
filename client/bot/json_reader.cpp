#include "client/bot/json_reader.h"

#include <cmath>
#include <sstream>

namespace fts::bot {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxQuotedBytes = 60;

}  // namespace

std::string in_words(double value) {
    std::ostringstream out;
    out << value;
    return out.str();
}

std::string quoted(const json& value) {
    std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.size() > kMaxQuotedBytes) text = text.substr(0, kMaxQuotedBytes) + "...";
    return text;
}

void JsonError::set(const std::string& place, const std::string& problem) {
    if (message.empty()) message = file + ": " + place + " " + problem;
}

JsonReader::JsonReader(const json& object, std::string place, JsonError& error)
    : object_(&object), place_(std::move(place)), error_(&error) {
    if (!object.is_object())
        error_->set(place_, "is " + quoted(object) + "; make it an object {}.");
}

bool JsonReader::has(const std::string& name) const {
    return object_->is_object() && object_->contains(name);
}

const json* JsonReader::member(const std::string& name) {
    asked_.insert(name);
    return has(name) ? &(*object_)[name] : nullptr;
}

void JsonReader::fail(const std::string& name, const std::string& problem) {
    error_->set(name.empty() ? place_ : place_ + "." + name, problem);
}

std::optional<double> JsonReader::number(const std::string& name, double low, double high) {
    const json* value = member(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_number()) {
        const double result = value->get<double>();
        if (result >= low && result <= high) return result;
    }
    fail(name, "is " + quoted(*value) + "; give a number from " + in_words(low) + " to " +
                   in_words(high) + ".");
    return std::nullopt;
}

std::optional<int> JsonReader::integer(const std::string& name, int low, int high) {
    const auto value = number(name, low, high);
    if (!value) return std::nullopt;
    if (std::floor(*value) == *value) return static_cast<int>(*value);
    fail(name, "is " + in_words(*value) + "; give a whole number.");
    return std::nullopt;
}

std::optional<bool> JsonReader::boolean(const std::string& name) {
    const json* value = member(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_boolean()) return value->get<bool>();
    fail(name, "is " + quoted(*value) + "; give true or false.");
    return std::nullopt;
}

std::optional<std::string> JsonReader::text(const std::string& name) {
    const json* value = member(name);
    if (value == nullptr) return std::nullopt;
    if (value->is_string()) return value->get<std::string>();
    fail(name, "is " + quoted(*value) + "; give a text in quotes.");
    return std::nullopt;
}

std::string JsonReader::required_text(const std::string& name) {
    const auto value = text(name);
    if (!value && ok()) fail("", "has no \"" + name + "\"; add it.");
    return value.value_or("");
}

std::vector<JsonReader> JsonReader::objects(const std::string& name) {
    const json* value = member(name);
    std::vector<JsonReader> readers;
    if (value == nullptr) return readers;
    if (!value->is_array()) {
        fail(name, "is " + quoted(*value) + "; make it a list [].");
        return readers;
    }
    for (std::size_t i = 0; i < value->size(); ++i) {
        const std::string place = place_ + "." + name + "[" + std::to_string(i) + "]";
        readers.emplace_back((*value)[i], place, *error_);
    }
    return readers;
}

std::optional<JsonReader> JsonReader::object(const std::string& name) {
    const json* value = member(name);
    if (value == nullptr) return std::nullopt;
    return JsonReader(*value, place_ + "." + name, *error_);
}

std::vector<std::string> JsonReader::names() const {
    std::vector<std::string> names;
    if (!object_->is_object()) return names;
    for (const auto& [name, value] : object_->items()) names.push_back(name);
    return names;
}

void JsonReader::expect_nothing_else() {
    for (const std::string& name : names()) {
        if (!asked_.contains(name))
            fail(name, "means nothing here; remove it or correct its name.");
    }
}

}  // namespace fts::bot
