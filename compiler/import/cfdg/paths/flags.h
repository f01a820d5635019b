#pragma once

#include <cstdint>
#include <initializer_list>
#include <set>
#include <string_view>

#include "compiler/import/cfdg/evaluate/evaluator.h"

namespace graftal::cfdg {

enum class PathFlag : std::uint8_t {
    align,
    arc_clockwise,
    arc_large,
    continuous,
    even_odd,
    iso_width,
    miter_join,
    round_join,
    bevel_join,
    butt_cap,
    round_cap,
    square_cap
};

/// The flags of a line of a path: those that its operation or command takes. A note says which change
/// nothing.
class PathFlags {
  public:
    /// `operation` is that of the line: "ARCTO", "STROKE" and so on. All must outlive this.
    PathFlags(Evaluator& evaluator, std::string_view operation)
        : evaluator_(evaluator), operation_(operation) {}

    /// Adds flags of version 3, one after the other: "CF::RoundCapCF::IsoWidth". False after an error.
    bool add(std::string_view flags, Span span);
    /// Adds those of version 2, which are parts of one word: `p roundcapiso`.
    void add_word(std::string_view word, Span span);
    void add(PathFlag flag) { flags_.insert(flag); }

    bool has(PathFlag flag) const { return flags_.contains(flag); }

  private:
    void add_known(PathFlag flag, std::string_view name, std::string_view operations, Span span);

    Evaluator& evaluator_;
    std::string_view operation_;
    std::set<PathFlag> flags_;
};

/// Whether a line of version 2 may have the adjustment: `rx` of ARCTO, `width` of STROKE.
bool takes_word(std::string_view operation, std::string_view word);

/// Whether the operation may have this many numbers.
bool takes_numbers(std::string_view operation, std::size_t count, const PathFlags& flags);

} // namespace graftal::cfdg
