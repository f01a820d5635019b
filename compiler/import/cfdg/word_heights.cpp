// Heights in words: of shapes by their sizes, and of the elements of a rule by their order.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/import/cfdg/writer.h"

namespace graftal::cfdg {

namespace {

/// Turns that a loop is taken to have if its count is not known.
constexpr double unknown_turns = 1000;
/// The share of the height of all sizes that the elements of a rule may take.
constexpr double most_of_lift = 1e-6;
/// The share for elements that are translucent, which engines must see apart.
constexpr double most_of_lift_of_veils = 0.1;
/// The least distance at which both engines see one veil behind another.
constexpr double unit_of_veils = 1e-5;
/// More heights than these are rounded.
constexpr double most_heights = 1e6;

} // namespace

std::optional<double> Writer::turns_of(const Element& loop) const {
    std::vector<double> n;
    for (const Expr& bound : loop.arguments) {
        const std::optional<double> number = expressions_.number(bound);
        if (!number) return std::nullopt;
        n.push_back(*number);
    }
    if (n.empty()) return std::nullopt;
    const double turns = n.size() == 1 ? n[0] : (n[1] - n[0]) / (n.size() > 2 && n[2] != 0 ? n[2] : 1);
    return std::max(0.0, std::ceil(turns));
}

double Writer::width_of(const Elements& elements, std::size_t shape) const {
    double width = 0;
    for (const Element& element : elements)
        width += width_of(element, shape);
    return width;
}

/// Number of heights that an element of a rule of the shape needs.
double Writer::width_of(const Element& element, std::size_t shape) const {
    const double body = width_of(element.body, shape), other = width_of(element.other, shape);
    switch (element.kind) {
    case Element::Kind::shape: {
        const std::optional<std::size_t> to = recursion_.index(element.name);
        return to && !recursion_.together(shape, *to) ? widths_[*to] : 1;
    }
    case Element::Kind::loop:
        return turns_of(element).value_or(unknown_turns) * body + other;
    case Element::Kind::condition:
        return std::max(body, other);
    case Element::Kind::choice: {
        double most = 0;
        for (const Case& one : element.cases)
            most = std::max(most, width_of(one.body, shape));
        return most;
    }
    case Element::Kind::transform:
        return static_cast<double>(element.arguments.size()) * body;
    case Element::Kind::define:
    case Element::Kind::path_operation:
        break;
    }
    return 0;
}

/// Shapes that others draw come first. The unit stays 0 where heights would be too many.
void Writer::find_widths() {
    widths_.assign(grammar_.shapes.size(), 1);
    for (const std::size_t shape : recursion_.from_the_leaves()) {
        for (const Rule& rule : grammar_.shapes[shape].rules)
            if (!grammar_.shapes[shape].is_path)
                widths_[shape] = std::max(widths_[shape], width_of(rule.body, shape));
        widest_ = std::max(widest_, widths_[shape]);
        if (widest_ > most_heights) return;
    }
    if (!translucent_)
        unit_ = most_of_lift * lift / widest_;
    else if (2 * widest_ * unit_of_veils <= most_of_lift_of_veils * lift)
        unit_ = unit_of_veils;
    copy_step_ = unit_;
}

/// The third number of a `translate`; "" of none.
std::string Writer::height_text(const Height& height, const Size& size) const {
    const bool depends = !size.factors.empty();
    double known = !height.lifts ? 0 : depends ? lift : lift * (1 - size.known);
    if (height.calls && (depends || std::abs(size.known - 1) < 1e-6)) known += unit_ * widest_;
    known += unit_ * height.order;
    std::string text = known != 0 ? shortest(known) : "";
    if (height.lifts && depends) text += fmt::format(" - {}{}", shortest(lift * size.known), size.factors);
    if (!height.each_of.empty())
        text += fmt::format("{}{}/({})", text.empty() ? "" : " + ", shortest(unit_ * height.width),
                            height.each_of);
    return text;
}

} // namespace graftal::cfdg
