#include "compiler/editing/maps/map_form.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/editing/rounding.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/lower/point_maps.h"
#include "compiler/rifs/system.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"
#include "compiler/syntax/write_out.h"

namespace graftal {

namespace {

using LineKind = TransformLine::Kind;

/// The unit of what never changes: the points by whose images a map is said.
constexpr double fixed = 1e-9;

bool has_names(const Expression& expression) {
    if (expression.kind == Expression::Kind::name && expression.text != "pi") return true;
    if (expression.kind == Expression::Kind::element) return true;
    return std::ranges::any_of(expression.operands, has_names);
}

/// Whether one pair of brackets holds all of the text.
bool is_bracketed(std::string_view text) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        depth += (text[i] == '(') - (text[i] == ')');
        if (depth == 0) return text[i] == ')' && i + 1 == text.size();
    }
    return false;
}

/// Whether a constant can stand behind it without brackets.
bool takes_a_constant(const Expression& expression, std::string_view text) {
    if (is_bracketed(text) || expression.kind != Expression::Kind::binary) return true;
    constexpr std::string_view loose[] = {"==", "!=", "<", "<=", ">", ">=", "&&", "||"};
    return std::ranges::count(loose, expression.text) == 0;
}

bool is_flat(const Affine& map) {
    const Mat3& m = map.linear;
    const double size = std::max(largest_entry(m), 1e-300);
    const double others =
        std::max({std::abs(m[2][0]), std::abs(m[2][1]), std::abs(m[0][2]), std::abs(m[1][2])});
    if (others > 0 || map.translation.z != 0) return false;
    return std::abs(flattened(map).linear[2][2] - m[2][2]) <= 1e-9 * size;
}

/// The most that two maps differ in a box.
double farthest(const Affine& a, const Affine& b, const Box& box) {
    double most = 0;
    for (const Vec3& corner : box.corners())
        most = std::max(most, glm::distance(a(corner), b(corner)));
    return most;
}

} // namespace

Expression number_of(double value) {
    Expression number;
    number.number = value;
    return number;
}

std::string number_text(double value, double about) {
    std::string rounded;
    append_number(rounded, value, 12);
    const std::optional<double> read = parse_number(rounded);
    constexpr double rounding = 4e-15;
    if (read && std::abs(*read - value) <= rounding * std::max(std::abs(value), about)) return rounded;
    return std::abs(value) < rounding ? "0" : shortest(value);
}

Affine flattened(const Affine& map) {
    const Mat3& m = map.linear;
    return flat_map({m[0][0], m[0][1], 0}, {m[1][0], m[1][1], 0}, {map.translation.x, map.translation.y, 0});
}

std::optional<MapForm> MapForm::of(const RifsMap& map, const Environment& lets, std::string& why) {
    if (map.form == RifsForm::transforms) return of(map.transforms, lets, why);
    return made(map.form, {}, map.codes, lets, why);
}

std::optional<MapForm> MapForm::of(const std::vector<TransformLine>& lines, const Environment& lets,
                                   std::string& why) {
    std::vector<Expression> numbers;
    for (const TransformLine& line : lines)
        numbers.insert(numbers.end(), line.numbers.begin(), line.numbers.end());
    return made(RifsForm::transforms, lines, std::move(numbers), lets, why);
}

std::optional<MapForm> MapForm::made(RifsForm form, std::vector<TransformLine> lines,
                                     std::vector<Expression> numbers, const Environment& lets,
                                     std::string& why) {
    MapForm result;
    Diagnostics faults;
    for (const Expression& number : numbers) {
        if (calls_chance(number)) {
            why = "its numbers are random";
            return std::nullopt;
        }
        const std::optional<double> value = evaluate(number, lets, faults);
        if (!value) {
            why = faults.all().empty() ? "one of its numbers has no value" : faults.all().front().message;
            return std::nullopt;
        }
        result.values_.push_back(*value);
    }
    result.form_ = form;
    result.lines_ = std::move(lines);
    result.numbers_ = std::move(numbers);
    const std::optional<Affine> matrix = result.at(result.values_);
    if (!matrix) {
        why = "it is no map that can be drawn";
        return std::nullopt;
    }
    result.matrix_ = *matrix;
    const bool flat_row = form == RifsForm::codes_2d || form == RifsForm::codes_polar ||
                          (form == RifsForm::codes_barycentric && control_points(result.values_.size()) == 3);
    result.flat_ = flat_row || is_flat(*matrix);
    return result;
}

double MapForm::unit(std::size_t number) const {
    constexpr double degrees = 57.3;
    if (form_ == RifsForm::codes_barycentric) {
        const std::size_t points = control_points(values_.size());
        return number < points * points ? 1 : fixed;
    }
    if (form_ == RifsForm::codes_polar) return number == 2 || number == 3 ? degrees : 1;
    for (const TransformLine& line : lines_) {
        const std::size_t count = line.numbers.size();
        if (number < count && line.kind == LineKind::points) return 2 * number < count ? fixed : 1;
        if (number < count) return line.kind == LineKind::rotate && number + 1 == count ? degrees : 1;
        number -= line.numbers.size();
    }
    return 1;
}

