#include "tests/tidy/scan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <regex>
#include <utility>

#include "tests/tidy/rules.h"

namespace fts::tidy {
namespace {

std::vector<std::string_view> words_of(std::string_view list, std::string_view separators = " ") {
    std::vector<std::string_view> words;
    while (!list.empty()) {
        const std::size_t end = std::min(list.find_first_of(separators), list.size());
        if (end > 0) {
            words.push_back(list.substr(0, end));
        }
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return words;
}

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        lines.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

bool is_in_folder(std::string_view path, std::string_view folder) {
    return path == folder ||
           (path.starts_with(folder) && path.size() > folder.size() && path[folder.size()] == '/');
}

bool is_in_any(std::string_view path, std::string_view folders) {
    return std::ranges::any_of(words_of(folders), [&](auto f) { return is_in_folder(path, f); });
}

const Room* room_of(std::string_view path) {
    const Room* best = nullptr;
    for (const Room& room : kRooms) {
        if (is_in_folder(path, room.path) && (!best || room.path.size() > best->path.size())) {
            best = &room;
        }
    }
    return best;
}

// ---- blanking out what braces and quotes inside must not count
// --------------------------------------

// The end of the literal or comment that starts at `at`, or `at` when none does.
std::size_t end_of_opaque(std::string_view text, std::size_t at) {
    const std::string_view rest = text.substr(at);
    const auto past = [&](std::string_view closing, std::size_t from) {
        const std::size_t found = rest.find(closing, from);
        return at + (found == rest.npos ? rest.size() : found + closing.size());
    };
    if (rest.starts_with("//")) {
        return at + std::min(rest.find('\n'), rest.size());
    }
    if (rest.starts_with("/*")) {
        return past("*/", 2);
    }
    if (rest.starts_with("R\"")) {
        const std::size_t open = std::min(rest.find('('), rest.size());
        return past(")" + std::string(rest.substr(2, open - 2)) + "\"", open);
    }
    const char quote = rest.front();
    const bool digit_separator = quote == '\'' && at > 0 && std::isxdigit(text[at - 1]) != 0;
    if ((quote != '"' && quote != '\'') || digit_separator) {
        return at;
    }
    for (std::size_t i = 1; i < rest.size(); ++i) {
        if (rest[i] == '\\') {
            ++i;
        } else if (rest[i] == quote) {
            return at + i + 1;
        }
    }
    return text.size();
}

void blank(std::string& text, std::size_t from, std::size_t to) {
    std::replace_if(
        text.begin() + static_cast<std::ptrdiff_t>(from),
        text.begin() + static_cast<std::ptrdiff_t>(to), [](char c) { return c != '\n'; }, ' ');
}

void blank_directives(std::string& text) {
    bool at_line_start = true;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (at_line_start && text[i] == '#') {
            std::size_t end = std::min(text.find('\n', i), text.size());
            while (end < text.size() && text[end - 1] == '\\') {
                end = std::min(text.find('\n', end + 1), text.size());
            }
            blank(text, i, end);
            i = end;
        }
        at_line_start =
            i < text.size() && (text[i] == '\n' || (at_line_start && std::isspace(text[i]) != 0));
    }
}

std::string code_of(std::string_view source) {
    std::string text(source);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = end_of_opaque(text, i);
        blank(text, i, end);
        i = std::max(end, i + 1);
    }
    blank_directives(text);
    return text;
}

// ---- functions
// --------------------------------------------------------------------------------------

enum class Scope { kNamespaceOrClass, kFunction, kOther };

std::string without_template_head(const std::string& head) {
    static const std::regex kTemplate(R"(^\s*template\s*<)");
    std::smatch match;
    if (!std::regex_search(head, match, kTemplate)) {
        return head;
    }
    std::size_t at = static_cast<std::size_t>(match.length());
    for (int depth = 1; at < head.size() && depth > 0; ++at) {
        depth += head[at] == '<' ? 1 : head[at] == '>' ? -1 : 0;
    }
    return without_template_head(head.substr(at));
}

// What a brace opens, from the text between it and the end of the previous statement.
Scope scope_opened(Scope around, const std::string& whole_head) {
    static const std::regex kNamed(
        R"(^\s*((inline|export|static|constexpr|const|typedef)\s+)*(namespace|class|struct|union|extern)\b)");
    static const std::regex kInitialiser(R"((=|\breturn)\s*$)");
    if (around != Scope::kNamespaceOrClass) {
        return Scope::kOther;
    }
    const std::string head = without_template_head(whole_head);
    if (std::regex_search(head, kNamed)) {
        return Scope::kNamespaceOrClass;
    }
    const bool has_parameters = head.find(')') != head.npos;
    return has_parameters && !std::regex_search(head, kInitialiser) ? Scope::kFunction
                                                                    : Scope::kOther;
}

// ---- single rules
// -----------------------------------------------------------------------------------

std::optional<std::string> breach_of_our_include(std::string_view path, const Include& include) {
    const Room* from = room_of(path);
    const Room* to = room_of(include.header);
    if (!to) {
        return "includes \"" + include.header +
               "\", which names no room; write includes from the root, as \"common/game/rules.h\"";
    }
    if (!from || from == to || is_in_any(include.header, from->may_include)) {
        return std::nullopt;
    }
    for (const Exception& exception : kExceptions) {
        const auto headers = words_of(exception.headers);
        if (exception.room == from->path &&
            std::ranges::find(headers, include.header) != headers.end()) {
            return std::nullopt;
        }
    }
    return std::string(from->path) + " may not include \"" + include.header +
           "\"; it may include " +
           (from->may_include.empty() ? "no other room" : std::string(from->may_include)) +
           ". Move what is needed to where both may see it";
}

std::optional<std::string> breach_of_outside_include(std::string_view path,
                                                     const Include& include) {
    const auto starts_header = [&](std::string_view start) {
        return include.header.starts_with(start);
    };
    for (const ThirdParty& party : kThirdParties) {
        if (std::ranges::none_of(words_of(party.headers), starts_header)) {
            continue;
        }
        if (!party.homes.empty() && !is_in_any(path, party.homes)) {
            return std::string(party.name) + " is confined to " + std::string(party.homes) +
                   "; go through what that room offers";
        }
        if (party.sources_only && path.ends_with(".h") && !is_in_folder(path, "tests")) {
            return std::string(party.name) +
                   " may not be included by a header; include it in the .cpp and hide its types "
                   "there";
        }
        return std::nullopt;
    }
    const bool standard = include.header.find_first_of("/.") == include.header.npos;
    if (!standard) {
        return "<" + include.header +
               "> is no known third party; adding one is a decision: give it a row in "
               "tests/tidy/rules.h";
    }
    const auto headers = words_of(kIndeterminateHeaders);
    if (is_in_any(path, kDeterministicRooms) &&
        std::ranges::find(headers, include.header) != headers.end()) {
        return "<" + include.header +
               "> has no place where the same calls must give the same bits; pass time and "
               "randomness "
               "in, and use ordered containers";
    }
    return std::nullopt;
}

void check_includes(const std::string& path, std::string_view text, std::vector<Breach>& breaches) {
    for (const Include& include : includes_of(text)) {
        const auto what = include.quoted && !include.header.ends_with(".pb.h")
                              ? breach_of_our_include(path, include)
                              : breach_of_outside_include(path, include);
        if (what) {
            breaches.push_back({path, include.line, *what});
        }
    }
}

void check_sizes(const std::string& path, std::string_view text, std::vector<Breach>& breaches) {
    const std::size_t lines = lines_of(text).size();
    if (lines > kMaxFileLines) {
        breaches.push_back({path, kMaxFileLines + 1,
                            "has " + std::to_string(lines) + " lines, more than " +
                                std::to_string(kMaxFileLines) + "; find the second thing it does"});
    }
    for (const Function& function : functions_of(text)) {
        if (function.lines > kMaxFunctionLines) {
            breaches.push_back({path, function.first_line,
                                "a function of " + std::to_string(function.lines) +
                                    " lines, more than " + std::to_string(kMaxFunctionLines) +
                                    "; name its parts and call them"});
        }
    }
}

void check_header(const std::string& path, std::string_view text, std::vector<Breach>& breaches) {
    if (!path.ends_with(".h")) {
        return;
    }
    if (!text.starts_with("//")) {
        breaches.push_back(
            {path, 1, "does not begin with a comment; say what it is, and what it is not"});
    }
    if (text.find("\n#pragma once\n") == text.npos) {
        breaches.push_back({path, 1, "has no #pragma once"});
    }
}

}  // namespace

