#pragma once

#include <optional>

#include "compiler/detail/graph/cut_graph.h"
#include "runtime/render/render.h"
#include "runtime/trace/picture_film.h"

namespace graftal {

/// Writes each pass to the file that is asked for, in place of the one before, developed by the view's film
/// and with the AOVs as further channels. Keeps references to the options.
class FileFilm final : public PictureFilm {
  public:
    FileFilm(const RenderOptions& options, const Film& film, const CutGraph& cut);

    void begin(const Tile& window, int channels) override;
    void tile(const Tile&, const Image&, int) override {}
    Status end(int pass, const Image& picture, const AovPicture* aovs) override;

  private:
    const RenderOptions& options_;
    Film film_;
    Tile window_;
    std::optional<ObjectNumbers> numbers_; ///< if there are AOVs
};

/// Linear light as the samples of a PNG. `window`: the place of the picture in the whole.
Image developed_picture(const Image& picture, const Tile& window, const Film& film, SampleFormat format,
                        const Workers& workers);

} // namespace graftal
