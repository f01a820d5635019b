// Primitives, and the lines of operators: transforms and inks.

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/import/eisenscript/text.h"
#include "compiler/import/eisenscript/writer.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"

namespace graftal::eisenscript {

namespace {

/// The size in place of 0: graftal's maps must be regular.
constexpr double thinnest = 1e-4;

} // namespace

// Primitives

std::string Writer::triangle_object(const Token& token) {
    std::vector<double> numbers;
    std::string word;
    for (const char c : token.text.substr(9)) {
        if (c != ',' && c != ';' && c != ']') {
            if (c != ' ') word += c;
            continue;
        }
        const std::optional<double> value = parse_number(word);
        if (value && std::abs(*value) <= 1e9) numbers.push_back(*value - 0.5);
        word.clear();
    }
    std::optional<std::string> map;
    if (numbers.size() == 9)
        map = triangle_map({numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]},
                           {numbers[6], numbers[7], numbers[8]});
    if (!map) {
        file_.diagnostics.error(token.span, "a triangle is written triangle[0,0,0;1,0,0;0.5,1,0.5]")
            .with_hint("its corners must not lie on one line");
        return "nothing";
    }
    auto [known, fresh] = primitive_names_.try_emplace(*map);
    if (fresh) {
        known->second = free_name("triangle_1");
        primitive_lines_[*map] = {*map};
    }
    return known->second;
}

std::string Writer::primitive(const Action& action) {
    const std::string& text = action.target.text;
    if (text.starts_with("triangle[")) return triangle_object(action.target);
    const std::size_t colons = text.find("::");
    const std::string kind = text.substr(0, colons);
    const std::string of = colons == std::string::npos ? "" : plain_name(text.substr(colons + 2));
    auto [known, fresh] = primitive_names_.try_emplace(text);
    if (!fresh) return known->second;
    known->second = free_name(of.empty() ? (kind == "sphere"     ? "ball"
                                            : kind == "cylinder" ? "rod"
                                                                 : kind)
                                         : fmt::format("{}_{}", of, kind));
    std::vector<std::string>& lines = primitive_lines_[text];
    if (kind == "box") {
        lines = {"instance: cube  scale: 0.5"};
    } else if (kind == "sphere") {
        lines = {"instance: sphere  scale: 0.5"};
    } else if (kind == "dot" || kind == "point") {
        lines = {"instance: sphere  scale: 0.02"};
    } else if (kind == "line") {
        lines = {"instance: cylinder  scale: 0.01, 1, 0.01  rotate: z, -90  translate: -0.5, 0, 0"};
    } else if (kind == "cylinder" || kind == "tube") {
        lines = {"instance: cylinder  scale: 0.5, 1, 0.5  rotate: x, 90  translate: 0, 0, -0.5"};
    } else { // the edges of a box
        for (const auto& [turn, axis] : {std::pair{"z, -90", 'x'}, {"", 'y'}, {"x, 90", 'z'}})
            for (const double a : {-0.5, 0.5})
                for (const double b : {-0.5, 0.5}) {
                    const Vec3 at = axis == 'x'   ? Vec3(-0.5, a, b)
                                    : axis == 'y' ? Vec3(a, -0.5, b)
                                                  : Vec3(a, b, -0.5);
                    lines.push_back(fmt::format("instance: cylinder  scale: 0.01, 1, 0.01{}  translate: {}",
                                                *turn ? fmt::format("  rotate: {}", turn) : "",
                                                vector_text(at)));
                }
    }
    if (finishes_.contains(text.substr(std::min(text.size(), colons + 2))) && colons != std::string::npos)
        for (std::string& words : lines)
            words += fmt::format("  material: {}", of);
    return known->second;
}

// Lines