std::vector<Include> includes_of(std::string_view text) {
    static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^">]+)[">])re");
    std::vector<Include> includes;
    std::size_t number = 0;
    for (const std::string_view line : lines_of(text)) {
        ++number;
        std::cmatch match;
        if (std::regex_search(line.data(), line.data() + line.size(), match, kInclude)) {
            includes.push_back({number, match[2].str(), match[1].str() == "\""});
        }
    }
    return includes;
}

std::vector<Function> functions_of(std::string_view text) {
    struct Open {
        Scope scope;
        std::size_t line;
        std::size_t parentheses;
    };
    std::vector<Function> functions;
    std::vector<Open> open{{Scope::kNamespaceOrClass, 1, 0}};
    std::string head;
    std::size_t line = 1;
    std::size_t parentheses = 0;
    for (const char c : code_of(text)) {
        line += c == '\n' ? 1 : 0;
        if (c == '{') {
            const bool in_argument = parentheses > open.back().parentheses;
            const Scope scope = in_argument ? Scope::kOther : scope_opened(open.back().scope, head);
            open.push_back({scope, line, parentheses});
            head.clear();
        } else if (c == '}' && open.size() > 1) {
            if (open.back().scope == Scope::kFunction) {
                functions.push_back({open.back().line, line - open.back().line + 1});
            }
            parentheses = open.back().parentheses;
            open.pop_back();
            head.clear();
        } else if (c == ';') {
            head.clear();
        } else {
            parentheses += c == '(' ? 1 : 0;
            parentheses -= c == ')' && parentheses > 0 ? 1 : 0;
            head += c;
        }
    }
    return functions;
}

