#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/editing/maps/map_form.h"
#include "compiler/inst/parse/ast.h"

namespace graftal {

/// A map where the text writes it, beside what maps_of() tells of it.
struct WrittenMap {
    std::string name;
    std::string object;           ///< that has the instances
    std::optional<MapForm> form;  ///< nothing: `why`
    std::string why;              ///< it cannot be moved
    Span span;                    ///< of all its text
    Span list_end;                ///< an empty span where more transforms can stand
    std::vector<Span> places;     ///< that its instances in the graph have: of the map, or of its masters
    const RifsMap* row = nullptr; ///< of a `.rifs`
    const InstGroup* group = nullptr;
};

/// All maps of a text. The document must outlive it.
std::vector<WrittenMap> written_maps(const Document& document, const Environment& lets);

} // namespace graftal
