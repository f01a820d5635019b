#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/zoom/focus.h"
#include "compiler/zoom/magnification.h"

namespace graftal {

/// The maps from the frames on a path to the picture, as far as doubles hold them.
class ZoomScale {
  public:
    /// The focus at the origin of the picture, lengths `zoom` times as large as in the world.
    static ZoomScale about_focus(const Graph& graph, const Focus& focus, const Magnification& zoom);
    /// The picture has the frame of the last object of the (finite) path.
    static ZoomScale of_last_object(const Graph& graph, const Focus& focus);

    /// Goes on to the frame behind the next step of the path.
    void descend();
    /// The map of the frame reached; nothing while the frame is larger than `largest` in the picture.
    std::optional<Affine> picture_from_frame() const;
    /// Enlargement of lengths from the world to the picture.
    Magnification zoom() const { return zoom_; }

    static constexpr double largest = 1e150;

  private:
    ZoomScale(const Graph& graph, const Focus& focus) : graph_(&graph), focus_(&focus) {}
    void normalise();

    const Graph* graph_;
    const Focus* focus_;
    Magnification zoom_;
    std::size_t depth_ = 0;
    Mat3 linear_{1.0}; ///< about the focus: times 2^exponent_
    std::int64_t exponent_ = 0;
    std::shared_ptr<const std::vector<Affine>>
        from_last_; ///< picture_from_frame by steps up from the last object
};

} // namespace graftal
