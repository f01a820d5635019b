#pragma once

#include <optional>

#include "runtime/render/render.h"
#include "runtime/trace/picture_film.h"

namespace graftal {

/// Develops each pass as the picture's format wants it, and hands it on. Keeps a reference to the options.
class DevelopedFilm : public PictureFilm {
  public:
    explicit DevelopedFilm(const RenderOptions& options) : options_(options) {}

    void begin(const PictureShape& shape) override { shape_.emplace(shape); }
    void tile(const Tile&, const Image&, int) override {}
    Status end(int pass, const Image& picture, const AovPicture* aovs) override;

  protected:
    virtual Status take(const Image& developed, const AovPicture* aovs) = 0;
    const RenderOptions& options() const { return options_; }
    const PictureShape& shape() const { return *shape_; }

  private:
    const RenderOptions& options_;
    std::optional<PictureShape> shape_; ///< since begin()
};

/// Writes each pass to the file that is asked for, in place of the one before, with the AOVs as further
/// channels.
class FileFilm final : public DevelopedFilm {
  public:
    using DevelopedFilm::DevelopedFilm;

  private:
    Status take(const Image& developed, const AovPicture* aovs) override;
};

/// Keeps the last pass: the samples that the file would have.
class MemoryFilm final : public DevelopedFilm {
  public:
    using DevelopedFilm::DevelopedFilm;
    const Image& picture() const { return picture_; }

  private:
    Status take(const Image& developed, const AovPicture*) override {
        picture_ = developed;
        return {};
    }

    Image picture_;
};

} // namespace graftal
