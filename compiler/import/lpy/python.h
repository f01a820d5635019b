#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/import/lpy/lines.h"

namespace graftal {

/// The values of names where an expression stands, as expressions of ours.
using LpyValues = std::map<std::string, std::string, std::less<>>;

/// The name in our language, where `step` and `age` mean something.
std::string lpy_own_name(const std::string& name);

/// Hears of Python that has no translation, and where.
using LpyComplaint = std::function<void(Span span, const std::string& message)>;

/// One way through the statements of a rule or a function.
struct LpyPath {
    std::vector<std::string> conditions; ///< all hold
    std::string chance;                  ///< of this way among those with the same conditions; "": 1
    LpyValues values;
    std::vector<std::string> produced; ///< strings as they are written; of a function its result
    std::vector<Span> spans;           ///< of the statements that produce them
};

/// The Python of a file: its numbers, its functions of one expression each, and the ways through its rules.
class LpyPython {
  public:
    explicit LpyPython(LpyComplaint complain) : complain_(std::move(complain)) {}

    /// `name = value` at the top of the file. A value that is no number has no translation, which is an error
    /// only where something uses it.
    void name_value(const std::string& name, std::string_view value, Span span);
    void name_unknown(const std::string& name, Span span);
    /// `def name(parameters):` with the lines below it.
    void add_function(const LpyLine& line);
    /// `import random as rd`, `from math import *`
    void add_import(std::string_view text);

    struct Number {
        std::string name, value;
        Span span;
    };
    const std::vector<Number>& numbers() const { return numbers_; }

    /// An expression of ours; useless after a complaint.
    std::string expression(std::string_view text, Span span, const LpyValues& values);

    /// All ways through a rule's statements that produce something.
    std::vector<LpyPath> ways(const std::vector<LpyLine>& lines, const LpyValues& values);

    /// Whether a name may be a value of the rules: not one of the file's own numbers.
    bool is_global(const std::string& name) const { return global_.contains(name); }

  private:
    friend class LpyExpression;
    friend class LpyWays;

    struct Function {
        std::vector<std::pair<std::string, std::string>> parameters; ///< with their defaults, or ""
        std::vector<LpyLine> lines;
        Span span;
    };

    LpyComplaint complain_;
    std::vector<Number> numbers_;
    std::set<std::string, std::less<>> global_;
    std::map<std::string, Span, std::less<>> unknown_; ///< names of what is no number
    std::map<std::string, Function, std::less<>> functions_;
    std::set<std::string, std::less<>> modules_; ///< of Python, by the names that they have here
    std::size_t work_ = 0;                       ///< atoms read for the outermost expression
    int depth_ = 0;                              ///< of functions under way
};

} // namespace graftal
