#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/editing/document.h"
#include "compiler/editing/text_edit.h"
#include "compiler/rifs/ast.h"
#include "compiler/support/affine.h"
#include "compiler/support/bounds.h"
#include "compiler/syntax/transform.h"

namespace graftal {

/// The hand that drags a map, by what it can tell.
struct Hand {
    double grain = 0; ///< a length of the model that is just seen; 0: numbers are written exactly
    Box reach;        ///< of what is mapped; empty: about one unit
};

/// An affine map as a text writes it: a row of codes or a transform list, whose numbers may change.
class MapForm {
  public:
    /// The numbers have the values that `lets` gives them. Nothing where one of them has none, or where the
    /// map is no map: `why` then says it.
    static std::optional<MapForm> of(const RifsMap& map, const Environment& lets, std::string& why);
    static std::optional<MapForm> of(const std::vector<TransformLine>& lines, const Environment& lets,
                                     std::string& why);

    /// The numbers, in the order of the text.
    const std::vector<double>& values() const { return values_; }
    /// A change of a number that counts as much as others: degrees count less than lengths.
    double unit(std::size_t number) const;
    /// Whether a number moves only: the linear part does not depend on it.
    bool translates(std::size_t number) const;
    /// The map with these numbers in place of its own; nothing where they make none.
    std::optional<Affine> at(const std::vector<double>& values) const;
    /// The map as the text has it.
    const Affine& matrix() const { return matrix_; }
    /// Whether it moves the plane z = 0 in itself, and its text leaves z to the rule of flat maps.
    bool flat() const { return flat_; }

    bool is_row() const { return form_ != RifsForm::transforms; }
    const std::vector<TransformLine>& lines() const { return lines_; }

    /// Edits that give the numbers these values: a number, and an expression without names, is replaced; to
    /// one with names, such as `2*lean`, a constant is added. Numbers that stay are left as they are.
    std::vector<TextEdit> edits(const Document& document, const std::vector<double>& values) const;

    /// The values with the decimals that the hand can tell. Those that are the text's own stay.
    std::vector<double> rounded(const std::vector<double>& values, const Hand& hand) const;

    /// Scales of fewer numbers, none of them with names, get one for each axis: two of a flat map. `lines`:
    /// gets their places.
    MapForm widened(std::vector<std::size_t>& lines) const;
    /// A copy that need not stay in the plane.
    MapForm in_space() const;
    /// Lines that were not in the text, at the end of the list: made of literal numbers without places.
    std::optional<MapForm> with(std::vector<TransformLine> lines) const;

  private:
    static std::optional<MapForm> made(RifsForm form, std::vector<TransformLine> lines,
                                       std::vector<Expression> numbers, const Environment& lets,
                                       std::string& why);

    RifsForm form_ = RifsForm::transforms;
    std::vector<TransformLine> lines_; ///< of a transform list
    std::vector<Expression> numbers_;  ///< as the text has them
    std::vector<double> values_;
    Affine matrix_;
    bool flat_ = false;
};

/// A literal number without a place.
Expression number_of(double value);

/// A number as texts have it: the shortest one that reads back as the same, or a shorter one so near that
/// only rounding lies between. `about`: the size of what it was computed from, where that is larger.
std::string number_text(double value, double about = 0);

/// The matrix of a flat map, with the z that a row of `codes 2d` has.
Affine flattened(const Affine& map);

} // namespace graftal
