#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/maps/contraction_check.h"
#include "compiler/editing/maps/map_form.h"
#include "compiler/editing/text_edit.h"
#include "compiler/session/values.h"
#include "compiler/support/bounds.h"

// Direct manipulation of the maps of a model (Sherman and Hart, "Direct manipulation of recurrent models").

namespace graftal {

/// A map of a `.rifs`, or the transforms of a group of a `.inst`, where the text has them.
struct EditableMap {
    std::string
        name; ///< of a map, with its block where there are several; `object/master`, `object/master#2`
    std::string object;     ///< of the graph, whose instances it places; of a group the object that has it
    Affine matrix;          ///< parent_from_child; the identity where it has no value
    Box box;                ///< of what it maps, in the frame below it; empty: unknown
    double contraction = 0; ///< the largest stretch
    Span span;              ///< of the map's text
    bool movable = false;
    std::string why; ///< it is not movable
};

/// The maps of a text in its order. `model`: gives the boxes; null: they are empty. Maps of L-systems are
/// turtles' ways, and no text has them. O(text).
std::vector<EditableMap> maps_of(const Document& document, const LowerOptions& options = {},
                                 const AnalysedModel* model = nullptr);

/// A change of maps, as the studio answers it.
struct MapChange {
    std::vector<TextEdit> edits; ///< empty where it is refused
    std::string refusal;         ///< why the text cannot say it; "": it can
    double ratio = 0;            ///< the largest stretch of the maps that changed
    bool contracts = false;      ///< the model then converges
    std::string why;             ///< it does not: as the command line says it
};

/// Gives the map of this name another matrix, in the form in which it is written: the numbers of its row, or
/// of its transforms in their order, as little changed as can be. Where these cannot say the matrix, scales
/// get a number for each axis, a translation or rotations are added, and at last a `matrix` takes the place
/// of all. Comments stay. Of a flat map in the plane, the z of the matrix follows the rule of flat maps. Read
/// back, the map is the matrix to within 1e-12 of its size, or to what the hand can tell. Throws as
/// check_contraction().
MapChange move_map(const Document& document, std::string_view name, const Affine& matrix,
                   const EditContext& context = {}, const Hand& hand = {});

/// Moves the point of the attractor with this address (zoom/address.h) from one place to another: solves for
/// the numbers of all maps on the address with the least change, and keeps the model contracting; where that
/// fails, only what translates is changed. Of a finite address the point keeps its place in the frame of the
/// last object. Requires nothing of `from` with an endless address, whose point is known. Throws as
/// check_contraction().
MapChange pull(const Document& document, std::string_view address, Vec3 from, Vec3 to,
               const EditContext& context = {}, const Hand& hand = {});

/// The control digraph of a block of a `.rifs`.
struct Digraph {
    std::string block;
    std::vector<std::string> maps;        ///< in the order of the text
    std::vector<std::vector<bool>> edges; ///< [from][to]: w_to may follow w_from
};
std::vector<Digraph> digraphs_of(const Document& document);

/// Adds or removes an edge of the control digraph, in the form in which `follow` is written, or beside it. A
/// matrix of probabilities is refused: its rows have sums. `from` and `to`: names as maps_of() has them.
MapChange set_edge(const Document& document, std::string_view from, std::string_view to, bool edge,
                   const EditContext& context = {});

} // namespace graftal
