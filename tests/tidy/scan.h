// Reads one source text and reports what breaks the rules of the house (rules.h). Pure: a path and
// a text go in, breaches come out, so the scanner is itself tested with planted breaches.
//
// It is a scanner and no parser: comments and literals are blanked out, braces are counted. What it
// calls a function is a brace at namespace or class level that follows a parameter list.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fts::tidy {

struct Breach {
    std::string path;  // from the root
    std::size_t line = 0;
    std::string what;  // the rule and the remedy
};

struct Include {
    std::size_t line = 0;
    std::string header;  // between the quotes or angle brackets
    bool quoted = false;
};
std::vector<Include> includes_of(std::string_view text);

struct Function {
    std::size_t first_line = 0;  // of the opening brace
    std::size_t lines = 0;       // both braces included
};
std::vector<Function> functions_of(std::string_view text);

// Everything below at once, for a file of C++.
std::vector<Breach> breaches_of_source(const std::string& path, std::string_view text);
// Words and paths that may not stand in any text file of the project.
std::vector<Breach> breaches_of_text(const std::string& path, std::string_view text);
// Names that say nothing.
std::vector<Breach> breaches_of_name(const std::string& path);

}  // namespace fts::tidy
