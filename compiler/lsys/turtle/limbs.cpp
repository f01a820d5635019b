#include <algorithm>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "compiler/lsys/turtle/turtle.h"
#include "compiler/primitives/limb_sweep.h"

// The part of the turtle that gathers segments into limbs, each for one skin. A limb may begin in one part
// and go on in others; so a part hands on the segments that continue a limb from before, and the limb that
// is open at its exit.

namespace graftal {

namespace {

/// Two places are one if their distance is less than this share of what begins there.
constexpr double same_place = 1e-6;

bool are_near(Vec3 a, Vec3 b, double size) {
    return glm::distance(a, b) <= same_place * size;
}

} // namespace

/// Adds a segment to the limb that ends where it begins, or begins one.
void Turtle::extend_limb(const LimbNode& from, const LimbNode& to, int colour, Span span) {
    const double size = std::max({glm::distance(from.place, to.place), from.radius, to.radius});
    if (!limb_.nodes.empty()) {
        const LimbNode last = limb_.nodes.back();
        const bool goes_on = are_near(last.place, from.place, size);
        if (!goes_on || limb_.colour != colour || limb_.nodes.size() == most_limb_points) {
            end_limb();
            if (goes_on) stand_on(last);
        }
    }
    if (limb_.nodes.empty()) {
        if (limb_.base == Limb::Base::limb && !are_near(limb_.base_place, from.place, size)) limb_ = {};
        limb_.colour = colour;
        limb_.span = span;
        limb_.nodes.push_back(from);
    }
    limb_.nodes.push_back(to);
    set_limb_radius(to.radius);
}

/// The limb tapers from the width before to this one.
void Turtle::add_segment_to_limb(double length, double width, Span span) {
    if (length == 0) return;
    if (width == 0) return set_limb_radius(0);
    const Vec3 from = start_from_turtle_.translation;
    const Vec3 to = from + length * start_from_turtle_.linear[1];
    extend_limb({from, width / 2}, {to, width / 2}, read_colour(), span);
}

/// The next limb leaves another there.
void Turtle::stand_on(const LimbNode& node) {
    limb_ = {.base = Limb::Base::limb,
             .base_place = node.place,
             .base_radius = node.radius,
             .base_way = start_from_turtle_.linear[1]};
}

/// The radius is that of the limb that comes to here; 0: none does.
void Turtle::set_limb_radius(double radius) {
    state_.limb_radius = radius;
    writes_ |= reads_limb;
}

/// Draws the limb, or leaves it to the part in which it began.
void Turtle::end_limb() {
    if (limb_.base == Limb::Base::entry)
        part_.limbs.push_back(std::move(limb_));
    else if (!limb_.nodes.empty())
        context_.bodies.add_limb(limb_, context_.skin, sink(false));
    limb_ = {};
}

void Turtle::end_limbs() {
    std::vector<Limb> open = std::exchange(part_.limbs, {});
    for (Branch& branch : std::exchange(branches_, {}))
        open.push_back(std::move(branch.limb));
    open.push_back(std::move(limb_));
    for (Limb& limb : open) {
        limb_ = std::move(limb);
        if (limb_.base == Limb::Base::entry) limb_.base = Limb::Base::nothing; // nothing comes before a word
        end_limb();
    }
}

/// A branch begins: what it draws leaves the limb that comes to here.
Limb Turtle::branch_off() {
    Limb before = std::exchange(limb_, {});
    note(reads_limb);
    if (state_.limb_radius > 0) stand_on({start_from_turtle_.translation, state_.limb_radius});
    return before;
}

/// Goes on with the limb at the start of a part, and takes over the one at its exit.
void Turtle::append_limbs(const TurtlePart& part, double scale, Span span) {
    const auto placed = [&](const LimbNode& node) {
        return LimbNode{start_from_turtle_(scale * node.place), scale * node.radius};
    };
    const Limb& entry = part.limbs.front();
    // A limb that would be too long leaves the part's whole: parts are composed from the tips on, and each
    // would leave a limb of one segment behind.
    if (limb_.nodes.size() + entry.nodes.size() > most_limb_points + 1) {
        const LimbNode last = limb_.nodes.back();
        end_limb();
        stand_on(last);
    }
    for (std::size_t i = 1; i < entry.nodes.size(); ++i)
        extend_limb(placed(entry.nodes[i - 1]), placed(entry.nodes[i]), entry.colour, span);
    if (part.limbs.size() == 1) return;
    end_limb();
    limb_ = part.limbs.back();
    for (LimbNode& node : limb_.nodes)
        node = placed(node);
    limb_.base_place = start_from_turtle_(scale * limb_.base_place);
    limb_.base_radius *= scale;
    limb_.base_way = start_from_turtle_.linear * limb_.base_way;
}

} // namespace graftal