bool MapForm::translates(std::size_t number) const {
    if (form_ == RifsForm::codes_3d) return number >= 9;
    if (is_row()) return form_ != RifsForm::codes_barycentric && number >= 4;
    for (const TransformLine& line : lines_) {
        if (number < line.numbers.size()) {
            const bool rows = line.kind == LineKind::matrix || line.kind == LineKind::projection;
            return line.kind == LineKind::translate || (rows && number % 4 == 3);
        }
        number -= line.numbers.size();
    }
    return false;
}

std::optional<Affine> MapForm::at(const std::vector<double>& values) const {
    if (is_row()) {
        const Affine map = map_from_codes(form_, values);
        return is_finite(map) && range_fault(map).empty() ? std::optional(map) : std::nullopt;
    }
    Diagnostics ignored;
    std::vector<TransformLine> lines = lines_;
    auto value = values.begin();
    for (TransformLine& line : lines)
        for (Expression& number : line.numbers)
            number = number_of(*value++);
    return lower_transforms(lines, {}, ignored);
}

std::vector<TextEdit> MapForm::edits(const Document& document, const std::vector<double>& values) const {
    std::vector<TextEdit> edits;
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
        const Expression& number = numbers_[i];
        const double change = values[i] - values_[i];
        constexpr double rounding = 1e-15;
        if (unit(i) == fixed || !number.span.known() || std::abs(change) <= rounding * std::abs(values_[i]))
            continue;
        if (!has_names(number)) {
            edits.push_back({number.span.begin, number.span.end, number_text(values[i])});
            continue;
        }
        const std::string_view text = document.text(number.span);
        const bool sum = number.kind == Expression::Kind::binary &&
                         (number.text == "+" || number.text == "-") && !text.starts_with("(");
        if (sum && number.operands[1].kind == Expression::Kind::number) {
            const Expression& constant = number.operands[1];
            const double sign = number.text == "-" ? -1 : 1;
            edits.push_back({constant.span.begin, constant.span.end,
                             number_text(constant.number + sign * change, std::abs(values_[i]))});
            continue;
        }
        const std::string behind =
            (change < 0 ? "-" : "+") + number_text(std::abs(change), std::abs(values_[i]));
        if (takes_a_constant(number, text))
            edits.push_back({number.span.end, number.span.end, behind});
        else
            edits.push_back({number.span.begin, number.span.end, fmt::format("({}){}", text, behind)});
    }
    return edits;
}

std::vector<double> MapForm::rounded(const std::vector<double>& values, const Hand& hand) const {
    const std::optional<Affine> map = at(values);
    if (!(hand.grain > 0) || !map) return values;
    const Box reach = hand.reach.empty() ? Box{Vec3(-1.0), Vec3(1.0)} : hand.reach;
    std::vector<double> result = values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double change = values[i] - values_[i];
        constexpr double kept = 1e-12;
        if (std::abs(change) <= kept * std::abs(values_[i])) {
            result[i] = values_[i];
            continue;
        }
        const auto unseen = [&](double off) {
            std::vector<double> moved = values;
            moved[i] += off;
            const std::optional<Affine> other = at(moved);
            return other && farthest(*map, *other, reach) <= hand.grain / static_cast<double>(values.size());
        };
        const int decimals = decimals_for(unseen);
        // To a number with names a constant is added.
        result[i] = has_names(numbers_[i]) ? values_[i] + graftal::rounded(change, decimals)
                                           : graftal::rounded(values[i], decimals);
    }
    return at(result) ? result : values;
}

MapForm MapForm::in_space() const {
    MapForm result = *this;
    result.flat_ = false;
    return result;
}

MapForm MapForm::widened(std::vector<std::size_t>& lines) const {
    MapForm result = *this;
    result.numbers_.clear();
    result.values_.clear();
    const std::size_t axes = flat_ ? 2 : 3;
    std::size_t number = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const std::size_t count = lines_[i].numbers.size();
        std::vector<Expression> numbers = lines_[i].numbers;
        std::vector<double> values(values_.begin() + static_cast<std::ptrdiff_t>(number),
                                   values_.begin() + static_cast<std::ptrdiff_t>(number + count));
        number += count;
        if (lines_[i].kind == LineKind::scale && count < axes && std::ranges::none_of(numbers, has_names)) {
            const double mean = std::sqrt(std::abs(values.front() * values.back()));
            while (values.size() < axes)
                values.push_back(count == 2 ? mean : values.front());
            numbers.resize(axes);
            result.lines_[i].numbers = numbers;
            lines.push_back(i);
        }
        std::ranges::move(numbers, std::back_inserter(result.numbers_));
        std::ranges::move(values, std::back_inserter(result.values_));
    }
    return result;
}

std::optional<MapForm> MapForm::with(std::vector<TransformLine> lines) const {
    std::vector<TransformLine> all = lines_;
    std::ranges::move(lines, std::back_inserter(all));
    // The numbers that are there keep their values, whatever their names stand for.
    MapForm result = *this;
    result.lines_ = std::move(all);
    for (std::size_t i = lines_.size(); i < result.lines_.size(); ++i)
        for (const Expression& number : result.lines_[i].numbers) {
            result.numbers_.push_back(number);
            result.values_.push_back(number.number);
        }
    const std::optional<Affine> matrix = result.at(result.values_);
    if (!matrix) return std::nullopt;
    result.matrix_ = *matrix;
    return result;
}

} // namespace graftal
