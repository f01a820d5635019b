#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compiler/support/source.h"

// An L-system of another program after it is parsed. Its expressions are in our language already.

namespace graftal {

struct LSystemModule {
    std::string symbol;                  ///< "F", "@Gs", "~l"
    std::vector<std::string> parameters; ///< as the model writes them
    bool has_parentheses = false;
    Span span; ///< where a format tells modules apart by their places; else unknown
};

using LSystemString = std::vector<LSystemModule>;
using LSystemComments = std::vector<std::pair<std::string, Span>>;

enum class LSystemSection { productions, decomposition, homomorphism };

/// When a block of the model is carried out.
enum class LSystemMoment { start, start_each, end_each, end };

/// A statement of a block, in our language.
struct LSystemAction {
    enum class Kind { assign, branch, loop, loop_after } kind = Kind::assign;
    std::string name;   ///< variable to assign
    std::string target; ///< variable with its indices
    std::string value;  ///< or the condition
    std::vector<LSystemAction> then, otherwise;
    bool has_otherwise = false;
};

using LSystemBlock = std::vector<LSystemAction>;

struct LSystemArray {
    std::string name, sizes, values; ///< "a", "[3][2]", "1, 2, 3, 4, 5, 6", or ""
    Span span;
};

struct LSystemProduction {
    LSystemString left, predecessor, right;
    LSystemBlock before, after; ///< its condition
    std::string condition;      ///< "" for none
    LSystemString successor;
    std::string probability;
    Span span;
    LSystemComments comments; ///< before it
    std::string remark;       ///< behind it
};

struct LSystem {
    LSystemComments head_comments, axiom_comments, tail_comments;
    std::string seed, length;
    std::string filter, filter_symbols; ///< "ignore" or "consider", and of what
    Span seed_span, length_span, filter_span, axiom_span;
    LSystemString axiom;
    std::string axiom_remark; ///< behind it
    std::map<LSystemSection, std::string> depth;
    std::map<LSystemSection, std::vector<LSystemProduction>> productions = {
        {LSystemSection::productions, {}},
        {LSystemSection::decomposition, {}},
        {LSystemSection::homomorphism, {}}};
    std::map<LSystemMoment, LSystemBlock> blocks;
    std::map<LSystemMoment, Span> block_spans;
    std::vector<LSystemArray> arrays;
};

} // namespace graftal
