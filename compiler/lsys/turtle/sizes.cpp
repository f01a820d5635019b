#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "compiler/lsys/turtle/turtle.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

// The lengths, widths and angles of a turtle.

namespace graftal {

namespace {

/// `!` without an argument: the areas of two such branches sum to that of their parent.
constexpr double thinning = std::numbers::sqrt2 / 2;

} // namespace

double Turtle::line_width(double length) {
    constexpr double slenderness = 0.05;
    if (context_.relative_width) {
        const double least = context_.thinnest > 0 ? written(context_.thinnest) * read_unit() : 0;
        return at_least_size(std::max(read_width() * std::abs(length), least));
    }
    return context_.limit && context_.lines ? slenderness * std::abs(length) : read_width();
}

double Turtle::usual_angle() {
    if (!context_.varies_angle) return context_.angle_deg;
    note(reads_angle);
    return state_.angle_factor * context_.angle_deg;
}

/// The length in the model of a length that a string writes.
double Turtle::written(double length) {
    if (!context_.varies_step) return scale_ * length;
    note(reads_ruler);
    return state_.ruler * length;
}

/// The diameter of things as thick as a segment.
double Turtle::usual_diameter() {
    return context_.relative_width ? read_width() * scale_ * context_.step * read_unit() : read_width();
}

/// The width stays as it is, and so becomes another one as seen from the turtle. `written_too`: lengths that
/// strings write go with the scale.
bool Turtle::scale_by(double factor, bool written_too, Span span) {
    const double scale = scale_ * factor;
    const double ruler = state_.ruler * (written_too ? factor : 1);
    const double largest = std::max(ruler, context_.relative_width ? 0 : state_.width) / std::min(1.0, scale);
    if (scale >= least_size && scale <= largest_size && ruler >= least_size && largest <= largest_size) {
        scale_ = scale;
        if (!context_.varies_step || !written_too) return true;
        note(reads_ruler);
        writes_ |= reads_ruler;
        state_.ruler = ruler;
        return true;
    }
    if (factor > 0 && std::isfinite(factor)) return report_scale(span);
    context_.diagnostics.error(
        span, fmt::format("a factor of the scale must be above 0, but is {}", shortest(factor)));
    return false;
}

bool Turtle::report_scale(Span span) {
    context_.diagnostics.error(span, "the scale of the turtle leaves the range of numbers")
        .with_hint("use fewer steps, or factors closer to 1");
    return false;
}

void Turtle::taper() {
    note(reads_tapers);
    if (state_.tapers == most_tapers) return;
    ++state_.tapers;
    state_.width = at_least_size(context_.taper * read_width());
    writes_ |= reads_width | reads_tapers;
}

bool Turtle::widen_by(double factor, Span span) {
    const double width = factor * read_width();
    if (factor >= 0 && width <= largest_size) {
        state_.width = at_least_size(width);
        writes_ |= reads_width;
        return true;
    }
    context_.diagnostics.error(span, fmt::format("a width must lie between 0 and {}, but is {}",
                                                 shortest(largest_size), shortest(width)));
    return false;
}

/// A width never becomes negative.
bool Turtle::widen(double by, Span span) {
    const double width = read_width() + (context_.relative_width ? by : written(by));
    if (width <= largest_size) {
        state_.width = at_least_size(std::max(0.0, width));
        writes_ |= reads_width;
        return true;
    }
    context_.diagnostics.error(
        span, fmt::format("a width is at most {}, not {}", shortest(largest_size), shortest(width)));
    return false;
}

bool Turtle::multiply_angle(double factor, Span span) {
    note(reads_angle);
    const double product = state_.angle_factor * factor;
    if (std::abs(product) <= largest_size && std::isfinite(product * context_.angle_deg)) {
        state_.angle_factor = product;
        writes_ |= reads_angle;
        return true;
    }
    context_.diagnostics.error(span, "the factor of the angle leaves the range of numbers");
    return false;
}

/// Notes the radius of something round that is drawn here.
void Turtle::note_radius(double radius, WidthSource source) {
    part_.thickest = std::max(part_.thickest, radius);
    const double own_error = source == width_source_ ? width_error_ * radius : 0;
    part_.size_error.farthest = std::max(part_.size_error.farthest, size_shift_ + own_error);
    part_.error.farthest = std::max(part_.error.farthest, error_.shift + own_error);
    if (source == WidthSource::start) part_.width_sensitivity = std::max(part_.width_sensitivity, radius);
    const double by_unit = source == WidthSource::unit ? radius : 0;
    part_.unit_sensitivity.farthest = std::max(part_.unit_sensitivity.farthest, unit_shift_ + by_unit);
}

bool Turtle::set_width(std::span<const double> parameters, bool absolute, Span span) {
    const double width = parameters.empty()        ? thinning * read_width()
                         : context_.relative_width ? parameters[0]
                                                   : written(parameters[0]);
    if (width < 0) {
        context_.diagnostics.error(span,
                                   fmt::format("a width must not be negative, but is {}", shortest(width)));
        return false;
    }
    state_.width = at_least_size(width);
    if (!parameters.empty()) {
        width_source_ = absolute ? WidthSource::unit : WidthSource::sizes;
        if (!state_.in_cylinder) width_error_ = 0; // a taper has the width before, too
    }
    writes_ |= reads_width;
    return true;
}

} // namespace graftal
