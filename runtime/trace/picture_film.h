#pragma once

#include "compiler/detail/graph/detail_graph.h"
#include "compiler/scene/scene.h"
#include "compiler/support/status.h"
#include "runtime/image/image.h"
#include "runtime/trace/aovs.h"
#include "runtime/trace/tile.h"

namespace graftal {

/// The picture that comes. The view and the graph outlive the film.
struct PictureShape {
    Tile window; ///< the part of the whole picture that is drawn
    int channels = 3;
    const View& view;       ///< whose film makes samples for people of its light
    const DetailGraph& cut; ///< whose nodes AOVs name
};

/// The door by which a picture leaves the tracer: a file, the memory of a caller, a socket, the loss of a fit
/// stand behind it. It is drawn in passes, each finer than the one before; pixels are linear light, not
/// clamped.
class PictureFilm {
  public:
    virtual ~PictureFilm() = default;

    /// Called once, before all else.
    virtual void begin(const PictureShape& shape) = 0;
    /// Called for each finished tile of a pass, by one thread at a time. `tile` is in pixels of the whole
    /// picture; `picture` holds the window, with this pass in the tile.
    virtual void tile(const Tile& tile, const Image& picture, int pass) = 0;
    /// Called after a pass, or after the part of it that an interruption left, which is worth showing.
    /// `aovs`: null, or a pixel for each of the picture. A failure ends the drawing.
    virtual Status end(int pass, const Image& picture, const AovPicture* aovs) = 0;
};

} // namespace graftal
