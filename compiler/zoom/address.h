#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/analysis/contraction.h"
#include "compiler/graph/graph.h"
#include "compiler/support/control.h"
#include "compiler/support/diagnostics.h"

namespace graftal {

/// One step of an address: from an object to the master of one of its instances.
struct AddressStep {
    std::string name;        ///< of the master; empty: any
    std::uint32_t index = 0; ///< which of the instances that fit, from 1; 0: the only one
    bool operator==(const AddressStep&) const = default;
};

/// A path through the graph as its user writes it, from the root down. The grammar:
///   address  part { "." part }
///   part     ( step | "(" address ")" ) [ "*" [ count ] ]     # "*" without a count, at the end: for ever
///   step     NAME [ "#" index ] | "#" index
/// Names are those of objects, with their arguments if they have some (`tip(3)`); in double quotes if they
/// hold a dot or other punctuation.
struct Address {
    std::vector<AddressStep> steps;
    std::vector<AddressStep> cycle; ///< follows the steps again and again; may be empty
    bool operator==(const Address&) const = default;
};

/// Steps that an address may have, its repetitions written out, and that its path may have.
inline constexpr std::size_t most_address_steps = 1'000'000;

/// Reads an address. Nothing where it is malformed: `problem` then says why, in lower case.
std::optional<Address> parse_address(std::string_view text, std::string& problem);

/// An address found in a graph: instances to follow from the root.
struct GraphPath {
    std::vector<GraphStep> steps;
    std::vector<GraphStep> cycle; ///< then again and again; leads from an object back to itself

    bool endless() const { return !cycle.empty(); }
    /// Requires i < steps.size(), or an endless path.
    const GraphStep& at(std::size_t i) const {
        return i < steps.size() ? steps[i] : cycle[(i - steps.size()) % cycle.size()];
    }
};

/// Finds the address. A name fits a master of that name; else one whose name ends in it after a dot (of an
/// imported model); else one that has it in front of its arguments. Objects of one instance that no name
/// fits are passed through. Endless repetition ends where the graph does. Errors go to `diagnostics`; a path
/// of more than most_address_steps is one. `control` counts the names that are compared.
std::optional<GraphPath> find_path(const Graph& graph, const Address& address, Diagnostics& diagnostics,
                                   const Control& control = no_control());

} // namespace graftal