std::string Writer::transforms(const std::vector<Operator>& operators) {
    std::string text;
    std::array<std::string, 3> moved;
    const auto flush = [&] {
        if (moved[0].empty() && moved[1].empty() && moved[2].empty()) return;
        for (std::string& part : moved)
            if (part.empty()) part = "0";
        text += fmt::format("  translate: {}, {}, {}", moved[0], moved[1], moved[2]);
        moved = {};
    };
    for (auto op = operators.rbegin(); op != operators.rend(); ++op) {
        if (!op->moves()) continue;
        if (op->kind <= Operator::Kind::z) {
            std::string& part = moved[static_cast<std::size_t>(op->kind)];
            const std::string offset = expression(op->numbers[0]);
            part = part.empty() ? offset : fmt::format("{} + {}", offset, part);
            continue;
        }
        flush();
        if (op->kind <= Operator::Kind::rz) {
            const char axis = "xyz"[static_cast<int>(op->kind) - static_cast<int>(Operator::Kind::rx)];
            text += fmt::format("  rotate: {}, {}", axis, expression(op->numbers[0]));
        } else if (op->kind == Operator::Kind::size) {
            std::vector<std::string> factors;
            for (const Value& value : op->numbers) {
                if (value.number == 0) file_.diagnostics.warning(op->span, "a size of 0 becomes 0.0001");
                factors.push_back(value.number == 0 ? shortest(thinnest) : expression(value));
            }
            text += fmt::format("  scale: {}", fmt::join(factors, ", "));
        } else {
            Loop alone;
            alone.operators.push_back(*op);
            const Affine map = map_of(alone);
            if (is_singular(map))
                file_.diagnostics.error(op->span, "this matrix is singular: it flattens what it maps");
            text += "  matrix:";
            for (int row = 0; row < 3; ++row)
                text += fmt::format(" {}, {}, {}, {}{}", shortest(map.linear[0][row]),
                                    shortest(map.linear[1][row]), shortest(map.linear[2][row]),
                                    shortest(map.translation[row]), row < 2 ? "," : "");
        }
    }
    flush();
    return text;
}

/// Colours of one list of operators, added up as Structure Synth does: those set and changed in one are set.
std::string Writer::inks(const std::vector<Operator>& operators) {
    std::array<double, 4> change = {0, 1, 1, 1};
    std::array<std::string, 4> words;
    bool set = false, drawn = false;
    const Operator* blend = nullptr;
    for (const Operator& op : operators) {
        if (op.kind == Operator::Kind::blend && op.numbers[0].number > 0) blend = &op;
        if (op.kind == Operator::Kind::colour) {
            drawn = !op.colour;
            if (op.colour) {
                const Hsv hsv = hsv_of(*op.colour);
                if (set) change = {0, 1, 1, 1};
                change[0] += hsv.hue_deg, change[1] *= hsv.saturation, change[2] *= hsv.value;
            }
            set = true;
        }
        if (op.kind < Operator::Kind::hue || op.kind > Operator::Kind::alpha) continue;
        const auto channel =
            static_cast<std::size_t>(op.kind) - static_cast<std::size_t>(Operator::Kind::hue);
        const double number = op.numbers[0].number;
        words[channel] = words[channel].empty() && number >= 0 ? expression(op.numbers[0]) : "";
        change[channel] = channel == 0 ? change[channel] + number : change[channel] * number;
    }
    for (std::size_t i = 1; i < 4; ++i)
        change[i] = std::clamp(change[i], 0.0, set ? 1.0 : 1e6);
    drawn = drawn || (set && change[0] > 360);
    std::string text;
    if (drawn) {
        if (pool_ == "randomrgb")
            text = "  ink: random(0, 1), random(0, 1), random(0, 1)";
        else if (pool_ == "greyscale")
            text = "  ink: hsv(0, 0, random(0, 1))";
        else if (pool_colours_.empty())
            text = "  ink: hsv(random(0, 360), 1, 1)";
    } else if (set) {
        text = fmt::format("  ink: hsv({}, {}, {})", shortest(change[0]), shortest(change[1]),
                           shortest(change[2]));
        if (change[3] < 1) text += fmt::format("  ink {{ alpha {} }}", shortest(change[3]));
    } else {
        static constexpr std::array channels = {"hue", "saturation", "value", "alpha"};
        std::string changes;
        for (std::size_t i = 0; i < 4; ++i) {
            const bool same = change[i] == (i == 0 ? 0 : 1);
            if (same && (words[i].empty() || !constants_.contains(words[i]))) continue;
            changes += fmt::format(" {} {}", channels[i],
                                   constants_.contains(words[i]) ? words[i] : shortest(change[i]));
        }
        if (!changes.empty()) text = fmt::format("  ink {{{} }}", changes);
    }
    if (blend) {
        const Hsv hsv = hsv_of(*blend->colour);
        const double share = blend->numbers[0].number / (1 + blend->numbers[0].number);
        text += fmt::format("  ink {{ hue to {1} by {0} saturation to {2} by {0} value to {3} by {0} }}",
                            shortest(share), shortest(hsv.hue_deg), shortest(hsv.saturation),
                            shortest(hsv.value));
    }
    return text;
}

} // namespace graftal::eisenscript
