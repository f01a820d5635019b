#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/rifs/follow_ast.h"
#include "compiler/rifs/look.h"
#include "compiler/rifs/orbit_ast.h"
#include "compiler/support/source.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/names.h"
#include "compiler/syntax/scene_statements.h"
#include "compiler/syntax/transform.h"

// The tree of a `.rifs` file (docs/language.md). Texts are views of the source, which outlives the tree.

namespace graftal {

/// More maps than this in one file are refused while parsing.
inline constexpr std::size_t max_rifs_maps = 100'000;

/// `condense` and `terminal`: a primitive or used model, placed.
struct RifsPart {
    Name master;
    std::vector<Expression> arguments; ///< `frustum(0.5)`, or the inner parameters of a model
    std::vector<TransformLine> transforms;
    RifsLook look;
    std::optional<Expression> probability; ///< of a condensation set
    std::optional<Expression> below;       ///< of a terminal: the size from which down it is drawn
    Span span;                             ///< from the keyword on
};

/// The form of a map's numbers: a transform list, or one of the rows of `codes`.
enum class RifsForm : std::uint8_t { transforms, codes_2d, codes_polar, codes_3d, codes_barycentric };

struct RifsMap {
    Name name;                ///< of a row without a label: an empty text, at the row
    std::uint32_t number = 0; ///< in its block, from 1: a row without a label is named by it
    RifsForm form = RifsForm::transforms;
    std::vector<TransformLine> transforms;
    /// Without the probability: as many as the form has. Those of codes_barycentric are the weights of each
    /// image and then the control points of the block.
    std::vector<Expression> codes;
    std::optional<Expression> probability;
    RifsLook look;
    std::optional<Name> from; ///< the block whose attractor this map takes
    std::optional<RifsPart> terminal;
    bool broken = false; ///< reported while parsing: there is nothing to evaluate
    Span span;
};

struct RifsBlock {
    Name name;
    bool is_main = false;
    std::vector<RifsMap> maps;
    std::optional<RifsFollow> follow;
    std::vector<Name> start;         ///< empty: all maps
    std::vector<Expression> control; ///< coordinates of three points of the plane or four of space, or none
    Span control_span;
    std::vector<RifsPart> condense;
    std::optional<RifsPart> terminal;
    bool broken = false; ///< an error lost a part of it
};

/// A whole `.rifs` file.
struct RifsFile {
    FileId file = 0;
    std::vector<UseStatement> uses;
    std::vector<SceneStatement> statements;
    std::vector<RifsBlock> blocks;
    std::vector<OrbitBlock> orbits;
};

} // namespace graftal
