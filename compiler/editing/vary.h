#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/maps/contraction_check.h"
#include "compiler/lower/lower_options.h"

namespace graftal {

enum class VariationKind : std::uint8_t {
    seed,       ///< other random numbers
    parameters, ///< other values of lets, inner parameters and settings
    rules,      ///< changed numbers, and turns of turtles, in the text
};

/// One child of a model. One of the three values is there.
struct Variation {
    std::optional<std::uint64_t> seed;
    std::map<std::string, double, std::less<>> set; ///< in place of these values
    std::optional<std::string> text;
    std::string says; ///< what differs, in plain words
};

struct VariationOptions {
    VariationKind kind = VariationKind::seed;
    std::size_t count = 9;  ///< at most 100
    double spread = 0.3;    ///< from 0 to 1: how far children are from the parent
    std::uint64_t seed = 0; ///< chooses the children
};

/// The values that a parameter is varied within, and that a slider of it may have: [0, 1] of an inner one; of
/// others from 0 to twice the value, or from -1 to 1.
struct ParameterRange {
    double least = 0;
    double most = 1;
};
ParameterRange range_of(const ModelParameter& parameter);

/// Children of a model, all different; fewer than asked for where there is not so much to change. The same
/// options give the same children. `parameters`: as lowering notes them, with the values that they have now.
/// Children by rules are read without errors, and those of `.rifs` and `.inst` contract. Throws as
/// check_contraction().
std::vector<Variation> vary(const Document& document, const std::vector<ModelParameter>& parameters,
                            const VariationOptions& options, const EditContext& context = {});

} // namespace graftal
