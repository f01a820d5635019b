#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compiler/import/cpfg/block.h"
#include "compiler/support/source.h"

// A model of cpfg after it is parsed. Its expressions are in our language already.

namespace graftal {

struct CpfgModule {
    std::string symbol;                  ///< "F", "@Gs", "~l"
    std::vector<std::string> parameters; ///< as the model writes them
    bool has_parentheses = false;
};

using CpfgString = std::vector<CpfgModule>;
using CpfgComments = std::vector<std::pair<std::string, Span>>;

enum class CpfgSection { productions, decomposition, homomorphism };

/// When a block of the model is carried out.
enum class CpfgMoment { start, start_each, end_each, end };

struct CpfgArray {
    std::string name, sizes, values; ///< "a", "[3][2]", "1, 2, 3, 4, 5, 6", or ""
    Span span;
};

struct CpfgProduction {
    CpfgString left, predecessor, right;
    bool has_left = false, has_right = false;
    CpfgBlock before, after; ///< its condition
    std::string condition;   ///< "" for none
    CpfgString successor;
    std::string probability;
    Span span;
    CpfgComments comments;
};

struct CpfgSystem {
    CpfgComments head_comments, axiom_comments;
    std::string seed, length;
    std::string filter, filter_symbols; ///< "ignore" or "consider", and of what
    Span seed_span, length_span, filter_span, axiom_span;
    bool stochastic = false;
    CpfgString axiom;
    std::map<CpfgSection, std::string> depth;
    std::map<CpfgSection, std::vector<CpfgProduction>> productions;
    std::map<CpfgMoment, CpfgBlock> blocks;
    std::map<CpfgMoment, Span> block_spans;
    std::vector<CpfgArray> arrays;
};

} // namespace graftal
