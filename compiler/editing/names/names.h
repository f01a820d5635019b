#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/editing/document.h"

namespace graftal {

enum class NameKind : std::uint8_t {
    let,
    inner,
    parameter, ///< of an object, a module, a function
    variable,  ///< or array
    table,
    local, ///< value of one production or map
    module,
    label,
    material,
    map,
    block, ///< `lsys`, `rifs` or `orbit`
    object,
    model, ///< of `use`
    function,
};

/// "let", "object", "used model", ...
std::string_view word_of(NameKind kind);

/// A name that a text gives to something, with all its places.
struct NamedThing {
    NameKind kind = NameKind::let;
    std::string name;
    Span scope; ///< where it is known: the whole file, a block, an object, a production
    /// Places of the name where the text says what it is, the first first; more than one of objects with
    /// several definitions, and of modules with several productions. None of a row of codes without a label.
    std::vector<Span> definitions;
    std::vector<Span> uses; ///< all other places of the name
    Span whole;             ///< the text that defines it: for outlines, and to be shown
};

/// All names of a text in the order of their first places, and behind them what the text uses but does not
/// define, each without definitions and with an unknown scope. Equal names in different scopes are different
/// things. O(text log text).
std::vector<NamedThing> names_of(const Document& document);

/// The thing whose name stands at a place, or right before it; null if there is none.
const NamedThing* thing_at(const std::vector<NamedThing>& things, std::uint32_t offset);

} // namespace graftal
