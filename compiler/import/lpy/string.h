#pragma once

#include <set>
#include <string>
#include <string_view>

#include "compiler/import/l_system.h"
#include "compiler/import/lpy/python.h"

namespace graftal {

/// Reads strings of L-Py: its modules by the names that the file declares, the turtle's by their short ones.
class LpyStrings {
  public:
    /// `python` must outlive this.
    LpyStrings(LpyPython& python, LpyComplaint complain) : python_(python), complain_(std::move(complain)) {}

    /// `A, B(x) : scale = 2` behind the word `module`.
    void declare(std::string_view text);

    LSystemString read(std::string_view text, Span span, const LpyValues& values);
    /// A predecessor or a context. Names of parameters become values; a parameter that is a number asks for
    /// it, which adds to `condition`.
    LSystemString formals(std::string_view text, Span span, LpyValues& values, std::string& condition);

  private:
    struct Written {
        std::string symbol;
        std::vector<std::string_view> parameters;
    };
    std::vector<Written> modules_of(std::string_view text, Span span) const;
    std::string symbol_at(std::string_view text, std::size_t& at) const;

    LpyPython& python_;
    LpyComplaint complain_;
    std::set<std::string, std::less<>> declared_;
};

} // namespace graftal
