#include "compiler/lsys/parse/surroundings.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/syntax/expression_parser.h"

namespace graftal {

namespace {

constexpr std::size_t most_sources = 100;

/// A statement of the environment, and the range of how many numbers it takes.
struct EnvironmentForm {
    std::string_view kind;
    std::size_t least, most;
    std::string_view numbers; ///< for messages
};

constexpr std::array<EnvironmentForm, 8> environment_forms = {
    {{"sphere", 4, 4, "x, y, z, radius"},
     {"box", 6, 6, "x, y, z of the least corner, then of the greatest"},
     {"plane", 4, 4, "a, b, c, d: all places with ax + by + cz <= d"},
     {"crowd", 1, 4, "radius, then x, y, z of a direction along which distance does not count"},
     {"rivals", 0, 3, "x, y, z of a direction along which distance does not count"},
     {"shade", 1, 1 + 4 * most_sources, "transmittance, then x, y, z, intensity of each source"},
     {"shadows", 4, 4, "size of a voxel, strength, decay, depth in voxels"},
     {"points", 3, 3, "count, distance of influence, distance of removal"}}};

const EnvironmentForm* form_of(std::string_view kind) {
    const auto* const found = std::ranges::find(environment_forms, kind, &EnvironmentForm::kind);
    return found == environment_forms.end() ? nullptr : found;
}

} // namespace

std::vector<std::string_view> environment_kinds() {
    std::vector<std::string_view> kinds;
    for (const EnvironmentForm& form : environment_forms)
        kinds.push_back(form.kind);
    return kinds;
}

std::optional<LsysBending> parse_bending(TokenStream& stream, Span keyword) {
    LsysBending bending{.span = keyword};
    bending.before = stream.accept("before");
    if (!bending.before && !stream.accept("after")) {
        stream.expected("'after' or 'before'")
            .with_hint("write bending after segments, after moves, or before moves");
        return std::nullopt;
    }
    bending.moves = stream.accept("moves");
    if (bending.moves || (!bending.before && stream.accept("segments"))) return bending;
    stream.expected(bending.before ? "'moves'" : "'segments' or 'moves'");
    return std::nullopt;
}

std::optional<LsysEnvironment> parse_environment(TokenStream& stream) {
    const std::optional<Token> kind = stream.expect_name("what answers '?E'");
    if (!kind) return std::nullopt;
    const EnvironmentForm* const form = form_of(kind->text);
    if (!form) {
        std::vector<std::string> known;
        for (const EnvironmentForm& other : environment_forms)
            known.emplace_back(other.kind);
        stream.diagnostics()
            .error(kind->span, fmt::format("there is no environment '{}'", kind->text))
            .with_hint(choices(kind->text, known));
        return std::nullopt;
    }
    LsysEnvironment statement{.kind = form->kind, .numbers = {}, .span = kind->span};
    while (!stream.at_end() && (statement.numbers.empty() || stream.accept(","))) {
        std::optional<Expression> number = parse_expression(stream);
        if (!number) return std::nullopt;
        statement.numbers.push_back(std::move(*number));
    }
    const std::size_t count = statement.numbers.size();
    if (count >= form->least && count <= form->most) return statement;
    Diagnostic& error = stream.diagnostics().error(
        kind->span, form->most == 0 ? fmt::format("'{}' takes no numbers", form->kind)
                                    : fmt::format("'{}' takes {} numbers{}, not {}", form->kind, form->least,
                                                  form->most > form->least ? " or more" : "", count));
    if (!form->numbers.empty()) error.with_hint(fmt::format("they are {}", form->numbers));
    return std::nullopt;
}

} // namespace graftal
