#include "compiler/import/cfdg/paths/flags.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

namespace graftal::cfdg {

namespace {

struct FlagRow {
    PathFlag flag;
    std::string_view name;       ///< of version 3, behind "CF::"
    std::string_view word;       ///< of version 2; "" where it has none
    std::string_view operations; ///< beginnings of operations that take it
};

constexpr std::array<FlagRow, 12> rows = {{{PathFlag::align, "Align", "align", "CLOSEPOLY"},
                                           {PathFlag::arc_clockwise, "ArcCW", "cw", "ARC"},
                                           {PathFlag::arc_large, "ArcLarge", "large", "ARC"},
                                           {PathFlag::continuous, "Continuous", "", "CURVE"},
                                           {PathFlag::even_odd, "EvenOdd", "evenodd", "FILL"},
                                           {PathFlag::iso_width, "IsoWidth", "iso", "STROKE"},
                                           {PathFlag::miter_join, "MiterJoin", "miterjoin", "STROKE"},
                                           {PathFlag::round_join, "RoundJoin", "roundjoin", "STROKE"},
                                           {PathFlag::bevel_join, "BevelJoin", "beveljoin", "STROKE"},
                                           {PathFlag::butt_cap, "ButtCap", "buttcap", "STROKE"},
                                           {PathFlag::round_cap, "RoundCap", "roundcap", "STROKE"},
                                           {PathFlag::square_cap, "SquareCap", "squarecap", "STROKE"}}};

} // namespace

void PathFlags::add_known(PathFlag flag, std::string_view name, std::string_view operations, Span span) {
    if (operation_.starts_with(operations))
        flags_.insert(flag);
    else
        evaluator_.note(span, fmt::format("'{}' changes nothing in {}", name, operation_));
}

bool PathFlags::add(std::string_view flags, Span span) {
    constexpr std::string_view space = "CF::";
    while (flags.starts_with(space)) {
        const std::size_t end = std::min(flags.find(space, space.size()), flags.size());
        const std::string_view name = flags.substr(0, end);
        const auto* const row = std::ranges::find(rows, name.substr(space.size()), &FlagRow::name);
        if (row == rows.end()) {
            evaluator_.fail(span, fmt::format("'{}' is no flag of a path", name));
            return false;
        }
        add_known(row->flag, name, row->operations, span);
        flags.remove_prefix(end);
    }
    return true;
}

void PathFlags::add_word(std::string_view word, Span span) {
    bool known = false;
    for (const FlagRow& row : rows) {
        if (row.word.empty() || word.find(row.word) == std::string_view::npos) continue;
        known = true;
        add_known(row.flag, row.word, row.operations, span);
    }
    if (!known) evaluator_.note(span, fmt::format("'p {}' changes nothing here", word));
}

bool takes_word(std::string_view operation, std::string_view word) {
    const auto one_of = [&](std::initializer_list<std::string_view> words) {
        return std::ranges::find(words, word) != words.end();
    };
    if (operation == "STROKE") return one_of({"p", "width"});
    if (operation == "FILL" || operation == "CLOSEPOLY") return word == "p";
    if (one_of({"x", "y"})) return true;
    if (operation.starts_with("ARC")) return one_of({"rx", "ry", "r", "p"});
    return operation.starts_with("CURVE") && one_of({"x1", "y1", "x2", "y2", "p"});
}

bool takes_numbers(std::string_view operation, std::size_t count, const PathFlags& flags) {
    if (operation == "CLOSEPOLY" || operation == "FILL") return count == 0;
    if (operation == "STROKE") return count <= 1;
    if (operation.starts_with("ARC")) return count == 3 || count == 5;
    if (!operation.starts_with("CURVE")) return count == 2;
    return flags.has(PathFlag::continuous) ? count == 2 || count == 4 : count == 4 || count == 6;
}

} // namespace graftal::cfdg
