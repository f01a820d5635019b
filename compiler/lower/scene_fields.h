#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/light/blackbody.h"
#include "compiler/lower/lower_area.h"
#include "compiler/lower/lower_transform.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"
#include "compiler/syntax/scene_statements.h"

namespace graftal {

inline constexpr double most_brightness = 1e6; // half floats of POV-Ray's pictures end at 65504

/// Whether a number lies between two, or is one of them.
inline auto between(double least, double most) {
    return [=](double x) { return x >= least && x <= most; };
}
inline auto whole_between(double least, double most) {
    return [=](double x) { return x >= least && x <= most && x == std::floor(x); };
}

/// One statement's fields by name, each evaluated and checked on demand.
class SceneFields {
  public:
    SceneFields(const SceneStatement& statement, const Environment& lets, Diagnostics& diagnostics)
        : statement_(statement), lets_(lets), diagnostics_(diagnostics) {
        for (const SceneField& field : statement.fields)
            if (const SceneField* const first = find(field.keyword); first != &field)
                diagnostics.error(field.span, fmt::format("duplicate '{}'", field.keyword))
                    .with_note(first->span, "first given here");
    }

    const SceneField* find(std::string_view keyword) const {
        const auto found = std::ranges::find(statement_.fields, keyword, &SceneField::keyword);
        return found == statement_.fields.end() ? nullptr : &*found;
    }

    const Environment& lets() const { return lets_; }
    bool empty() const { return statement_.fields.empty(); }
    /// False if an error lost a part of the statement, which may be what is missed.
    bool complete() const { return statement_.complete; }
    bool flag(std::string_view keyword) const { return find(keyword) != nullptr; }

    /// A point of the scene.
    std::optional<Vec3> place(std::string_view keyword) const {
        return vector(keyword, is_place, place_demand());
    }

    /// One coordinate of such a point.
    std::optional<double> coordinate(std::string_view keyword) const {
        return number(keyword, between(-largest_size, largest_size), place_demand());
    }

    std::optional<unsigned> whole(std::string_view keyword, unsigned least, unsigned most) const {
        const std::optional<double> value =
            number(keyword, whole_between(least, most),
                   fmt::format("be a whole number between {} and {}", least, most));
        return value ? std::optional(static_cast<unsigned>(*value)) : std::nullopt;
    }

    /// A vector of which only the direction counts.
    std::optional<Vec3> direction(std::string_view keyword) const {
        const auto good = [](Vec3 v) { return v == Vec3(0.0) || is_direction(v); };
        return vector(keyword, good, range_demand());
    }

    /// A positive size: number `index` of the field's.
    std::optional<double> size(std::string_view keyword, std::size_t index = 0) const {
        const std::optional<double> value = number(
            keyword, [](double x) { return x > 0; }, "be positive", index);
        if (!value || is_size(*value)) return value;
        return number(keyword, is_size, range_demand(), index);
    }

    std::optional<Rgb> color(std::string_view keyword) const {
        const SceneField* field = find(keyword);
        return field ? lower_color(field->values, lets_, diagnostics_) : std::nullopt;
    }

    std::optional<Rgb> light_color(std::string_view keyword) const {
        const SceneField* field = find(keyword);
        return field ? lower_light_color(field->values, lets_, diagnostics_) : std::nullopt;
    }

    std::optional<double> temperature(std::string_view keyword) const {
        return within(keyword, least_temperature_k, most_temperature_k, " kelvin");
    }

    /// A factor of light.
    std::optional<double> brightness(std::string_view keyword) const {
        return within(keyword, 0, most_brightness);
    }

    std::optional<FlatArea> area(std::string_view keyword) const {
        const SceneField* field = find(keyword);
        return field ? lower_area(field->values, field->span, lets_, diagnostics_) : std::nullopt;
    }

    std::optional<double> number(std::string_view keyword, std::size_t index = 0) const {
        const SceneField* field = find(keyword);
        return field ? evaluate(field->values[index], lets_, diagnostics_) : std::nullopt;
    }

    /// A number for which `good` holds, else the error "'angle' must lie ..., not 200".
    template<typename Predicate>
    std::optional<double> number(std::string_view keyword, const Predicate& good, std::string_view demand,
                                 std::size_t index = 0) const {
        const std::optional<double> value = number(keyword, index);
        if (!value || good(*value)) return value;
        diagnostics_.error(find(keyword)->values[index].span,
                           fmt::format("'{}' must {}, not {}", keyword, demand, shortest(*value)));
        return std::nullopt;
    }

    /// A number of a range. `unit`: what messages say after its ends.
    std::optional<double> within(std::string_view keyword, double least, double most,
                                 std::string_view unit = "") const {
        return number(keyword, between(least, most),
                      fmt::format("lie between {} and {}{}", shortest(least), shortest(most), unit));
    }

    void error(std::string_view keyword, std::string message) const {
        diagnostics_.error(find(keyword)->span, std::move(message));
    }

    void error_at_statement(std::string message, std::string hint) const {
        if (!complete()) return;
        diagnostics_.error(statement_.span, std::move(message)).with_hint(std::move(hint));
    }

  private:
    static std::string place_demand() {
        return fmt::format("lie within {} units of the origin", shortest(largest_size));
    }
    static std::string range_demand() {
        return fmt::format("have a size between {} and {}", shortest(least_size), shortest(largest_size));
    }

    template<typename Predicate>
    std::optional<Vec3> vector(std::string_view keyword, const Predicate& good,
                               const std::string& demand) const {
        const SceneField* field = find(keyword);
        if (!field) return std::nullopt;
        const std::optional<Vec3> value = lower_vector(field->values, lets_, diagnostics_);
        if (!value || good(*value)) return value;
        diagnostics_.error(join(field->values.front().span, field->values.back().span),
                           fmt::format("'{}' must {}", keyword, demand));
        return std::nullopt;
    }

    const SceneStatement& statement_;
    const Environment& lets_;
    Diagnostics& diagnostics_;
};

} // namespace graftal
