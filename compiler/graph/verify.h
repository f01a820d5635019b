#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/graph/graph.h"

namespace graftal {

/// A broken rule of the graph, in words, with the object at fault.
struct Flaw {
    ObjectId object = 0;
    std::string message;
};

/// All rules that every stage may rely on: root, masters and materials exist; the root is a union; a
/// primitive bears its own name and has no instances and no terminal; every other object has an instance;
/// names are unique and `.inst` can write them (`up`, `leaf.llr`, `tip(3)`); numbers are finite, those of the
/// settings too; tints lie in [0,1]; linear parts are not zero; terminals are ending; planes are not reached
/// through cycles; parts have no terminals and no parts; combined
/// objects have bounds, and lie in no cycle. O(graph).
std::vector<Flaw> verify(const Graph& graph);

/// Throws an exception that names `stage` and the object, if verify() finds a flaw: for use after lowering
/// and each pass.
void check_verified(const Graph& graph, std::string_view stage);

} // namespace graftal
