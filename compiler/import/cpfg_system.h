#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

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
using CpfgValues = std::vector<std::pair<std::string, std::string>>; ///< names with their values

enum class CpfgSection { productions, decomposition, homomorphism };

struct CpfgProduction {
    CpfgString left, predecessor, right;
    bool has_left = false, has_right = false;
    std::string condition; ///< "" for none
    CpfgValues locals;
    CpfgString successor;
    std::string probability;
    Span span;
    CpfgComments comments;
};

struct CpfgSystem {
    CpfgComments head_comments, axiom_comments;
    std::string seed, length;
    std::string filter, filter_symbols; ///< "ignore" or "consider", and of what
    Span seed_span, length_span, filter_span, axiom_span, globals_span;
    bool stochastic = false;
    CpfgString axiom;
    std::map<CpfgSection, std::string> depth;
    std::map<CpfgSection, std::vector<CpfgProduction>> productions;
    CpfgValues globals;
};

} // namespace graftal
