#pragma once

#include <cstddef>
#include <vector>

namespace graftal::cfdg {

/// A line of an object, as its place in the order of painting sees it.
struct PaintedLine {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    std::size_t node = none; ///< the object that it draws; none of a primitive
    /// A shape of rules, painted when its own turn comes. Primitives and paths are painted with their rule.
    bool is_call = false;
    bool is_part = false;  ///< lines of the rule itself, which are an object of their own
    bool beside = false;   ///< it does not cover the line before it: both lie at one height
    double depth = 0;      ///< how far `z` moves it
    double log_shrunk = 0; ///< of a call: the logarithm of how much smaller it is
};

/// Heights of objects' lines over their objects, such that shapes lie in the order in which Context Free
/// paints them: by depth; then by the size of the shape whose rule draws them, the largest first; then by
/// generation; then in the order of the lines. Heights add up along each path through the objects.
/// Objects may contain themselves if each call shrinks heights as it shrinks sizes.
class PaintOrder {
  public:
    /// `extent` is the size of the picture. `veils`: copies of each shape, one over the other, where shapes
    /// are translucent, which lie as far apart as an engine must have them; else 0. `endless`: objects
    /// contain themselves, and calls scale the heights below them by their sizes. Requires that no such line
    /// moves in depth, and of others that no object contains itself. O(lines).
    PaintOrder(const std::vector<std::vector<PaintedLine>>& objects, std::size_t root, double extent,
               std::size_t veils, bool endless);

    double height(std::size_t object, std::size_t line) const { return heights_[object][line]; }
    /// The least height of one line over another.
    double gap() const { return gap_; }
    /// The height of the highest line over the root.
    double top() const { return top_; }
    /// Whether there are more lines than heights tell apart.
    bool is_crowded() const { return crowded_; }

  private:
    /// The extent of an object's drawing, in units of the least distance.
    struct Spread {
        double width = 0;  ///< lines of one size and one generation
        double levels = 0; ///< generations of one size
    };

    std::vector<std::vector<double>> heights_; ///< first the numbers of lines, then their heights
    double top_ = 0, gap_ = 0;
    bool crowded_ = false;
};

} // namespace graftal::cfdg