std::vector<Breach> breaches_of_source(const std::string& path, std::string_view text) {
    std::vector<Breach> breaches;
    check_includes(path, text, breaches);
    check_sizes(path, text, breaches);
    check_header(path, text, breaches);
    return breaches;
}

std::vector<Breach> breaches_of_text(const std::string& path, std::string_view text) {
    // In halves, so that this file may be read by its own rule.
    static const std::regex kUnfinished(
        "\\b(TO"
        "DO|FIX"
        "ME|XX"
        "X|HA"
        "CK)\\b");
    static const std::regex kWorkplace(
        "(^|[^\\w.])/wo"
        "rk/|\\.\\./sha"
        "red|/fa"
        "rm/|\\.lib"
        "rary");
    std::vector<Breach> breaches;
    std::size_t number = 0;
    for (const std::string_view line : lines_of(text)) {
        ++number;
        const auto found = [&](const std::regex& what) {
            return std::regex_search(line.data(), line.data() + line.size(), what);
        };
        if (found(kUnfinished)) {
            breaches.push_back(
                {path, number, "a mark of unfinished work; finish it or leave it out"});
        }
        if (found(kWorkplace)) {
            breaches.push_back(
                {path, number, "a path outside the project; it speaks of itself alone"});
        }
    }
    return breaches;
}

std::vector<Breach> breaches_of_name(const std::string& path) {
    const std::string stem = std::filesystem::path(path).stem().string();
    const auto empty_names = words_of(kEmptyNames);
    for (const std::string_view word : words_of(stem, "_-.")) {
        if (std::ranges::find(empty_names, word) != empty_names.end()) {
            return {{path, 1, "the name says nothing; name what is in it"}};
        }
    }
    const bool is_source = path.ends_with(".cpp") || path.ends_with(".h");
    if (is_source && std::ranges::any_of(stem, [](char c) { return std::isupper(c) != 0; })) {
        return {{path, 1, "file names are snake_case"}};
    }
    return {};
}

}  // namespace fts::tidy
